/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/cone_parameters.h"

#include "materials/cone.h"
#include "math/angle.h"

const char *const cone_fit_names[] = {"outer", "inner", "plane_strain", NULL};

/* Slope of the cone under a fit. */
static double read_slope(const double *values, enum cone_fit fit)
{
    return isnan(values[CONE_VALUE_CONE_SLOPE])
               ? cone_slope(fit, angle_radians(values[CONE_VALUE_FRICTION_ANGLE]))
               : values[CONE_VALUE_CONE_SLOPE];
}

/* Slope of the potential under a fit that is not a plane strain one. */
static double read_flow_slope(const double *values, enum cone_fit fit)
{
    if (!isnan(values[CONE_VALUE_FLOW_SLOPE]))
        return values[CONE_VALUE_FLOW_SLOPE];
    if (!isnan(values[CONE_VALUE_FLOW_RATIO]))
        return values[CONE_VALUE_FLOW_RATIO] * read_slope(values, fit);
    return cone_slope(fit, angle_radians(values[CONE_VALUE_DILATION_ANGLE]));
}

/* The fit that is meant: plane strain is two of them, told apart by the dilation. */
static enum cone_fit read_fit(const double *values)
{
    enum cone_fit fit = (enum cone_fit)values[CONE_VALUE_CONE_FIT];
    if (fit != CONE_FIT_PLANE_STRAIN)
        return fit;
    double slope = read_slope(values, CONE_FIT_PLANE_STRAIN_ASSOCIATED);
    double flow_slope = read_flow_slope(values, CONE_FIT_PLANE_STRAIN_ASSOCIATED);
    bool associated = slope > 0.0 && fabs(flow_slope - slope) <= 1e-9 * slope;
    return associated ? CONE_FIT_PLANE_STRAIN_ASSOCIATED : CONE_FIT_PLANE_STRAIN;
}

const char *cone_flow_key(const double *values)
{
    if (!isnan(values[CONE_VALUE_FLOW_SLOPE]))
        return "flow_slope";
    return isnan(values[CONE_VALUE_FLOW_RATIO]) ? "dilation_angle" : "flow_ratio";
}

void cone_check(const double *values, struct material_issues *issues)
{
    enum cone_fit fit = read_fit(values);
    double slope = read_slope(values, fit);
    double flow_slope = read_flow_slope(values, fit);
    struct elasticity elasticity = elasticity_read(values);

    if (slope >= cone_slope_limit(fit))
        material_issue_add(issues, "cone_slope", "limit",
                           "%s cones are less steep than %.4f (a friction angle of 90 degrees)",
                           cone_fit_names[(size_t)values[CONE_VALUE_CONE_FIT]],
                           cone_slope_limit(fit));
    if (fit == CONE_FIT_PLANE_STRAIN && flow_slope != 0.0)
        material_issue_add(issues, cone_flow_key(values), "contradiction",
                           "the plane_strain fit is known for dilation_angle 0 and for a dilation "
                           "angle equal to the friction angle only");
    else if (flow_slope > slope * (1.0 + 1e-9))
        material_issue_add(issues, cone_flow_key(values), "limit",
                           "dilation beyond the friction (rho_G %.4g > rho_F %.4g) would make "
                           "plastic flow a source of energy",
                           flow_slope, slope);
    if (2.0 * elasticity.shear + 9.0 * elasticity.bulk * slope * flow_slope <= 0.0)
        material_issue_add(issues, cone_flow_key(values), "limit",
                           "contraction is so strong that flow meets no yield surface: "
                           "2 G + 9 K rho_F rho_G must be positive");
}

struct cone cone_read(const double *values)
{
    enum cone_fit fit = read_fit(values);
    double slope = read_slope(values, fit);
    double strength = values[CONE_VALUE_CONE_STRENGTH];
    if (isnan(strength))
        strength = cone_strength(fit, cone_angle(fit, slope), values[CONE_VALUE_COHESION]);
    return (struct cone){
        .slope = slope, .flow_slope = read_flow_slope(values, fit), .strength = strength};
}

double cone_friction_angle_deg(const double *values)
{
    double slope = read_slope(values, read_fit(values));
    return angle_degrees(cone_angle(CONE_FIT_OUTER, slope));
}
