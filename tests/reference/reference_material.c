/* SPDX-License-Identifier: Apache-2.0 */
#include "reference_material.h"

#include "materials/material.h"
#include "yield_planes.h"

#include <math.h>
#include <string.h>

struct elastic {
    double bulk, shear;
};

double reference_value(const struct material *material, const double *values, const char *key)
{
    return values[material_parameter_index(material, key)];
}

static struct elastic read_elastic(const struct material *material, const double *values)
{
    return (struct elastic){reference_value(material, values, "bulk_modulus"),
                            reference_value(material, values, "shear_modulus")};
}

/* Principal stresses of principal strains: lambda tr(e) + 2 G e_A. */
static void principal_stress(struct elastic elastic, const double strain[3], double stress[3])
{
    const double lame = elastic.bulk - 2.0 / 3.0 * elastic.shear;
    const double volumetric = strain[0] + strain[1] + strain[2];
    for (int k = 0; k < 3; k++)
        stress[k] = lame * volumetric + 2.0 * elastic.shear * strain[k];
}

/* The inverse law. */
static void principal_strain(struct elastic elastic, const double stress[3], double strain[3])
{
    const double first = stress[0] + stress[1] + stress[2];
    for (int k = 0; k < 3; k++)
        strain[k] =
            first / (9.0 * elastic.bulk) + (stress[k] - first / 3.0) / (2.0 * elastic.shear);
}

static double first_invariant(const double s[3])
{
    return s[0] + s[1] + s[2];
}

/* Unit direction of the deviator, zero if there is none; returns |s|. */
static double deviator_direction(const double stress[3], double direction[3])
{
    const double mean = first_invariant(stress) / 3.0;
    double square = 0;
    for (int k = 0; k < 3; k++) {
        direction[k] = stress[k] - mean;
        square += direction[k] * direction[k];
    }
    const double norm = sqrt(square);
    for (int k = 0; k < 3; k++)
        direction[k] = norm > 0 ? direction[k] / norm : 0.0;
    return norm;
}

static void from_invariants(double first, double norm, const double direction[3], double stress[3])
{
    for (int k = 0; k < 3; k++)
        stress[k] = first / 3.0 + norm * direction[k];
}

static void linear_elastic_return(const struct material *material, const double *values,
                                  struct reference_history *history, double stress[3])
{
    (void)material;
    (void)values;
    (void)history;
    (void)stress;
}

/* Cone with a circle about the origin of the (I1, |s|) plane (Mast 2013, sec. 3.6.2). */
static void cap_return(const struct material *material, const double *values,
                       struct reference_history *history, double stress[3])
{
    (void)history;
    const struct elastic e = read_elastic(material, values);
    const double sine = sin(reference_value(material, values, "friction_angle") * M_PI / 180.0);
    const double slope = sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
    const double flow = slope * reference_value(material, values, "flow_ratio");
    const double strength = reference_value(material, values, "cone_strength");
    const double radius = strength / sqrt(1.0 + slope * slope);
    const double tangent_first = slope * strength / (1.0 + slope * slope);
    double n[3];
    const double norm = deviator_direction(stress, n), first = first_invariant(stress);
    const bool in_cone = norm + slope * first - strength <= 0;
    const bool in_circle = norm * norm + first * first <= radius * radius;
    if (first <= tangent_first ? in_cone : in_circle)
        return;
    const double multiplier =
        (norm + slope * first - strength) / (2.0 * e.shear + 9.0 * e.bulk * slope * flow);
    const double cone_first = first - 9.0 * e.bulk * flow * multiplier;
    if (cone_first <= tangent_first) {
        from_invariants(cone_first, norm - 2.0 * e.shear * multiplier, n, stress);
        return;
    }
    double low = 0, high = 1.0 / e.shear; /* |(I1, |s|)| decreases along the associated flow */
    double circle_first = first, circle_norm = norm;
    while (pow(first / (1.0 + 18.0 * e.bulk * high), 2) +
               pow(norm / (1.0 + 4.0 * e.shear * high), 2) >
           radius * radius)
        high *= 2;
    for (int iteration = 0; iteration < 200; iteration++) {
        const double middle = 0.5 * (low + high);
        circle_first = first / (1.0 + 18.0 * e.bulk * middle);
        circle_norm = norm / (1.0 + 4.0 * e.shear * middle);
        if (circle_first * circle_first + circle_norm * circle_norm > radius * radius)
            low = middle;
        else
            high = middle;
    }
    if (first > tangent_first && circle_first >= tangent_first)
        from_invariants(circle_first, circle_norm, n, stress);
    else
        from_invariants(tangent_first, strength / (1.0 + slope * slope), n, stress);
}

/* Mobilised angles at the start of the step (Mast 2013, eq. 3.112-3.119), as tangents. */
static void mobilised_tangents(const struct material *material, const double *values,
                               const struct reference_history *history, double *friction,
                               double *dilation)
{
    const double a0 = reference_value(material, values, "friction.a0");
    const double a1 = reference_value(material, values, "friction.a1");
    const double a2 = reference_value(material, values, "friction.a2");
    const double a3 = reference_value(material, values, "friction.a3");
    const double a4 = reference_value(material, values, "friction.a4");
    const double a5 = reference_value(material, values, "friction.a5");
    const double measure =
        reference_value(material, values, "friction.strain_scale") * history->measure;
    const double angle = a0 + (a1 * measure - a4) * exp(a2 * history->first - a3 * measure);
    const double critical = a0 - a4 * exp(-a5 * measure);
    *friction = tan(fmin(fmax(angle, 0), 89) * M_PI / 180.0);
    *dilation = *friction - tan(fmin(fmax(critical, 0), 89) * M_PI / 180.0);
}

static double outer_cone_slope(double tangent)
{
    const double sine = sin(atan(tangent));
    return sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
}

static double apex_invariant(const struct material *material, const double *values)
{
    const double a0 = reference_value(material, values, "friction.a0") * M_PI / 180.0;
    return 3.0 * reference_value(material, values, "cohesion") / tan(a0);
}

/* Cone and flat cut-off at the apex, both surfaces tried (Mast 2013, sec. 3.6.1, eq. 3.93-3.100
 * without hardening inside the step; the second is dropped if its multiplier is negative).
 * Contraction ends at I1 = 0 or at once under tension. */
static void mobilised_cone_return(const struct material *material, const double *values,
                                  struct reference_history *history, double stress[3])
{
    const struct elastic e = read_elastic(material, values);
    const double apex = apex_invariant(material, values);
    double friction, dilation, n[3];
    mobilised_tangents(material, values, history, &friction, &dilation);
    const double slope = outer_cone_slope(friction);
    const double flow = fmin(outer_cone_slope(dilation), slope);
    const double norm = deviator_direction(stress, n), first = first_invariant(stress);
    const double excess = norm + slope * (first - apex), above = first - apex;
    if (excess <= 0 && above <= 0)
        return;
    const double resistance = 2.0 * e.shear + 9.0 * e.bulk * slope * flow;
    const double multiplier = excess / resistance;
    const double cone_first = first - 9.0 * e.bulk * flow * multiplier;
    const double cone_norm = norm - 2.0 * e.shear * multiplier;
    const double stop = fmax(first, 0);
    if (flow < 0 && above < 0 && (resistance <= 0 || cone_first > stop)) {
        from_invariants(stop, slope * (apex - stop), n, stress);
        return;
    }
    /* With both surfaces active the first multiplier is |s|/(2 G). */
    if (above > 0 && above / (9.0 * e.bulk) >= fmax(flow, 0) * norm / (2.0 * e.shear))
        from_invariants(apex, 0, n, stress);
    else
        from_invariants(cone_first, cone_norm, n, stress);
}

/* Matsuoka-Nakai: all shifted principal stresses compressive and kappa I3 - I1 I2 <= 0. */
static bool matsuoka_nakai_admits(double kappa, double shift, const double stress[3])
{
    const double a = stress[0] - shift, b = stress[1] - shift, c = stress[2] - shift;
    if (a > 0 || b > 0 || c > 0)
        return false;
    return kappa * a * b * c - (a + b + c) * (a * b + b * c + c * a) <= 0;
}

/* Largest |s| / (3 c - I1) that is admissible in the direction n of the deviator. */
static double matsuoka_nakai_slope(double kappa, const double n[3])
{
    double low = 0, high = 3; /* sigma = -1 + r n leaves the compressive octant before r = 3 */
    for (int iteration = 0; iteration < 100; iteration++) {
        const double middle = 0.5 * (low + high);
        const double stress[3] = {middle * n[0] - 1, middle * n[1] - 1, middle * n[2] - 1};
        if (matsuoka_nakai_admits(kappa, 0, stress))
            low = middle;
        else
            high = middle;
    }
    return low / 3.0;
}

/* Along the straight line of the Drucker-Prager flow to the surface, by bisection (sec. 3.7). */
static void matsuoka_nakai_return(const struct material *material, const double *values,
                                  struct reference_history *history, double stress[3])
{
    const struct elastic e = read_elastic(material, values);
    const double shift = apex_invariant(material, values) / 3.0;
    double friction, dilation, n[3];
    mobilised_tangents(material, values, history, &friction, &dilation);
    const double kappa = 9.0 + 8.0 * friction * friction;
    const double norm = deviator_direction(stress, n), first = first_invariant(stress);
    if (matsuoka_nakai_admits(kappa, shift, stress))
        return;
    const double flow = fmin(outer_cone_slope(dilation), matsuoka_nakai_slope(kappa, n));
    double low = 0, high = norm / (2.0 * e.shear);
    if (first - 9.0 * e.bulk * fmax(flow, 0) * high >= 3.0 * shift) {
        from_invariants(3.0 * shift, 0, n, stress);
        return;
    }
    for (int iteration = 0; iteration < 100; iteration++) {
        const double middle = 0.5 * (low + high);
        const double along = first - 9.0 * e.bulk * flow * middle;
        from_invariants(fmin(along, fmax(first, 0)), norm - 2.0 * e.shear * middle, n, stress);
        if (matsuoka_nakai_admits(kappa, shift, stress))
            high = middle;
        else
            low = middle;
    }
}

/* From peak to residual over the plastic shear strain at the start of the step. */
static double softened(const struct material *material, const double *values,
                       const struct reference_history *history, const char *peak,
                       const char *residual)
{
    const double top = reference_value(material, values, peak);
    const double rest = reference_value(material, values, residual);
    if (isnan(rest))
        return top;
    return rest + (top - rest) *
                      exp(-reference_value(material, values, "softening_rate") * history->shear);
}

static void tresca_return(const struct material *material, const double *values,
                          struct reference_history *history, double stress[3])
{
    const struct elastic e = read_elastic(material, values);
    const double cohesion = softened(material, values, history, "cohesion", "residual_cohesion");
    const struct yield_planes planes =
        yield_planes_of(e.bulk, e.shear, 0.0, 0.0, cohesion, INFINITY);
    (void)yield_planes_return(&planes, stress);
}

static void mohr_coulomb_return(const struct material *material, const double *values,
                                struct reference_history *history, double stress[3])
{
    const struct elastic e = read_elastic(material, values);
    const double cohesion = softened(material, values, history, "cohesion", "residual_cohesion");
    const double friction =
        softened(material, values, history, "friction_angle", "residual_friction_angle");
    const double dilation = reference_value(material, values, "dilation_angle");
    const double tension = reference_value(material, values, "tensile_strength");
    const double apex = cohesion / tan(friction * M_PI / 180.0);
    const struct yield_planes planes = yield_planes_of(
        e.bulk, e.shear, friction, fmin(dilation, friction), cohesion, fmin(tension, apex));
    (void)yield_planes_return(&planes, stress);
}

/* K ln J + G (l_k^2 - mean) J^(-2/3) of the principal stretches l; `stress` comes as the linear law
 * has it. */
static void neo_hookean_stress(struct elastic e, const double strain[3], double stress[3])
{
    const double mean = first_invariant(strain) / 3.0;
    double square[3];
    for (int k = 0; k < 3; k++)
        square[k] = expm1(2.0 * (strain[k] - mean)); /* l_k^2 - 1: only differences count */
    for (int k = 0; k < 3; k++)
        stress[k] = 3.0 * e.bulk * mean + e.shear * (square[k] - first_invariant(square) / 3.0);
}

/* A return in principal space, from the trial strain to the new elastic strain. */
static void update_principal(const struct material *material, const double *values,
                             struct reference_history *history, struct reference_update *update,
                             void (*stress_return)(const struct material *, const double *,
                                                   struct reference_history *, double *))
{
    const struct elastic e = read_elastic(material, values);
    struct spectrum strain = tensor_spectrum(update->strain), stress = strain;
    double trial[3], square = 0, work = 0, high = 0, low = 0;
    memcpy(trial, strain.value, sizeof trial);
    principal_stress(e, strain.value, stress.value);
    double before[3];
    memcpy(before, stress.value, sizeof before);
    stress_return(material, values, history, stress.value);
    if (memcmp(before, stress.value, sizeof before) != 0) {
        principal_strain(e, stress.value, strain.value);
        for (int k = 0; k < 3; k++) {
            const double increment = trial[k] - strain.value[k];
            square += increment * increment;
            high = k == 0 ? increment : fmax(high, increment);
            low = k == 0 ? increment : fmin(low, increment);
            work += stress.value[k] * increment;
        }
    }
    update->strain = tensor_from_spectrum(&strain);
    update->stress = tensor_from_spectrum(&stress);
    update->plastic = sqrt(square);
    update->dissipation = fmax(work, 0.0);
    history->measure += sqrt(square);
    history->shear += high - low;
    history->first = first_invariant(stress.value);
}

/* (1 - W dt/2)^-1 (1 + W dt/2): the rotation of a step (Hughes and Winget 1980). */
static struct tensor step_rotation(const struct reference_update *update)
{
    const struct tensor spin =
        tensor_scale(tensor_add(update->gradient, -1.0, tensor_transpose(update->gradient)),
                     0.25 * update->time_step);
    return tensor_product(tensor_inverse(tensor_add(tensor_unit(), -1.0, spin)),
                          tensor_add(tensor_unit(), 1.0, spin));
}

struct cone {
    double slope, flow, strength;
};

/* |eta| + slope I1 = strength + sqrt(2/3) k a_iso; J2 is a cone of slope 0. */
static struct cone read_cone(const struct material *material, const double *values)
{
    if (strcmp(material->name, "j2") == 0)
        return (struct cone){0, 0,
                             sqrt(2.0 / 3.0) * reference_value(material, values, "yield_stress")};
    const double angle = reference_value(material, values, "friction_angle") * M_PI / 180.0;
    const double factor = sqrt(2.0 / 3.0) / (3.0 - sin(angle));
    const double slope = 2.0 * factor * sin(angle);
    return (struct cone){slope, slope * reference_value(material, values, "flow_ratio"),
                         6.0 * factor * cos(angle) * reference_value(material, values, "cohesion")};
}

struct multipliers {
    double cone, apex;
};

/* Cone alone, or cone and apex where both multipliers are positive (Mast 2013, eq. 3.96-3.100; J21
 * with the term 2 k/(3 rho) of an apex that moves). */
static struct multipliers cone_multipliers(const struct cone *cone, struct elastic e, double k,
                                           double h, double strength, double norm, double first)
{
    const double excess = norm + cone->slope * first - strength;
    const double shear = 2.0 * e.shear + 2.0 / 3.0 * h;
    const double along = shear + 2.0 / 3.0 * k + 9.0 * e.bulk * cone->slope * cone->flow;
    struct multipliers multipliers = {fmax(excess, 0) / along, 0};
    if (cone->slope > 0 && first > strength / cone->slope) {
        const double a12 = 9.0 * e.bulk * cone->slope, a22 = 9.0 * e.bulk;
        const double a21 = 9.0 * e.bulk * cone->flow + 2.0 * k / (3.0 * cone->slope);
        const double beyond = first - strength / cone->slope;
        const double determinant = along * a22 - a12 * a21;
        const double second = (along * beyond - a21 * excess) / determinant;
        if (second > 0)
            multipliers = (struct multipliers){(a22 * excess - a12 * beyond) / determinant, second};
    }
    return multipliers;
}

/* Return about the back stress (Mast 2013, eq. 3.69-3.100); not coaxial with the strain, so with
 * whole tensors. */
static void update_hardening(const struct material *material, const double *values,
                             struct reference_history *history, struct reference_update *update)
{
    const struct elastic e = read_elastic(material, values);
    const struct cone cone = read_cone(material, values);
    const double k = reference_value(material, values, "isotropic_hardening");
    const double h = reference_value(material, values, "kinematic_hardening");
    if (update->finite_strain) {
        const struct tensor turn = step_rotation(update);
        history->kinematic =
            tensor_product(turn, tensor_product(history->kinematic, tensor_transpose(turn)));
    }
    struct tensor s = tensor_scale(tensor_deviator(update->strain), 2.0 * e.shear);
    const struct tensor eta = tensor_add(s, -2.0 / 3.0 * h, history->kinematic);
    const double norm = sqrt(tensor_dot(eta, eta));
    const double first = 3.0 * e.bulk * tensor_trace(update->strain);
    const double strength = cone.strength + sqrt(2.0 / 3.0) * k * history->isotropic;
    const struct multipliers m = cone_multipliers(&cone, e, k, h, strength, norm, first);
    update->plastic = update->dissipation = 0;
    if (m.cone > 0 || m.apex > 0) {
        const struct tensor n = tensor_scale(eta, norm > 0 ? 1.0 / norm : 0.0);
        const double spherical = cone.flow * m.cone + m.apex;
        s = tensor_add(s, -2.0 * e.shear * m.cone, n);
        update->strain =
            tensor_add(tensor_add(update->strain, -m.cone, n), -spherical, tensor_unit());
        history->kinematic = tensor_add(history->kinematic, m.cone, n);
        history->isotropic += sqrt(2.0 / 3.0) * m.cone;
        update->plastic = sqrt(m.cone * m.cone + 3.0 * spherical * spherical);
        const struct tensor left = tensor_add(s, -2.0 / 3.0 * h, history->kinematic);
        update->dissipation =
            tensor_dot(left, n) * m.cone + (first - 9.0 * e.bulk * spherical) * spherical;
    }
    update->stress = tensor_add(s, e.bulk * tensor_trace(update->strain), tensor_unit());
}

/* J2 and the cone that hardens, whose history is a tensor. */
static bool hardens(const struct material *material)
{
    return strcmp(material->name, "j2") == 0 || strcmp(material->name, "drucker_prager") == 0;
}

/* tau = K ln J 1 + 2 mu J d (Mast 2013, sec. 6.1). */
static void update_fluid(const struct material *material, const double *values,
                         struct reference_update *update)
{
    const double bulk = reference_value(material, values, "bulk_modulus");
    const double viscosity = reference_value(material, values, "viscosity");
    const struct tensor rate = tensor_symmetric(update->gradient);
    const double factor = 2.0 * viscosity * update->volume_ratio;
    update->stress =
        tensor_add(tensor_scale(rate, factor), bulk * update->strain.m[0][0], tensor_unit());
    update->plastic = 0;
    update->dissipation = factor * tensor_dot(rate, rate) * update->time_step;
}

static void update_neo_hookean(const struct material *material, const double *values,
                               struct reference_update *update)
{
    struct spectrum strain = tensor_spectrum(update->strain), stress = strain;
    neo_hookean_stress(read_elastic(material, values), strain.value, stress.value);
    update->stress = tensor_from_spectrum(&stress);
    update->plastic = update->dissipation = 0;
}

static const struct {
    const char *name;
    void (*stress_return)(const struct material *, const double *, struct reference_history *,
                          double *);
} principal_models[] = {
    {"linear_elastic", linear_elastic_return},
    {"drucker_prager_cap", cap_return},
    {"drucker_prager_mobilised", mobilised_cone_return},
    {"matsuoka_nakai", matsuoka_nakai_return},
    {"mohr_coulomb", mohr_coulomb_return},
    {"tresca", tresca_return},
};
enum { PRINCIPAL_COUNT = sizeof principal_models / sizeof principal_models[0] };

bool reference_material_known(const struct material *material)
{
    for (int index = 0; index < PRINCIPAL_COUNT; index++) {
        if (strcmp(principal_models[index].name, material->name) == 0)
            return true;
    }
    return hardens(material) || strcmp(material->name, "newtonian_fluid") == 0 ||
           strcmp(material->name, "neo_hookean") == 0;
}

void reference_material_update(const struct material *material, const double *values,
                               struct reference_history *history, struct reference_update *update)
{
    if (hardens(material)) {
        update_hardening(material, values, history, update);
    } else if (strcmp(material->name, "newtonian_fluid") == 0) {
        update_fluid(material, values, update);
    } else if (strcmp(material->name, "neo_hookean") == 0) {
        update_neo_hookean(material, values, update);
    } else {
        int index = 0;
        while (strcmp(principal_models[index].name, material->name) != 0)
            index++;
        update_principal(material, values, history, update, principal_models[index].stress_return);
    }
}

/* (tr b' - 3)/2 */
static double neo_hookean_shape(struct tensor deviator)
{
    const struct spectrum strain = tensor_spectrum(deviator);
    double sum = 0; /* of exp(2 e) - 1 - 2 e: the e add up to nothing */
    for (int k = 0; k < 3; k++) {
        const double x = 2.0 * strain.value[k];
        double term = 0.5 * x * x;
        for (int n = 3; n < 60; n++) {
            sum += term;
            term *= x / n;
        }
    }
    return 0.5 * sum;
}

double reference_material_energy(const struct material *material, const double *values,
                                 const struct reference_history *history, struct tensor strain)
{
    const double bulk = reference_value(material, values, "bulk_modulus");
    if (strcmp(material->name, "newtonian_fluid") == 0)
        return 0.5 * bulk * strain.m[0][0] * strain.m[0][0];
    const double shear = reference_value(material, values, "shear_modulus");
    const struct tensor deviator = tensor_deviator(strain);
    if (strcmp(material->name, "neo_hookean") == 0) /* tr b' - 3 by strains of any size */
        return 0.5 * bulk * tensor_trace(strain) * tensor_trace(strain) +
               shear * neo_hookean_shape(deviator);
    double energy = 0.5 * bulk * tensor_trace(strain) * tensor_trace(strain) +
                    shear * tensor_dot(deviator, deviator);
    if (hardens(material))
        energy += reference_value(material, values, "kinematic_hardening") / 3.0 *
                  tensor_dot(history->kinematic, history->kinematic);
    return energy;
}
