/* SPDX-License-Identifier: Apache-2.0 */
/* Fits over nodes: what they preserve, means by mass, separate sets, and where they fall back. */
#include "antilocking/node_fit.h"
#include "simulation_fixture.h"
#include "state/sparse_grid.h"

enum { CELLS = 6, PER_CELL = 20, COMPONENTS = 6, MOST_SLOTS = 20 * LANE_COUNT };
/* Sums of some hundred numbers around 1; linear fits lose twice the digits of coordinates up to
 * CELLS, over a spread of about 1/30. */
#define ROUNDING (3e4 * (double)REAL_EPSILON)

static const double cell_width[3] = {0.5, 0.25, 2.0};

struct bench {
    struct sparse_grid grid;
    struct talus_scene scene;
    struct node_fit fit;
    struct shape_context context;
    const struct shape_kernels *kernels;
    size_t axes;
};

/* Arrays of one block. */
struct block_arrays {
    _Alignas(64) real weight[MOST_SLOTS], product[MOST_SLOTS], coordinate[3][MOST_SLOTS];
    _Alignas(64) real values[COMPONENTS][MOST_SLOTS];
    real *quantities[COMPONENTS];
    struct node_fit_block at;
};

static size_t components_of(size_t axes)
{
    return axes == 1 ? 3 : axes == 2 ? 4 : 6;
}

/* Particles at random places of a box of CELLS cells an axis (3 in z); two materials in turn. */
static void bench_init(struct bench *bench, size_t axes, enum talus_anti_locking_field field,
                       enum talus_anti_locking_averaging averaging)
{
    uint64_t random = 7 + axes;
    memset(bench, 0, sizeof *bench);
    bench->axes = axes;
    bench->scene.axis_count = axes;
    bench->scene.dimension = axes == 1 ? TALUS_LINE : axes == 2 ? TALUS_PLANE_STRAIN : TALUS_SOLID;
    bench->scene.material_count = 2;
    bench->scene.solver.anti_locking = TALUS_CONTROL_NODE;
    bench->scene.solver.anti_locking_field = field;
    bench->scene.solver.anti_locking_averaging = averaging;
    struct sparse_grid *grid = &bench->grid;
    grid->domain.axis_count = axes;
    for (size_t axis = 0; axis < 3; axis++) {
        bench->scene.grid.cell_count[axis] = CELLS;
        grid->domain.cell_count[axis] = CELLS;
    }
    grid->layout.component_count[PARTICLE_POSITION] = (uint32_t)axes;
    grid->layout.component_count[PARTICLE_MASS] = 1;
    particle_layout_finish(&grid->layout);
    node_layout_init(&grid->nodes.layout, axes, false);
    node_fit_init(&bench->fit, &bench->scene, components_of(axes));
    node_fit_place(&bench->fit,
                   node_layout_extend(&grid->nodes.layout, bench->fit.component_count));
    const int32_t high = axes > 1 ? CELLS : 1, deep = axes > 2 ? 3 : 1;
    for (int32_t particle = 0; particle < CELLS * high * deep * PER_CELL; particle++) {
        const int32_t index = particle / PER_CELL;
        const int32_t cell[3] = {index % CELLS, index / CELLS % high, index / CELLS / high};
        struct particle_record record = {.id = (uint32_t)particle};
        size_t slot = 0;
        for (size_t axis = 0; axis < axes; axis++)
            record.values[axis] = (real)(0.5 * random_value(&random));
        record.values[axes] = (real)(1.5 + random_value(&random));
        assert_int_not_equal(sparse_grid_insert(grid, cell, &record, &slot), BLOCK_NONE);
    }
    bench->context = shape_context_make(&grid->layout, &grid->nodes, cell_width, 0.1);
    bench->kernels = shape_find("linear")->kernels[axes - 1];
    for (size_t block = 0; block < grid->nodes.count; block++)
        node_fit_clear(&bench->fit, &grid->nodes, block);
}

static size_t material_of(const struct particle_block *block, size_t slot)
{
    return block->id[slot] % 2;
}

/* Weights of one material, and coordinates. */
static void take_block(struct bench *bench, size_t index, size_t material,
                       struct block_arrays *arrays)
{
    const struct particle_block *block = &bench->grid.blocks[index];
    const real *mass = particle_values(&bench->grid.layout, block, PARTICLE_MASS, 0);
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    assert_true(count <= MOST_SLOTS);
    memset(arrays, 0, sizeof *arrays);
    for (size_t slot = 0; slot < count; slot++)
        arrays->weight[slot] = material_of(block, slot) == material ? mass[slot] : 0;
    for (size_t component = 0; component < COMPONENTS; component++)
        arrays->quantities[component] = arrays->values[component];
    arrays->at = (struct node_fit_block){
        .context = &bench->context,
        .kernels = bench->kernels,
        .block = block,
        .product = arrays->product,
        .coordinate = {arrays->coordinate[0], arrays->coordinate[1], arrays->coordinate[2]}};
    node_fit_locate(&bench->fit, &arrays->at);
}

/* Fields: constants that differ by material; with a slope lines in the normal components. */
static double field_at(const struct bench *bench, const struct block_arrays *arrays, size_t slot,
                       size_t component, size_t material, double slope)
{
    const struct particle_block *block = arrays->at.block;
    double value = 0.3 + 0.1 * (double)component + (double)material;
    for (uint32_t axis = 0; axis < bench->axes && component < 3; axis++) {
        const real *position = particle_values(&bench->grid.layout, block, PARTICLE_POSITION, axis);
        const size_t lane = axis == 0 ? slot % LANE_COUNT : 0;
        const double x = block->cell[axis] + (double)lane - 0.5 * CELLS + (double)position[slot];
        value += slope * (double)(1 + component + axis) * x;
    }
    return value;
}

/* Scatters the field, solves, and returns the largest difference of what comes back. */
static double round_trip(struct bench *bench, double slope)
{
    struct block_arrays arrays;
    double worst = 0;
    for (int back = 0; back < 2; back++) {
        for (size_t block = 0; back && block < bench->grid.nodes.count; block++)
            assert_int_equal(
                node_fit_solve(&bench->fit, &bench->grid.nodes, block, NODE_FIT_STRAIN), 0);
        for (size_t index = 0; index < bench->grid.block_count; index++) {
            const size_t count = (size_t)bench->grid.blocks[index].row_count * LANE_COUNT;
            for (size_t material = 0; material < 2; material++) {
                take_block(bench, index, material, &arrays);
                if (back)
                    node_fit_gather(&bench->fit, &arrays.at, material, NODE_FIT_STRAIN,
                                    arrays.quantities);
                for (size_t k = 0; k < bench->fit.quantity_count * count; k++) {
                    const size_t slot = k % count, component = k / count;
                    const double value = field_at(bench, &arrays, slot, component, material, slope);
                    real *held = &arrays.values[component][slot];
                    if (!back)
                        *held = (real)value;
                    else if (arrays.weight[slot] > 0)
                        worst = fmax(worst, fabs((double)*held - value));
                }
                if (back)
                    continue;
                node_fit_scatter_masses(&bench->fit, &arrays.at, material, arrays.weight, false);
                node_fit_scatter(&bench->fit, &arrays.at, material, NODE_FIT_STRAIN, arrays.weight,
                                 arrays.quantities);
            }
        }
    }
    return worst;
}

static void test_fields_preserved(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        for (int averaging = 0; averaging < 3; averaging++) {
            struct bench bench;
            bench_init(&bench, axes, TALUS_FIT_VOLUMETRIC,
                       (enum talus_anti_locking_averaging)averaging);
            assert_close(round_trip(&bench, 0), 0, ROUNDING, 1.0);
            sparse_grid_release(&bench.grid);
            bench_init(&bench, axes, TALUS_FIT_FULL, (enum talus_anti_locking_averaging)averaging);
            /* Lines come back only with the weights that take nodes to the particles' places. */
            const double slope = averaging == TALUS_AVERAGING_UNWEIGHTED ? 0 : 0.2;
            assert_close(round_trip(&bench, slope), 0, ROUNDING, 1.0);
            sparse_grid_release(&bench.grid);
        }
    }
}

/* With weights in both directions sum m q stays: sum_p m_p sum_i N_ip (S_i / m_i) = sum_i S_i. */
static void test_mean_by_mass(void **state)
{
    (void)state;
    struct bench bench;
    struct block_arrays arrays;
    double before = 0, after = 0;
    bench_init(&bench, 2, TALUS_FIT_VOLUMETRIC, TALUS_AVERAGING_WEIGHTED);
    assert_true(round_trip(&bench, 0.7) > 0.1); /* scatters, solves; a line is not preserved */
    for (size_t index = 0; index < bench.grid.block_count; index++) {
        take_block(&bench, index, 0, &arrays);
        node_fit_gather(&bench.fit, &arrays.at, 0, NODE_FIT_STRAIN, arrays.quantities);
        for (size_t slot = 0; slot < MOST_SLOTS; slot++) {
            if (arrays.weight[slot] == 0)
                continue;
            before += (double)arrays.weight[slot] * field_at(&bench, &arrays, slot, 0, 0, 0.7);
            after += (double)(arrays.weight[slot] * arrays.values[0][slot]);
        }
    }
    assert_close(after, before, ROUNDING, fabs(before));
    sparse_grid_release(&bench.grid);
}

/* All particles of a material on one line: the nodes count as fallen back and take the mean. */
static void test_singular(void **state)
{
    (void)state;
    struct bench bench;
    struct block_arrays arrays;
    bench_init(&bench, 2, TALUS_FIT_FULL, TALUS_AVERAGING_WEIGHTED);
    take_block(&bench, 0, 0, &arrays);
    real *x = particle_values(&bench.grid.layout, &bench.grid.blocks[0], PARTICLE_POSITION, 0);
    real *y = particle_values(&bench.grid.layout, &bench.grid.blocks[0], PARTICLE_POSITION, 1);
    for (size_t slot = 0; slot < MOST_SLOTS; slot++) {
        if (slot % LANE_COUNT != 2 || slot / LANE_COUNT > 3)
            arrays.weight[slot] = 0;
        else
            y[slot] = x[slot];
        for (size_t component = 0; component < COMPONENTS; component++)
            arrays.values[component][slot] = (real)2;
    }
    node_fit_locate(&bench.fit, &arrays.at);
    node_fit_scatter_masses(&bench.fit, &arrays.at, 0, arrays.weight, false);
    node_fit_scatter(&bench.fit, &arrays.at, 0, NODE_FIT_STRAIN, arrays.weight, arrays.quantities);
    size_t fall_backs = 0;
    for (size_t block = 0; block < bench.grid.nodes.count; block++)
        fall_backs += node_fit_solve(&bench.fit, &bench.grid.nodes, block, NODE_FIT_STRAIN);
    assert_int_equal(fall_backs, 4);
    node_fit_gather(&bench.fit, &arrays.at, 0, NODE_FIT_STRAIN, arrays.quantities);
    for (size_t slot = 0; slot < MOST_SLOTS; slot++) {
        if (arrays.weight[slot] > 0)
            assert_close((double)arrays.values[0][slot], 2, ROUNDING, 1.0);
    }
    sparse_grid_release(&bench.grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields_preserved),
        cmocka_unit_test(test_mean_by_mass),
        cmocka_unit_test(test_singular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
