/* SPDX-License-Identifier: Apache-2.0 */
#include "trial_models.h"

static const double degrees = 180.0 / M_PI;

/* A parameter by its key. */
static double value_of(const struct trial_state *state, const char *key)
{
    size_t index = material_parameter_index(state->fixture->material, key);
    assert_true(index != (size_t)-1);
    return state->fixture->values[index];
}

static double trace_of(const struct trial_state *state)
{
    return state->principal[0] + state->principal[1] + state->principal[2];
}

static double deviator_norm(const struct trial_state *state)
{
    return sym3_norm(sym3_deviator(state->stress));
}

/* |s - 2/3 H a_kin|; state 0 is the isotropic variable, states 1 ... 6 the back strain. */
static double relative_norm(const struct trial_state *state)
{
    const double *back = state->history + 1;
    struct sym3 back_strain = {back[0], back[1], back[2], back[3], back[4], back[5]};
    double hardening = value_of(state, "kinematic_hardening");
    return sym3_norm(
        sym3_add_scaled(sym3_deviator(state->stress), -2.0 / 3.0 * hardening, back_strain));
}

static double j2_surface(const struct trial_state *state)
{
    double yield = value_of(state, "yield_stress") +
                   value_of(state, "isotropic_hardening") * state->history[0];
    return relative_norm(state) - sqrt(2.0 / 3.0) * yield;
}

/* Slope of the cone through the compression corners of Mohr-Coulomb. */
static double outer_slope(double angle_deg)
{
    double sine = sin(angle_deg / degrees);
    return sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
}

static double cone_slope_of(const struct trial_state *state)
{
    double slope = value_of(state, "cone_slope");
    return isnan(slope) ? outer_slope(value_of(state, "friction_angle")) : slope;
}

/* The cone about the back stress and the cut-off at its apex. */
static double drucker_prager_surface(const struct trial_state *state)
{
    double angle = value_of(state, "friction_angle") / degrees;
    double slope = cone_slope_of(state);
    double strength =
        isnan(value_of(state, "cone_strength"))
            ? sqrt(2.0 / 3.0) * 6.0 * value_of(state, "cohesion") * cos(angle) / (3.0 - sin(angle))
            : value_of(state, "cone_strength");
    strength += sqrt(2.0 / 3.0) * value_of(state, "isotropic_hardening") * state->history[0];
    double cone = relative_norm(state) + slope * trace_of(state) - strength;
    return fmax(cone, slope > 0.0 ? trace_of(state) - strength / slope : cone);
}

/* The cone up to its tangent point, the circle about the origin beyond. */
static double cap_surface(const struct trial_state *state)
{
    double slope = cone_slope_of(state);
    double strength = value_of(state, "cone_strength");
    double first = trace_of(state);
    double norm = deviator_norm(state);
    if (first > slope * strength / (1.0 + slope * slope))
        return hypot(norm, first) - strength / sqrt(1.0 + slope * slope);
    return (norm + slope * first - strength) / sqrt(1.0 + slope * slope);
}

/* phi = a0 + (a1 lambda - a4) exp(a2 I1 - a3 lambda), 0 ... 89 degrees (Mast 2013, eq. 3.113);
 * state 0 is lambda, state 1 the I1 of the last step. */
static double mobilised_friction(const struct trial_state *state)
{
    if (isnan(value_of(state, "friction.a0")))
        return value_of(state, "friction_angle");
    double lambda = value_of(state, "friction.strain_scale") * state->history[0];
    double peak = value_of(state, "friction.a1") * lambda - value_of(state, "friction.a4");
    double decay = value_of(state, "friction.a2") * state->history[1] -
                   value_of(state, "friction.a3") * lambda;
    return fmin(fmax(value_of(state, "friction.a0") + peak * exp(decay), 0.0), 89.0);
}

/* Mean stress at the apex of the models with mobilised friction. */
static double mobilised_apex(const struct trial_state *state)
{
    double apex = value_of(state, "apex_stress");
    double residual = value_of(state, "friction.a0");
    double cohesion = value_of(state, "cohesion");
    if (isnan(residual))
        residual = value_of(state, "friction_angle");
    if (isnan(apex))
        apex = cohesion > 0.0 ? cohesion / tan(residual / degrees) : 0.0;
    return apex;
}

/* The cone, and the cut-off at its apex. */
static double mobilised_cone(const struct trial_state *state)
{
    double beyond = trace_of(state) - 3.0 * mobilised_apex(state);
    double slope = outer_slope(mobilised_friction(state));
    return fmax((deviator_norm(state) + slope * beyond) / sqrt(1.0 + slope * slope), beyond);
}

/* (kappa I3 - I1 I2) / |sb|^2 of the shifted stress, and no principal stress beyond the apex: the
 * former is negative where two are. */
static double matsuoka_nakai_surface(const struct trial_state *state)
{
    double apex = mobilised_apex(state);
    double tangent = tan(mobilised_friction(state) / degrees);
    double kappa = 9.0 + 8.0 * tangent * tangent;
    double a = state->principal[0] - apex;
    double b = state->principal[1] - apex;
    double c = state->principal[2] - apex;
    double square = a * a + b * b + c * c;
    if (square == 0.0)
        return 0.0;
    return fmax((kappa * a * b * c - (a + b + c) * (a * b + b * c + c * a)) / square / kappa, a);
}

/* From peak to residual; NAN: no residual value. */
static double softened(const struct trial_state *state, const char *peak, const char *residual)
{
    double top = value_of(state, peak);
    double rest = value_of(state, residual);
    if (isnan(rest))
        return top;
    return rest + (top - rest) * exp(-value_of(state, "softening_rate") * state->history[0]);
}

static double tresca_surface(const struct trial_state *state)
{
    double cohesion = softened(state, "cohesion", "residual_cohesion");
    return (state->principal[0] - state->principal[2] - 2.0 * cohesion) / sqrt(2.0);
}

/* Shear plane as its normal's length makes it, tension up to its strength and the apex. */
static double mohr_coulomb_surface(const struct trial_state *state)
{
    double sine = sin(softened(state, "friction_angle", "residual_friction_angle") / degrees);
    double cohesion = softened(state, "cohesion", "residual_cohesion");
    double tension = value_of(state, "tensile_strength");
    double high = state->principal[0];
    double low = state->principal[2];
    double cosine = sqrt(1.0 - sine * sine);
    double shear = (high - low) + (high + low) * sine - 2.0 * cohesion * cosine;
    double apex = sine > 0.0 ? cohesion * cosine / sine : INFINITY;
    double limit = isnan(tension) ? apex : fmin(tension, apex);
    return fmax(shear / sqrt(2.0 + 2.0 * sine * sine), high - limit);
}

#define ELASTIC                                                                                    \
    {"density", 2000.0}, {"bulk_modulus", 5e6},                                                    \
    {                                                                                              \
        "shear_modulus", 3e6                                                                       \
    }
/* Peak and softening of Mast 2013, table 3.5, column i, with a residual angle of 30 degrees. */
#define SOFTENING                                                                                  \
    {"friction.a0", 30.0}, {"friction.a1", 3000.0}, {"friction.a2", 1e-6}, {"friction.a3", 150.0}, \
    {                                                                                              \
        "friction.a4", 15.0                                                                        \
    }

/* clang-format off */
const struct trial_model trial_models[] = {
    {"j2", "j2", {ELASTIC, {"yield_stress", 5e3}, {"isotropic_hardening", 2e5}, {"kinematic_hardening", 4e5}}, j2_surface, false},
    {"j2, perfectly plastic", "j2", {ELASTIC, {"yield_stress", 5e3}}, j2_surface, false},
    {"cone", "drucker_prager", {ELASTIC, {"friction_angle", 25.0}, {"cohesion", 2e3}, {"dilation_angle", 15.0}, {"isotropic_hardening", 2e5}, {"kinematic_hardening", 4e5}}, drucker_prager_surface, false},
    {"cone, no cohesion, no dilation", "drucker_prager", {ELASTIC, {"friction_angle", 30.0}}, drucker_prager_surface, false},
    {"cone, no friction", "drucker_prager", {ELASTIC, {"cone_slope", 0.0}, {"cone_strength", 4e3}, {"flow_ratio", 0.0}, {"isotropic_hardening", 3e5}}, drucker_prager_surface, false},
    {"cone, associated, isotropic hardening", "drucker_prager", {ELASTIC, {"cone_slope", 0.3}, {"cone_strength", 4e3}, {"flow_ratio", 1.0}, {"isotropic_hardening", 1e7}}, drucker_prager_surface, false},
    {"cone, contraction", "drucker_prager", {ELASTIC, {"friction_angle", 25.0}, {"cohesion", 2e3}, {"dilation_angle", -15.0}, {"isotropic_hardening", 2e5}, {"kinematic_hardening", 4e5}}, drucker_prager_surface, false},
    {"cone, contraction, no cohesion", "drucker_prager", {ELASTIC, {"friction_angle", 35.0}, {"flow_slope", -0.1}}, drucker_prager_surface, false},
    {"cap", "drucker_prager_cap", {ELASTIC, {"friction_angle", 25.0}, {"cone_strength", 4e3}, {"flow_ratio", 0.05}}, cap_surface, false},
    {"cap, no dilation", "drucker_prager_cap", {ELASTIC, {"friction_angle", 35.0}, {"cone_strength", 1.0}}, cap_surface, false},
    {"cap, associated", "drucker_prager_cap", {ELASTIC, {"cone_slope", 0.4}, {"cone_strength", 4e3}, {"flow_slope", 0.4}}, cap_surface, false},
    {"cap, contraction", "drucker_prager_cap", {ELASTIC, {"friction_angle", 25.0}, {"cone_strength", 4e3}, {"dilation_angle", -15.0}}, cap_surface, false},
    {"mobilised, softening", "drucker_prager_mobilised", {ELASTIC, SOFTENING, {"friction.a5", 200.0}, {"cohesion", 1e3}}, mobilised_cone, true},
    {"mobilised, no dilation", "drucker_prager_mobilised", {ELASTIC, {"friction_angle", 30.0}}, mobilised_cone, true},
    {"mobilised, contraction", "drucker_prager_mobilised", {ELASTIC, {"friction_angle", 30.0}, {"dilation_angle", -20.0}, {"cohesion", 1e3}}, mobilised_cone, true},
    {"mobilised, constant dilation", "drucker_prager_mobilised", {ELASTIC, SOFTENING, {"dilation_angle", 25.0}, {"apex_stress", 500.0}, {"friction.strain_measure", 2.0}}, mobilised_cone, true},
    {"mobilised, no friction", "drucker_prager_mobilised", {ELASTIC, {"friction_angle", 0.0}, {"dilation_angle", -10.0}}, mobilised_cone, true},
    {"matsuoka-nakai, no friction", "matsuoka_nakai", {ELASTIC, {"friction.a0", 0.0}, {"friction.a1", 2000.0}, {"friction.a3", 200.0}, {"friction.a5", 200.0}, {"apex_stress", 1e3}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, softening", "matsuoka_nakai", {ELASTIC, SOFTENING, {"friction.a5", 200.0}, {"cohesion", 1e3}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, no dilation", "matsuoka_nakai", {ELASTIC, {"friction_angle", 30.0}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, contraction", "matsuoka_nakai", {ELASTIC, {"friction_angle", 30.0}, {"dilation_angle", -20.0}, {"cohesion", 1e3}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, own potential, softening", "matsuoka_nakai", {ELASTIC, SOFTENING, {"friction.a5", 200.0}, {"cohesion", 1e3}, {"potential", 1.0}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, own potential, 10 degrees", "matsuoka_nakai", {ELASTIC, {"friction_angle", 35.0}, {"dilation_angle", 10.0}, {"potential", 1.0}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, own potential, associated", "matsuoka_nakai", {ELASTIC, {"friction_angle", 50.0}, {"dilation_angle", 50.0}, {"cohesion", 3e3}, {"potential", 1.0}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, own potential, steep", "matsuoka_nakai", {ELASTIC, {"friction_angle", 80.0}, {"dilation_angle", 70.0}, {"potential", 1.0}}, matsuoka_nakai_surface, true},
    {"matsuoka-nakai, own potential, least", "matsuoka_nakai", {{"density", 2000.0}, {"bulk_modulus", 1e9}, {"shear_modulus", 1e6}, {"friction_angle", 30.0}, {"dilation_angle", 1.0}, {"cohesion", 1e3}, {"potential", 1.0}}, matsuoka_nakai_surface, true},
    {"mohr-coulomb", "mohr_coulomb", {ELASTIC, {"friction_angle", 30.0}, {"dilation_angle", 10.0}, {"cohesion", 3e3}}, mohr_coulomb_surface, true},
    {"mohr-coulomb, associated", "mohr_coulomb", {ELASTIC, {"friction_angle", 40.0}, {"dilation_angle", 40.0}, {"cohesion", 3e3}, {"tensile_strength", 1e3}}, mohr_coulomb_surface, true},
    {"mohr-coulomb, no cohesion", "mohr_coulomb", {ELASTIC, {"friction_angle", 35.0}}, mohr_coulomb_surface, true},
    {"mohr-coulomb, no friction", "mohr_coulomb", {ELASTIC, {"friction_angle", 0.0}, {"cohesion", 3e3}, {"tensile_strength", 0.0}}, mohr_coulomb_surface, true},
    {"mohr-coulomb, softening", "mohr_coulomb", {ELASTIC, {"friction_angle", 35.0}, {"dilation_angle", 30.0}, {"cohesion", 3e3}, {"tensile_strength", 2e3}, {"residual_friction_angle", 20.0}, {"residual_cohesion", 0.0}, {"softening_rate", 30.0}}, mohr_coulomb_surface, true},
    {"mohr-coulomb, steep", "mohr_coulomb", {ELASTIC, {"friction_angle", 89.0}, {"cohesion", 3e3}}, mohr_coulomb_surface, true},
    {"tresca", "tresca", {ELASTIC, {"cohesion", 4e3}}, tresca_surface, true},
    {"tresca, softening", "tresca", {ELASTIC, {"cohesion", 4e3}, {"residual_cohesion", 0.0}, {"softening_rate", 30.0}}, tresca_surface, true},
};
/* clang-format on */
const size_t trial_model_count = LENGTH(trial_models);
