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
    double total_share, deviatoric_share, spherical_share; /* of what adds to lambda: 1 or 0 */
    double apex;                                           /* I1 at the apex, 3 c [Pa] */
};

ELASTICITY_COMES_FIRST(struct mobilised);

extern const char *const mobilised_strain_measures[];
extern const char *const mobilised_state_names[MOBILISED_STATE_COUNT];

/* The parts of struct material that the models share. */
size_t mobilised_check(const double *values, struct material_issue *items, size_t capacity);
void mobilised_prepare(const double *values, void *constants);
void mobilised_initialise(const void *constants, const double strain[SYM3_COMPONENTS],
                          double *history);
double mobilised_initial_friction_angle_deg(const double *values);

/* Angles in force over the slots of a chunk. */
struct mobilised_angles {
    MATERIAL_ALIGNED real tangent[MATERIAL_CHUNK];      /* tan phi */
    MATERIAL_ALIGNED real flow_tangent[MATERIAL_CHUNK]; /* tan psi, before the limit by the
                                                           friction */
};

/* Angles at the start of the step, from the history of slots begin ... begin + count - 1: that of
 * friction, that of dilation (which reads the one of friction), both. */
void mobilised_friction_at_start(const struct mobilised *mobilised,
                                 const struct material_batch *batch, size_t begin, size_t count,
                                 struct mobilised_angles *angles);
void mobilised_dilation_at_start(const struct mobilised *mobilised,
                                 const struct material_batch *batch, size_t begin, size_t count,
                                 struct mobilised_angles *angles);
static inline void mobilised_angles_at_start(const struct mobilised *mobilised,
                                             const struct material_batch *batch, size_t begin,
                                             size_t count, struct mobilised_angles *angles)
{
    mobilised_friction_at_start(mobilised, batch, begin, count, angles);
    mobilised_dilation_at_start(mobilised, batch, begin, count, angles);
}

/* Outer-cone slopes of angles given by their tangents: sqrt(2/3) 2 sin/(3 - sin). */
void mobilised_cone_slopes(size_t count, const real *tangent, real *slope);

/* Slots beyond |s| + slope (I1 - apex) = 0 or the apex get a positive plastic strain; the others
 * their whole update but for the stress: no flow, and I1 into the history. */
void mobilised_mark_yielding(const struct mobilised *mobilised, const struct material_batch *batch,
                             size_t begin, size_t count, const real *slopes,
                             const struct invariants *invariants);

/* A return on its way through two loops. */
struct mobilised_flow {
    MATERIAL_ALIGNED real deviatoric[MATERIAL_CHUNK]; /* |dev| of the plastic strain increment */
    MATERIAL_ALIGNED real left[MATERIAL_CHUNK]; /* deviator returned, along that increment [Pa] */
};

/* A potential of a model's own: replaces the return of `count` slots where it wants to. `yields`:
 * positive where a trial is beyond the surface. */
typedef void mobilised_potential(const struct mobilised *mobilised, size_t count,
                                 const real *yields, const struct mobilised_angles *angles,
                                 struct invariants *invariants, struct mobilised_flow *flow);

/* Returns trials to the surface along the flow |s| + flow_slope I1 of the angles' dilation, or to
 * the apex where the line ends there (Mast 2013, sec. 3.6.1, without hardening inside the step). A
 * flow slope above the slope would make plastic work negative and is cut; so would contraction
 * under tensile mean stress (Mast leaves it open), which ends at I1 = 0: the potential is |s|
 * beyond, the wedge between the two directions returns to I1 = 0. `potential` (or NULL) has the
 * last word. Writes the `out` of the invariants, plastic strain, dissipation and the history:
 * lambda and I1 at the end of the step. */
void mobilised_return(const struct mobilised *mobilised, const struct material_batch *batch,
                      size_t begin, size_t count, const real *slopes,
                      const struct mobilised_angles *angles, mobilised_potential *potential,
                      struct invariants *invariants);

/* What a model with mobilised friction adds: slopes |s| / (apex - I1) of its surface in the
 * direction of the trial, from the tangents of the friction angle. */
typedef void mobilised_surface(size_t count, const real *tangent,
                               const struct invariants *invariants, real *slope);

/* The update of a model with that surface, which reads invariants of that kind, and with a
 * potential of its own or NULL. */
TALUS_INLINE bool mobilised_update(const struct mobilised *mobilised,
                                   const struct material_batch *batch, size_t components,
                                   mobilised_surface *surface, enum invariants_kind kind,
                                   mobilised_potential *potential)
{
    const struct stiffness stiffness = elasticity_stiffness(&mobilised->elasticity);
    const size_t slots = slot_count(batch);
    struct mobilised_angles angles;
    struct invariants invariants;
    MATERIAL_ALIGNED real slope[MATERIAL_CHUNK];
    bool flowed = false;
    for (size_t begin = 0; begin < slots; begin += MATERIAL_CHUNK) {
        const size_t count = chunk_count(slots, begin);
        mobilised_friction_at_start(mobilised, batch, begin, count, &angles);
        invariants_of_trial(stiffness, batch, components, begin, count, kind, &invariants);
        surface(count, angles.tangent, &invariants, slope);
        mobilised_mark_yielding(mobilised, batch, begin, count, slope, &invariants);
        if (!any_flowed(batch, begin, count)) {
            elasticity_apply(stiffness, batch, components, begin, count);
            continue;
        }
        flowed = true;
        mobilised_dilation_at_start(mobilised, batch, begin, count, &angles);
        mobilised_return(mobilised, batch, begin, count, slope, &angles, potential, &invariants);
        invariants_apply(stiffness, batch, components, begin, count, kind, &invariants);
    }
    return flowed;
}

#endif
