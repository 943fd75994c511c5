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

/* (cos(2/3 acos(h)) - 1/2) / h for 0 <= h <= 1 within 6e-9 of itself: interpolated at Chebyshev's
 * nodes. */
TALUS_INLINE real root_polynomial(real h)
{
    const real c0 = (real)0.5773502661742581;
    const real c1 = (real)-0.1111106201233669;
    const real c2 = (real)0.05344492503753065;
    const real c3 = (real)-0.03277693653966827;
    const real c4 = (real)0.02206028030351269;
    const real c5 = (real)-0.01441198482897398;
    const real c6 = (real)0.0077827227005653;
    const real c7 = (real)-0.002827966994270052;
    const real c8 = (real)0.0004893159269461952;
    return c0 + h * (c1 + h * (c2 + h * (c3 + h * (c4 + h * (c5 + h * (c6 + h * (c7 + h * c8)))))));
}

/* With a = sqrt((kappa - 3)/6) the root is w = 2 a z, where 4 z^3 - 3 z = q and
 * q = kappa sqrt(kappa - 9) t / (2 a^3) lies in -1 ... 1: z = cos(acos(q)/3) = 1/2 + h P(h) with
 * h = sqrt((1 + q)/2). The polynomial for P is followed by one step of Newton's method, written for
 * 1/z and freed of 0/0 at h = 0, where two roots meet (friction angles towards 90 degrees). */
static void surface_slopes(size_t count, const real *tangents, const struct invariants *invariants,
                           real *slopes)
{
    const real q_factor = (real)20.784609690826528;    /* 6 sqrt(6) sqrt(2) */
    const real slope_factor = (real)6.928203230275509; /* 2 sqrt(2) sqrt(6) */
    MATERIAL_ALIGNED real size[MATERIAL_CHUNK];        /* sqrt(kappa - 9) / a */
    MATERIAL_ALIGNED real root[MATERIAL_CHUNK];        /* h */
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real tangent = tangents[index];
        real square = tangent * tangent;
        real norm = invariants->norm[index];
        norm = norm > 0 ? norm : 1;
        real inverse = 1 / (norm * real_sqrt(6 + 8 * square)); /* 1 / (sqrt(6) a |s|) */
        real third = invariants->determinant[index] * inverse * inverse * inverse;
        real q = q_factor * tangent * (9 + 8 * square) * third;
        /* the bounds hold round-off of tiny stresses off */
        root[index] = real_sqrt(maximum(minimum((real)0.5 + (real)0.5 * q, 1), 0));
        size[index] = slope_factor * tangent * norm * inverse;
    }
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real h = root[index];
        real p = root_polynomial(h);
        real d = h * p;                                              /* z - 1/2 */
        real newton = p * (1 + d) / (h + p * (3 + d * (6 + 4 * d))); /* 1 / (6 z) */
        slopes[index] = size[index] * newton;
    }
}

TALUS_INLINE bool update_stress_kernel(const struct mobilised *mobilised,
                                       const struct material_batch *batch, size_t components)
{
    return mobilised_update(mobilised, batch, components, surface_slopes, true);
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct mobilised *mobilised = constants;
    return MATERIAL_INSTANTIATE(update_stress_kernel, mobilised, batch);
}

const struct material matsuoka_nakai = {
    .name = "matsuoka_nakai",
    .reference = "Mast 2013, sec. 3.7 and eq. 3.112-3.120",
    .summary = "Matsuoka-Nakai yield with mobilised friction and Drucker-Prager flow",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
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
