/* SPDX-License-Identifier: Apache-2.0 */
/* The material models once more, one point at a time and as their equations stand: returns in
 * principal space, roots by bisection. Nothing is shared with solver/materials but the names and
 * values of the parameters. */
#ifndef REFERENCE_MATERIAL_H
#define REFERENCE_MATERIAL_H

#include "reference_tensor.h"

#include <stdbool.h>

struct material;

struct reference_history {
    double isotropic;        /* a_iso of the models that harden linearly */
    struct tensor kinematic; /* their a_kin */
    double measure;          /* lambda of the mobilised models, unscaled */
    double first;            /* their I1 at the end of the last step [Pa] */
    double shear;            /* sum of largest minus smallest principal plastic strain increments */
};

struct reference_update {
    /* in */
    struct tensor strain;   /* trial elastic strain: Hencky, or small; fluid: ln J in [0][0] */
    struct tensor gradient; /* L [1/s] */
    double volume_ratio;    /* J */
    double time_step;       /* [s] */
    bool finite_strain;
    /* out; strain becomes the elastic strain */
    struct tensor stress; /* Kirchhoff or Cauchy [Pa] */
    double plastic;       /* norm of the plastic strain increment */
    double dissipation;   /* [J/m^3] */
};

/* True if the reference knows the model. */
bool reference_material_known(const struct material *material);
void reference_material_update(const struct material *material, const double *values,
                               struct reference_history *history, struct reference_update *update);
/* Strain energy per reference volume [J/m^3]. */
double reference_material_energy(const struct material *material, const double *values,
                                 const struct reference_history *history, struct tensor strain);
/* A parameter by its key. */
double reference_value(const struct material *material, const double *values, const char *key);

#endif
