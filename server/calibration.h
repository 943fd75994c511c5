/* SPDX-License-Identifier: Apache-2.0 */
/* What the daemon has learned of the machine from finished jobs, for the forecast of the next ones.
 *
 * The daemon knows no methods: a forecast names under `learn` the statistics that its run belongs
 * to, and the processor time as a sum over the run's metrics. Learned are log(processor time /
 * that sum) under each of these names, and log(wall time / what the processor time lets expect)
 * under another. The statistics live in the store; those of another processor are not used, those
 * of another build count little. Thread-safe. */
#ifndef TALUS_CALIBRATION_H
#define TALUS_CALIBRATION_H

#include "store.h"

#include <jansson.h>

struct calibration;

/* Under what conditions a job ran. */
struct calibration_run {
    double threads;
    double busy; /* threads of other jobs meanwhile, on average; negative: not known */
};

struct calibration_summary {
    int64_t names;  /* statistics that are kept */
    int64_t judged; /* jobs that succeeded at their first attempt, unsteered, with a forecast */
    int64_t inside; /* of these, whose wall time was in the interval */
    double recent;  /* share of the last hundred or so; NAN without any */
};

/* Reads what is known. *store is borrowed. */
TALUS_MUST_CHECK enum talus_status calibration_create(struct calibration **calibration,
                                                      struct store *store,
                                                      struct talus_error *error);
/* NULL is fine. */
void calibration_destroy(struct calibration *calibration);

/* What a helper is told for a forecast: {"ratios", "load": {"cores", "busy"}}; new reference, NULL
 * without memory. `busy`: threads of other jobs that it would run beside. */
json_t *calibration_question(struct calibration *calibration, double busy);

/* Judges the forecast of a finished job and learns from it; what cannot be used is ignored. Waits
 * for the store. A daemon that is killed before has forgotten this one job. */
void calibration_learn(struct calibration *calibration, const json_t *forecast,
                       const json_t *metrics, const struct calibration_run *run);

void calibration_summarise(struct calibration *calibration, struct calibration_summary *summary);

#endif
