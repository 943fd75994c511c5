/* SPDX-License-Identifier: Apache-2.0 */
/* Shapes, lattices, volumes, counts. */
#include "seeding_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#define ASSERT_WITHIN(value, expected, tolerance)                                                  \
    assert_true(fabs((value) - (expected)) <= (tolerance))

static const double pi = 3.14159265358979323846;

static double total(const double *values, size_t count)
{
    double sum = 0.0;
    for (size_t index = 0; index < count; index++)
        sum += values[index];
    return sum;
}

static struct particle_seed create(const struct seeding_fixture *fixture)
{
    struct particle_seed seed;
    struct talus_error error = {.status = TALUS_OK};
    assert_int_equal(seeding_create(&fixture->scene, &seed, &error), TALUS_OK);
    return seed;
}

static void assert_refused(const struct seeding_fixture *fixture, const char *code)
{
    struct particle_seed seed;
    struct talus_error error = {.status = TALUS_OK};
    assert_int_equal(seeding_create(&fixture->scene, &seed, &error), TALUS_INVALID);
    assert_string_equal(error.code, code);
    assert_string_equal(error.pointer, "/bodies/0");
}

static void box_is_filled_exactly(void **state)
{
    (void)state;
    for (size_t axis_count = 1; axis_count <= 3; axis_count++) {
        struct seeding_fixture fixture;
        fixture_init(&fixture, axis_count, "linear_elastic");
        struct particle_seed seed = create(&fixture);
        assert_int_equal(seed.count, (size_t)pow(8.0, (double)axis_count));
        ASSERT_WITHIN(total(seed.volume, seed.count), 1.0, 1e-14);
        ASSERT_WITHIN(total(seed.mass, seed.count), 2000.0, 1e-10);
        ASSERT_WITHIN(seed.volume_factor[0], 1.0, 0.0);
        ASSERT_WITHIN(seed.position[0][0], 0.0625, 1e-15); /* half a spacing from the side */
        ASSERT_WITHIN(seed.position[0][1], 0.1875, 1e-15); /* x runs fastest */
        assert_null(seed.stress[0]);
        for (size_t k = axis_count; k < 3; k++)
            ASSERT_WITHIN(total(seed.position[k], seed.count), 0.0, 0.0);
        seeding_release(&seed);
    }
}

static void lattices_round_to_the_bounding_box(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    uint64_t particles, cells;
    fixture_init(&fixture, 2, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    body->box_max[0] = 0.9; /* 0.9 / 0.125 = 7.2 points */
    seeding_count(&fixture.scene, &particles, &cells);
    assert_int_equal(particles, 7 * 8);
    assert_int_equal(cells, 4 * 4);
    body->lattice = TALUS_LATTICE_SPACING;
    body->lattice_value[0] = 0.25; /* 3.6 points */
    body->lattice_value[1] = 5.0;  /* 0.2 points: at least one */
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.count, 4);
    ASSERT_WITHIN(seed.position[0][0], 0.9 / 8.0, 1e-15);
    ASSERT_WITHIN(seed.position[1][0], 0.5, 1e-15);
    ASSERT_WITHIN(total(seed.volume, seed.count), 0.9, 1e-14);
    seeding_release(&seed);
    body->lattice = TALUS_LATTICE_COUNT;
    body->lattice_value[0] = 35.0;
    body->lattice_value[1] = 70.0;
    seeding_count(&fixture.scene, &particles, &cells);
    assert_int_equal(particles, 35 * 70);
}

static void make_sphere(struct talus_body *body, double radius)
{
    body->shape = TALUS_BODY_SPHERE;
    body->radius = radius;
    memset(body->centre, 0, sizeof body->centre);
}

static void disc_and_sphere_have_exact_volume(void **state)
{
    (void)state;
    const double volumes[] = {0.0, 2.0, pi, 4.0 / 3.0 * pi};
    for (size_t axis_count = 1; axis_count <= 3; axis_count++) {
        struct seeding_fixture fixture;
        fixture_init(&fixture, axis_count, "linear_elastic");
        make_sphere(&fixture.bodies[0], 1.0);
        struct particle_seed seed = create(&fixture);
        ASSERT_WITHIN(total(seed.volume, seed.count), volumes[axis_count], 1e-12);
        assert_true(seed.volume_factor[0] > 0.95 && seed.volume_factor[0] < 1.05);
        uint64_t particles, cells;
        seeding_count(&fixture.scene, &particles, &cells);
        assert_int_equal(particles, seed.count);
        for (size_t index = 0; index < seed.count; index++) {
            double square = 0.0;
            for (size_t k = 0; k < axis_count; k++)
                square += seed.position[k][index] * seed.position[k][index];
            assert_true(square <= 1.0 + 1e-9);
        }
        for (size_t k = 0; k < axis_count; k++) /* mirror images about the centre */
            ASSERT_WITHIN(total(seed.position[k], seed.count), 0.0, 1e-11);
        seeding_release(&seed);
    }
}

static void quarter_cylinder_of_the_source(void **state)
{
    (void)state;
    /* Mast 2013, sec. 6.2.3: Taylor bar, 9,408 particles at 27 per cell of 1 cm. */
    struct seeding_fixture fixture;
    fixture_init(&fixture, 3, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    for (size_t k = 0; k < 3; k++) {
        fixture.scene.grid.cell[k] = 0.01;
        fixture.scene.grid.min[k] = 0.0;
        body->lattice_value[k] = 3.0;
    }
    body->shape = TALUS_BODY_CYLINDER;
    body->to[1] = 0.28;
    body->radius = 0.04;
    body->clip_min[0] = body->clip_min[2] = 0.0;
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.count, 9408);
    double exact = pi * 0.04 * 0.04 / 4.0 * 0.28;
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body), exact, 1e-9 * exact);
    ASSERT_WITHIN(total(seed.volume, seed.count), exact, 1e-9 * exact);
    seeding_release(&seed);
}

static void oblique_cylinder(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 3, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    body->shape = TALUS_BODY_CYLINDER;
    body->from[0] = -1.0;
    body->to[0] = 1.0;
    body->to[1] = 2.0;
    body->to[2] = 1.0;
    body->radius = 0.75;
    double length = 3.0, exact = pi * 0.75 * 0.75 * length;
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body), exact, 1e-12);
    struct particle_seed seed = create(&fixture);
    ASSERT_WITHIN(total(seed.volume, seed.count), exact, 1e-10);
    assert_true(fabs(seed.volume_factor[0] - 1.0) < 0.02);
    double centre = 0.0;
    for (size_t index = 0; index < seed.count; index++)
        centre += seed.position[1][index] / (double)seed.count;
    ASSERT_WITHIN(centre, 1.0, 1e-9);
    seeding_release(&seed);
    body->clip_min[1] = 1.0; /* through the middle: half of it by symmetry */
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body), 0.5 * exact, 1e-8);
}

static void cut_shapes(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 3, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    make_sphere(body, 1.0);
    body->clip_min[1] = 0.5; /* a cap of height 1/2: pi h^2 (3 r - h) / 3 */
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body), pi * 0.25 * 2.5 / 3.0, 1e-8);
    body->clip_min[1] = 0.0;
    body->clip_min[0] = body->clip_min[2] = 0.0; /* an eighth */
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body), pi / 6.0, 1e-9);
    fixture_init(&fixture, 2, "linear_elastic");
    make_sphere(body, 1.0);
    body->clip_min[0] = 0.5; /* segment: r^2 (a - sin a) / 2 with a = 120 deg */
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body),
                  0.5 * (2.0 * pi / 3.0 - sin(2.0 * pi / 3.0)), 1e-12);
    fixture_init(&fixture, 2, "linear_elastic");
    body->clip_max[1] = 0.25;
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.count, 8 * 2);
    ASSERT_WITHIN(total(seed.volume, seed.count), 0.25, 1e-15);
    seeding_release(&seed);
}

static void bodies_follow_each_other(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 2, "linear_elastic");
    fixture.scene.body_count = 2;
    struct talus_body *second = &fixture.bodies[1];
    second->box_min[0] = 2.0;
    second->box_max[0] = 3.0;
    second->velocity[0] = -4.0;
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.count, 128);
    for (size_t index = 0; index < seed.count; index++) {
        assert_int_equal(seed.body[index], index < 64 ? 0 : 1);
        ASSERT_WITHIN(seed.velocity[0][index], index < 64 ? 0.0 : -4.0, 0.0);
        assert_true((seed.position[0][index] > 2.0) == (index >= 64));
    }
    seeding_release(&seed);
}

static void bad_bodies_are_refused(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_body *body = &fixture.bodies[0];
    fixture_init(&fixture, 2, "linear_elastic");
    body->box_max[1] = 10.5; /* the grid ends at 10 */
    assert_refused(&fixture, "outside");
    fixture_init(&fixture, 2, "linear_elastic");
    body->clip_min[0] = 2.0;
    assert_refused(&fixture, "empty");
    fixture_init(&fixture, 3, "linear_elastic");
    make_sphere(body, 1.0); /* one point for a sphere: its bounding box is 1.9 times as large */
    body->lattice = TALUS_LATTICE_COUNT;
    body->lattice_value[0] = body->lattice_value[1] = body->lattice_value[2] = 1.0;
    assert_refused(&fixture, "volume_factor");
    fixture_init(&fixture, 2, "linear_elastic");
    make_sphere(body, 1.0); /* the four points lie inside, but stand for the whole square */
    body->lattice = TALUS_LATTICE_COUNT;
    assert_refused(&fixture, "volume_factor");
}

static void material_inside_an_obstacle_is_refused(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    char name[] = "pile";
    fixture_init(&fixture, 3, "linear_elastic");
    make_sphere(&fixture.bodies[0], 1.0);
    fixture.boundary.name = name;
    fixture.boundary.shape = TALUS_BOUNDARY_BOX;
    fixture.boundary.body_index = -1;
    fixture.scene.boundaries = &fixture.boundary;
    fixture.scene.boundary_count = 1;
    for (size_t k = 0; k < 3; k++) { /* touches the bounding box, not the sphere */
        fixture.boundary.box_min[k] = 0.6;
        fixture.boundary.box_max[k] = 2.0;
    }
    struct particle_seed seed = create(&fixture);
    seeding_release(&seed);
    for (size_t k = 0; k < 3; k++)
        fixture.boundary.box_min[k] = 0.5;
    assert_refused(&fixture, "contradiction");
    fixture.boundary.body_index = 1; /* acts on another body only */
    seed = create(&fixture);
    seeding_release(&seed);
}

static void monstrous_scenes_are_answered_at_once(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct timespec begin, end;
    uint64_t particles, cells;
    fixture_init(&fixture, 3, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    body->lattice = TALUS_LATTICE_COUNT;
    for (size_t k = 0; k < 3; k++)
        body->lattice_value[k] = 1e4;
    (void)clock_gettime(CLOCK_MONOTONIC, &begin);
    seeding_count(&fixture.scene, &particles, &cells);
    assert_int_equal(particles, 1000000000000u);
    assert_refused(&fixture, "limit");
    make_sphere(body, 1.0);
    assert_refused(&fixture, "limit");
    for (size_t k = 0; k < 3; k++)
        body->lattice_value[k] = 1e300;
    seeding_count(&fixture.scene, &particles, &cells);
    assert_true(particles == UINT64_MAX);
    assert_refused(&fixture, "limit");
    (void)clock_gettime(CLOCK_MONOTONIC, &end);
    double seconds =
        (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
    assert_true(seconds < 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_is_filled_exactly),
        cmocka_unit_test(lattices_round_to_the_bounding_box),
        cmocka_unit_test(disc_and_sphere_have_exact_volume),
        cmocka_unit_test(quarter_cylinder_of_the_source),
        cmocka_unit_test(oblique_cylinder),
        cmocka_unit_test(cut_shapes),
        cmocka_unit_test(bodies_follow_each_other),
        cmocka_unit_test(bad_bodies_are_refused),
        cmocka_unit_test(material_inside_an_obstacle_is_refused),
        cmocka_unit_test(monstrous_scenes_are_answered_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
