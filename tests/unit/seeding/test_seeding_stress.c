/* SPDX-License-Identifier: Apache-2.0 */
/* Initial stresses. */
#include "seeding_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define ASSERT_WITHIN(value, expected, tolerance)                                                  \
    assert_true(fabs((value) - (expected)) <= (tolerance))

static const double weight = 2000.0 * 9.81; /* [N/m^3] of the fixture's material */

static struct particle_seed create(const struct seeding_fixture *fixture)
{
    struct particle_seed seed;
    struct talus_error error = {.status = TALUS_OK};
    assert_int_equal(seeding_create(&fixture->scene, &seed, &error), TALUS_OK);
    assert_non_null(seed.stress[0]);
    return seed;
}

static void assert_near(double value, double expected)
{
    ASSERT_WITHIN(value, expected, 1e-9 * (fabs(expected) + 1.0));
}

static void geostatic_follows_depth(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 2, "linear_elastic");
    fixture.scene.gravity[0] = 1.0; /* depth runs along the largest component only */
    fixture.scene.gravity[1] = -9.81;
    fixture.bodies[0].initial_stress = TALUS_INITIAL_GEOSTATIC;
    fixture.bodies[0].k0_rule = TALUS_K0_GIVEN;
    fixture.bodies[0].k0 = 0.43;
    fixture.bodies[0].surcharge = 1000.0;
    struct particle_seed seed = create(&fixture);
    for (size_t index = 0; index < seed.count; index++) {
        double vertical = -(weight * (1.0 - seed.position[1][index]) + 1000.0);
        assert_near(seed.stress[1][index], vertical);
        assert_near(seed.stress[0][index], 0.43 * vertical);
        assert_near(seed.stress[2][index], 0.43 * vertical);
        for (size_t k = 3; k < 6; k++)
            ASSERT_WITHIN(seed.stress[k][index], 0.0, 0.0);
    }
    seeding_release(&seed);
}

static void depth_is_below_the_surface_over_the_particle(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 3, "linear_elastic");
    fixture.scene.gravity[2] = 9.81; /* down is +z */
    struct talus_body *body = &fixture.bodies[0];
    body->shape = TALUS_BODY_SPHERE;
    body->radius = 1.0;
    body->initial_stress = TALUS_INITIAL_GEOSTATIC;
    body->k0_rule = TALUS_K0_GIVEN;
    body->k0 = 1.0;
    struct particle_seed seed = create(&fixture);
    for (size_t index = 0; index < seed.count; index++) {
        double x = seed.position[0][index], y = seed.position[1][index];
        double top = -sqrt(1.0 - x * x - y * y);
        double expected = -weight * (seed.position[2][index] - top);
        ASSERT_WITHIN(seed.stress[2][index], expected, 1e-6 * weight);
        assert_true(seed.stress[2][index] <= 0.0);
    }
    seeding_release(&seed);
}

static void hydrostatic_is_isotropic(void **state)
{
    (void)state;
    for (size_t axis_count = 1; axis_count <= 3; axis_count++) {
        struct seeding_fixture fixture;
        fixture_init(&fixture, axis_count, "linear_elastic");
        size_t vertical = axis_count - 1;
        fixture.scene.gravity[vertical] = -9.81;
        fixture.bodies[0].initial_stress = TALUS_INITIAL_HYDROSTATIC;
        struct particle_seed seed = create(&fixture);
        for (size_t index = 0; index < seed.count; index++) {
            for (size_t k = 0; k < 3; k++)
                assert_near(seed.stress[k][index],
                            -weight * (1.0 - seed.position[vertical][index]));
        }
        seeding_release(&seed);
    }
}

static void hydrostatic_below_a_given_surface(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 2, "linear_elastic");
    fixture.scene.gravity[1] = -9.81;
    fixture.bodies[0].initial_stress = TALUS_INITIAL_HYDROSTATIC;
    fixture.bodies[0].surface = 0.5;
    struct particle_seed seed = create(&fixture);
    for (size_t index = 0; index < seed.count; index++) {
        double depth = fmax(0.0, 0.5 - seed.position[1][index]);
        assert_near(seed.stress[0][index], -weight * depth);
    }
    seeding_release(&seed);
}

static void given_components_are_copied(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 3, "linear_elastic");
    fixture.scene.body_count = 2;
    fixture.bodies[1].box_min[0] = 2.0;
    fixture.bodies[1].box_max[0] = 3.0;
    fixture.bodies[1].initial_stress = TALUS_INITIAL_GIVEN;
    for (size_t k = 0; k < 6; k++)
        fixture.bodies[1].stress[k] = 1.0 + (double)k;
    struct particle_seed seed = create(&fixture);
    for (size_t k = 0; k < 6; k++) {
        ASSERT_WITHIN(seed.stress[k][0], 0.0, 0.0);
        ASSERT_WITHIN(seed.stress[k][seed.count - 1], 1.0 + (double)k, 0.0);
    }
    seeding_release(&seed);
}

static void k0_rules(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_body *body = &fixture.bodies[0];
    fixture_init(&fixture, 2, "drucker_prager_cap");
    fixture_set(&fixture, "friction_angle", 30.0);
    fixture_set(&fixture, "cohesion", 10.0);
    body->k0_rule = TALUS_K0_ELASTIC; /* nu / (1 - nu) */
    assert_near(seeding_k0(&fixture.scene, body), 1.0 / 3.0);
    body->k0_rule = TALUS_K0_JAKY;
    assert_near(seeding_k0(&fixture.scene, body), 0.5);
    body->k0_rule = TALUS_K0_AUTO; /* nu / (1 - nu) equals Ka(30 deg) here */
    assert_near(seeding_k0(&fixture.scene, body), 1.0 / 3.0);
    fixture_set(&fixture, "friction_angle", 10.0);
    double sine = sin(10.0 * 3.14159265358979323846 / 180.0);
    assert_near(seeding_k0(&fixture.scene, body), (1.0 - sine) / (1.0 + sine));
    fixture_set(&fixture, "friction_angle", 40.0);
    assert_near(seeding_k0(&fixture.scene, body), 1.0 / 3.0);
    body->k0_rule = TALUS_K0_GIVEN;
    body->k0 = 0.7;
    assert_near(seeding_k0(&fixture.scene, body), 0.7);
}

static void depth_needs_gravity(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct particle_seed seed;
    struct talus_error error = {.status = TALUS_OK};
    fixture_init(&fixture, 2, "linear_elastic");
    assert_int_equal(seeding_vertical_axis(&fixture.scene), TALUS_NO_AXIS);
    fixture.bodies[0].initial_stress = TALUS_INITIAL_HYDROSTATIC;
    assert_int_equal(seeding_create(&fixture.scene, &seed, &error), TALUS_INVALID);
    assert_string_equal(error.pointer, "/bodies/0/initial_stress");
    assert_null(seed.volume);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(geostatic_follows_depth),
        cmocka_unit_test(depth_is_below_the_surface_over_the_particle),
        cmocka_unit_test(hydrostatic_is_isotropic),
        cmocka_unit_test(hydrostatic_below_a_given_surface),
        cmocka_unit_test(given_components_are_copied),
        cmocka_unit_test(k0_rules),
        cmocka_unit_test(depth_needs_gravity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
