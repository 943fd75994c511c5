/* SPDX-License-Identifier: Apache-2.0 */
/* What earlier runs on this machine say about the cost of the next one.
 *
 * Whoever keeps the calibration knows, under opaque names, running statistics of log(measured /
 * predicted): how many runs they are worth, their mean and their variance. Under the names of a
 * method they are of processor time, under "wall" of wall time over that ("wall/files" of runs that
 * do little but write files: they wait for the disk, not for a core). A run's own method counts
 * most, runs of its class and of the machine where there are few of it: each level is a normal
 * prior for the next (Gelman et al., Bayesian Data Analysis, 3rd ed., sec. 5.4, with the spreads
 * between methods as stated in scene_calibration.c). */
#ifndef TALUS_SCENE_CALIBRATION_H
#define TALUS_SCENE_CALIBRATION_H

#include "scene/scene_cost.h"

#include <jansson.h>

/* Of the logarithm of a ratio: normal, or Student's t with that many degrees of freedom. */
struct calibration_belief {
    double mean, variance, freedom;
};

/* Name under which wall time over processor time is learned; `files`: of runs that do little but
 * write files. */
const char *scene_calibration_wait_name(bool files);

/* Belief in log(processor time / predicted) of the next run with these keys. `calibration`:
 * {"ratios": {NAME: [weight, mean, variance], ...}, "load": {"cores", "busy"}}; everything may be
 * missing, and the whole may be NULL: then nothing is known of this machine. */
struct calibration_belief scene_calibration_cost(const json_t *calibration,
                                                 const struct scene_cost_keys *keys);
/* The same of log(wall time / what the processor time lets expect), on a machine with that load and
 * this run's threads; `files` as above. */
struct calibration_belief scene_calibration_wait(const json_t *calibration, bool files,
                                                 double threads);

/* Both together, as if independent, with a spread of their product known from elsewhere (standard
 * deviation of its logarithm). */
struct calibration_belief scene_calibration_join(struct calibration_belief cost,
                                                 struct calibration_belief wait, double spread);

struct calibration_interval {
    double low, expected, high;
};
/* Where 95 of 100 runs should end, around a predicted value [s]. Never narrower than 8 % and some
 * hundredths of a second each way, never wider than a factor of 20. */
struct calibration_interval scene_calibration_interval(double predicted,
                                                       struct calibration_belief belief);

#endif
