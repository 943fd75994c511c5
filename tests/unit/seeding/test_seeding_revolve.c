/* SPDX-License-Identifier: Apache-2.0 */
/* Bodies of revolution: volumes of the whole circle, and particles that add up to them. */
#include "seeding_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static struct talus_body *begin(struct seeding_fixture *fixture, enum talus_body_shape shape)
{
    fixture_init(fixture, 2, "linear_elastic");
    fixture->scene.dimension = TALUS_AXISYMMETRIC;
    fixture->scene.grid.min[0] = 0.0;
    fixture->bodies[0].shape = shape;
    for (size_t k = 0; k < 2; k++)
        fixture->bodies[0].lattice_value[k] = 8.0;
    return &fixture->bodies[0];
}

/* The body's volume, that of its particles, their mass, and no particle beyond the axis. */
static void check(const struct seeding_fixture *fixture, double expected)
{
    struct particle_seed seed;
    struct talus_error error = {.status = TALUS_OK};
    const double volume = seeding_body_volume(&fixture->scene, &fixture->bodies[0]);
    double sum = 0.0, mass = 0.0;
    if (fabs(volume - expected) > 1e-9 * expected)
        fail_msg("volume %.15g, not %.15g", volume, expected);
    if (seeding_create(&fixture->scene, &seed, &error) != TALUS_OK)
        fail_msg("%s", error.text);
    for (size_t particle = 0; particle < seed.count; particle++) {
        assert_true(seed.position[0][particle] > 0.0);
        sum += seed.volume[particle];
        mass += seed.mass[particle];
    }
    assert_true(fabs(sum - expected) <= 1e-9 * expected);
    assert_true(fabs(mass - 2000.0 * expected) <= 2e-6 * expected);
    /* Particles are alike but for their circles. */
    assert_true(fabs(seed.volume[0] / seed.position[0][0] -
                     seed.volume[seed.count - 1] / seed.position[0][seed.count - 1]) <
                1e-12 * seed.volume[0] / seed.position[0][0]);
    seeding_release(&seed);
}

static void cylinder_and_ring(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_body *body = begin(&fixture, TALUS_BODY_BOX);
    check(&fixture, pi);
    body->box_min[0] = 2.0;
    body->box_max[0] = 3.0;
    check(&fixture, pi * (9.0 - 4.0));
}

static void ball_and_torus(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_body *body = begin(&fixture, TALUS_BODY_SPHERE);
    body->radius = 0.8;
    check(&fixture, 4.0 / 3.0 * pi * 0.8 * 0.8 * 0.8);
    body->centre[0] = 2.0;
    check(&fixture, 2.0 * pi * 2.0 * pi * 0.8 * 0.8);
    body->centre[0] = 0.0;
    body->clip_min[1] = 0.0; /* half a ball */
    check(&fixture, 2.0 / 3.0 * pi * 0.8 * 0.8 * 0.8);
}

static void cone(void **state)
{
    (void)state;
    double vertices[] = {0.0, 0.0, 1.5, 0.0, 0.0, 2.0};
    struct seeding_fixture fixture;
    struct talus_body *body = begin(&fixture, TALUS_BODY_POLYGON);
    body->vertices = vertices;
    body->vertex_count = 3;
    check(&fixture, pi / 3.0 * 1.5 * 1.5 * 2.0);
    body->clip_max[1] = 1.0; /* a frustum: what is above is half as large in each direction */
    check(&fixture, pi / 3.0 * 1.5 * 1.5 * 2.0 * 7.0 / 8.0);
}

static void turned_box(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_body *body = begin(&fixture, TALUS_BODY_BOX);
    body->box_min[0] = 2.0;
    body->box_max[0] = 3.0;
    body->rotate_angle_deg = 30.0;
    body->rotate_about[0] = 2.0;
    body->rotate_axis[2] = 1.0;
    const double angle = pi / 6.0;
    check(&fixture, 2.0 * pi * (2.0 + 0.5 * cos(angle) - 0.5 * sin(angle)));
}

/* Volumes in a list are those of whole circles already. */
static void points(void **state)
{
    (void)state;
    double positions[] = {0.5, 0.5, 0.0, 1.5, 0.5, 0.0}, volumes[] = {0.25, 0.75};
    struct seeding_fixture fixture;
    struct talus_body *body = begin(&fixture, TALUS_BODY_POINTS);
    body->point_count = 2;
    body->point_positions = positions;
    body->point_volumes = volumes;
    check(&fixture, 1.0);
}

static void beyond_the_axis(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_error error = {.status = TALUS_OK};
    struct talus_body *body = begin(&fixture, TALUS_BODY_BOX);
    body->box_min[0] = -0.5;
    assert_true(seeding_check(&fixture.scene, 0, &error) == TALUS_INVALID);
    assert_string_equal(error.pointer, "/bodies/0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cylinder_and_ring),
        cmocka_unit_test(ball_and_torus),
        cmocka_unit_test(cone),
        cmocka_unit_test(turned_box),
        cmocka_unit_test(points),
        cmocka_unit_test(beyond_the_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
