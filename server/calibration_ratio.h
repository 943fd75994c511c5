/* SPDX-License-Identifier: Apache-2.0 */
/* Running statistics of how far something is from its prediction: mean and variance of the
 * logarithm of measured over predicted, in which old runs fade and single ones cannot do much. */
#ifndef TALUS_CALIBRATION_RATIO_H
#define TALUS_CALIBRATION_RATIO_H

#include <stdint.h>

struct calibration_ratio {
    int64_t count;         /* of runs, ever */
    double weight;         /* runs that the statistics are worth, at most what learning allows */
    double mean, variance; /* of the logarithm */
};

/* Adds a run. Beyond `most` runs, each new one counts 1 / most: a machine that has changed is
 * followed within some `most` runs. From the third on, what is more than three standard deviations
 * off (of at least 0.15) counts as if it were three. Ignores what is not a finite number. */
void calibration_ratio_learn(struct calibration_ratio *ratio, double logarithm, double most);

#endif
