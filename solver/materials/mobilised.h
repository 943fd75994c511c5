/* SPDX-License-Identifier: Apache-2.0 */
/* Mobilised friction and dilation (Mast 2013, eq. 3.112-3.119; angles in degrees, I1 tension
 * positive, lambda the accumulated norm of the plastic strain increments times a scale):
 *
 *   phi    = a0 + (a1 lambda - a4) exp(a2 I1 - a3 lambda)
 *   phi_cs = a0 - a4 exp(-a5 lambda)         tan psi = tan phi - tan phi_cs
 *
 * evaluated at the start of a step (semi-implicit). phi and phi_cs are kept within 0 ... 89
 * degrees. Shared by the models whose yield surface is a cone about the hydrostatic axis with a
 * fixed apex: for a given direction of the deviator each of them is |s| = slope (3 c - I1). */
#ifndef TALUS_MOBILISED_H
#define TALUS_MOBILISED_H

#include "materials/invariants.h"

enum mobilised_value {
    MOBILISED_FRICTION_ANGLE = ELASTICITY_VALUE_COUNT,
    MOBILISED_A0,
    MOBILISED_A1,
    MOBILISED_A2,
    MOBILISED_A3,
    MOBILISED_A4,
    MOBILISED_A5,
    MOBILISED_STRAIN_SCALE,
    MOBILISED_STRAIN_MEASURE,
    MOBILISED_DILATION_ANGLE,
    MOBILISED_COHESION,
    MOBILISED_APEX_STRESS,
    MOBILISED_VALUE_COUNT,
};

enum mobilised_state { MOBILISED_STATE_LAMBDA, MOBILISED_STATE_INVARIANT, MOBILISED_STATE_COUNT };

struct mobilised {
    struct elasticity elasticity;
    double residual, hardening, pressure_decay, strain_decay, initial_drop; /* a0 ... a4 */
    double critical_decay;                                                  /* a5 */
    bool critical_state; /* a5 sets the dilation */
    bool constant;       /* phi and psi never change */
    double tangent;      /* tan phi if constant */
    double flow_tangent; /* tan psi unless critical_state, or if constant */
    double strain_scale;
    double deviatoric_share, volumetric_share; /* 1 or 0: what counts for lambda */
    double apex;                               /* I1 at the apex, 3 c [Pa] */
};

extern const char *const mobilised_strain_measures[];
extern const char *const mobilised_state_names[MOBILISED_STATE_COUNT];

/* The parts of struct material that the models share. */
size_t mobilised_check(const double *values, struct material_issue *items, size_t capacity);
void mobilised_prepare(const double *values, void *constants);
double mobilised_wave_speed(const void *constants);
void mobilised_initialise(const void *constants, const double strain[SYM3_COMPONENTS],
                          double *history);
void mobilised_strain_energy(const void *constants, const struct material_batch *batch,
                             double *energy);
void mobilised_strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                                  double strain[SYM3_COMPONENTS]);
double mobilised_initial_friction_angle_deg(const double *values);

/* Angles in force over the slots of a chunk. */
struct mobilised_angles {
    double tangent[MATERIAL_CHUNK];      /* tan phi */
    double flow_tangent[MATERIAL_CHUNK]; /* tan psi, before the limit by the friction */
};

/* Angles at the start of the step, from the history of slots begin ... begin + count - 1. */
void mobilised_angles_at_start(const struct mobilised *mobilised,
                               const struct material_batch *batch, size_t begin, size_t count,
                               struct mobilised_angles *angles);

/* lambda and I1 at the end of the step into the history. */
void mobilised_advance(const struct mobilised *mobilised, const struct material_batch *batch,
                       size_t begin, size_t count, const struct invariants *invariants);

/* Outer-cone slope of an angle given by its tangent: sqrt(2/3) 2 sin/(3 - sin). */
TALUS_INLINE double mobilised_cone_slope(double tangent)
{
    double sine = tangent / sqrt(1.0 + tangent * tangent);
    return 2.0 * sqrt(2.0 / 3.0) * sine / (3.0 - sine);
}

/* Return to |s| + slope (I1 - apex) = 0 along the flow |s| + flow_slope I1, or to the apex where
 * the line ends there (Mast 2013, sec. 3.6.1, without hardening inside the step). A flow slope
 * above the slope would make plastic work negative and is cut. */
TALUS_INLINE void mobilised_return(const struct mobilised *mobilised, size_t count,
                                   const double *slopes, const double *flow_slopes,
                                   struct invariants *invariants)
{
    double shear = 2.0 * mobilised->elasticity.shear;
    double bulk = 9.0 * mobilised->elasticity.bulk;
    double apex = mobilised->apex;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        double first = invariants->trial[index];
        double norm = invariants->norm[index];
        double slope = slopes[index];
        double flow_slope = minimum(flow_slopes[index], slope);
        double excess = norm + slope * (first - apex);
        double resistance = shear + bulk * slope * flow_slope;
        double multiplier = maximum(excess, 0.0) / (resistance > 0.0 ? resistance : 1.0);
        double returned = first - bulk * flow_slope * multiplier;
        double left = norm - shear * multiplier;
        bool on_cone = resistance > 0.0 && left >= 0.0 && returned <= apex;
        bool plastic = excess > 0.0 || first > apex;
        double scale = on_cone ? left / (norm > 0.0 ? norm : 1.0) : 0.0;
        double moved = on_cone ? returned : apex;
        invariants->scale[index] = plastic ? scale : 1.0;
        invariants->first[index] = plastic ? moved : first;
    }
}

#endif
