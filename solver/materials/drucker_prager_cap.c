/* SPDX-License-Identifier: Apache-2.0 */
/* Parameters of the capped cone; the return is in cap_return.h. */
#include "materials/cap_return.h"
#include "materials/cone.h"
#include "math/angle.h"

enum value {
    VALUE_FRICTION_ANGLE = ELASTICITY_VALUE_COUNT,
    VALUE_CONE_SLOPE,
    VALUE_COHESION,
    VALUE_CONE_STRENGTH,
    VALUE_DILATION_ANGLE,
    VALUE_FLOW_RATIO,
    VALUE_FLOW_SLOPE,
    VALUE_CONE_FIT,
};

static const char *const cone_fits[] = {"outer", "inner", "plane_strain", NULL};

static const struct parameter parameters[] = {
    {.key = "friction_angle",
     .symbol = "phi",
     .unit = "deg",
     .minimum = 0.0,
     .maximum = 90.0,
     .below_maximum = true,
     .required = true,
     .default_value = NAN,
     .alternative = "friction",
     .meaning = "Mohr-Coulomb friction angle that cone_fit matches"},
    {.key = "cone_slope",
     .symbol = "rho_F",
     .unit = "1",
     .minimum = 0.0,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "friction",
     .meaning = "slope of the cone |s| + rho_F I1 = mu"},
    {.key = "cohesion",
     .symbol = "c",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "strength",
     .meaning = "Mohr-Coulomb cohesion that cone_fit matches"},
    {.key = "cone_strength",
     .symbol = "mu",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "strength",
     .meaning = "norm of the deviatoric stress that the cone allows at zero mean stress"},
    {.key = "dilation_angle",
     .symbol = "psi",
     .unit = "deg",
     .minimum = -90.0,
     .above_minimum = true,
     .maximum = 90.0,
     .below_maximum = true,
     .default_value = 0.0,
     .alternative = "flow",
     .meaning = "dilation angle that cone_fit matches; at most the friction angle"},
    {.key = "flow_ratio",
     .symbol = "rho_G/rho_F",
     .unit = "1",
     .minimum = -INFINITY,
     .maximum = 1.0,
     .default_value = NAN,
     .alternative = "flow",
     .meaning = "slope of the flow potential over slope of the cone"},
    {.key = "flow_slope",
     .symbol = "rho_G",
     .unit = "1",
     .minimum = -INFINITY,
     .maximum = INFINITY,
     .default_value = NAN,
     .alternative = "flow",
     .meaning = "slope of the flow potential; at most that of the cone"},
    {.key = "cone_fit",
     .symbol = "",
     .unit = "1",
     .kind = PARAMETER_CHOICE,
     .minimum = 0.0,
     .maximum = 2.0,
     .default_value = 0.0,
     .choices = cone_fits,
     .meaning =
         "where the cone meets Mohr-Coulomb: triaxial compression (outer), extension (inner) "
         "or plane strain (dilation angle 0 or equal to the friction angle only)"},
    {.key = NULL},
};

/* Slope of the cone under a fit. */
static double read_slope(const double *values, enum cone_fit fit)
{
    return isnan(values[VALUE_CONE_SLOPE])
               ? cone_slope(fit, angle_radians(values[VALUE_FRICTION_ANGLE]))
               : values[VALUE_CONE_SLOPE];
}

/* Slope of the potential under a fit that is not a plane strain one. */
static double read_flow_slope(const double *values, enum cone_fit fit)
{
    if (!isnan(values[VALUE_FLOW_SLOPE]))
        return values[VALUE_FLOW_SLOPE];
    if (!isnan(values[VALUE_FLOW_RATIO]))
        return values[VALUE_FLOW_RATIO] * read_slope(values, fit);
    return cone_slope(fit, angle_radians(values[VALUE_DILATION_ANGLE]));
}

/* The fit that is meant: plane strain is two of them, told apart by the dilation. */
static enum cone_fit read_fit(const double *values)
{
    enum cone_fit fit = (enum cone_fit)values[VALUE_CONE_FIT];
    if (fit != CONE_FIT_PLANE_STRAIN)
        return fit;
    double slope = read_slope(values, CONE_FIT_PLANE_STRAIN_ASSOCIATED);
    double flow_slope = read_flow_slope(values, CONE_FIT_PLANE_STRAIN_ASSOCIATED);
    bool associated = slope > 0.0 && fabs(flow_slope - slope) <= 1e-9 * slope;
    return associated ? CONE_FIT_PLANE_STRAIN_ASSOCIATED : CONE_FIT_PLANE_STRAIN;
}

static const char *flow_key(const double *values)
{
    if (!isnan(values[VALUE_FLOW_SLOPE]))
        return "flow_slope";
    return isnan(values[VALUE_FLOW_RATIO]) ? "dilation_angle" : "flow_ratio";
}

static void check_flow(const double *values, struct material_issues *issues)
{
    enum cone_fit fit = read_fit(values);
    double slope = read_slope(values, fit);
    double flow_slope = read_flow_slope(values, fit);
    struct elasticity elasticity = elasticity_read(values);

    if (slope >= cone_slope_limit(fit))
        material_issue_add(issues, "cone_slope", "range",
                           "%s cones are less steep than %.4f (a friction angle of 90 degrees)",
                           cone_fits[(size_t)values[VALUE_CONE_FIT]], cone_slope_limit(fit));
    if (fit == CONE_FIT_PLANE_STRAIN && flow_slope != 0.0)
        material_issue_add(issues, flow_key(values), "contradiction",
                           "the plane_strain fit is known for dilation_angle 0 and for a dilation "
                           "angle equal to the friction angle only");
    else if (flow_slope > slope * (1.0 + 1e-9))
        material_issue_add(issues, flow_key(values), "range",
                           "dilation beyond the friction (rho_G %.4g > rho_F %.4g) would make "
                           "plastic flow a source of energy",
                           flow_slope, slope);
    if (2.0 * elasticity.shear + 9.0 * elasticity.bulk * slope * flow_slope <= 0.0)
        material_issue_add(issues, flow_key(values), "range",
                           "contraction is so strong that flow meets no yield surface: "
                           "2 G + 9 K rho_F rho_G must be positive");
}

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    elasticity_check(values, &issues);
    if (issues.count == 0)
        check_flow(values, &issues);
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct cap *cap = constants;
    enum cone_fit fit = read_fit(values);
    double slope = read_slope(values, fit);
    double strength = values[VALUE_CONE_STRENGTH];
    if (isnan(strength))
        strength = cone_strength(fit, cone_angle(fit, slope), values[VALUE_COHESION]);

    double square = 1.0 + slope * slope;
    *cap = (struct cap){
        .elasticity = elasticity_read(values),
        .slope = slope,
        .flow_slope = read_flow_slope(values, fit),
        .strength = strength,
        .radius = strength / sqrt(square),
        .tangent_invariant = slope * strength / square,
        .tangent_norm = strength / square,
    };
}

static double wave_speed(const void *constants)
{
    const struct cap *cap = constants;
    return elasticity_wave_speed(&cap->elasticity);
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct cap *cap = constants;
    return MATERIAL_INSTANTIATE(cap_update_stress, cap, batch);
}

static void strain_energy(const void *constants, const struct material_batch *batch, real *energy)
{
    const struct cap *cap = constants;
    elasticity_strain_energy(&cap->elasticity, batch, energy);
}

static void strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                               double strain[SYM3_COMPONENTS])
{
    const struct cap *cap = constants;
    elasticity_strain_from_stress(&cap->elasticity, stress, strain);
}

static double initial_friction_angle_deg(const double *values)
{
    double slope = read_slope(values, read_fit(values));
    return angle_degrees(cone_angle(CONE_FIT_OUTER, slope));
}

const struct material drucker_prager_cap = {
    .name = "drucker_prager_cap",
    .reference = "Mast 2013, sec. 3.6.2, after Swan and Seo 1999 (eq. 3.101 corrected)",
    .summary = "Drucker-Prager cone, perfectly plastic, closed by a circular cap in tension",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .constants_size = sizeof(struct cap),
    .check = check,
    .prepare = prepare,
    .wave_speed = wave_speed,
    .update_stress = update_stress,
    .strain_energy = strain_energy,
    .strain_from_stress = strain_from_stress,
    .initial_friction_angle_deg = initial_friction_angle_deg,
};
