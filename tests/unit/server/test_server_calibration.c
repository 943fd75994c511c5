/* SPDX-License-Identifier: Apache-2.0 */
/* What is learned from finished jobs, that it survives a restart, and that it is this machine's. */
#include "calibration.h"
#include "calibration_ratio.h"
#include "folder.h"
#include "server_fixture.h"
#include "store_calibration.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct fixture {
    char *folder, *path;
    struct store *store;
    struct calibration *calibration;
};

static void fixture_open(struct fixture *fixture)
{
    struct talus_error error = {0};
    assert_int_equal(store_open(fixture->path, &fixture->store, &error), TALUS_OK);
    assert_int_equal(calibration_create(&fixture->calibration, fixture->store, &error), TALUS_OK);
}

static void fixture_close(struct fixture *fixture)
{
    calibration_destroy(fixture->calibration);
    store_close(fixture->store);
}

static int setup(void **state)
{
    struct fixture *fixture = calloc(1, sizeof *fixture);
    assert_non_null(fixture);
    fixture->folder = fixture_folder();
    fixture->path = folder_join(fixture->folder, "db.sqlite");
    fixture_open(fixture);
    *state = fixture;
    return 0;
}

static int teardown(void **state)
{
    struct fixture *fixture = *state;
    fixture_close(fixture);
    fixture_folder_remove(fixture->folder);
    free(fixture->path);
    free(fixture);
    return 0;
}

/* In turn above and below: mean log(2), standard deviation 0.1. */
static void ratios_converge(void **state)
{
    (void)state;
    struct calibration_ratio ratio = {0};
    for (int run = 0; run < 100; run++)
        calibration_ratio_learn(&ratio, log(2.0) + (run % 2 == 0 ? 0.1 : -0.1), 20.0);
    assert_true(fabs(ratio.mean - log(2.0)) < 0.02);
    assert_true(fabs(sqrt(ratio.variance) - 0.1) < 0.02);
    assert_int_equal(ratio.count, 100);
    assert_true(fabs(ratio.weight - 20.0) < 1e-12);
}

/* A job during which the machine slept takes a thousand times as long. */
static void outliers_do_little(void **state)
{
    (void)state;
    struct calibration_ratio ratio = {0};
    for (int run = 0; run < 10; run++)
        calibration_ratio_learn(&ratio, 0.0, 20.0);
    calibration_ratio_learn(&ratio, log(1000.0), 20.0);
    /* Three deviations of 0.15, of eleven runs. */
    assert_true(fabs(ratio.mean - 0.45 / 11.0) < 1e-12);
    assert_true(sqrt(ratio.variance) < 0.15);
    calibration_ratio_learn(&ratio, (double)NAN, 20.0);
    calibration_ratio_learn(&ratio, (double)INFINITY, 20.0);
    assert_int_equal(ratio.count, 11);
}

static void changes_are_followed(void **state)
{
    (void)state;
    struct calibration_ratio ratio = {0};
    for (int run = 0; run < 1000; run++)
        calibration_ratio_learn(&ratio, 0.0, 20.0);
    for (int run = 0; run < 60; run++)
        calibration_ratio_learn(&ratio, log(1.5), 20.0);
    assert_true(fabs(ratio.mean - log(1.5)) < 0.05);
}

/* A job that was expected to take 1 s + 10 us a step of processor time and as much wall time, at
 * most 20 s and at least 5. */
static void learn(struct calibration *calibration, const char *name, double processor, double wall,
                  double busy)
{
    json_t *forecast = json_pack("{s:{s:f, s:f, s:f}, s:{s:[s, s], s:{s:f, s:f}, s:s, s:f}}",
                                 "wall_seconds", "low", 5.0, "expected", 10.0, "high", 20.0,
                                 "learn", "names", name, "all", "cpu_seconds", "fixed", 1.0,
                                 "steps", 1e-5, "wall_name", "wall", "wall_over_cpu", 1.0);
    json_t *metrics = json_pack("{s:f, s:f, s:f}", "cpu_seconds", processor, "wall_seconds", wall,
                                "steps", 900000.0);
    const struct calibration_run run = {.threads = 1.0, .busy = busy};
    assert_true(forecast != NULL && metrics != NULL);
    calibration_learn(calibration, forecast, metrics, &run);
    json_decref(forecast);
    json_decref(metrics);
}

/* One of the three figures that a helper gets under a name; NAN without any. */
static double told(struct calibration *calibration, const char *name, size_t figure)
{
    json_t *question = calibration_question(calibration, 0.0);
    const json_t *list = json_object_get(json_object_get(question, "ratios"), name);
    double value = list == NULL ? (double)NAN : json_number_value(json_array_get(list, figure));
    json_decref(question);
    return value;
}

static void jobs_teach(void **state)
{
    struct fixture *fixture = *state;
    assert_true(isnan(told(fixture->calibration, "method", 0)));
    learn(fixture->calibration, "method", 20.0, 30.0, 0.0);
    learn(fixture->calibration, "other", 10.0, 10.0, 0.0);
    assert_true(fabs(told(fixture->calibration, "method", 1) - log(2.0)) < 1e-12);
    assert_true(fabs(told(fixture->calibration, "other", 1)) < 1e-12);
    assert_true(fabs(told(fixture->calibration, "all", 1) - 0.5 * log(2.0)) < 1e-12);
    assert_true(fabs(told(fixture->calibration, "all", 0) - 2.0) < 1e-12);
    assert_true(fabs(told(fixture->calibration, "wall", 1) - 0.5 * log(1.5)) < 1e-12);
    /* One that ended under another daemon teaches what processor time tells, not how it waited. */
    learn(fixture->calibration, "method", 20.0, 300.0, -1.0);
    assert_true(fabs(told(fixture->calibration, "wall", 0) - 2.0) < 1e-12);
    assert_true(fabs(told(fixture->calibration, "method", 0) - 2.0) < 1e-12);
}

static void forecasts_are_judged(void **state)
{
    struct fixture *fixture = *state;
    struct calibration_summary summary;
    calibration_summarise(fixture->calibration, &summary);
    assert_true(isnan(summary.recent) && summary.judged == 0);
    learn(fixture->calibration, "method", 10.0, 10.0, 0.0);
    learn(fixture->calibration, "method", 4.0, 4.0, 0.0);
    learn(fixture->calibration, "method", 10.0, 21.0, 0.0);
    learn(fixture->calibration, "method", 10.0, 20.0, 0.0);
    calibration_summarise(fixture->calibration, &summary);
    assert_int_equal(summary.judged, 4);
    assert_int_equal(summary.inside, 2);
    assert_true(fabs(summary.recent - 0.5) < 1e-12);
    assert_int_equal(summary.names, 3);
}

static void it_survives(void **state)
{
    struct fixture *fixture = *state;
    struct calibration_summary summary;
    learn(fixture->calibration, "method", 20.0, 30.0, 0.0);
    learn(fixture->calibration, "method", 21.0, 15.0, 0.0);
    double mean = told(fixture->calibration, "method", 1);
    double variance = told(fixture->calibration, "method", 2);
    fixture_close(fixture);
    fixture_open(fixture);
    assert_true(fabs(told(fixture->calibration, "method", 0) - 2.0) < 1e-12);
    assert_true(fabs(told(fixture->calibration, "method", 1) - mean) < 1e-12);
    assert_true(fabs(told(fixture->calibration, "method", 2) - variance) < 1e-12);
    calibration_summarise(fixture->calibration, &summary);
    assert_int_equal(summary.judged, 2);
    assert_int_equal(summary.inside, 1);
}

static void nothing_to_learn(void **state)
{
    struct fixture *fixture = *state;
    static const char *const texts[] = {
        "{}", "{\"learn\": 3}", "{\"learn\": {\"names\": [\"a\"]}}",
        "{\"learn\": {\"names\": [3, null], \"cpu_seconds\": {\"fixed\": 1}}}",
        "{\"learn\": {\"names\": [\"a\"], \"cpu_seconds\": {\"fixed\": -1}}}"};
    const struct calibration_run run = {.threads = 1.0};
    json_t *metrics = json_pack("{s:f, s:f}", "cpu_seconds", 1.0, "wall_seconds", 1.0);
    struct calibration_summary summary;
    for (size_t index = 0; index < sizeof texts / sizeof texts[0]; index++) {
        json_t *forecast = json_loads(texts[index], 0, NULL);
        calibration_learn(fixture->calibration, forecast, metrics, &run);
        calibration_learn(fixture->calibration, forecast, NULL, &run);
        json_decref(forecast);
    }
    json_decref(metrics);
    calibration_summarise(fixture->calibration, &summary);
    assert_int_equal(summary.judged, 0);
    assert_int_equal(summary.names, 0);
}

/* Figures of another machine are not used, those of another build are doubted. */
static void machines_differ(void **state)
{
    struct fixture *fixture = *state;
    struct talus_error error = {0};
    struct store_ratio ratio = {.ratio = {.count = 9, .weight = 9.0, .mean = 1.0}, .used = 1};
    const struct store_ratio *list[] = {&ratio};
    const struct store_quality quality = {0};
    const struct store_machine here = {"this", "old"}, there = {"that", "old"};
    const struct store_machine now = {"this", "new"};
    struct store_ratio found[4];
    struct store_quality read;
    size_t count;
    (void)snprintf(ratio.name, sizeof ratio.name, "ours");
    assert_int_equal(
        store_calibration_write(fixture->store, &here, list, 1, NULL, 0, &quality, &error),
        TALUS_OK);
    (void)snprintf(ratio.name, sizeof ratio.name, "theirs");
    assert_int_equal(
        store_calibration_write(fixture->store, &there, list, 1, NULL, 0, &quality, &error),
        TALUS_OK);
    assert_int_equal(
        store_calibration_read(fixture->store, &here, 3.0, found, 4, &count, &read, &error),
        TALUS_OK);
    assert_int_equal(count, 1);
    assert_string_equal(found[0].name, "ours");
    assert_true(fabs(found[0].ratio.weight - 9.0) < 1e-12);
    assert_int_equal(
        store_calibration_read(fixture->store, &now, 3.0, found, 4, &count, &read, &error),
        TALUS_OK);
    assert_true(count == 1 && fabs(found[0].ratio.weight - 3.0) < 1e-12);
    fixture_close(fixture);
    fixture_open(fixture);
    assert_true(isnan(told(fixture->calibration, "ours", 0)));
}

/* Whoever sends ever new methods does not fill the store, nor push out what is in use. */
static void the_oldest_make_room(void **state)
{
    struct fixture *fixture = *state;
    struct calibration_summary summary;
    learn(fixture->calibration, "first", 10.0, 10.0, 0.0);
    for (int index = 0; index < 300; index++) {
        char name[32];
        (void)snprintf(name, sizeof name, "method %d", index);
        learn(fixture->calibration, name, 10.0, 10.0, 0.0);
        if (index % 100 == 0)
            learn(fixture->calibration, "in use", 10.0, 10.0, 0.0);
    }
    calibration_summarise(fixture->calibration, &summary);
    assert_int_equal(summary.names, 256);
    fixture_close(fixture);
    fixture_open(fixture);
    calibration_summarise(fixture->calibration, &summary);
    assert_int_equal(summary.names, 256);
    assert_true(isnan(told(fixture->calibration, "first", 0)));
    assert_true(isnan(told(fixture->calibration, "method 0", 0)));
    assert_true(!isnan(told(fixture->calibration, "method 299", 0)));
    assert_true(!isnan(told(fixture->calibration, "in use", 0)));
    assert_true(!isnan(told(fixture->calibration, "all", 0)));
    assert_true(!isnan(told(fixture->calibration, "wall", 0)));
}

#define WITH_STORE(test) cmocka_unit_test_setup_teardown(test, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ratios_converge),      cmocka_unit_test(outliers_do_little),
        cmocka_unit_test(changes_are_followed), WITH_STORE(jobs_teach),
        WITH_STORE(forecasts_are_judged),       WITH_STORE(it_survives),
        WITH_STORE(nothing_to_learn),           WITH_STORE(machines_differ),
        WITH_STORE(the_oldest_make_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
