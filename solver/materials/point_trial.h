/* SPDX-License-Identifier: Apache-2.0 */
/* One material point and trial steps from its state: the material update of several increments at
 * once, without touching the state, until one of them is accepted. */
#ifndef TALUS_POINT_TRIAL_H
#define TALUS_POINT_TRIAL_H

#include "materials/material.h"
#include "math/tensor.h"

/* Lane 0 is the step itself, 1 ... 6 differ from it in one component (numerical tangent); the last
 * stays empty. */
enum { POINT_LANES = 8 };

struct point_state {
    double elastic[SYM3_COMPONENTS]; /* as the model stores it; volumetric models use [0] */
    double strain[SYM3_COMPONENTS];  /* total */
    double stress[SYM3_COMPONENTS];  /* Cauchy [Pa] */
    struct mat3 gradient;            /* F */
    double volume_ratio;             /* J; 1 at small strain */
    double plastic_strain, dissipation;
    double *history; /* [state_count], owned */
};

struct point_trial {
    double strain[SYM3_COMPONENTS][POINT_LANES]; /* in: total strain increment */
    struct mat3 step[POINT_LANES];               /* in: incremental gradient f, finite strain */
    real elastic[SYM3_COMPONENTS][POINT_LANES];
    real stress[SYM3_COMPONENTS][POINT_LANES]; /* out: Cauchy */
    real rate[SYM3_COMPONENTS][POINT_LANES];
    real spin[3][POINT_LANES];
    real volume_ratio[POINT_LANES];
    real plastic_strain[POINT_LANES],
        dissipation[POINT_LANES]; /* zero where the model writes none */
    real *history_values;         /* [state_count x POINT_LANES], owned */
    real **history;               /* [state_count], owned */
};

struct point {
    const struct material *material;
    void *constants; /* owned */
    bool finite_strain;
    struct point_state state;
    struct point_trial trial;
};

/* Undeformed, under an initial stress. On failure nothing is owned. */
TALUS_MUST_CHECK enum talus_status point_init(struct point *point, const struct material *material,
                                              const double *values, bool finite_strain,
                                              const double stress[SYM3_COMPONENTS],
                                              struct talus_error *error);
/* Accepts a zeroed point. */
void point_release(struct point *point);

/* Sets f of every lane from its strain increment: stretching without spin. */
void point_trial_stretch(struct point *point);

/* Runs the model from the state over trial.strain (and trial.step) in `time_step` seconds. False if
 * a lane has no logarithmic strain or no finite stress. */
bool point_trial_run(struct point *point, double time_step);

/* Makes lane 0 the state. */
void point_trial_accept(struct point *point);

/* Strain energy of the state per initial volume [J/m^3]. */
double point_strain_energy(struct point *point);

#endif
