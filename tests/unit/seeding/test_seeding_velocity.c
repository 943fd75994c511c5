/* SPDX-License-Identifier: Apache-2.0 */
/* Velocity fields of bodies at the start. */
#include "seeding/seeding_velocity.h"
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

/* Known to ten digits (any table of beam functions), and the equation itself. */
static void roots_of_the_clamped_free_beam(void **state)
{
    (void)state;
    static const double known[] = {1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349};
    for (size_t index = 0; index < 4; index++)
        ASSERT_WITHIN(seeding_beam_root((double)index + 1.0), known[index], 5e-11);
    for (int mode = 1; mode <= 50; mode++) {
        const double root = seeding_beam_root(mode);
        ASSERT_WITHIN(cos(root) + 1.0 / cosh(root), 0.0, 1e-13);
    }
}

/* Clamped: no displacement, no slope; free: no curvature, no shear; the field equation
 * phi'''' = b^4 phi. Derivatives of the slope by differences. */
static void shapes_are_bending_modes(void **state)
{
    (void)state;
    for (int mode = 1; mode <= 50; mode++) {
        const double b = seeding_beam_root(mode), h = 0.01 / b;
        double shape[5], slope[5];
        seeding_beam_shape(mode, 0.0, &shape[0], &slope[0]);
        ASSERT_WITHIN(shape[0], 0.0, 1e-13);
        ASSERT_WITHIN(slope[0] / b, 0.0, 1e-13);
        seeding_beam_shape(mode, 1.0, &shape[0], &slope[0]);
        ASSERT_WITHIN(shape[0], 1.0, 1e-13);
        for (int k = 0; k < 5; k++)
            seeding_beam_shape(mode, 1.0 - 4.0 * h + k * h, &shape[k], &slope[k]);
        /* fourth order one-sided: curvature at the free end */
        const double curvature = (25.0 * slope[4] - 48.0 * slope[3] + 36.0 * slope[2] -
                                  16.0 * slope[1] + 3.0 * slope[0]) /
                                 (12.0 * h * b * b);
        ASSERT_WITHIN(curvature, 0.0, 1e-6);
        for (int k = 0; k < 5; k++)
            seeding_beam_shape(mode, 0.6 - 2.0 * h + k * h, &shape[k], &slope[k]);
        const double fourth =
            (-0.5 * slope[0] + slope[1] - slope[3] + 0.5 * slope[4]) / (h * h * h);
        ASSERT_WITHIN(fourth / pow(b, 4.0), shape[2], 2e-4);
        ASSERT_WITHIN((shape[3] - shape[1]) / (2.0 * h * b), slope[2] / b, 2e-5);
    }
    double shape, slope; /* Mast 2013, sec. 6.2: first mode at a quarter and a half */
    seeding_beam_shape(1.0, 0.25, &shape, &slope);
    ASSERT_WITHIN(shape, 0.09729, 5e-6);
    seeding_beam_shape(1.0, 0.5, &shape, &slope);
    ASSERT_WITHIN(shape, 0.33952, 5e-6);
}

/* An oblique beam: sections stay normal to the axis, whatever its direction. */
static void beam_field_bends_without_shear(void **state)
{
    (void)state;
    struct talus_body body = {.velocity_field = TALUS_VELOCITY_BEAM_MODE,
                              .beam_mode = 2.0,
                              .beam_from = {1.0, 2.0, 0.0},
                              .beam_to = {4.0, 6.0, 0.0},
                              .beam_tip = {-0.8, 0.6, 0.0}};
    const double axis[2] = {0.6, 0.8}, normal[2] = {-0.8, 0.6}, h = 1e-5;
    double velocity[3], value[4][3];
    seeding_velocity_at(&body, body.beam_to, velocity);
    ASSERT_WITHIN(velocity[0], -0.8, 1e-14);
    ASSERT_WITHIN(velocity[1], 0.6, 1e-14);
    seeding_velocity_at(&body, body.beam_from, velocity);
    ASSERT_WITHIN(hypot(velocity[0], velocity[1]), 0.0, 1e-14);
    for (int k = 0; k < 4; k++) { /* around a point off the axis: along it, across it */
        const double *way = k < 2 ? axis : normal, side = k % 2 == 0 ? h : -h;
        const double position[3] = {1.0 + 2.0 * axis[0] + 0.3 * normal[0] + side * way[0],
                                    2.0 + 2.0 * axis[1] + 0.3 * normal[1] + side * way[1], 0.0};
        seeding_velocity_at(&body, position, value[k]);
    }
    double shear = 0.0, across = 0.0;
    for (int k = 0; k < 2; k++) {
        shear += (value[0][k] - value[1][k]) * normal[k] + (value[2][k] - value[3][k]) * axis[k];
        across += (value[2][k] - value[3][k]) * normal[k];
    }
    ASSERT_WITHIN(shear / (2.0 * h), 0.0, 1e-9);
    ASSERT_WITHIN(across / (2.0 * h), 0.0, 1e-9);
}

static void rotation_is_rigid(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct particle_seed seed;
    struct talus_error error = {.status = TALUS_OK};
    fixture_init(&fixture, 3, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    const double about[3] = {0.5, -1.0, 2.0}, rate[3] = {1.0, -2.0, 3.0};
    body->velocity_field = TALUS_VELOCITY_ROTATION;
    memcpy(body->rotation_about, about, sizeof about);
    memcpy(body->rotation_rate, rate, sizeof rate);
    assert_int_equal(seeding_create(&fixture.scene, &seed, &error), TALUS_OK);
    double fastest = 0.0;
    for (size_t index = 0; index < seed.count; index++) {
        double along = 0.0, radial = 0.0, square = 0.0, arm_square = 0.0, arm_along = 0.0;
        for (size_t k = 0; k < 3; k++) {
            const double arm = seed.position[k][index] - about[k], v = seed.velocity[k][index];
            along += v * rate[k];
            radial += v * arm;
            square += v * v;
            arm_square += arm * arm;
            arm_along += arm * rate[k];
        }
        ASSERT_WITHIN(along, 0.0, 1e-12);
        ASSERT_WITHIN(radial, 0.0, 1e-12);
        ASSERT_WITHIN(square, 14.0 * arm_square - arm_along * arm_along, 1e-10);
        fastest = fmax(fastest, sqrt(square));
    }
    assert_true(seeding_largest_speed(&fixture.scene, body) >= fastest);
    seeding_release(&seed);
    fixture_init(&fixture, 2, "linear_elastic"); /* counterclockwise */
    body->velocity_field = TALUS_VELOCITY_ROTATION;
    body->rotation_rate[2] = 2.0;
    double velocity[3];
    seeding_velocity_at(body, (double[3]){1.0, 0.0, 0.0}, velocity);
    ASSERT_WITHIN(velocity[1], 2.0, 0.0);
    ASSERT_WITHIN(seeding_largest_speed(&fixture.scene, body), 2.0 * sqrt(2.0), 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_of_the_clamped_free_beam),
        cmocka_unit_test(shapes_are_bending_modes),
        cmocka_unit_test(beam_field_bends_without_shear),
        cmocka_unit_test(rotation_is_rigid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
