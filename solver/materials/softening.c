/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/softening.h"

#include "math/elementary.h"

const char *const softening_state_names[1] = {"plastic_shear_strain"};

struct softening softening_read(double rate)
{
    return (struct softening){.rate = isnan(rate) ? 0.0 : rate};
}

struct decay decay_read(double peak, double residual)
{
    const double end = isnan(residual) ? peak : residual;
    return (struct decay){.residual = end, .drop = peak - end};
}

void decay_check(const char *key, double peak, double residual, struct material_issues *issues)
{
    if (residual > peak)
        material_issue_add(issues, key, "contradiction",
                           "strength falls from its peak (%g) to the residual value, which cannot "
                           "lie above it",
                           peak);
}

void softening_check(bool residual_given, double rate, struct material_issues *issues)
{
    if (residual_given && isnan(rate))
        material_issue_add(issues, "softening_rate", "incomplete",
                           "'softening_rate' is required with a residual strength: how fast "
                           "plastic shear strain brings it about");
    if (!residual_given && !isnan(rate))
        material_issue_add(issues, "softening_rate", "contradiction",
                           "softening_rate needs a residual strength to fall to");
}

bool softening_shares(const struct softening *softening, const real *shear, size_t count,
                      real *share)
{
    const real rate = (real)softening->rate;
    count = whole_rows(count);
    if (rate == 0 || !number_bits(count, shear).nonzero)
        return false;
#pragma omp simd
    for (size_t index = 0; index < count; index++)
        share[index] = elementary_exp(-rate * shear[index]);
    return true;
}
