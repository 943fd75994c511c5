/* SPDX-License-Identifier: Apache-2.0 */
/* From peak to residual: residual + (peak - residual) exp(-rate x plastic shear strain), for the
 * models of multi_surface.h, whose history variable the plastic shear strain is. */
#ifndef TALUS_SOFTENING_H
#define TALUS_SOFTENING_H

#include "materials/material_issue.h"
#include "materials/material_kernel.h"

/* Their one history variable. */
extern const char *const softening_state_names[1];

struct softening {
    double rate; /* per plastic shear strain; 0: none */
};

/* The scene's softening_rate, or NAN. */
struct softening softening_read(double rate);

/* A value with its residual one, which is the peak where the scene gives none. */
struct decay {
    double residual, drop; /* drop = peak - residual */
};

/* Out of checked values; `residual` may be NAN. */
struct decay decay_read(double peak, double residual);

/* Adds what is wrong with a peak and the residual value of `key`, which must not lie above it. */
void decay_check(const char *key, double peak, double residual, struct material_issues *issues);

/* Adds an issue if softening_rate stands without a residual value, or none with one. */
void softening_check(bool residual_given, double rate, struct material_issues *issues);

/* share[index] = exp(-rate x shear[index]), the share of the drop that is left, for count slots;
 * false, and nothing written, if all of them are at their peak, where the share is 1. */
bool softening_shares(const struct softening *softening, const real *shear, size_t count,
                      real *share);

#endif
