/* SPDX-License-Identifier: Apache-2.0 */
#include "reference_material.h"

#include "materials/material.h"

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
 * without hardening inside the step; the second is dropped if its multiplier is negative). */
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
    bool apex_active;
    if (flow >= 0) {
        /* With both surfaces active the first multiplier is |s|/(2 G). */
        const double second = above / (9.0 * e.bulk) - flow * norm / (2.0 * e.shear);
        apex_active = above > 0 && second >= 0;
    } else {
        apex_active = !(resistance > 0 && cone_norm >= 0 && cone_first <= apex);
    }
    if (apex_active)
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
    if (first - 9.0 * e.bulk * flow * high >= 3.0 * shift) {
        from_invariants(3.0 * shift, 0, n, stress);
        return;
    }
    for (int iteration = 0; iteration < 100; iteration++) {
        const double middle = 0.5 * (low + high);
        from_invariants(first - 9.0 * e.bulk * flow * middle, norm - 2.0 * e.shear * middle, n,
                        stress);
        if (matsuoka_nakai_admits(kappa, shift, stress))
            high = middle;
        else
            low = middle;
    }
}

/* A return in principal space, from the trial strain to the new elastic strain. */
static void update_principal(const struct material *material, const double *values,
                             struct reference_history *history, struct reference_update *update,
                             void (*stress_return)(const struct material *, const double *,
                                                   struct reference_history *, double *))
{
    const struct elastic e = read_elastic(material, values);
    struct spectrum strain = tensor_spectrum(update->strain), stress = strain;
    double trial[3], square = 0, work = 0;
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
            work += stress.value[k] * increment;
        }
    }
    update->strain = tensor_from_spectrum(&strain);
    update->stress = tensor_from_spectrum(&stress);
    update->plastic = sqrt(square);
    update->dissipation = fmax(work, 0.0);
    history->measure += sqrt(square);
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

/* Radial return about the back stress (Mast 2013, eq. 3.69-3.83); not coaxial with the strain, so
 * with whole tensors. */
static void update_j2(const struct material *material, const double *values,
                      struct reference_history *history, struct reference_update *update)
{
    const struct elastic e = read_elastic(material, values);
    const double yield = reference_value(material, values, "yield_stress");
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
    const double excess = norm - sqrt(2.0 / 3.0) * (yield + k * history->isotropic);
    update->plastic = update->dissipation = 0;
    if (excess > 0) {
        const double multiplier = excess / (2.0 * e.shear + 2.0 / 3.0 * (h + k));
        const struct tensor n = tensor_scale(eta, 1.0 / norm);
        s = tensor_add(s, -2.0 * e.shear * multiplier, n);
        update->strain = tensor_add(update->strain, -multiplier, n);
        history->kinematic = tensor_add(history->kinematic, multiplier, n);
        history->isotropic += sqrt(2.0 / 3.0) * multiplier;
        update->plastic = multiplier;
        const struct tensor left = tensor_add(s, -2.0 / 3.0 * h, history->kinematic);
        update->dissipation = sqrt(tensor_dot(left, left)) * multiplier;
    }
    update->stress = tensor_add(s, e.bulk * tensor_trace(update->strain), tensor_unit());
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

static const struct {
    const char *name;
    void (*stress_return)(const struct material *, const double *, struct reference_history *,
                          double *);
} principal_models[] = {
    {"linear_elastic", linear_elastic_return},
    {"drucker_prager_cap", cap_return},
    {"drucker_prager_mobilised", mobilised_cone_return},
    {"matsuoka_nakai", matsuoka_nakai_return},
};
enum { PRINCIPAL_COUNT = sizeof principal_models / sizeof principal_models[0] };

bool reference_material_known(const struct material *material)
{
    for (int index = 0; index < PRINCIPAL_COUNT; index++) {
        if (strcmp(principal_models[index].name, material->name) == 0)
            return true;
    }
    return strcmp(material->name, "j2") == 0 || strcmp(material->name, "newtonian_fluid") == 0;
}

void reference_material_update(const struct material *material, const double *values,
                               struct reference_history *history, struct reference_update *update)
{
    if (strcmp(material->name, "j2") == 0) {
        update_j2(material, values, history, update);
    } else if (strcmp(material->name, "newtonian_fluid") == 0) {
        update_fluid(material, values, update);
    } else {
        int index = 0;
        while (strcmp(principal_models[index].name, material->name) != 0)
            index++;
        update_principal(material, values, history, update, principal_models[index].stress_return);
    }
}

double reference_material_energy(const struct material *material, const double *values,
                                 const struct reference_history *history, struct tensor strain)
{
    const double bulk = reference_value(material, values, "bulk_modulus");
    if (strcmp(material->name, "newtonian_fluid") == 0)
        return 0.5 * bulk * strain.m[0][0] * strain.m[0][0];
    const double shear = reference_value(material, values, "shear_modulus");
    const struct tensor deviator = tensor_deviator(strain);
    double energy = 0.5 * bulk * tensor_trace(strain) * tensor_trace(strain) +
                    shear * tensor_dot(deviator, deviator);
    if (strcmp(material->name, "j2") == 0)
        energy += reference_value(material, values, "kinematic_hardening") / 3.0 *
                  tensor_dot(history->kinematic, history->kinematic);
    return energy;
}
