/* SPDX-License-Identifier: Apache-2.0 */
/* Forecast and advice. */
#include "scene_fixture.h"

#include "talus/simulation.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

static struct fixture_result read_valid(json_t *scene)
{
    struct fixture_result result;
    fixture_read(scene, &result);
    for (size_t index = 0; index < result.issues.count; index++)
        (void)fprintf(stderr, "%s: %s\n", result.issues.items[index].pointer,
                      result.issues.items[index].detail);
    assert_int_equal(result.status, TALUS_OK);
    json_decref(scene);
    return result;
}

static json_t *forecast(const struct talus_scene *scene, int threads)
{
    struct talus_error error = {.status = TALUS_OK};
    json_t *answer = scene_forecast(scene, threads, &error);
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
    struct fixture_result result = read_valid(fixture_scene(BASE_PLANE));
    json_t *one = forecast(&result.scene, 1);
    const json_t *wall = json_object_get(one, "wall_seconds");
    assert_true(number(one, "particles") == 16.0 * 8.0);
    assert_true(number(one, "active_cells") == 8.0 * 4.0);
    double step = number(one, "time_step");
    assert_true(fabs(step - 0.4 * number(one, "critical_time_step")) < 1e-12);
    assert_true(fabs(number(one, "steps") * step - 2.0) <= step);
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
    struct fixture_result result = read_valid(fixture_scene(BASE_SOLID));
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
    struct fixture_result small = read_valid(fixture_scene(BASE_PLANE));
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/bodies/0/particles_per_cell", "[40, 40]");
    fixture_change(scene, "/output", "{\"frames\": {\"every\": 0.01, \"precision\": \"double\"}}");
    struct fixture_result large = read_valid(scene);
    json_t *low = forecast(&small.scene, 1), *high = forecast(&large.scene, 1);
    json_t *parallel = forecast(&large.scene, 2);
    assert_true(number(high, "particles") == 400.0 * number(low, "particles"));
    assert_true(number(high, "disk_bytes") > 1000.0 * number(low, "disk_bytes") / 10.0);
    assert_true(number(json_object_get(high, "wall_seconds"), "expected") >
                10.0 * number(json_object_get(low, "wall_seconds"), "expected"));
    assert_true(number(json_object_get(parallel, "wall_seconds"), "expected") <
                number(json_object_get(high, "wall_seconds"), "expected"));
    json_decref(low);
    json_decref(high);
    json_decref(parallel);
    fixture_result_release(&small);
    fixture_result_release(&large);
}

static bool advises(json_t *scene, const char *pointer, const char *code)
{
    struct fixture_result result = read_valid(scene);
    json_t *list = scene_advice(&result.scene), *item;
    size_t index;
    bool found = false;
    json_array_foreach(list, index, item)
    {
        bool here = strcmp(json_string_value(json_object_get(item, "code")), code) == 0 &&
                    strcmp(json_string_value(json_object_get(item, "pointer")), pointer) == 0;
        assert_true(json_string_length(json_object_get(item, "detail")) > 0);
        assert_true(json_string_length(json_object_get(item, "change")) > 0);
        assert_true(json_string_length(json_object_get(item, "saves")) > 0);
        found |= here;
    }
    json_decref(list);
    fixture_result_release(&result);
    return found;
}

struct advice_case {
    enum fixture_base base;
    const char *change, *value; /* that brings the advice about; NULL: the base itself has it */
    const char *pointer, *code;
};

static void advice_comes_and_goes(void **state)
{
    (void)state;
    static const struct advice_case cases[] = {
        {BASE_PLANE, "/solver/time_step", "1e-6", "/solver/time_step", "small_time_step"},
        {BASE_PLANE, "/output", "{\"frames\": {\"every\": 0.001}}", "/output/frames/every",
         "many_frames"},
        {BASE_PLANE, "/output", "{\"history\": {\"every\": 1e-6}}", "/output/history/every",
         "fine_history"},
        {BASE_PLANE, "/solver", "{}", "/solver/anti_locking/control", "locking"},
        {BASE_SOLID, "/materials/rubber/poisson_ratio", "0.49", "/solver/anti_locking/control",
         "locking"},
        {BASE_SOLID, "/solver", "{\"anti_locking\": {\"control\": \"cell\"}}",
         "/solver/anti_locking/control", "superfluous_anti_locking"},
        {BASE_PLANE, "/bodies/0/particles_per_cell", "[1, 2]", "/bodies/0/particles_per_cell",
         "few_particles"},
        {BASE_PLANE, "/grid/cell", "[0.5, 2]", "/grid/cell", "coarse_grid"},
        {BASE_PLANE, "/grid/cell", "0.01", "/grid/cell", "fine_grid"},
    };
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        const struct advice_case *entry = &cases[index];
        json_t *scene = fixture_scene(entry->base);
        assert_false(advises(json_deep_copy(scene), entry->pointer, entry->code));
        fixture_change(scene, entry->change, entry->value);
        if (!advises(scene, entry->pointer, entry->code)) {
            (void)fprintf(stderr, "%s is not advised\n", entry->code);
            fail();
        }
    }
}

/* A channel along z between slip walls. */
static json_t *uniform_scene(void)
{
    json_t *scene = fixture_scene(BASE_SOLID);
    fixture_change(scene, "/bodies/0/sphere", NULL);
    fixture_change(scene, "/bodies/0/box", "{\"min\": [1, 0, 0], \"max\": [3, 2, 10]}");
    fixture_change(scene, "/gravity", "[0, -10, 0]");
    fixture_change(scene, "/boundaries",
                   "[{\"plane\": {\"point\": [0, 0, 0], \"normal\": [0, 1, 0]},"
                   "  \"condition\": \"stick\"},"
                   " {\"plane\": {\"point\": [0, 0, 0], \"normal\": [0, 0, 1]},"
                   "  \"condition\": \"slip\"},"
                   " {\"plane\": {\"point\": [0, 0, 10], \"normal\": [0, 0, -1]},"
                   "  \"condition\": \"slip\"}]");
    return scene;
}

static void uniform_scenes_are_seen(void **state)
{
    (void)state;
    assert_true(advises(uniform_scene(), "/dimension", "uniform_axis"));
    json_t *scene = uniform_scene();
    fixture_change(scene, "/boundaries/2/condition", "\"stick\""); /* an end that holds */
    assert_false(advises(scene, "/dimension", "uniform_axis"));
    scene = uniform_scene();
    fixture_change(scene, "/boundaries/-",
                   "{\"box\": {\"min\": [5, 0, 4], \"max\": [6, 5, 6]}, \"condition\": \"slip\"}");
    assert_false(advises(scene, "/dimension", "uniform_axis"));
    scene = uniform_scene();
    fixture_change(scene, "/bodies/0/velocity", "[0, 0, 1]");
    assert_false(advises(scene, "/dimension", "uniform_axis"));
    static const char *const keys[] = {"velocity", "traction", "rotate"};
    static const char *const values[] = {
        "{\"rotation\": {\"about\": [5, 0, 5], \"rate\": [0, 1, 0]}}",
        "[{\"face\": \"z_max\", \"pressure\": 1}]",
        "{\"angle\": 180, \"about\": [5, 2, 5], \"axis\": [0, 1, 0]}"};
    for (size_t index = 0; index < sizeof keys / sizeof keys[0]; index++) {
        char pointer[32];
        (void)snprintf(pointer, sizeof pointer, "/bodies/0/%s", keys[index]);
        for (int symmetry = 0; symmetry < 2; symmetry++) {
            scene = uniform_scene();
            fixture_change(scene, pointer, values[index]);
            assert_false(advises(scene, symmetry == 0 ? "/dimension" : "/grid",
                                 symmetry == 0 ? "uniform_axis" : "mirror_symmetry"));
        }
    }
    scene = uniform_scene();
    fixture_change(scene, "/gravity", "[0, -10, [[0, 0], [1, 2]]]");
    assert_false(advises(scene, "/dimension", "uniform_axis"));
    scene = uniform_scene();
    fixture_change(scene, "/gravity",
                   "{\"magnitude\": 10, \"up\": [0, 1, 0], \"slopes\": ["
                   "{\"along\": [0, 0, 1], \"below\": 3, \"angle\": 10}]}");
    assert_false(advises(scene, "/dimension", "uniform_axis"));
}

static json_t *revolution_scene(void)
{
    json_t *scene = fixture_scene(BASE_SOLID);
    fixture_change(scene, "/gravity", "[0, -10, 0]");
    fixture_change(scene, "/bodies/-",
                   "{\"material\": \"rubber\", \"spacing\": [0.25, 0.25, 0.25],"
                   " \"cylinder\": {\"from\": [5, 1, 5], \"to\": [5, 3, 5], \"radius\": 2}}");
    fixture_change(scene, "/boundaries",
                   "[{\"plane\": {\"point\": [0, 0, 0], \"normal\": [0, 1, 0]},"
                   "  \"condition\": \"stick\"}]");
    return scene;
}

static void bodies_of_revolution_are_seen(void **state)
{
    (void)state;
    assert_true(advises(revolution_scene(), "/dimension", "body_of_revolution"));
    json_t *scene = revolution_scene();
    fixture_change(scene, "/bodies/1/cylinder/to", "[5.5, 3, 5]");
    assert_false(advises(scene, "/dimension", "body_of_revolution"));
    scene = revolution_scene();
    fixture_change(scene, "/bodies/0/sphere/centre", "[5, 5, 5.5]");
    assert_false(advises(scene, "/dimension", "body_of_revolution"));
    scene = revolution_scene();
    fixture_change(scene, "/gravity", "[1, -10, 0]");
    assert_false(advises(scene, "/dimension", "body_of_revolution"));
    scene = revolution_scene();
    fixture_change(scene, "/boundaries/-",
                   "{\"plane\": {\"point\": [5, 0, 0], \"normal\": [1, 0, 0]},"
                   " \"condition\": \"slip\"}");
    assert_false(advises(scene, "/dimension", "body_of_revolution"));
    /* Across its radius a body of revolution has no mirror. */
    scene = fixture_scene(BASE_AXIAL);
    fixture_change(scene, "/bodies/0/sphere", NULL);
    fixture_change(scene, "/bodies/0/box", "{\"min\": [0, 0.5], \"max\": [1, 1.5]}");
    assert_false(advises(scene, "/grid", "mirror_symmetry"));
}

/* What is nearly incompressible gives way across the plane. */
static void plane_stress_does_not_lock(void **state)
{
    (void)state;
    json_t *scene = fixture_scene(BASE_AXIAL);
    fixture_change(scene, "/materials/rubber/poisson_ratio", "0.49");
    assert_true(advises(json_deep_copy(scene), "/solver/anti_locking/control", "locking"));
    fixture_change(scene, "/dimension", "\"plane_stress\"");
    fixture_change(scene, "/bodies/0/sphere/centre", "[1, 1]");
    assert_false(advises(json_deep_copy(scene), "/solver/anti_locking/control", "locking"));
    fixture_change(scene, "/solver", "{\"anti_locking\": {\"control\": \"cell\"}}");
    assert_true(advises(scene, "/solver/anti_locking/control", "superfluous_anti_locking"));
}

static void mirror_images_are_seen(void **state)
{
    (void)state;
    json_t *scene = uniform_scene(); /* also its own mirror image about z = 5 */
    fixture_change(scene, "/boundaries/-",
                   "{\"box\": {\"min\": [5, 0, 4], \"max\": [6, 5, 6]}, \"condition\": \"slip\"}");
    assert_true(advises(json_deep_copy(scene), "/grid", "mirror_symmetry"));
    fixture_change(scene, "/boundaries/3/box/max", "[6, 5, 6.5]");
    assert_false(advises(scene, "/grid", "mirror_symmetry"));
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
        assert_non_null(fixture_find(&result.issues, "/bodies/0", "range"));
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
        cmocka_unit_test(advice_comes_and_goes),
        cmocka_unit_test(uniform_scenes_are_seen),
        cmocka_unit_test(bodies_of_revolution_are_seen),
        cmocka_unit_test(plane_stress_does_not_lock),
        cmocka_unit_test(mirror_images_are_seen),
        cmocka_unit_test(monstrous_scenes_are_refused_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
