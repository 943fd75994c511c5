/* SPDX-License-Identifier: Apache-2.0 */
/* Polygons, lists of points, and bodies that are turned. */
#include "seeding/seeding_polygon.h"
#include "seeding/seeding_shape.h"
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

/* A U: 3 x 2 m with a notch of 1 x 1 m from above. */
static double notched[] = {0, 0, 3, 0, 3, 2, 2, 2, 2, 1, 1, 1, 1, 2, 0, 2};

static struct particle_seed create(const struct seeding_fixture *fixture)
{
    struct particle_seed seed;
    struct talus_error error = {.status = TALUS_OK};
    assert_int_equal(seeding_create(&fixture->scene, &seed, &error), TALUS_OK);
    return seed;
}

static double total(const double *values, size_t count)
{
    double sum = 0.0;
    for (size_t index = 0; index < count; index++)
        sum += values[index];
    return sum;
}

static void make_polygon(struct talus_body *body, double *vertices, size_t count)
{
    body->shape = TALUS_BODY_POLYGON;
    body->vertices = vertices;
    body->vertex_count = count;
}

static void a_notched_block_is_filled_exactly(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    uint64_t particles, cells;
    fixture_init(&fixture, 2, "linear_elastic");
    make_polygon(&fixture.bodies[0], notched, 8);
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.count, 5 * 64); /* 8 points a metre */
    ASSERT_WITHIN(seed.volume_factor[0], 1.0, 1e-14);
    ASSERT_WITHIN(total(seed.volume, seed.count), 5.0, 1e-13);
    for (size_t index = 0; index < seed.count; index++)
        assert_false(seed.position[1][index] > 1.0 && seed.position[0][index] > 1.0 &&
                     seed.position[0][index] < 2.0);
    seeding_count(&fixture.scene, &particles, &cells);
    assert_int_equal(particles, seed.count);
    seeding_release(&seed);
    fixture.bodies[0].clip_min[1] = 1.5; /* the two arms */
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, &fixture.bodies[0]), 1.0, 1e-15);
    fixture.bodies[0].clip_max[0] = 0.75;
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, &fixture.bodies[0]), 0.375, 1e-15);
}

/* A row of points on sides: with the material above and below, on both sides of the mirror. */
static void points_on_a_side_are_inside(void **state)
{
    (void)state;
    double flag[] = {0, 0, 3, 0, 3, 3, 0, 3, 0, 2.5, 2, 2.5, 2, 0.5, 0, 0.5};
    struct seeding_fixture fixture;
    fixture_init(&fixture, 2, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    make_polygon(body, flag, 8);
    body->lattice = TALUS_LATTICE_COUNT;
    body->lattice_value[0] = 30;
    body->lattice_value[1] = 3; /* rows at 0.5, 1.5, 2.5 */
    struct particle_seed seed = {0};
    struct talus_error error = {.status = TALUS_OK};
    struct seeding_report report;
    seeding_report(&fixture.scene, 0, &report);
    assert_int_equal(report.particle_count, 30 + 10 + 30);
    assert_int_equal(seeding_create(&fixture.scene, &seed, &error), TALUS_INVALID); /* 5/7 */
    assert_string_equal(error.code, "volume_factor");
}

static void orientation_does_not_matter(void **state)
{
    (void)state;
    double reversed[16];
    struct seeding_fixture fixture;
    for (size_t k = 0; k < 8; k++)
        memcpy(reversed + 2 * k, notched + 2 * (7 - k), 2 * sizeof *reversed);
    fixture_init(&fixture, 2, "linear_elastic");
    make_polygon(&fixture.bodies[0], reversed, 8);
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.count, 5 * 64);
    ASSERT_WITHIN(total(seed.volume, seed.count), 5.0, 1e-13);
    seeding_release(&seed);
}

/* A polygon with many sides against the disc: area n/2 sin(2 pi / n) r^2. */
static void a_round_polygon_is_a_disc(void **state)
{
    (void)state;
    enum { SIDES = 360 };
    static double vertices[2 * SIDES];
    const double pi = 3.14159265358979323846;
    struct seeding_fixture fixture;
    for (size_t k = 0; k < SIDES; k++) {
        vertices[2 * k] = cos(2.0 * pi * (double)k / SIDES);
        vertices[2 * k + 1] = sin(2.0 * pi * (double)k / SIDES);
    }
    fixture_init(&fixture, 2, "linear_elastic");
    make_polygon(&fixture.bodies[0], vertices, SIDES);
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, &fixture.bodies[0]),
                  0.5 * SIDES * sin(2.0 * pi / SIDES), 1e-13);
    struct particle_seed seed = create(&fixture);
    assert_true(fabs(seed.volume_factor[0] - 1.0) < 0.05);
    ASSERT_WITHIN(total(seed.position[0], seed.count), 0.0, 1e-10);
    ASSERT_WITHIN(total(seed.position[1], seed.count), 0.0, 1e-10);
    seeding_release(&seed);
    fixture.bodies[0].clip_min[0] = fixture.bodies[0].clip_min[1] = 0.0;
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, &fixture.bodies[0]),
                  0.125 * SIDES * sin(2.0 * pi / SIDES), 1e-13);
}

static void crossing_sides_are_found(void **state)
{
    (void)state;
    static const double bow[] = {0, 0, 1, 1, 1, 0, 0, 1};
    static const double spike[] = {0, 0, 2, 0, 1, 0, 1, 1};
    static const double touch[] = {0, 0, 2, 0, 2, 2, 1, 0, 0, 2};
    static const double twice[] = {0, 0, 1, 0, 1, 0, 0, 1};
    static const double square[] = {0, 0, 1, 0, 1, 1, 0, 1};
    size_t first, second;
    assert_true(polygon_crosses_itself(bow, 4, &first, &second));
    assert_int_equal(first, 0);
    assert_int_equal(second, 2);
    assert_true(polygon_crosses_itself(spike, 4, &first, &second));
    assert_true(polygon_crosses_itself(touch, 5, &first, &second));
    assert_true(polygon_crosses_itself(twice, 4, &first, &second));
    assert_false(polygon_crosses_itself(square, 4, &first, &second));
    assert_false(polygon_crosses_itself(notched, 8, &first, &second));
}

/* Below the notch the ground begins at 1 m; under an arm at 2 m. Depth runs from there. */
static void depth_runs_from_the_surface_above(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    fixture_init(&fixture, 2, "linear_elastic");
    make_polygon(&fixture.bodies[0], notched, 8);
    fixture.scene.gravity[1] = -10.0;
    fixture.bodies[0].initial_stress = TALUS_INITIAL_HYDROSTATIC;
    for (int turned = 0; turned < 2; turned++) {
        struct particle_seed seed = create(&fixture);
        for (size_t index = 0; index < seed.count; index++) {
            const double x = seed.position[0][index], y = seed.position[1][index];
            double top = x > 1.0 && x < 2.0 ? 1.0 : 2.0; /* upright */
            if (turned == 1) /* the U lies on its side, open to the left, arms below and above */
                top = x > -1.0 || y > 2.0 ? 3.0 : (y < 1.0 ? 1.0 : NAN);
            ASSERT_WITHIN(seed.stress[1][index], -2000.0 * 10.0 * (top - y), 1e-8);
        }
        seeding_release(&seed);
        fixture.bodies[0].rotate_angle_deg = 90.0;
        fixture.bodies[0].rotate_axis[2] = 1.0;
    }
}

/* The lattice turns with the body: the same points, mapped. */
static void turned_bodies_keep_their_lattice(void **state)
{
    (void)state;
    const double axis[3] = {2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0}, about[3] = {1.0, 0.5, -0.25};
    const enum talus_body_shape shapes[] = {TALUS_BODY_BOX, TALUS_BODY_SPHERE, TALUS_BODY_CYLINDER};
    for (size_t kind = 0; kind < 3; kind++) {
        struct seeding_fixture fixture;
        fixture_init(&fixture, 3, "linear_elastic");
        struct talus_body *body = &fixture.bodies[0];
        body->shape = shapes[kind];
        body->radius = 1.0;
        body->to[1] = 2.0;
        body->clip_max[0] = 0.625;
        struct particle_seed straight = create(&fixture);
        const double volume = seeding_body_volume(&fixture.scene, body);
        body->rotate_angle_deg = 37.0;
        memcpy(body->rotate_axis, axis, sizeof axis);
        memcpy(body->rotate_about, about, sizeof about);
        struct particle_seed turned = create(&fixture);
        struct seeding_shape shape;
        double low[3], high[3], trace = 0.0;
        seeding_shape_init(&shape, &fixture.scene, body);
        seeding_shape_bounds(&shape, low, high);
        for (size_t k = 0; k < 3; k++)
            trace += shape.turn[k][k];
        ASSERT_WITHIN(trace, 1.0 + 2.0 * cos(37.0 * 3.14159265358979323846 / 180.0), 1e-14);
        ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body), volume, 0.0);
        assert_int_equal(turned.count, straight.count);
        for (size_t index = 0; index < turned.count; index++) {
            double along[2] = {0.0, 0.0}, distance[2] = {0.0, 0.0};
            for (size_t k = 0; k < 3; k++) {
                const double before = straight.position[k][index] - about[k];
                const double after = turned.position[k][index] - about[k];
                along[0] += before * axis[k];
                along[1] += after * axis[k];
                distance[0] += before * before;
                distance[1] += after * after;
                assert_true(turned.position[k][index] > low[k]);
                assert_true(turned.position[k][index] < high[k]);
            }
            ASSERT_WITHIN(along[1], along[0], 1e-13);
            ASSERT_WITHIN(distance[1], distance[0], 1e-12);
        }
        seeding_release(&straight);
        seeding_release(&turned);
    }
}

static void rotation_is_counterclockwise(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct seeding_shape shape;
    double low[3], high[3];
    fixture_init(&fixture, 2, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    body->box_max[0] = 3.0;
    body->rotate_angle_deg = 90.0;
    body->rotate_axis[2] = 1.0;
    seeding_shape_init(&shape, &fixture.scene, body);
    seeding_shape_bounds(&shape, low, high);
    ASSERT_WITHIN(low[0], -1.0, 0.0);
    ASSERT_WITHIN(high[0], 0.0, 0.0);
    ASSERT_WITHIN(high[1], 3.0, 0.0);
    body->rotate_angle_deg = 45.0;
    seeding_shape_init(&shape, &fixture.scene, body);
    seeding_shape_bounds(&shape, low, high);
    ASSERT_WITHIN(low[0], -sqrt(0.5), 1e-15);
    ASSERT_WITHIN(high[0], 3.0 * sqrt(0.5), 1e-15);
    ASSERT_WITHIN(high[1], 4.0 * sqrt(0.5), 1e-15);
}

static void points_are_taken_as_they_are(void **state)
{
    (void)state;
    double positions[] = {1, 2, 0, 3, 4, 0, -1, 0.5, 0}, volumes[] = {0.1, 0.2, 0.4};
    struct seeding_fixture fixture;
    uint64_t particles, cells;
    fixture_init(&fixture, 2, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    body->shape = TALUS_BODY_POINTS;
    body->point_count = 3;
    body->point_positions = positions;
    body->point_volumes = volumes;
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.count, 3);
    for (size_t index = 0; index < 3; index++) {
        ASSERT_WITHIN(seed.position[0][index], positions[3 * index], 0.0);
        ASSERT_WITHIN(seed.position[1][index], positions[3 * index + 1], 0.0);
        ASSERT_WITHIN(seed.volume[index], volumes[index], 0.0);
        ASSERT_WITHIN(seed.mass[index], 2000.0 * volumes[index], 0.0);
    }
    ASSERT_WITHIN(seed.volume_factor[0], 1.0, 0.0);
    ASSERT_WITHIN(seeding_body_volume(&fixture.scene, body), 0.7, 1e-15);
    seeding_count(&fixture.scene, &particles, &cells);
    assert_int_equal(particles, 3);
    assert_int_equal(cells, 3);
    seeding_release(&seed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_notched_block_is_filled_exactly),
        cmocka_unit_test(points_on_a_side_are_inside),
        cmocka_unit_test(orientation_does_not_matter),
        cmocka_unit_test(a_round_polygon_is_a_disc),
        cmocka_unit_test(crossing_sides_are_found),
        cmocka_unit_test(depth_runs_from_the_surface_above),
        cmocka_unit_test(turned_bodies_keep_their_lattice),
        cmocka_unit_test(rotation_is_counterclockwise),
        cmocka_unit_test(points_are_taken_as_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
