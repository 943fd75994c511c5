/* SPDX-License-Identifier: Apache-2.0 */
/* What the Drucker-Prager models with a constant cone share: their parameters, and the return to
 * the cone |s| + rho_F I1 = mu along |s| + rho_G I1 (Mast 2013, eq. 3.84-3.92). */
#ifndef TALUS_CONE_PARAMETERS_H
#define TALUS_CONE_PARAMETERS_H

#include "materials/elasticity.h"

enum cone_value {
    CONE_VALUE_FRICTION_ANGLE = ELASTICITY_VALUE_COUNT,
    CONE_VALUE_CONE_SLOPE,
    CONE_VALUE_COHESION,
    CONE_VALUE_CONE_STRENGTH,
    CONE_VALUE_DILATION_ANGLE,
    CONE_VALUE_FLOW_RATIO,
    CONE_VALUE_FLOW_SLOPE,
    CONE_VALUE_CONE_FIT,
    CONE_VALUE_COUNT,
};

extern const char *const cone_fit_names[];

struct cone {
    double slope, flow_slope; /* rho_F, rho_G [-] */
    double strength;          /* mu [Pa] */
};

/* Out of checked values. */
struct cone cone_read(const double *values);
/* Adds what contradicts itself or would make plastic flow a source of energy. The elastic constants
 * have passed their own check. */
void cone_check(const double *values, struct material_issues *issues);
/* The key that sets the dilation. */
const char *cone_flow_key(const double *values);
/* Friction angle [deg] of the cone in triaxial compression. */
double cone_friction_angle_deg(const double *values);

struct cone_law { /* what the loops compute with */
    real slope;
    real flow_bulk; /* fall of I1 over the multiplier [Pa] */
    real inverse;   /* multiplier over what is beyond the cone [1/Pa] */
};

/* `shear` and `isotropic` [Pa]: fall of the deviatoric norm and growth of the strength over the
 * multiplier. */
static inline struct cone_law cone_law_of(const struct cone *cone, double bulk_modulus,
                                          double shear, double isotropic)
{
    const double flow_bulk = 9.0 * bulk_modulus * cone->flow_slope;
    return (struct cone_law){
        .slope = (real)cone->slope,
        .flow_bulk = (real)flow_bulk,
        .inverse = (real)(1.0 / (shear + isotropic + flow_bulk * cone->slope)),
    };
}

/* What (I1, norm) is beyond a cone of that strength [Pa]; negative inside. */
TALUS_INLINE real cone_excess(const struct cone_law *law, real first, real norm, real strength)
{
    return norm + law->slope * first - strength;
}

/* Multiplier of the return to the cone, 0 inside. */
TALUS_INLINE real cone_multiplier(const struct cone_law *law, real excess)
{
    return maximum(excess, 0) * law->inverse;
}

#endif
