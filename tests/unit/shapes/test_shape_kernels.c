/* SPDX-License-Identifier: Apache-2.0 */
/* Every shape of the table, in one to three axes, without and with walls at the sides of cells:
 * partition of unity, linear reproduction, gradient sums, and that gathering is the transpose of
 * scattering. */
#include "shapes/shape.h"
#include "simulation_fixture.h"
#include "state/sparse_grid.h"

enum { ROWS = 5 };
#define TIME_STEP 0.125
#define DENSITY 4.0
#define ROUNDING (45 * (double)REAL_EPSILON)
static const double cell_width[3] = {0.5, 0.25, 2.0};

struct bench {
    struct sparse_grid grid;
    struct block_scratch scratch;
    struct shape_context context;
    const struct shape_kernels *kernels;
    size_t axes, count;
    uint32_t block;
    _Alignas(64) real volume[ROWS * LANE_COUNT];
};

static struct particle_block *bench_block(struct bench *bench)
{
    return &bench->grid.blocks[bench->block];
}

static real *values(struct bench *bench, enum particle_field field, size_t component)
{
    return particle_values(&bench->grid.layout, bench_block(bench), field, (uint32_t)component);
}

/* One block with particles at random places, on cell faces and in corners; lane 2 has fewer. */
static void bench_init(struct bench *bench, const struct shape *shape, size_t axes, bool walled)
{
    static const double edges[3] = {-0.5, 0.5, 0.0};
    static const uint8_t walls[6] = {0x1, 0x4, 0xA, 0x6, 0x3, 0xF}; /* all pairs of sides */
    uint64_t random = 17 + axes;
    memset(bench, 0, sizeof *bench);
    struct sparse_grid *grid = &bench->grid;
    bench->axes = grid->domain.axis_count = axes;
    grid->reach = shape->reach;
    grid->layout.component_count[PARTICLE_POSITION] = (uint32_t)axes;
    grid->layout.component_count[PARTICLE_VELOCITY] = (uint32_t)axes;
    grid->layout.component_count[PARTICLE_MASS] = 1;
    if (shape->domain != NULL)
        grid->layout.component_count[PARTICLE_DOMAIN] = shape->domain->component_count(axes);
    particle_layout_finish(&grid->layout);
    node_layout_init(&grid->nodes.layout, axes, true);
    for (int32_t particle = 0; particle < ROWS * LANE_COUNT; particle++) {
        const int32_t cell[3] = {particle % LANE_COUNT, 0, 0};
        struct particle_record record = {.id = (uint32_t)particle};
        if (cell[0] == 2 && particle > 2 * LANE_COUNT)
            continue;
        for (size_t axis = 0; axis < axes; axis++) {
            const bool edge = particle < 2 * LANE_COUNT;
            record.values[axis] =
                edge ? edges[((size_t)particle / 2 + axis) % 3] : 0.5 * random_value(&random);
            record.values[axes + axis] = random_value(&random);
        }
        const double size[3] = {1.01 + random_value(&random), 1.01 + random_value(&random),
                                1.01 + random_value(&random)};
        if (shape->domain != NULL)
            shape->domain->initialise(
                axes, size, record.values + grid->layout.first_component[PARTICLE_DOMAIN]);
        record.values[grid->layout.first_component[PARTICLE_MASS]] = 1.5 + random_value(&random);
        size_t slot = 0;
        bench->block = sparse_grid_insert(grid, cell, &record, &slot);
        assert_int_not_equal(bench->block, BLOCK_NONE);
    }
    for (size_t side = 0; walled && side < 2 * axes; side++)
        bench_block(bench)->folds[side] = walls[side];
    bench->count = (size_t)grid->blocks[bench->block].row_count * LANE_COUNT;
    assert_int_equal(block_scratch_reserve(&bench->scratch, bench->count), 0);
    bench->context = shape_context_make(&grid->layout, &grid->nodes, cell_width, TIME_STEP);
    for (size_t slot = 0; slot < bench->count; slot++)
        bench->volume[slot] = values(bench, PARTICLE_MASS, 0)[slot] / DENSITY;
    bench->kernels = shape->kernels[axes - 1];
}

static void bench_release(struct bench *bench)
{
    block_scratch_release(&bench->scratch);
    sparse_grid_release(&bench->grid);
}

static bool filled(struct bench *bench, size_t slot)
{
    return bench_block(bench)->id[slot] != PARTICLE_NONE;
}

static double node_position(const struct bench *bench, size_t block, size_t lane, size_t axis)
{
    const int32_t line = bench->grid.nodes.place[block][axis] + (axis == 0 ? (int32_t)lane : 0);
    return cell_width[axis] * line;
}

static double particle_position(struct bench *bench, size_t slot, size_t axis)
{
    const double cell = axis == 0 ? (double)(slot % LANE_COUNT) : 0.0;
    return cell_width[axis] * (cell + 0.5 + values(bench, PARTICLE_POSITION, axis)[slot]);
}

/* What the block scatters: its masses, volumes and the stresses in scratch. */
static struct scatter_source source_of(struct bench *bench)
{
    struct scatter_source source = {.mass = values(bench, PARTICLE_MASS, 0),
                                    .volume = bench->volume};
    for (size_t component = 0; component < 6; component++)
        source.stress[component] = bench->scratch.stress[component];
    return source;
}

/* v = a + B x at the nodes must come back as dt v and dt B at the particles. */
static void check_linear_reproduction(struct bench *bench)
{
    double a[3], b[3][3];
    uint64_t random = 5;
    const struct node_blocks *nodes = &bench->grid.nodes;
    for (size_t row = 0; row < 3; row++) {
        a[row] = random_value(&random);
        for (size_t column = 0; column < 3; column++)
            b[row][column] = random_value(&random);
    }
    for (size_t block = 0; block < nodes->count; block++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            for (size_t row = 0; row < bench->axes; row++) {
                double value = a[row];
                for (size_t axis = 0; axis < bench->axes; axis++)
                    value += b[row][axis] * node_position(bench, block, lane, axis);
                node_values(nodes, block, nodes->layout.velocity + (uint32_t)row)[lane] = value;
            }
        }
    }
    bench->kernels->gather(&bench->context, bench_block(bench),
                           GATHER_DISPLACEMENT | GATHER_GRADIENT, &bench->scratch);
    for (size_t slot = 0; slot < bench->count; slot++) {
        for (size_t row = 0; row < bench->axes; row++) {
            double value = a[row];
            for (size_t axis = 0; axis < bench->axes; axis++) {
                value += b[row][axis] * particle_position(bench, slot, axis);
                assert_close(bench->scratch.gradient[3 * row + axis][slot],
                             filled(bench, slot) ? TIME_STEP * b[row][axis] : 0.0, ROUNDING, 10);
            }
            assert_close(bench->scratch.displacement[row][slot] * cell_width[row],
                         filled(bench, slot) ? TIME_STEP * value : 0.0, ROUNDING, 10);
        }
    }
}

/* Sums over the nodes of what was scattered: mass, first moment, momentum, and a vanishing net
 * force with the virial of the stresses. */
static void check_sums(struct bench *bench)
{
    const struct node_layout *layout = &bench->grid.nodes.layout;
    const struct node_blocks *nodes = &bench->grid.nodes;
    double expected[20] = {0}, actual[20] = {0};
    for (size_t slot = 0; slot < bench->count; slot++) {
        const double mass = values(bench, PARTICLE_MASS, 0)[slot];
        expected[0] += mass;
        for (size_t axis = 0; axis < bench->axes; axis++) {
            expected[1 + axis] += mass * particle_position(bench, slot, axis);
            expected[4 + axis] += mass * values(bench, PARTICLE_VELOCITY, axis)[slot];
            static const size_t index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
            for (size_t row = 0; row < bench->axes; row++)
                expected[10 + 3 * row + axis] -=
                    bench->volume[slot] * bench->scratch.stress[index[row][axis]][slot];
        }
    }
    for (size_t block = 0; block < nodes->count; block++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            const double mass = node_values(nodes, block, layout->mass)[lane];
            actual[0] += mass;
            for (uint32_t axis = 0; axis < bench->axes; axis++) {
                const double position = node_position(bench, block, lane, axis);
                actual[1 + axis] += mass * position;
                actual[4 + axis] += node_values(nodes, block, layout->momentum + axis)[lane];
                for (uint32_t row = 0; row < bench->axes; row++) {
                    const double force = node_values(nodes, block, layout->force + row)[lane];
                    actual[7 + row] += axis == 0 ? force : 0.0;      /* sum of gradients is 0 */
                    actual[10 + 3 * row + axis] += force * position; /* sum G (x) x = 1 */
                }
            }
        }
    }
    for (size_t k = 0; k < LENGTH(actual); k++)
        assert_close(actual[k], expected[k], 10 * ROUNDING, 20);
}

static void fill_scratch(struct bench *bench)
{
    uint64_t random = 29;
    for (size_t component = 0; component < 6; component++) {
        for (size_t slot = 0; slot < bench->count; slot++)
            bench->scratch.stress[component][slot] =
                filled(bench, slot) ? random_value(&random) : 0.0;
    }
}

static void clear_nodes(struct bench *bench)
{
    struct node_blocks *nodes = &bench->grid.nodes;
    memset(nodes->values, 0,
           nodes->count * nodes->layout.component_count * LANE_COUNT * sizeof(double));
}

/* sum_i w_i (scatter m)_i = sum_p m_p (gather w)_p, and the same for forces and gradients. */
static void check_transposes(struct bench *bench)
{
    struct node_blocks *nodes = &bench->grid.nodes;
    const struct node_layout *layout = &nodes->layout;
    uint64_t random = 41;
    double nodal = 0, material = 0, force_power = 0, stress_power = 0;
    for (size_t block = 0; block < nodes->count; block++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            for (uint32_t axis = 0; axis < bench->axes; axis++) {
                const double w = random_value(&random);
                node_values(nodes, block, layout->velocity + axis)[lane] = w;
                nodal += w * node_values(nodes, block, layout->mass)[lane];
                force_power += w * node_values(nodes, block, layout->force + axis)[lane];
            }
        }
    }
    bench->kernels->gather(&bench->context, bench_block(bench),
                           GATHER_DISPLACEMENT | GATHER_GRADIENT, &bench->scratch);
    static const size_t index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (size_t slot = 0; slot < bench->count; slot++) {
        for (size_t row = 0; row < bench->axes; row++) {
            material += values(bench, PARTICLE_MASS, 0)[slot] *
                        bench->scratch.displacement[row][slot] * cell_width[row];
            for (size_t axis = 0; axis < bench->axes; axis++)
                stress_power -= bench->volume[slot] *
                                bench->scratch.stress[index[row][axis]][slot] *
                                bench->scratch.gradient[3 * row + axis][slot];
        }
    }
    assert_close(TIME_STEP * nodal, material, 10 * ROUNDING, 30);
    assert_close(TIME_STEP * force_power, stress_power, 10 * ROUNDING, 100);
}

/* One particle at a time gives what all at once give. */
static void check_scatter_one(struct bench *bench)
{
    struct node_blocks *nodes = &bench->grid.nodes;
    const size_t size = nodes->count * nodes->layout.component_count * LANE_COUNT;
    clear_nodes(bench);
    const struct scatter_source source = source_of(bench);
    bench->kernels->scatter(&bench->context, bench_block(bench), &source,
                            SCATTER_MASS | SCATTER_FORCE | SCATTER_MOMENTUM);
    real *all = malloc(size * sizeof *all);
    assert_non_null(all);
    memcpy(all, nodes->values, size * sizeof *all);
    clear_nodes(bench);
    for (size_t slot = 0; slot < bench->count; slot++) {
        real stress[6];
        for (size_t component = 0; component < 6; component++)
            stress[component] = bench->volume[slot] * bench->scratch.stress[component][slot];
        if (filled(bench, slot))
            bench->kernels->scatter_one(&bench->context, bench_block(bench), slot, stress,
                                        SCATTER_MASS | SCATTER_FORCE | SCATTER_MOMENTUM);
    }
    for (size_t k = 0; k < size; k++)
        assert_close(nodes->values[k], all[k], ROUNDING, 30);
    free(all);
}

/* kick: v += N dv, and the momentum of the kicked particles; empty slots stay empty. */
static void check_kick(struct bench *bench)
{
    struct node_blocks *nodes = &bench->grid.nodes;
    const double constant[3] = {0.5, -0.25, 0.125};
    double before[3] = {0}, after[3] = {0}, nodal[3] = {0}, mass = 0;
    clear_nodes(bench);
    for (size_t block = 0; block < nodes->count; block++) {
        for (uint32_t axis = 0; axis < bench->axes; axis++)
            lanes_store(node_values(nodes, block, nodes->layout.kick + axis),
                        lanes_splat(constant[axis]));
    }
    for (size_t axis = 0; axis < bench->axes; axis++) {
        for (size_t slot = 0; slot < bench->count; slot++)
            before[axis] += values(bench, PARTICLE_MASS, 0)[slot] *
                            values(bench, PARTICLE_VELOCITY, axis)[slot];
    }
    bench->kernels->kick(&bench->context, bench_block(bench));
    for (size_t slot = 0; slot < bench->count; slot++)
        mass += values(bench, PARTICLE_MASS, 0)[slot];
    for (uint32_t axis = 0; axis < bench->axes; axis++) {
        for (size_t slot = 0; slot < bench->count; slot++) {
            const double velocity = values(bench, PARTICLE_VELOCITY, axis)[slot];
            after[axis] += values(bench, PARTICLE_MASS, 0)[slot] * velocity;
            if (!filled(bench, slot))
                assert_true(velocity == 0);
        }
        for (size_t block = 0; block < nodes->count; block++) {
            for (size_t lane = 0; lane < LANE_COUNT; lane++)
                nodal[axis] += node_values(nodes, block, nodes->layout.momentum + axis)[lane];
        }
        assert_close(after[axis], before[axis] + mass * constant[axis], 10 * ROUNDING, 30);
        assert_close(nodal[axis], after[axis], 10 * ROUNDING, 30);
    }
}

static void test_shapes(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < shape_count; shape++) {
        for (size_t turn = 0; turn < 6; turn++) {
            struct bench bench;
            bench_init(&bench, shape_table[shape], 1 + turn / 2, turn % 2 != 0);
            check_linear_reproduction(&bench);
            fill_scratch(&bench);
            clear_nodes(&bench);
            const struct scatter_source source = source_of(&bench);
            bench.kernels->scatter(&bench.context, bench_block(&bench), &source,
                                   SCATTER_MASS | SCATTER_FORCE | SCATTER_MOMENTUM);
            check_sums(&bench);
            check_transposes(&bench);
            check_scatter_one(&bench);
            check_kick(&bench);
            bench_release(&bench);
        }
    }
}

static void test_table(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < shape_count; shape++) {
        assert_ptr_equal(shape_find(shape_table[shape]->name), shape_table[shape]);
        assert_true(shape_table[shape]->courant_limit[TALUS_STRESS_MODIFIED_LAST] > 0);
        assert_true(shape_table[shape]->courant_limit[TALUS_STRESS_LAST] > 0);
    }
    assert_null(shape_find("no such shape"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
