/* SPDX-License-Identifier: Apache-2.0 */
/* Domains that shear without bound, alone and beside walls: what one particle gives and takes. */
#include "shapes/cpdi.h"
#include "simulation_fixture.h"
#include "state/sparse_grid.h"

enum { LANE = 2 };
#define HALF 0.25
#define MASS 3.0

/* One particle in a cell of unit width, with its domain resized for F = I + h. */
struct bench {
    struct sparse_grid grid;
    struct block_scratch scratch;
    struct shape_context context;
    const struct shape_kernels *kernels;
    struct domain_findings findings;
    size_t axes, slot;
};

static void bench_init(struct bench *bench, size_t axes, const double h[9], const double place[3])
{
    const struct shape *shape = shape_find("cpdi");
    const double size[3] = {2 * HALF, 2 * HALF, 2 * HALF}, width[3] = {1, 1, 1};
    struct particle_record record = {.id = 7};
    memset(bench, 0, sizeof *bench);
    struct sparse_grid *grid = &bench->grid;
    bench->axes = grid->domain.axis_count = axes;
    bench->kernels = shape->kernels[axes - 1];
    grid->reach = shape->reach;
    grid->layout.component_count[PARTICLE_POSITION] = (uint32_t)axes;
    grid->layout.component_count[PARTICLE_MASS] = 1;
    grid->layout.component_count[PARTICLE_DOMAIN] = shape->domain->component_count(axes);
    grid->layout.component_count[PARTICLE_GRADIENT] = (uint32_t)(axes * axes);
    particle_layout_finish(&grid->layout);
    node_layout_init(&grid->nodes.layout, axes, true);
    const uint32_t *first = grid->layout.first_component;
    shape->domain->initialise(axes, size, record.values + first[PARTICLE_DOMAIN]);
    record.values[first[PARTICLE_MASS]] = (real)MASS;
    for (size_t row = 0; row < axes; row++) {
        record.values[first[PARTICLE_POSITION] + row] = (real)(place[row] - 0.5);
        for (size_t column = 0; column < axes; column++)
            record.values[first[PARTICLE_GRADIENT] + axes * row + column] =
                (real)h[3 * row + column];
    }
    assert_int_equal(
        sparse_grid_insert(grid, (const int32_t[3]){LANE, 0, 0}, &record, &bench->slot), 0);
    bench->context = shape_context_make(&grid->layout, &grid->nodes, width, 1.0);
    shape->domain->resize[0](&bench->context, &grid->blocks[0], &bench->findings);
    const size_t count = (size_t)grid->blocks[0].row_count * LANE_COUNT;
    assert_int_equal(block_scratch_reserve(&bench->scratch, count), 0);
}

static void bench_release(struct bench *bench)
{
    block_scratch_release(&bench->scratch);
    sparse_grid_release(&bench->grid);
}

static double node_position(const struct bench *bench, size_t block, size_t lane, size_t axis)
{
    return bench->grid.nodes.place[block][axis] + (axis == 0 ? (double)lane : 0.0);
}

/* Weights of the nodes, by the mass that they get: their sum, the least of them, the farthest node
 * along any axis, and the mean of their places. */
struct weights {
    double sum, least, farthest, centre[3];
};

static struct weights scatter(struct bench *bench, const double place[3])
{
    const struct node_blocks *nodes = &bench->grid.nodes;
    struct particle_block *block = &bench->grid.blocks[0];
    const struct scatter_source source = {
        .mass = particle_values(&bench->grid.layout, block, PARTICLE_MASS, 0)};
    struct weights weights = {.least = INFINITY};
    bench->kernels->scatter(&bench->context, block, &source, SCATTER_MASS);
    for (size_t index = 0; index < nodes->count; index++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            const double weight = node_values(nodes, index, nodes->layout.mass)[lane] / MASS;
            weights.sum += weight;
            weights.least = fmin(weights.least, weight);
            for (size_t axis = 0; axis < bench->axes && weight != 0; axis++) {
                const double away =
                    node_position(bench, index, lane, axis) - place[axis] - (axis == 0 ? LANE : 0);
                weights.centre[axis] += weight * away;
                weights.farthest = fmax(weights.farthest, fabs(away));
            }
        }
    }
    return weights;
}

/* v = a + B x at the nodes, as the particle sees it: largest error of its slopes. */
static double slope_error(struct bench *bench)
{
    static const double slopes[3][3] = {{1, -2, 0.5}, {0.25, 3, -1}, {-0.5, 1.5, 2}};
    const struct node_blocks *nodes = &bench->grid.nodes;
    double error = 0;
    for (size_t index = 0; index < nodes->count; index++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            for (size_t row = 0; row < bench->axes; row++) {
                double value = 1;
                for (size_t axis = 0; axis < bench->axes; axis++)
                    value += slopes[row][axis] * node_position(bench, index, lane, axis);
                node_values(nodes, index, nodes->layout.velocity + (uint32_t)row)[lane] =
                    (real)value;
            }
        }
    }
    bench->kernels->gather(&bench->context, &bench->grid.blocks[0],
                           GATHER_DISPLACEMENT | GATHER_GRADIENT, &bench->scratch);
    for (size_t row = 0; row < bench->axes; row++) {
        for (size_t axis = 0; axis < bench->axes; axis++)
            error = fmax(error, fabs((double)bench->scratch.gradient[3 * row + axis][bench->slot] -
                                     slopes[row][axis]));
    }
    return error;
}

/* F_12 = 20, in 3D also F_13 = 10 and F_23 = 5: 5.25 and 8 cells without the cap. */
static const double shear[9] = {0, 20, 10, 0, 0, 5, 0, 0, 0};

/* Rounding of a slope: the thin side of the domain is 1 / 450 (2D) and 1 / 32,000 (3D) of a cell.
 */
static const double slope_rounding[4] = {0, 0, 1e-12, 1e-9};

static void test_cap(void **state)
{
    (void)state;
    const double place[3] = {0.3, 0.6, 0.45};
    for (size_t axes = 2; axes <= 3; axes++) {
        struct bench bench;
        bench_init(&bench, axes, shear, place);
        const struct weights weights = scatter(&bench, place);
        assert_int_equal(bench.findings.capped, 1);
        assert_int_equal(bench.findings.capped_particle, 7);
        assert_close(weights.sum, 1, 8 * (double)REAL_EPSILON, 1);
        assert_true(weights.least >= 0);
        /* Corners are within two cells, and so the nodes around them within three. */
        assert_true(weights.farthest < CPDI_REACH + 1);
        assert_true(weights.farthest >= CPDI_REACH - 1);
        for (size_t axis = 0; axis < axes; axis++)
            assert_close(weights.centre[axis], 0, 16 * (double)REAL_EPSILON, 1);
        const double error = slope_error(&bench);
        print_message("%zuD: farthest node at %.3f cells, slopes to %.1e\n", axes, weights.farthest,
                      error);
        assert_true(error < slope_rounding[axes]);
        bench_release(&bench);
    }
}

/* Beside walls a sheared domain takes no mass from any node, wherever its particle lies; and the
 * rest holds as well. */
static void test_walls(void **state)
{
    (void)state;
    static const double places[] = {0, 1e-9, 0.01, 0.2, 0.5, 0.97, 1};
    static const double shears[] = {0.5, 2, -6, 20};
    for (size_t axes = 2; axes <= 3; axes++) {
        for (size_t side = 0; side < 2 * axes; side++) {
            for (size_t k = 0; k < LENGTH(places) * LENGTH(shears); k++) {
                const double h[9] = {0, shears[k % LENGTH(shears)], 0.3, 0.2, 0, -0.4, 0, 0.1, 0};
                double place[3] = {0.3, 0.6, 0.45};
                struct bench bench;
                place[side / 2] = places[k / LENGTH(shears)];
                bench_init(&bench, axes, h, place);
                bench.grid.blocks[0].folds[side] = 1u << LANE;
                const struct weights weights = scatter(&bench, place);
                assert_close(weights.sum, 1, 8 * (double)REAL_EPSILON, 1);
                assert_true(weights.least >= -4 * (double)REAL_EPSILON);
                for (size_t axis = 0; axis < axes; axis++)
                    assert_close(weights.centre[axis], 0, 16 * (double)REAL_EPSILON, 1);
                assert_true(slope_error(&bench) < 1e-9);
                bench_release(&bench);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cap),
        cmocka_unit_test(test_walls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
