/* SPDX-License-Identifier: Apache-2.0 */
/* Loaded faces: their area is in the outermost particles, all of it. */
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

static void load(struct talus_body *body, struct talus_traction *traction, size_t face,
                 bool pressure)
{
    memset(traction, 0, sizeof *traction);
    traction->face = traction->last_face = face;
    traction->is_pressure = pressure;
    body->tractions = traction;
    body->traction_count = 1;
}

/* The outermost layer in equal shares, on every side in every dimension. */
static void a_box_is_loaded_evenly(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        for (size_t face = 0; face < 2 * axes; face++) {
            struct seeding_fixture fixture;
            struct talus_traction traction;
            fixture_init(&fixture, axes, "linear_elastic");
            fixture.bodies[0].box_max[0] = 0.75;
            load(&fixture.bodies[0], &traction, face, false);
            struct particle_seed seed = create(&fixture);
            const double edge[3] = {0.75, axes > 1 ? 1.0 : 0.0, axes > 2 ? 1.0 : 0.0};
            double area = 1.0;
            for (size_t k = 0; k < axes; k++)
                area *= k == face / 2 ? 1.0 : edge[k];
            assert_int_equal(seed.traction_components, 1);
            ASSERT_WITHIN(total(seed.traction[0], seed.count), area, 1e-14);
            size_t loaded = 0;
            for (size_t index = 0; index < seed.count; index++) {
                const double place = seed.position[face / 2][index];
                const double depth = face % 2 == 1 ? edge[face / 2] - place : place;
                assert_int_equal(seed.traction[0][index] > 0.0, depth < 0.0626);
                loaded += depth < 0.0626;
            }
            for (size_t index = 0; index < seed.count; index++) {
                if (seed.traction[0][index] > 0.0)
                    ASSERT_WITHIN(seed.traction[0][index], area / (double)loaded, 1e-15);
            }
            seeding_release(&seed);
        }
    }
}

/* Vector areas of a slanted side, at the particles along it. */
static void a_slanted_side_is_loaded_where_it_is(void **state)
{
    (void)state;
    double vertices[] = {0, 0, 3, 0, 3, 1, 0, 2.5};
    struct seeding_fixture fixture;
    struct talus_traction traction;
    fixture_init(&fixture, 2, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    body->shape = TALUS_BODY_POLYGON;
    body->vertices = vertices;
    body->vertex_count = 4;
    load(body, &traction, 2, true);
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.traction_components, 2);
    ASSERT_WITHIN(total(seed.traction[0], seed.count), 1.5, 1e-13);
    ASSERT_WITHIN(total(seed.traction[1], seed.count), 3.0, 1e-13);
    double first = 0.0, second = 0.0;
    for (size_t index = 0; index < seed.count; index++) {
        const double area = seed.traction[1][index], x = seed.position[0][index];
        const double depth = (2.5 - 0.5 * x - seed.position[1][index]) / sqrt(1.25);
        assert_true(area == 0.0 || depth < 0.13); /* spacing 0.125, about */
        first += area * x;
        second += area * x * x;
    }
    /* Evenly along the side: mean and variance of x; half a spacing further in than the side. */
    ASSERT_WITHIN(first / 3.0, 1.5 - 0.0625 * 0.447, 0.02);
    ASSERT_WITHIN(second / 3.0 - first * first / 9.0, 0.75, 0.03);
    seeding_release(&seed);
}

/* A pressure on a closed surface has no resultant and no moment, whatever the shape. */
static void closed_surfaces_are_in_balance(void **state)
{
    (void)state;
    double notched[] = {0, 0, 3, 0, 3, 2, 2, 2, 2, 1, 1, 1, 1, 2, 0, 2};
    const double pi = 3.14159265358979323846;
    const enum talus_body_shape shapes[] = {TALUS_BODY_POLYGON, TALUS_BODY_SPHERE,
                                            TALUS_BODY_SPHERE, TALUS_BODY_CYLINDER};
    const size_t dimensions[] = {2, 2, 3, 3};
    for (size_t kind = 0; kind < 4; kind++) {
        struct seeding_fixture fixture;
        struct talus_traction tractions[3];
        fixture_init(&fixture, dimensions[kind], "linear_elastic");
        struct talus_body *body = &fixture.bodies[0];
        for (size_t entry = 3; entry-- > 0;)
            load(body, &tractions[entry], entry, true);
        tractions[0].last_face = shapes[kind] == TALUS_BODY_POLYGON ? 7 : 0;
        body->traction_count = shapes[kind] == TALUS_BODY_CYLINDER ? 3 : 1;
        body->shape = shapes[kind];
        body->vertices = notched;
        body->vertex_count = 8;
        body->radius = 1.0;
        body->to[0] = 2.0;
        body->rotate_angle_deg = 33.0;
        body->rotate_axis[2] = 1.0;
        struct particle_seed seed = create(&fixture);
        const size_t axes = dimensions[kind];
        double moment = 0.0;
        for (size_t k = 0; k < axes; k++) {
            double force = 0.0;
            for (size_t c = k; c < seed.traction_components; c += axes)
                force += total(seed.traction[c], seed.count);
            ASSERT_WITHIN(force, 0.0, 1e-12);
        }
        for (size_t c = 0; c < seed.traction_components; c += axes)
            for (size_t index = 0; index < seed.count; index++)
                moment += seed.position[0][index] * seed.traction[c + 1][index] -
                          seed.position[1][index] * seed.traction[c][index];
        ASSERT_WITHIN(moment, 0.0, 0.05);
        seeding_release(&seed);
        for (size_t entry = 0; entry < 3; entry++)
            tractions[entry].is_pressure = false;
        seed = create(&fixture);
        const double areas[] = {12.0, 2.0 * pi, 4.0 * pi, 4.0 * pi};
        ASSERT_WITHIN(total(seed.traction[0], seed.count), areas[kind], 1e-11);
        if (shapes[kind] == TALUS_BODY_CYLINDER) {
            ASSERT_WITHIN(total(seed.traction[1], seed.count), pi, 1e-12);
            ASSERT_WITHIN(total(seed.traction[2], seed.count), pi, 1e-12);
        }
        seeding_release(&seed);
    }
}

/* The end `to` of a turned cylinder looks along its turned axis. */
static void normals_turn_with_the_body(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_traction traction;
    fixture_init(&fixture, 3, "linear_elastic");
    struct talus_body *body = &fixture.bodies[0];
    body->shape = TALUS_BODY_CYLINDER;
    body->radius = 1.0;
    body->to[0] = 2.0;
    body->rotate_angle_deg = 90.0;
    body->rotate_axis[2] = 1.0;
    load(body, &traction, 2, true);
    struct particle_seed seed = create(&fixture);
    ASSERT_WITHIN(total(seed.traction[0], seed.count), 0.0, 1e-13);
    ASSERT_WITHIN(total(seed.traction[1], seed.count), 3.14159265358979323846, 1e-12);
    for (size_t index = 0; index < seed.count; index++)
        assert_true(seed.traction[1][index] == 0.0 || seed.position[1][index] > 1.8);
    seeding_release(&seed);
}

/* Bodies share the components; each writes to its own particles only. */
static void bodies_do_not_mix(void **state)
{
    (void)state;
    struct seeding_fixture fixture;
    struct talus_traction first, second[2];
    fixture_init(&fixture, 2, "linear_elastic");
    fixture.scene.body_count = 2;
    fixture.bodies[1].box_min[0] = 1.0;
    fixture.bodies[1].box_max[0] = 3.0;
    load(&fixture.bodies[0], &first, 1, true);
    load(&fixture.bodies[1], &second[1], 2, true);
    load(&fixture.bodies[1], &second[0], 3, false);
    fixture.bodies[1].traction_count = 2;
    struct particle_seed seed = create(&fixture);
    assert_int_equal(seed.traction_components, 3);
    ASSERT_WITHIN(total(seed.traction[0], 64), 1.0, 1e-14);
    ASSERT_WITHIN(total(seed.traction[0] + 64, 128), 2.0, 1e-14);
    ASSERT_WITHIN(total(seed.traction[1], seed.count), 0.0, 0.0);
    ASSERT_WITHIN(total(seed.traction[2], seed.count), -2.0, 1e-14);
    seeding_release(&seed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_loaded_evenly),
        cmocka_unit_test(a_slanted_side_is_loaded_where_it_is),
        cmocka_unit_test(closed_surfaces_are_in_balance),
        cmocka_unit_test(normals_turn_with_the_body),
        cmocka_unit_test(bodies_do_not_mix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
