/* SPDX-License-Identifier: Apache-2.0 */
/* The table of rates, the names under which costs are learned, and what learning does to the
 * interval. */
#include "scene_fixture.h"

#include "materials/material.h"
#include "scene/scene_calibration.h"
#include "shapes/shape.h"
#include "transfers/velocity_transfer.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

/* The forecast of a base scene with one change (NULL: none); consumes `calibration`. */
static json_t *forecast(enum fixture_base base, const char *pointer, const char *value,
                        json_t *calibration)
{
    struct talus_error error = {.status = TALUS_OK};
    struct fixture_result result;
    json_t *scene = fixture_scene(base);
    if (pointer != NULL)
        fixture_change(scene, pointer, value);
    fixture_read(scene, &result);
    assert_int_equal(result.status, TALUS_OK);
    json_t *answer = scene_forecast(&result.scene, 1, calibration, &error);
    assert_non_null(answer);
    fixture_result_release(&result);
    json_decref(scene);
    json_decref(calibration);
    return answer;
}

static void every_part_has_a_rate(void **state)
{
    (void)state;
    for (size_t index = 0; index < shape_count; index++)
        assert_true(scene_cost_rate_known("SHAPE", shape_table[index]->name));
    for (size_t index = 0; index < material_count; index++)
        assert_true(scene_cost_rate_known("MATERIAL", material_table[index]->name));
    for (size_t index = 0; index < transfer_count; index++)
        assert_true(scene_cost_rate_known("TRANSFER", transfer_table[index]->name));
    assert_false(scene_cost_rate_known("SHAPE", "round"));
}

static const char *name_of(const json_t *answer, size_t level)
{
    return json_string_value(
        json_array_get(json_object_get(json_object_get(answer, "learn"), "names"), level));
}

static void names_are_of_methods(void **state)
{
    (void)state;
    json_t *plain = forecast(BASE_PLANE, NULL, NULL, NULL);
    json_t *longer = forecast(BASE_PLANE, "/duration", "3.0", NULL);
    json_t *smooth = forecast(BASE_PLANE, "/solver/shape", "\"bspline2\"", NULL);
    json_t *fluid = forecast(BASE_FLUID, NULL, NULL, NULL);
    for (size_t level = 0; level < COST_LEVEL_COUNT; level++)
        assert_string_equal(name_of(plain, level), name_of(longer, level));
    assert_string_not_equal(name_of(plain, 0), name_of(smooth, 0));
    assert_string_not_equal(name_of(plain, 1), name_of(smooth, 1));
    assert_string_not_equal(name_of(plain, 1), name_of(fluid, 1));
    assert_string_equal(name_of(plain, 2), name_of(fluid, 2));
    json_decref(plain);
    json_decref(longer);
    json_decref(smooth);
    json_decref(fluid);
}

/* What is to be learned adds up to what is forecast. */
static void the_sum_is_the_forecast(void **state)
{
    (void)state;
    json_t *answer = forecast(BASE_PLANE, NULL, NULL, NULL);
    const json_t *parts = json_object_get(json_object_get(answer, "learn"), "cpu_seconds");
    double steps = number(answer, "steps");
    double sum = number(parts, "fixed") + steps * number(parts, "steps") +
                 steps * number(answer, "particles") * number(parts, "particle_steps");
    assert_true(fabs(sum / number(answer, "cpu_seconds") - 1.0) < 1e-12);
    json_decref(answer);
}

/* `weight` runs of the method at `level` that took `ratio` times the table, with that spread. */
static json_t *calibration(enum fixture_base base, size_t level, double weight, double ratio,
                           double spread)
{
    json_t *plain = forecast(base, NULL, NULL, NULL);
    json_t *made = json_pack("{s:{s:[f, f, f], s:[f, f, f]}}", "ratios", name_of(plain, level),
                             weight, log(ratio), spread * spread,
                             scene_calibration_wait_name(false), weight, 0.0, spread * spread);
    json_decref(plain);
    assert_non_null(made);
    return made;
}

struct wall {
    double low, expected, high;
};

/* Long enough that the hundredths of a second that starting takes do not count. */
static struct wall wall_of(json_t *calibration_given)
{
    json_t *answer = forecast(BASE_PLANE, "/duration", "20000", calibration_given);
    const json_t *wall = json_object_get(answer, "wall_seconds");
    struct wall found = {number(wall, "low"), number(wall, "expected"), number(wall, "high")};
    assert_true(0.0 < found.low && found.low < found.expected && found.expected < found.high);
    json_decref(answer);
    return found;
}

static void learning_narrows(void **state)
{
    (void)state;
    struct wall unknown = wall_of(NULL);
    assert_true(unknown.high / unknown.low > 16.0); /* a factor of four each way */
    double before = unknown.high / unknown.low;
    static const double weights[] = {1.0, 3.0, 8.0, 20.0};
    for (size_t index = 0; index < 4; index++) {
        struct wall now = wall_of(calibration(BASE_PLANE, 0, weights[index], 2.0, 0.05));
        assert_true(now.high / now.low < before);
        before = now.high / now.low;
    }
    assert_true(before < 2.0);
    struct wall known = wall_of(calibration(BASE_PLANE, 0, 20.0, 2.0, 0.05));
    assert_true(fabs(known.expected / unknown.expected / 2.0 - 1.0) < 0.05);
    struct wall noisy = wall_of(calibration(BASE_PLANE, 0, 20.0, 2.0, 0.4));
    assert_true(noisy.high / noisy.low > 1.5 * before);
}

/* A machine that is twice as slow is so for methods that it has not run: less surely. */
static void relatives_count(void **state)
{
    (void)state;
    struct wall unknown = wall_of(NULL);
    struct wall of_class = wall_of(calibration(BASE_PLANE, 1, 10.0, 2.0, 0.1));
    struct wall of_machine = wall_of(calibration(BASE_PLANE, 2, 10.0, 2.0, 0.1));
    struct wall other = wall_of(calibration(BASE_FLUID, 0, 10.0, 2.0, 0.1));
    assert_true(of_class.high / of_class.low < of_machine.high / of_machine.low);
    assert_true(of_machine.high / of_machine.low < unknown.high / unknown.low);
    assert_true(of_class.expected > 1.6 * unknown.expected);
    assert_true(of_machine.expected > 1.6 * unknown.expected);
    assert_true(other.expected < 1.01 * unknown.expected);
}

static void others_slow_down(void **state)
{
    (void)state;
    json_t *free_cores = json_pack("{s:{s:i, s:i}}", "load", "cores", 4, "busy", 3);
    json_t *crowded = json_pack("{s:{s:i, s:i}}", "load", "cores", 4, "busy", 7);
    struct wall alone = wall_of(NULL), beside = wall_of(free_cores), queue = wall_of(crowded);
    assert_true(fabs(beside.expected / alone.expected - 1.0) < 1e-9);
    assert_true(beside.high > alone.high);
    assert_true(fabs(queue.expected / alone.expected - 2.0) < 1e-6);
}

static void nonsense_does_no_harm(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "{}", "[1]", "{\"ratios\": 3}", "{\"ratios\": {\"wall\": [-5, 1e300, -1]}}",
        "{\"ratios\": {\"wall\": [\"a\"]}, \"load\": {\"cores\": -1, \"busy\": 1e300}}"};
    for (size_t index = 0; index < sizeof texts / sizeof texts[0]; index++) {
        struct wall found = wall_of(json_loads(texts[index], 0, NULL));
        assert_true(isfinite(found.high));
    }
}

/* Two-sided 5 % points of Student's t: 2.776 (4 degrees), 2.228 (10), 1.960. */
static void intervals_are_of_95_percent(void **state)
{
    (void)state;
    static const double freedoms[] = {4.0, 10.0, 1e9}, points[] = {2.776, 2.228, 1.960};
    for (size_t index = 0; index < 3; index++) {
        struct calibration_belief belief = {.variance = 0.04, .freedom = freedoms[index]};
        struct calibration_interval interval = scene_calibration_interval(1e6, belief);
        assert_true(fabs(log(interval.high / 1e6) / 0.2 / points[index] - 1.0) < 0.01);
        assert_true(fabs(log(interval.low / 1e6) / 0.2 / points[index] + 1.0) < 0.01);
    }
}

static void what_is_written_has_bounds(void **state)
{
    (void)state;
    json_t *answer = forecast(BASE_PLANE, NULL, NULL, NULL);
    const json_t *disk = json_object_get(json_object_get(answer, "intervals"), "disk_bytes");
    assert_true(number(disk, "low") < number(disk, "expected"));
    assert_true(number(disk, "expected") < number(disk, "high"));
    /* The restart point lies beside while the run lasts. */
    double checkpoint = number(answer, "particles") * number(answer, "bytes_per_particle");
    assert_true(fabs(number(answer, "disk_bytes") - number(disk, "high") - checkpoint) <= 2.0);
    json_decref(answer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_has_a_rate),
        cmocka_unit_test(names_are_of_methods),
        cmocka_unit_test(the_sum_is_the_forecast),
        cmocka_unit_test(learning_narrows),
        cmocka_unit_test(relatives_count),
        cmocka_unit_test(others_slow_down),
        cmocka_unit_test(nonsense_does_no_harm),
        cmocka_unit_test(intervals_are_of_95_percent),
        cmocka_unit_test(what_is_written_has_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
