/* SPDX-License-Identifier: Apache-2.0 */
/* The table of the random trials: one row a model and set of parameters, with a yield function that
 * shares nothing with the solver. A new plastic model takes part by its row (and its surface). */
#ifndef TRIAL_MODELS_H
#define TRIAL_MODELS_H

#include "material_fixture.h"

#include "math/tensor.h"

struct trial_state { /* a returned state, as a surface sees it */
    const struct fixture *fixture;
    struct sym3 stress;
    double principal[3];   /* of the stress, descending [Pa] */
    const double *history; /* that the surface of the step belongs to */
};

/* Yield function in units of stress [Pa], of degree one in it: positive outside, zero on the
 * surface; of several surfaces the largest value. */
typedef double trial_surface(const struct trial_state *state);

struct trial_model {
    const char *label; /* unique; what failures name */
    const char *model;
    struct setting settings[12];
    trial_surface *surface;
    /* The surface of a step is that of the history at its start (semi-implicit hardening); else
     * that of its end. */
    bool surface_of_start;
};

extern const struct trial_model trial_models[];
extern const size_t trial_model_count;

#endif
