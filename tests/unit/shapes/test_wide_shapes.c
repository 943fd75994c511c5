/* SPDX-License-Identifier: Apache-2.0 */
/* Shapes that reach beyond their cell, against their definitions, at walls, and in motion. */
#include "shapes/shape.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"
#include "state/sparse_grid.h"
#include "state/wide_window.h"

/* Weights come from some ten operations of numbers of the size of 1. */
#define ROUNDING (32 * (double)REAL_EPSILON)

/* ---- the definitions, piece by piece; s from the node, l half a length, in cell widths ---- */

static double linear_weight(double s)
{
    return fmax(0, 1 - fabs(s));
}

static double bspline2_weight(double s, double l)
{
    (void)l;
    const double a = fabs(s);
    return a <= 0.5 ? 0.75 - s * s : a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0;
}

static double bspline3_weight(double s, double l)
{
    (void)l;
    const double a = fabs(s);
    return a <= 1  ? 2.0 / 3.0 - a * a + 0.5 * a * a * a
           : a < 2 ? (2 - a) * (2 - a) * (2 - a) / 6
                   : 0;
}

/* The mean of a hat over the box, by Simpson's rule between its kinks, which is exact. */
static double gimp_weight(double s, double l)
{
    double ends[5] = {s - l, -1, 0, 1, s + l}, sum = 0;
    for (size_t k = 0; k < 5; k++)
        ends[k] = fmin(fmax(ends[k], s - l), s + l);
    for (size_t k = 0; k < 4; k++)
        sum += (ends[k + 1] - ends[k]) / 6 *
               (linear_weight(ends[k]) + 4 * linear_weight(0.5 * (ends[k] + ends[k + 1])) +
                linear_weight(ends[k + 1]));
    return sum / (2 * l);
}

static const struct {
    const char *name;
    double (*weight)(double s, double l);
} definitions[] = {
    {"gimp", gimp_weight},
    {"gimp_scaled", gimp_weight},
    {"bspline2", bspline2_weight},
    {"bspline3", bspline3_weight},
};

/* ---- one particle, in cell 1 of a block ---- */

struct lone {
    struct sparse_grid grid;
    struct shape_context context;
    const struct shape *shape;
    const struct shape_kernels *kernels;
    size_t axes, slot;
};

enum { CELL = 1 };

static void lone_init(struct lone *lone, const struct shape *shape, size_t axes,
                      const double position[3], double half)
{
    memset(lone, 0, sizeof *lone);
    struct sparse_grid *grid = &lone->grid;
    struct particle_record record = {.id = 0};
    const double size[3] = {2 * half, 2 * half, 2 * half}, width[3] = {1, 1, 1};
    lone->shape = shape;
    lone->kernels = shape->kernels[axes - 1];
    lone->axes = grid->domain.axis_count = axes;
    grid->reach = shape->reach;
    grid->layout.component_count[PARTICLE_POSITION] = (uint32_t)axes;
    grid->layout.component_count[PARTICLE_VELOCITY] = (uint32_t)axes;
    grid->layout.component_count[PARTICLE_MASS] = 1;
    if (shape->domain != NULL)
        grid->layout.component_count[PARTICLE_DOMAIN] = shape->domain->component_count(axes);
    particle_layout_finish(&grid->layout);
    node_layout_init(&grid->nodes.layout, axes, true);
    for (size_t axis = 0; axis < axes; axis++)
        record.values[axis] = (real)position[axis];
    record.values[grid->layout.first_component[PARTICLE_MASS]] = 1;
    if (shape->domain != NULL)
        shape->domain->initialise(axes, size,
                                  record.values + grid->layout.first_component[PARTICLE_DOMAIN]);
    assert_int_equal(sparse_grid_insert(grid, (const int32_t[3]){CELL, 0, 0}, &record, &lone->slot),
                     0);
    lone->context = shape_context_make(&grid->layout, &grid->nodes, width, 1.0);
}

/* Mass at the node at offsets from the lower one of the cell. */
static double mass_at(const struct lone *lone, int32_t x, int32_t y, int32_t z)
{
    const struct particle_block *block = &lone->grid.blocks[0];
    const size_t place = window_index(lone->axes, lone->shape->reach, CELL + x, y, z);
    return node_values(&lone->grid.nodes, block->wide_nodes[place / LANE_COUNT],
                       lone->grid.nodes.layout.mass)[place % LANE_COUNT];
}

static void scatter_mass(struct lone *lone)
{
    const struct scatter_source source = {
        .mass = particle_values(&lone->grid.layout, &lone->grid.blocks[0], PARTICLE_MASS, 0)};
    lone->kernels->scatter(&lone->context, &lone->grid.blocks[0], &source, SCATTER_MASS);
}

/* Every weight is the product of the definition on the axes. */
static void check_weights(const struct shape *shape, double (*weight)(double, double), size_t axes,
                          uint64_t *random)
{
    const double position[3] = {0.5 * random_value(random), 0.5 * random_value(random),
                                0.5 * random_value(random)};
    const double half = 0.505 + 0.495 * random_value(random);
    struct lone lone;
    lone_init(&lone, shape, axes, position, half);
    scatter_mass(&lone);
    for (int32_t z = axes > 2 ? -1 : 0; z <= (axes > 2 ? 2 : 0); z++) {
        for (int32_t y = axes > 1 ? -1 : 0; y <= (axes > 1 ? 2 : 0); y++) {
            for (int32_t x = -1; x <= 2; x++) {
                const int32_t node[3] = {x, y, z};
                double expected = 1;
                for (size_t axis = 0; axis < axes; axis++)
                    expected *= weight((real)position[axis] + 0.5 - node[axis], (real)half);
                assert_close(mass_at(&lone, x, y, z), expected, ROUNDING, 1);
            }
        }
    }
    sparse_grid_release(&lone.grid);
}

static void test_weights_follow_their_definitions(void **state)
{
    (void)state;
    uint64_t random = 3;
    for (size_t index = 0; index < LENGTH(definitions); index++) {
        const struct shape *shape = shape_find(definitions[index].name);
        assert_non_null(shape);
        for (size_t turn = 0; turn < 300; turn++)
            check_weights(shape, definitions[index].weight, 1 + turn % 3, &random);
    }
}

/* d/dx of the value of a random field, by differences over positions, is the gathered slope. */
static void test_slopes_are_derivatives(void **state)
{
    (void)state;
    const double step = sizeof(real) == sizeof(double) ? 1e-6 : 1e-2;
    uint64_t random = 11;
    for (size_t index = 0; index < LENGTH(definitions); index++) {
        for (size_t turn = 0; turn < 60; turn++) {
            const size_t axes = 1 + turn % 3, along = (turn / 3) % axes;
            double position[3], values[2], slope = 0;
            for (size_t axis = 0; axis < 3; axis++)
                position[axis] = 0.48 * random_value(&random);
            const double half = 0.505 + 0.495 * random_value(&random);
            const uint64_t seed = random;
            for (int side = 0; side < 3; side++) {
                struct lone lone;
                struct block_scratch scratch = {.memory = NULL};
                double moved[3] = {position[0], position[1], position[2]};
                moved[along] += side < 2 ? (2 * side - 1) * step : 0;
                lone_init(&lone, shape_find(definitions[index].name), axes, moved, half);
                struct node_blocks *nodes = &lone.grid.nodes;
                uint64_t same = seed;
                for (size_t block = 0; block < nodes->count; block++) {
                    for (size_t lane = 0; lane < LANE_COUNT; lane++)
                        node_values(nodes, block, nodes->layout.velocity)[lane] =
                            (real)random_value(&same);
                }
                assert_int_equal(block_scratch_reserve(&scratch, LANE_COUNT), 0);
                lone.kernels->gather(&lone.context, &lone.grid.blocks[0],
                                     GATHER_DISPLACEMENT | GATHER_GRADIENT, &scratch);
                if (side < 2)
                    values[side] = scratch.displacement[0][lone.slot];
                else
                    slope = scratch.gradient[along][lone.slot];
                block_scratch_release(&scratch);
                sparse_grid_release(&lone.grid);
            }
            /* Slopes have kinks: there the error is of first order, with curvatures up to 4 / l. */
            assert_close(slope, (values[1] - values[0]) / (2 * step),
                         4 * step + 4 * (double)REAL_EPSILON / step, 1 / 0.01);
        }
    }
}

/* At a wall nothing reaches the nodes behind it, no node gets a negative share, and what lies on
 * the wall belongs to its node alone. Also between two walls one cell apart. */
static void check_walls(const struct shape *shape, size_t axes, unsigned sides, uint64_t *random)
{
    double position[3] = {0, 0, 0};
    const bool touches = random_value(random) > 0.5;
    for (size_t axis = 0; axis < axes; axis++)
        position[axis] =
            touches ? (sides >> (2 * axis) & 1 ? -0.5 : 0.5) : 0.5 * random_value(random);
    struct lone lone;
    lone_init(&lone, shape, axes, position, 0.505 + 0.495 * random_value(random));
    for (size_t side = 0; side < 2 * axes; side++)
        lone.grid.blocks[0].folds[side] = (uint8_t)((sides >> side & 1) << CELL);
    scatter_mass(&lone);
    double sum = 0;
    for (int32_t z = axes > 2 ? -1 : 0; z <= (axes > 2 ? 2 : 0); z++) {
        for (int32_t y = axes > 1 ? -1 : 0; y <= (axes > 1 ? 2 : 0); y++) {
            for (int32_t x = -1; x <= 2; x++) {
                const int32_t node[3] = {x, y, z};
                const double mass = mass_at(&lone, x, y, z);
                bool behind = false, away = false;
                sum += mass;
                assert_true(mass >= -ROUNDING);
                for (size_t axis = 0; axis < axes; axis++) {
                    const bool low = sides >> (2 * axis) & 1, high = sides >> (2 * axis + 1) & 1;
                    behind = behind || (low && node[axis] < 0) || (high && node[axis] > 1);
                    away = away || (touches && low && node[axis] != 0) ||
                           (touches && !low && high && node[axis] != 1);
                }
                if (behind || away)
                    assert_close(mass, 0, ROUNDING, 1);
            }
        }
    }
    assert_close(sum, 1, ROUNDING, 1);
    sparse_grid_release(&lone.grid);
}

static void test_nothing_reaches_behind_walls(void **state)
{
    (void)state;
    uint64_t random = 23;
    for (size_t index = 0; index < LENGTH(definitions); index++) {
        for (size_t axes = 1; axes <= 3; axes++) {
            for (unsigned sides = 1; sides < 1u << (2 * axes); sides++) {
                for (size_t turn = 0; turn < 8; turn++)
                    check_walls(shape_find(definitions[index].name), axes, sides, &random);
            }
        }
    }
}

/* ---- bodies ---- */

/* Largest force on a node inside of a bar under uniform stress, over that stress, where particles
 * are 3/7 of a cell apart: a body at rest, whose particles lie differently in every cell. */
static double largest_imbalance(const char *name)
{
    const double stress = -1e4;
    struct simulation_fixture fixture;
    simulation_fixture_init(&fixture, 1, 0.1, (const int64_t[3]){20, 1, 1});
    const size_t material =
        simulation_fixture_add_sample(&fixture, material_find("linear_elastic"));
    struct talus_body *body =
        simulation_fixture_add_box(&fixture, material, (double[3]){0.33}, (double[3]){1.53}, 1);
    body->lattice = TALUS_LATTICE_COUNT;
    body->lattice_value[0] = 28;
    body->initial_stress = TALUS_INITIAL_GIVEN;
    body->stress[0] = body->stress[1] = body->stress[2] = stress;
    fixture.scene.solver.shape_index = simulation_fixture_shape(name);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    const struct node_blocks *nodes = &simulation->run.grid.nodes;
    double largest = 0;
    for (size_t block = 0; block < nodes->count; block++) {
        for (int32_t lane = 0; lane < LANE_COUNT; lane++) {
            const int32_t node = nodes->place[block][0] + lane;
            if (node >= 6 && node <= 13)
                largest = fmax(largest,
                               fabs((double)node_values(nodes, block, nodes->layout.force)[lane]));
        }
    }
    talus_simulation_destroy(simulation);
    return largest / fabs(stress);
}

/* Boxes tile the bar, so that gimp integrates exactly. What points at a distance d of cells leave
 * of a spline of degree n is, by Poisson's sum, 4 pi f |sin(pi f) / (pi f)|^(n + 1) with f = 1/d,
 * and of the shorter waves less than a quarter of it. */
static void test_uniform_stress_is_in_balance(void **state)
{
    (void)state;
    const double pi = 3.14159265358979323846, wave = 7.0 / 3.0;
    const double decay = fabs(sin(pi * wave) / (pi * wave));
    const double strain_rounding = sizeof(real) == sizeof(double) ? 1e-12 : 1e-3;
    assert_true(largest_imbalance("linear") > 4 * pi * wave * pow(decay, 2) / 2);
    assert_true(largest_imbalance("gimp") < strain_rounding);
    assert_true(largest_imbalance("gimp_scaled") < strain_rounding);
    assert_true(largest_imbalance("bspline2") < 4 * pi * wave * pow(decay, 3) * 1.25);
    assert_true(largest_imbalance("bspline3") < 4 * pi * wave * pow(decay, 4) * 1.25);
}

/* A body that flies and spins through cells keeps its momentum to rounding, with every shape; its
 * particles leave their cells in many steps. */
static void test_momentum_in_flight(void **state)
{
    (void)state;
    enum { STEPS = 60 };
    static const int64_t count[3] = {24, 24, 24};
    static const double min[3] = {0.83, 0.97, 0.91}, max[3] = {1.23, 1.37, 1.31};
    for (size_t shape = 0; shape < shape_count; shape++) {
        if (shape_table[shape]->may_lump_negative)
            continue; /* for small displacements only: test_quadratic.c */
        for (size_t axes = 1; axes <= 3; axes++) {
            struct simulation_fixture fixture;
            simulation_fixture_init(&fixture, axes, 0.1, count);
            const size_t material =
                simulation_fixture_add_sample(&fixture, material_find("linear_elastic"));
            struct talus_body *body = simulation_fixture_add_box(&fixture, material, min, max, 2);
            fixture.scene.solver.shape_index = shape;
            fixture.scene.output.frame_fields = 1u << TALUS_FIELD_VELOCITY;
            body->velocity[0] = 9;
            body->velocity[1] = axes > 1 ? 7 : 0;
            body->velocity[2] = axes > 2 ? -5 : 0;
            struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
            simulation_run_steps(simulation, STEPS);
            assert_true(simulation_metric(simulation, "mass_error") <= 1e-12);
            assert_true(simulation_metric(simulation, "momentum_error") <=
                        STEPS * (double)REAL_EPSILON);
            talus_simulation_destroy(simulation);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weights_follow_their_definitions),
        cmocka_unit_test(test_slopes_are_derivatives),
        cmocka_unit_test(test_nothing_reaches_behind_walls),
        cmocka_unit_test(test_uniform_stress_is_in_balance),
        cmocka_unit_test(test_momentum_in_flight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
