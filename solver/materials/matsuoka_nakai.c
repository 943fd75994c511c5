/* SPDX-License-Identifier: Apache-2.0 */
/* Matsuoka-Nakai yield with the Drucker-Prager potential (Mast 2013, sec. 3.7).
 *
 * With sb = sigma - c 1 and kappa = 9 + 8 tan^2 phi, F = 6 (kappa det sb - I1b I2b); in terms of
 * P = -tr(sb)/3 > 0, r = |s| and t = det(s)/r^3
 *
 *   F / (6 P^3) = kappa t u^3 + (kappa - 3)/2 u^2 - (kappa - 9),      u = r/P.
 *
 * F < 0 also holds where two principal stresses are tensile. At the border of the octant where all
 * are compressive one of them vanishes and F = -6 I1b I2b > 0; the admissible set is therefore u
 * between 0 and the smallest positive root u*, and that root is unique in the octant. The flow of
 * the potential keeps the direction of s, hence t, hence u*: along the return the surface is a
 * straight cone |s| = (u* / 3) (3 c - I1), and its return is the closed form for that slope. With
 * u = sqrt(kappa - 9)/w the root is the largest one of
 *
 *   w^3 - (kappa - 3)/2 w - kappa sqrt(kappa - 9) t = 0                        (derived here)
 *
 * which all of kappa >= 9 shares without a special case (kappa = 9: u* = 0). */
#include "materials/mobilised.h"

enum { VALUE_POTENTIAL = MOBILISED_VALUE_COUNT };

static const char *const potentials[] = {"drucker_prager", NULL};
static const char *const reserved_potentials[] = {"matsuoka_nakai", NULL};

static const struct parameter parameters[] = {
#include "materials/mobilised_parameters.def"
    {.key = "potential",
     .symbol = "",
     .unit = "1",
     .kind = PARAMETER_CHOICE,
     .minimum = 0.0,
     .maximum = 0.0,
     .default_value = 0.0,
     .choices = potentials,
     .reserved_choices = reserved_potentials,
     .meaning = "surface whose normal is the direction of plastic flow"},
    {.key = NULL},
};

/* cos(2/3 acos(s)) for 0 <= s <= 1 within 4e-4: its Taylor series at 0, closed so that s = 1 is
 * met. */
TALUS_INLINE double cosine_of_two_thirds(double s)
{
    const double c1 = 0.5773502691896258;
    const double c2 = -0.1111111111111111;
    const double c3 = 0.05345835825829868;
    const double c4 = -0.03292181069958848;
    const double c5 = 0.01322429436277528;
    return 0.5 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
}

/* Slope |s| / (3 c - I1) of the surface in the direction of a deviator with third invariant
 * `third` = det(s)/|s|^3. The root is 2 a cos(acos(q)/3); the polynomial for it is most accurate
 * where two roots meet (q = -1, friction angles towards 90 degrees), and Newton's iteration makes
 * it exact. */
TALUS_INLINE double surface_slope(double tangent, double third)
{
    enum { ITERATIONS = 3 };
    double root = 2.0 * sqrt(2.0) * tangent; /* sqrt(kappa - 9) */
    double kappa = 9.0 + root * root;
    double linear = 0.5 * (kappa - 3.0);
    double constant = kappa * root * third;
    double a = sqrt(linear / 3.0);
    double q = constant / (2.0 * a * a * a);
    double w = 2.0 * a * cosine_of_two_thirds(sqrt(maximum(0.5 + 0.5 * q, 0.0)));
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        double square = w * w;
        w -= ((square - linear) * w - constant) / (3.0 * square - linear);
    }
    return root / (3.0 * w);
}

TALUS_INLINE void update_stress_kernel(const struct mobilised *mobilised,
                                       const struct material_batch *batch, size_t components)
{
    struct invariants invariants;
    struct mobilised_angles angles;
    for (size_t begin = 0; begin < batch->count; begin += MATERIAL_CHUNK) {
        size_t left = batch->count - begin;
        size_t count = left < MATERIAL_CHUNK ? left : MATERIAL_CHUNK;
        double slope[MATERIAL_CHUNK];
        double flow_slope[MATERIAL_CHUNK];
        mobilised_angles_at_start(mobilised, batch, begin, count, &angles);
        invariants_of_trial(&mobilised->elasticity, batch, components, begin, count, true,
                            &invariants);
#pragma omp simd
        for (size_t index = 0; index < count; index++) {
            slope[index] = surface_slope(angles.tangent[index], invariants.third[index]);
            flow_slope[index] = mobilised_cone_slope(angles.flow_tangent[index]);
        }
        mobilised_return(mobilised, count, slope, flow_slope, &invariants);
        invariants_apply(&mobilised->elasticity, batch, components, begin, count, &invariants);
        mobilised_advance(mobilised, batch, begin, count, &invariants);
    }
}

static void update_stress(const void *constants, const struct material_batch *batch)
{
    const struct mobilised *mobilised = constants;
    MATERIAL_INSTANTIATE(update_stress_kernel, mobilised, batch);
}

const struct material matsuoka_nakai = {
    .name = "matsuoka_nakai",
    .reference = "Mast 2013, sec. 3.7 and eq. 3.112-3.120",
    .summary = "Matsuoka-Nakai yield with mobilised friction and Drucker-Prager flow",
    .parameters = parameters,
    .plastic = true,
    .state_count = MOBILISED_STATE_COUNT,
    .state_names = mobilised_state_names,
    .constants_size = sizeof(struct mobilised),
    .check = mobilised_check,
    .prepare = mobilised_prepare,
    .wave_speed = mobilised_wave_speed,
    .initialise = mobilised_initialise,
    .update_stress = update_stress,
    .strain_energy = mobilised_strain_energy,
    .strain_from_stress = mobilised_strain_from_stress,
    .initial_friction_angle_deg = mobilised_initial_friction_angle_deg,
};
