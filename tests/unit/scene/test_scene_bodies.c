/* SPDX-License-Identifier: Apache-2.0 */
/* Bodies, their motion and loads, and gravity in all their forms: values arrive, and the effective
 * scene reads as itself. */
#include "scene_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define ASSERT_WITHIN(value, expected, tolerance)                                                  \
    assert_true(fabs((value) - (expected)) <= (tolerance))

/* Changes one value of a base and reads it, twice: the second time its own effective scene. */
static struct fixture_result read_changed(enum fixture_base base, const char *pointer,
                                          const char *value)
{
    struct fixture_result first, second;
    json_t *scene = fixture_scene(base);
    fixture_change(scene, pointer, value);
    fixture_read(scene, &first);
    json_decref(scene);
    for (size_t index = 0; index < first.issues.count; index++)
        (void)fprintf(stderr, "%s: %s\n", first.issues.items[index].pointer,
                      first.issues.items[index].detail);
    assert_int_equal(first.status, TALUS_OK);
    fixture_read(first.effective, &second);
    assert_int_equal(second.status, TALUS_OK);
    assert_true(json_equal(first.effective, second.effective));
    fixture_result_release(&second);
    return first;
}

static void polygons_arrive(void **state)
{
    (void)state;
    struct fixture_result result = read_changed(
        BASE_PLANE, "/bodies/0",
        "{\"material\": \"soil\", \"name\": \"heap\", \"spacing\": 0.1, \"polygon\": {\"vertices\":"
        " [[1, 1], [5, 1], [3, 2.5]]}, \"clip\": {\"max\": [4, null]},"
        " \"rotate\": {\"angle\": 30, \"about\": [1, 2]}}");
    const struct talus_body *body = &result.scene.bodies[0];
    assert_int_equal(body->shape, TALUS_BODY_POLYGON);
    assert_int_equal(body->vertex_count, 3);
    ASSERT_WITHIN(body->vertices[5], 2.5, 0.0);
    ASSERT_WITHIN(body->clip_max[0], 4.0, 0.0);
    ASSERT_WITHIN(body->rotate_angle_deg, 30.0, 0.0);
    ASSERT_WITHIN(body->rotate_about[1], 2.0, 0.0);
    ASSERT_WITHIN(body->rotate_axis[2], 1.0, 0.0);
    fixture_result_release(&result);
}

static void points_arrive(void **state)
{
    (void)state;
    struct fixture_result result = read_changed(
        BASE_SOLID, "/bodies/0",
        "{\"material\": \"rubber\", \"points\": {\"positions\": [[1, 2, 3], [4, 5, 6]],"
        " \"volumes\": [0.5, 0.25]}, \"rotate\": {\"angle\": -9, \"about\": [5, 5, 5],"
        " \"axis\": [0, 3, 4]}, \"velocity\": {\"rotation\": {\"about\": [1, 1, 1],"
        " \"rate\": [0, 0, -2]}}}");
    const struct talus_body *body = &result.scene.bodies[0];
    assert_int_equal(body->shape, TALUS_BODY_POINTS);
    assert_int_equal(body->point_count, 2);
    ASSERT_WITHIN(body->point_positions[4], 5.0, 0.0);
    ASSERT_WITHIN(body->point_volumes[1], 0.25, 0.0);
    ASSERT_WITHIN(body->rotate_axis[2], 0.8, 1e-15);
    assert_int_equal(body->velocity_field, TALUS_VELOCITY_ROTATION);
    ASSERT_WITHIN(body->rotation_rate[2], -2.0, 0.0);
    fixture_result_release(&result);
}

static void velocity_fields_arrive(void **state)
{
    (void)state;
    struct fixture_result result =
        read_changed(BASE_PLANE, "/bodies/0/velocity",
                     "{\"beam_mode\": {\"mode\": 2, \"from\": [0, 1], \"to\": [4, 1],"
                     " \"tip\": [0, 0.5]}}");
    const struct talus_body *body = &result.scene.bodies[0];
    assert_int_equal(body->velocity_field, TALUS_VELOCITY_BEAM_MODE);
    ASSERT_WITHIN(body->beam_mode, 2.0, 0.0);
    ASSERT_WITHIN(body->beam_to[0], 4.0, 0.0);
    ASSERT_WITHIN(body->beam_tip[1], 0.5, 0.0);
    fixture_result_release(&result);
    result = read_changed(BASE_PLANE, "/bodies/0/velocity",
                          "{\"rotation\": {\"about\": [2, 1], \"rate\": 3}}");
    ASSERT_WITHIN(result.scene.bodies[0].rotation_rate[2], 3.0, 0.0);
    fixture_result_release(&result);
}

static void tractions_arrive(void **state)
{
    (void)state;
    struct fixture_result result =
        read_changed(BASE_PLANE, "/bodies/0/traction",
                     "[{\"face\": \"y_max\", \"value\": [5, [[0, -1], [2, -3]]]},"
                     " {\"face\": \"x_min\", \"pressure\": 7, \"kind\": \"normal\"},"
                     " {\"face\": \"x_max\", \"pressure\": [[1, 4]], \"kind\": \"fibre\"}]");
    const struct talus_body *body = &result.scene.bodies[0];
    assert_int_equal(body->traction_count, 3);
    const struct talus_traction *traction = body->tractions;
    assert_int_equal(traction[0].face, 3);
    assert_int_equal(traction[0].kind, TALUS_TRACTION_DEAD);
    assert_false(traction[0].is_pressure);
    ASSERT_WITHIN(traction[0].value[0], 5.0, 0.0);
    ASSERT_WITHIN(traction[0].value[1], -1.0, 0.0); /* at t = 0 */
    assert_int_equal(traction[0].table[0].count, 0);
    assert_int_equal(traction[0].table[1].count, 2);
    ASSERT_WITHIN(traction[0].table[1].value[1], -3.0, 0.0);
    assert_int_equal(traction[1].face, 0);
    assert_int_equal(traction[1].kind, TALUS_TRACTION_NORMAL);
    assert_true(traction[1].is_pressure);
    ASSERT_WITHIN(traction[1].value[0], 7.0, 0.0);
    assert_int_equal(traction[2].kind, TALUS_TRACTION_FIBRE);
    assert_int_equal(traction[2].table[0].count, 1);
    fixture_result_release(&result);
}

static void sides_of_polygons_have_numbers(void **state)
{
    (void)state;
    struct fixture_result result = read_changed(
        BASE_PLANE, "/bodies/0",
        "{\"material\": \"soil\", \"name\": \"heap\", \"spacing\": 0.1, \"polygon\": {\"vertices\":"
        " [[1, 1], [5, 1], [5, 2], [3, 2.5]]}, \"traction\": ["
        " {\"face\": \"side_2\", \"pressure\": 1}, {\"face\": \"side_3_to_0\", \"pressure\": 1}]}");
    const struct talus_traction *traction = result.scene.bodies[0].tractions;
    assert_int_equal(traction[0].face, 2);
    assert_int_equal(traction[0].last_face, 2);
    assert_int_equal(traction[1].face, 3);
    assert_int_equal(traction[1].last_face, 0);
    fixture_result_release(&result);
}

static void gravity_varies(void **state)
{
    (void)state;
    struct fixture_result result =
        read_changed(BASE_PLANE, "/gravity", "[[[1, 2], [2, 4]], -9.81]");
    ASSERT_WITHIN(result.scene.gravity[0], 2.0, 0.0); /* constant before its first point */
    ASSERT_WITHIN(result.scene.gravity[1], -9.81, 0.0);
    assert_int_equal(result.scene.gravity_table[0].count, 2);
    assert_int_equal(result.scene.gravity_table[1].count, 0);
    fixture_result_release(&result);
    result =
        read_changed(BASE_PLANE, "/gravity",
                     "{\"magnitude\": 10, \"up\": [0, 2], \"slopes\": ["
                     "{\"along\": [3, 0], \"below\": 4, \"angle\": 20},"
                     "{\"along\": [-1, 0], \"about\": [5, 1], \"beyond\": 2, \"angle\": 10}]}");
    ASSERT_WITHIN(result.scene.gravity[0], 0.0, 0.0);
    ASSERT_WITHIN(result.scene.gravity[1], -10.0, 1e-15);
    assert_int_equal(result.scene.slope_count, 2);
    const struct talus_slope *slope = result.scene.slopes;
    ASSERT_WITHIN(slope[0].along[0], 1.0, 0.0);
    ASSERT_WITHIN(slope[0].below, 4.0, 0.0);
    ASSERT_WITHIN(slope[0].angle_deg, 20.0, 0.0);
    assert_true(isnan(slope[1].below));
    ASSERT_WITHIN(slope[1].about[0], 5.0, 0.0);
    ASSERT_WITHIN(slope[1].beyond, 2.0, 0.0);
    fixture_result_release(&result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polygons_arrive),
        cmocka_unit_test(points_arrive),
        cmocka_unit_test(velocity_fields_arrive),
        cmocka_unit_test(tractions_arrive),
        cmocka_unit_test(sides_of_polygons_have_numbers),
        cmocka_unit_test(gravity_varies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
