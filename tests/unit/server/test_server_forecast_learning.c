/* SPDX-License-Identifier: Apache-2.0 */
/* What the daemon learns and what the worker makes of it, together, on machines that are made up:
 * intervals hold, and are not wider than they must be. */
#include "calibration_ratio.h"
#include "scene/scene_calibration.h"
#include "server_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { METHOD_COUNT = 12, CLASS_COUNT = 3, RUN_COUNT = 600, NAME_COUNT = METHOD_COUNT + 5 };

/* A made-up machine: logarithms of how far the table of rates is off. */
struct machine {
    double offset, class_offset[CLASS_COUNT], method_offset[METHOD_COUNT];
    double run_spread, wait_mean, wait_spread, outlier_share;
    uint64_t random;
};

/* Uniform in 0 ... 1: splitmix64 (Steele, Lea, Flood 2014). */
static double uniform(uint64_t *state)
{
    uint64_t mixed = *state += UINT64_C(0x9e3779b97f4a7c15);
    mixed = (mixed ^ mixed >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    mixed = (mixed ^ mixed >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((mixed ^ mixed >> 31) >> 11) * 0x1p-53;
}

static double normal(uint64_t *state)
{
    double radius = sqrt(-2.0 * log(1.0 - uniform(state)));
    return radius * cos(2.0 * 3.14159265358979 * uniform(state));
}

static struct machine machine_make(uint64_t seed, double run_spread, double wait_spread)
{
    struct machine machine = {.run_spread = run_spread,
                              .wait_mean = 0.1,
                              .wait_spread = wait_spread,
                              .outlier_share = 0.02,
                              .random = seed};
    machine.offset = 0.5 * normal(&machine.random);
    for (size_t index = 0; index < CLASS_COUNT; index++)
        machine.class_offset[index] = 0.2 * normal(&machine.random);
    for (size_t index = 0; index < METHOD_COUNT; index++)
        machine.method_offset[index] = 0.2 * normal(&machine.random);
    return machine;
}

static struct scene_cost_keys keys_of(size_t method)
{
    struct scene_cost_keys keys;
    (void)snprintf(keys.level[0], COST_KEY_SIZE, "method %zu", method);
    (void)snprintf(keys.level[1], COST_KEY_SIZE, "class %zu", method % CLASS_COUNT);
    (void)snprintf(keys.level[2], COST_KEY_SIZE, "machine");
    return keys;
}

struct learned {
    char text[COST_KEY_SIZE];
    struct calibration_ratio ratio;
};

static void learn(struct learned *all, json_t *ratios, const char *name, double logarithm,
                  double most)
{
    size_t index = 0;
    while (index < NAME_COUNT && all[index].text[0] != '\0' && strcmp(all[index].text, name) != 0)
        index++;
    assert_true(index < NAME_COUNT);
    (void)snprintf(all[index].text, COST_KEY_SIZE, "%s", name);
    struct calibration_ratio *ratio = &all[index].ratio;
    calibration_ratio_learn(ratio, logarithm, most);
    (void)json_object_set_new(ratios, name,
                              json_pack("[f, f, f]", ratio->weight, ratio->mean, ratio->variance));
}

struct score {
    double inside, median_width; /* share; of the logarithm of high over low */
};

static int compare(const void *left, const void *right)
{
    const double one = *(const double *)left, other = *(const double *)right;
    return (one > other) - (one < other);
}

/* Runs of a hundred predicted seconds, methods at random; judged from the `from`th on. */
static struct score play(struct machine machine, size_t from)
{
    static struct learned all[NAME_COUNT];
    static double widths[RUN_COUNT];
    const double predicted = 100.0;
    memset(all, 0, sizeof all);
    json_t *ratios = json_object();
    json_t *calibration = json_pack("{s:O}", "ratios", ratios);
    size_t judged = 0, inside = 0;
    for (size_t run = 0; run < RUN_COUNT; run++) {
        size_t method = (size_t)(uniform(&machine.random) * METHOD_COUNT);
        const struct scene_cost_keys keys = keys_of(method);
        struct calibration_interval interval = scene_calibration_interval(
            predicted,
            scene_calibration_join(scene_calibration_cost(calibration, &keys),
                                   scene_calibration_wait(calibration, false, 1.0), 0.0));
        double cost = machine.offset + machine.class_offset[method % CLASS_COUNT] +
                      machine.method_offset[method] + machine.run_spread * normal(&machine.random);
        double wait = fmax(0.0, machine.wait_mean + machine.wait_spread * normal(&machine.random));
        if (uniform(&machine.random) < machine.outlier_share)
            wait += log(4.0);
        double wall = predicted * exp(cost + wait);
        if (run >= from) {
            inside += wall >= interval.low && wall <= interval.high ? 1 : 0;
            widths[judged++] = log(interval.high / interval.low);
        }
        for (size_t level = 0; level < COST_LEVEL_COUNT; level++)
            learn(all, ratios, keys.level[level], cost, 20.0);
        learn(all, ratios, scene_calibration_wait_name(false), wait, 10.0);
    }
    json_decref(calibration);
    json_decref(ratios);
    qsort(widths, judged, sizeof *widths, compare);
    return (struct score){(double)inside / (double)judged, widths[judged / 2]};
}

static void check(double run_spread, double wait_spread)
{
    /* Of the very first runs on, those of 2 in 100 that a machine sleeps through included. */
    double least = 1.0, sum = 0.0, width = 0.0;
    enum { MACHINES = 20 };
    for (uint64_t seed = 1; seed <= MACHINES; seed++) {
        struct score score = play(machine_make(seed, run_spread, wait_spread), 0);
        least = fmin(least, score.inside);
        sum += score.inside;
        width = fmax(width, score.median_width);
    }
    /* What no method could do without: two normal spreads together, 95 %. */
    double needed = 2.0 * 1.96 * hypot(run_spread, wait_spread);
    if (least < 0.9 || sum / MACHINES < 0.92 || width > 2.5 * needed + 0.8)
        fail_msg("spreads %g, %g: %.3f inside (least %.3f), width %.2f of %.2f", run_spread,
                 wait_spread, sum / MACHINES, least, width, needed);
}

static void calm_machines(void **state)
{
    (void)state;
    check(0.03, 0.02);
}

static void busy_machines(void **state)
{
    (void)state;
    check(0.1, 0.3);
}

static void odd_methods(void **state)
{
    (void)state;
    check(0.3, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calm_machines),
        cmocka_unit_test(busy_machines),
        cmocka_unit_test(odd_methods),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
