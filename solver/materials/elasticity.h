/* SPDX-License-Identifier: Apache-2.0 */
/* Isotropic linear elasticity between strain and stress, which all solids share: small strain and
 * Cauchy stress, or Hencky strain and Kirchhoff stress (Mast 2013, sec. 3.2; the tensor is
 * K 1(x)1 + 2 G (I - 1(x)1/3), in his eq. 3.46 the 2 is missing). */
#ifndef TALUS_ELASTICITY_H
#define TALUS_ELASTICITY_H

#include "materials/material_issue.h"
#include "materials/material_kernel.h"

#include <assert.h>
#include <stddef.h>

struct elasticity {
    double bulk, shear; /* K, G [Pa] */
    double density;     /* reference density [kg/m^3] */
};

/* Places of the shared parameters in an array of values; a model's own table follows. */
enum elasticity_value {
    ELASTICITY_DENSITY = MATERIAL_VALUE_DENSITY,
    ELASTICITY_BULK_MODULUS,
    ELASTICITY_SHEAR_MODULUS,
    ELASTICITY_YOUNG_MODULUS,
    ELASTICITY_POISSON_RATIO,
    ELASTICITY_VALUE_COUNT,
};

/* Out of checked values of a solid. */
struct elasticity elasticity_read(const double *values);
/* Adds a contradiction if the constants given are not one of the two pairs. */
void elasticity_check(const double *values, struct material_issues *issues);
/* The check and the constants of a model that has no more than these parameters. */
size_t elasticity_check_alone(const double *values, struct material_issue *items, size_t capacity);
void elasticity_prepare_alone(const double *values, void *constants);

/* Entries of struct material for models whose constants begin with a struct elasticity. */
#define ELASTICITY_COMES_FIRST(type)                                                               \
    static_assert(offsetof(type, elasticity) == 0, "the elasticity comes first in " #type)

/* sqrt((K + 4 G / 3) / rho) [m/s] */
double elasticity_wave_speed(const void *constants);
/* The inverse law: strain that gives a stress. */
void elasticity_strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                                   double strain[SYM3_COMPONENTS]);
/* K tr(e)^2 / 2 + G |dev e|^2 into energy[batch->count]. */
void elasticity_strain_energy(const void *constants, const struct material_batch *batch,
                              real *energy);

struct stiffness { /* what loops over slots compute with [Pa] */
    real shear;    /* 2 G: stress over strain of the deviators */
    real bulk;     /* 3 K: I1 over trace of the strain */
};

TALUS_INLINE struct stiffness elasticity_stiffness(const struct elasticity *elasticity)
{
    return (struct stiffness){(real)(2.0 * elasticity->shear), (real)(3.0 * elasticity->bulk)};
}

TALUS_INLINE struct sym3 elasticity_stress(struct stiffness stiffness, struct sym3 strain)
{
    real volumetric = (stiffness.bulk - stiffness.shear) * (real)(1.0 / 3.0) * sym3_trace(strain);
    return sym3_add_diagonal(sym3_scale(stiffness.shear, strain), volumetric);
}

/* Stress of slots begin ... begin + count - 1 that do not flow. */
TALUS_INLINE void elasticity_apply(struct stiffness stiffness, const struct material_batch *batch,
                                   size_t components, size_t begin, size_t count)
{
#pragma omp simd
    for (size_t slot = begin; slot < begin + count; slot++) {
        struct sym3 strain = components_load(batch->strain, slot, components);
        components_store(batch->stress, slot, components, elasticity_stress(stiffness, strain));
    }
}

#endif
