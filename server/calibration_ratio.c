/* SPDX-License-Identifier: Apache-2.0 */
#include "calibration_ratio.h"

#include <math.h>

static const double spread_least = 0.15;
static const double deviations_most = 3.0;

void calibration_ratio_learn(struct calibration_ratio *ratio, double logarithm, double most)
{
    if (!isfinite(logarithm))
        return;
    if (ratio->count >= 2) {
        double reach = deviations_most * fmax(sqrt(ratio->variance), spread_least);
        logarithm = fmin(fmax(logarithm, ratio->mean - reach), ratio->mean + reach);
    }
    ratio->count++;
    ratio->weight = fmin(ratio->weight + 1.0, most);
    double before = logarithm - ratio->mean;
    ratio->mean += before / ratio->weight;
    ratio->variance += (before * (logarithm - ratio->mean) - ratio->variance) / ratio->weight;
}
