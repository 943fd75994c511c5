/* SPDX-License-Identifier: Apache-2.0 */
/* Forecasts. */
#include "scene_fixture.h"

#include "talus/simulation.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#include <cmocka.h>

static json_t *forecast(const struct talus_scene *scene, int threads)
{
    struct talus_error error = {.status = TALUS_OK};
    json_t *answer = scene_forecast(scene, threads, NULL, &error);
    assert_non_null(answer);
    return answer;
}

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void the_forecast_counts(void **state)
{
    (void)state;
    struct fixture_result result = fixture_read_valid(fixture_scene(BASE_PLANE));
    json_t *one = forecast(&result.scene, 1);
    const json_t *wall = json_object_get(one, "wall_seconds");
    assert_true(number(one, "particles") == 16.0 * 8.0);
    assert_true(number(one, "active_cells") == 8.0 * 4.0);
    double step = number(one, "time_step");
    assert_true(fabs(step - 0.4 * number(one, "critical_time_step")) < 1e-12);
    const json_t *steps = json_object_get(json_object_get(one, "intervals"), "steps");
    assert_true(number(steps, "low") * step <= 2.0 + step);
    assert_true(number(steps, "high") * step >= 2.0);
    assert_true(number(steps, "low") <= number(one, "steps"));
    assert_true(number(one, "steps") <= number(steps, "high"));
    assert_true(number(one, "memory_bytes") > 0.0 && number(one, "bytes_per_particle") > 50.0);
    assert_true(number(wall, "low") < number(wall, "expected"));
    assert_true(number(wall, "expected") < number(wall, "high"));
    /* 51 frames of 128 particles with 3 + 6 + 1 components */
    assert_true(number(one, "disk_bytes") > 51.0 * 128.0 * 4.0 * 13.0);
    json_decref(one);
    fixture_result_release(&result);
}

static void bodies_are_reported(void **state)
{
    (void)state;
    struct fixture_result result = fixture_read_valid(fixture_scene(BASE_SOLID));
    json_t *answer = forecast(&result.scene, 1);
    const json_t *body = json_array_get(json_object_get(answer, "bodies"), 0);
    const double exact = 4.0 / 3.0 * 3.14159265358979323846;
    assert_string_equal(json_string_value(json_object_get(body, "name")), "body_0");
    assert_true(fabs(number(body, "volume") - exact) < 1e-12);
    double represented = number(body, "particles") * 0.25 * 0.25 * 0.25;
    assert_true(fabs(number(body, "volume_factor") * represented - exact) < 1e-9);
    assert_true(number(body, "particles") == number(answer, "particles"));
    json_decref(answer);
    fixture_result_release(&result);
}

static void more_costs_more(void **state)
{
    (void)state;
    struct fixture_result small = fixture_read_valid(fixture_scene(BASE_PLANE));
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/bodies/0/particles_per_cell", "[40, 40]");
    fixture_change(scene, "/output", "{\"frames\": {\"every\": 0.01, \"precision\": \"double\"}}");
    struct fixture_result large = fixture_read_valid(scene);
    /* Nothing but steps: one thread alone compresses frames, beside those that step. */
    json_t *quiet = fixture_scene(BASE_PLANE);
    fixture_change(quiet, "/bodies/0/particles_per_cell", "[40, 40]");
    fixture_change(quiet, "/output", "{\"frames\": {\"every\": 2.0}}");
    struct fixture_result stepping = fixture_read_valid(quiet);
    json_t *low = forecast(&small.scene, 1), *high = forecast(&large.scene, 1);
    json_t *serial = forecast(&stepping.scene, 1), *parallel = forecast(&stepping.scene, 2);
    assert_true(number(high, "particles") == 400.0 * number(low, "particles"));
    assert_true(number(high, "disk_bytes") > 1000.0 * number(low, "disk_bytes") / 10.0);
    assert_true(number(json_object_get(high, "wall_seconds"), "expected") >
                10.0 * number(json_object_get(low, "wall_seconds"), "expected"));
    assert_true(number(json_object_get(parallel, "wall_seconds"), "expected") <
                number(json_object_get(serial, "wall_seconds"), "expected"));
    json_decref(low);
    json_decref(high);
    json_decref(serial);
    json_decref(parallel);
    fixture_result_release(&stepping);
    fixture_result_release(&small);
    fixture_result_release(&large);
}

static void monstrous_scenes_are_refused_at_once(void **state)
{
    (void)state;
    struct timespec begin, end;
    (void)clock_gettime(CLOCK_MONOTONIC, &begin);
    for (int index = 0; index < 2; index++) {
        struct fixture_result result;
        json_t *scene = fixture_scene(BASE_SOLID);
        fixture_change(scene, "/bodies/0/spacing",
                       index == 0 ? "[1e-4, 1e-4, 1e-4]" : "[1e-25, 1e-25, 1e-25]");
        fixture_read(scene, &result);
        assert_int_equal(result.status, TALUS_INVALID);
        assert_non_null(fixture_find(&result.issues, "/bodies/0", "limit"));
        fixture_result_release(&result);
        json_decref(scene);
    }
    (void)clock_gettime(CLOCK_MONOTONIC, &end);
    assert_true((double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec) <
                0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_forecast_counts),
        cmocka_unit_test(bodies_are_reported),
        cmocka_unit_test(more_costs_more),
        cmocka_unit_test(monstrous_scenes_are_refused_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
