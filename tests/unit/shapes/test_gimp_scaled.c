/* SPDX-License-Identifier: Apache-2.0 */
/* Boxes that follow the deformation, their limits, and what is said about them. */
#include "shapes/gimp.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

#include <stdio.h>

#define HALF 0.25

/* One particle of a block with F = I + h, resized. */
struct resized {
    double half[3];
    struct domain_findings findings;
};

static struct resized resize(size_t axes, const double h[9], enum talus_gimp_scaling rule)
{
    const struct shape *shape = shape_find("gimp_scaled");
    struct resized result = {.findings = {0}};
    struct sparse_grid grid = {.reach = shape->reach};
    struct particle_record record = {.id = 7};
    const double size[3] = {2 * HALF, 2 * HALF, 2 * HALF}, width[3] = {1, 1, 1};
    size_t slot = 0;
    grid.domain.axis_count = axes;
    grid.layout.component_count[PARTICLE_MASS] = 1;
    grid.layout.component_count[PARTICLE_DOMAIN] = shape->domain->component_count(axes);
    grid.layout.component_count[PARTICLE_GRADIENT] = (uint32_t)(axes * axes);
    particle_layout_finish(&grid.layout);
    node_layout_init(&grid.nodes.layout, axes, true);
    const uint32_t *first = grid.layout.first_component;
    shape->domain->initialise(axes, size, record.values + first[PARTICLE_DOMAIN]);
    for (size_t row = 0; row < axes; row++) {
        for (size_t column = 0; column < axes; column++)
            record.values[first[PARTICLE_GRADIENT] + axes * row + column] =
                (real)h[3 * row + column];
    }
    assert_int_equal(sparse_grid_insert(&grid, (const int32_t[3]){2, 0, 0}, &record, &slot), 0);
    const struct shape_context context = shape_context_make(&grid.layout, &grid.nodes, width, 1.0);
    shape->domain->resize[rule](&context, &grid.blocks[0], &result.findings);
    for (uint32_t axis = 0; axis < axes; axis++)
        result.half[axis] =
            particle_values(&grid.layout, &grid.blocks[0], PARTICLE_DOMAIN, axis)[slot];
    sparse_grid_release(&grid);
    return result;
}

static void check_lengths(size_t axes, const double h[9], enum talus_gimp_scaling rule,
                          const double ratio[3])
{
    const struct resized result = resize(axes, h, rule);
    for (size_t axis = 0; axis < axes; axis++)
        assert_close(result.half[axis], HALF * ratio[axis], 16 * (double)REAL_EPSILON, HALF);
}

/* l = l0 J^(1/axes), J in the plane of a plane scene. */
static void test_volume(void **state)
{
    (void)state;
    const double shear_and_swell[9] = {0.2, 0.3, 0.1, -0.1, 0.1, 0.2, 0.05, 0, -0.1};
    const double line = 1.2, plane = sqrt(1.2 * 1.1 + 0.3 * 0.1);
    const double det = 1.2 * (1.1 * 0.9 - 0.2 * 0) - 0.3 * (-0.1 * 0.9 - 0.2 * 0.05) +
                       0.1 * (-0.1 * 0 - 1.1 * 0.05);
    const double solid = cbrt(det);
    check_lengths(1, shear_and_swell, TALUS_GIMP_VOLUME, (double[3]){line});
    check_lengths(2, shear_and_swell, TALUS_GIMP_VOLUME, (double[3]){plane, plane});
    check_lengths(3, shear_and_swell, TALUS_GIMP_VOLUME, (double[3]){solid, solid, solid});
}

/* l_a = l0 U_aa: a turned stretch is that of the body's own axes. */
static void test_stretch(void **state)
{
    (void)state;
    const double angle = 0.7, c = cos(angle), s = sin(angle);
    const double straight[9] = {0.3, 0, 0, 0, -0.2, 0, 0, 0, 0.1};
    check_lengths(1, straight, TALUS_GIMP_STRETCH, (double[3]){1.3});
    check_lengths(2, straight, TALUS_GIMP_STRETCH, (double[3]){1.3, 0.8});
    check_lengths(3, straight, TALUS_GIMP_STRETCH, (double[3]){1.3, 0.8, 1.1});
    const double turned[9] = {c * 1.3 - 1, -s * 0.8, 0, s * 1.3, c * 0.8 - 1, 0, 0, 0, 0.1};
    check_lengths(2, turned, TALUS_GIMP_STRETCH, (double[3]){1.3, 0.8});
    check_lengths(3, turned, TALUS_GIMP_STRETCH, (double[3]){1.3, 0.8, 1.1});
    /* Stretches of 1.3 and 0.8 along axes at 45 degrees. */
    const double oblique[9] = {0.05, 0.25, 0, 0.25, 0.05, 0, 0, 0, 0};
    check_lengths(2, oblique, TALUS_GIMP_STRETCH, (double[3]){1.05, 1.05});
}

/* Stretches just inside and outside of 0.7..1.4, along no axis of the grid. */
static void test_stretched_particles_are_found(void **state)
{
    (void)state;
    static const double stretches[4] = {0.701, 0.699, 1.399, 1.401};
    for (size_t axes = 1; axes <= 3; axes++) {
        for (size_t k = 0; k < 4; k++) {
            const double n[3] = {axes == 1 ? 1.0 : 0.6, 0.8, 0};
            double h[9] = {0};
            for (size_t row = 0; row < axes; row++) {
                for (size_t column = 0; column < axes; column++)
                    h[3 * row + column] = (stretches[k] - 1) * n[row] * n[column];
            }
            const struct resized result = resize(axes, h, TALUS_GIMP_VOLUME);
            assert_int_equal(result.findings.stretched, k % 2);
            assert_int_equal(result.findings.capped, 0);
            if (k % 2 == 1)
                assert_int_equal(result.findings.stretched_particle, 7);
        }
    }
}

static void test_long_particles_are_capped(void **state)
{
    (void)state;
    const double h[9] = {GIMP_HALF_MAX / HALF - 1 + 0.01, 0, 0, 0, 0, 0, 0, 0, 0};
    const struct resized result = resize(2, h, TALUS_GIMP_STRETCH);
    assert_true(result.half[0] == GIMP_HALF_MAX);
    assert_close(result.half[1], HALF, 4 * (double)REAL_EPSILON, HALF);
    assert_int_equal(result.findings.capped, 1);
    assert_int_equal(result.findings.capped_particle, 7);
}

static void build(struct simulation_fixture *fixture, const char *shape, double per_cell)
{
    static const int64_t count[3] = {16, 16, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material = simulation_fixture_add_sample(fixture, material_find("linear_elastic"));
    struct talus_body *body = simulation_fixture_add_box(fixture, material, (double[3]){0.4, 0.4},
                                                         (double[3]){1.0, 1.0}, per_cell);
    body->lattice = TALUS_LATTICE_COUNT;
    body->lattice_value[0] = body->lattice_value[1] = 6 * per_cell;
    fixture->scene.solver.shape_index = simulation_fixture_shape(shape);
}

static size_t first_slot(const struct particle_block *block)
{
    size_t slot = 0;
    while (block->id[slot] == PARTICLE_NONE)
        slot++;
    return slot;
}

/* Warned of once, at the start or when it happens, and counted. */
static void test_warnings(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_warning warning;
    build(&fixture, "gimp", 1.0 / 3.0); /* 2 x 2 particles of 0.3 m in cells of 0.1 m */
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    assert_true(talus_simulation_take_warning(simulation, &warning));
    assert_string_equal(warning.code, "domain_capped");
    assert_true(simulation_metric(simulation, "domains.capped") == 4);
    simulation_run_steps(simulation, 3);
    assert_false(talus_simulation_take_warning(simulation, &warning));
    talus_simulation_destroy(simulation);
    build(&fixture, "gimp_scaled", 2);
    simulation = simulation_fixture_start(&fixture, 1);
    assert_false(talus_simulation_take_warning(simulation, &warning));
    struct particle_block *block = &simulation->run.grid.blocks[0];
    const size_t slot = first_slot(block);
    particle_values(&simulation->run.grid.layout, block, PARTICLE_GRADIENT, 0)[slot] = 0.5;
    simulation_run_steps(simulation, 1);
    assert_true(talus_simulation_take_warning(simulation, &warning));
    assert_string_equal(warning.code, "domain_stretched");
    char number[32];
    (void)snprintf(number, sizeof number, "number %u ", block->id[slot]);
    assert_non_null(strstr(warning.text, number));
    assert_true(simulation_metric(simulation, "domains.stretched") == 1);
    simulation_run_steps(simulation, 1);
    assert_false(talus_simulation_take_warning(simulation, &warning));
    talus_simulation_destroy(simulation);
}

/* Half the spacing of the lattice, or of a cube of the same volume where the lattice is turned. */
static void test_initial_lengths(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct simulation_fixture fixture;
        build(&fixture, "gimp", 2);
        fixture.bodies[0].lattice_value[1] = 24;
        fixture.bodies[0].rotate_angle_deg = turned ? 30 : 0;
        fixture.bodies[0].rotate_about[0] = fixture.bodies[0].rotate_about[1] = 0.7;
        fixture.bodies[0].rotate_axis[2] = 1;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        const struct sparse_grid *grid = &simulation->run.grid;
        const double expected[2] = {turned ? 0.25 / sqrt(2) : 0.25,
                                    turned ? 0.25 / sqrt(2) : 0.125};
        const size_t slot = first_slot(&grid->blocks[0]);
        for (uint32_t axis = 0; axis < 2; axis++)
            assert_close(
                particle_values(&grid->layout, &grid->blocks[0], PARTICLE_DOMAIN, axis)[slot],
                expected[axis], 1e-2, expected[axis]); /* the volume factor */
        talus_simulation_destroy(simulation);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_volume),
        cmocka_unit_test(test_stretch),
        cmocka_unit_test(test_stretched_particles_are_found),
        cmocka_unit_test(test_long_particles_are_capped),
        cmocka_unit_test(test_warnings),
        cmocka_unit_test(test_initial_lengths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
