/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_calibration.h"

#include <math.h>

/* Standard deviations of logarithms: of the table of rates on a machine never seen, ... */
static const double machine_spread = 0.6;
/* ... of a class within a machine, of a method within its class, of a run within its method: what
 * the rates do not know of scenes (how a flow fills its blocks, how many walls it touches). */
static const double class_spread = 0.25, method_spread = 0.2, run_spread = 0.15;
/* Of waiting: how far a machine is from idle, and how that changes from run to run. Each
 * file waits for a disk that others use, too: where files are most of a run, by the disk. */
static const struct wait {
    const char *name;
    double level_spread, run_spread;
} waits[] = {{"wall", 0.2, 0.15}, {"wall/files", 0.6, 0.4}};
/* Runs that the spreads above are worth, against what has been seen. */
static const double prior_freedom = 4.0;
/* More runs than that do not make the mean of a level more certain: machines change. */
static const double weight_most = 20.0;
/* Beside others, for a machine that they fill: memory and caches are shared. */
static const double sharing_spread = 0.1;

static const double interval_narrowest = 0.077; /* log(1.08) */
static const double interval_widest = 3.0;      /* log(20) */
static const double clock_seconds = 0.03;       /* a process starts, a disk answers */
static const double quantile = 1.959964;        /* of the normal distribution, two sides 5 % */

struct level {
    double weight, mean, variance;
};

static double number_at(const json_t *list, size_t index)
{
    double value = json_number_value(json_array_get(list, index));
    return isfinite(value) ? value : 0.0;
}

static struct level level_read(const json_t *calibration, const char *name)
{
    const json_t *list = json_object_get(json_object_get(calibration, "ratios"), name);
    return (struct level){.weight = fmin(fmax(number_at(list, 0), 0.0), weight_most),
                          .mean = number_at(list, 1),
                          .variance = fmax(number_at(list, 2), 0.0)};
}

/* Variance of a run around the mean of its level: as assumed, and as seen. */
static double run_variance(struct level level, double assumed)
{
    return (prior_freedom * assumed * assumed + level.weight * level.variance) /
           (prior_freedom + level.weight);
}

/* The mean of a level, known before with mean and variance `belief`, after its runs. */
static struct calibration_belief update(struct calibration_belief belief, struct level level,
                                        double assumed)
{
    if (level.weight > 0.0) {
        double seen = run_variance(level, assumed) / level.weight;
        double share = belief.variance / (belief.variance + seen);
        belief.mean += share * (level.mean - belief.mean);
        belief.variance *= 1.0 - share;
    }
    belief.freedom = prior_freedom + level.weight;
    return belief;
}

struct calibration_belief scene_calibration_cost(const json_t *calibration,
                                                 const struct scene_cost_keys *keys)
{
    const double within[COST_LEVEL_COUNT] = {run_spread, hypot(run_spread, method_spread),
                                             hypot(hypot(run_spread, method_spread), class_spread)};
    const double between[COST_LEVEL_COUNT] = {method_spread, class_spread, machine_spread};
    struct calibration_belief belief = {0};
    for (size_t level = COST_LEVEL_COUNT; level-- > 0;) {
        belief.variance += between[level] * between[level];
        belief = update(belief, level_read(calibration, keys->level[level]), within[level]);
    }
    belief.variance += run_variance(level_read(calibration, keys->level[0]), run_spread);
    return belief;
}

const char *scene_calibration_wait_name(bool files)
{
    return waits[files ? 1 : 0].name;
}

struct calibration_belief scene_calibration_wait(const json_t *calibration, bool files,
                                                 double threads)
{
    const struct wait *wait = &waits[files ? 1 : 0];
    const json_t *load = json_object_get(calibration, "load");
    double cores = json_number_value(json_object_get(load, "cores"));
    double busy = fmax(json_number_value(json_object_get(load, "busy")), 0.0);
    struct level level = level_read(calibration, wait->name);
    struct calibration_belief belief = {.variance = wait->level_spread * wait->level_spread};
    belief = update(belief, level, wait->run_spread);
    belief.variance += run_variance(level, wait->run_spread);
    if (cores >= 1.0 && busy > 0.0) {
        /* More threads than cores take turns, as long as the others last. */
        double crowded = log(fmax(1.0, (busy + threads) / cores));
        double shared = sharing_spread * fmin(busy / cores, 1.0);
        belief.mean += crowded;
        belief.variance += 0.25 * crowded * crowded + shared * shared;
    }
    return belief;
}

struct calibration_belief scene_calibration_join(struct calibration_belief cost,
                                                 struct calibration_belief wait, double spread)
{
    return (struct calibration_belief){.mean = cost.mean + wait.mean,
                                       .variance = cost.variance + wait.variance + spread * spread,
                                       .freedom = fmin(cost.freedom, wait.freedom)};
}

/* Two-sided 5 % point of Student's t (Abramowitz and Stegun, 26.7.5): good to 1 % from three
 * degrees of freedom. */
static double student(double freedom)
{
    const double z = quantile, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
    const double first = (z3 + z) / 4.0, second = (5.0 * z5 + 16.0 * z3 + 3.0 * z) / 96.0;
    const double third = (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / 384.0;
    return z + ((third / freedom + second) / freedom + first) / freedom;
}

struct calibration_interval scene_calibration_interval(double predicted,
                                                       struct calibration_belief belief)
{
    double half = student(belief.freedom) * sqrt(belief.variance);
    half = fmin(fmax(half, interval_narrowest), interval_widest);
    double expected = predicted * exp(belief.mean);
    return (struct calibration_interval){
        .low = fmax(expected * exp(-half) - clock_seconds, 0.2 * expected * exp(-half)),
        .expected = expected,
        .high = expected * exp(half) + clock_seconds};
}
