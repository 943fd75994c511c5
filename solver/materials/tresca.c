/* SPDX-License-Identifier: Apache-2.0 */
/* Mohr and Coulomb's planes without friction: s1 - s3 <= 2 c, no apex, flow at constant volume. */
#include "materials/multi_surface.h"
#include "materials/softening.h"

struct tresca {
    struct elasticity elasticity;
    struct decay cohesion; /* [Pa] */
    struct softening softening;
};
ELASTICITY_COMES_FIRST(struct tresca);

enum value {
    VALUE_COHESION = ELASTICITY_VALUE_COUNT,
    VALUE_RESIDUAL_COHESION,
    VALUE_SOFTENING_RATE,
};

static const struct parameter parameters[] = {
    {.key = "cohesion",
     .symbol = "c",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .meaning = "undrained strength: the largest shear stress"},
#include "materials/softening_parameters.def"
    {.key = NULL},
};

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    const double residual = values[VALUE_RESIDUAL_COHESION];
    elasticity_check(values, &issues);
    decay_check("residual_cohesion", values[VALUE_COHESION], residual, &issues);
    softening_check(!isnan(residual), values[VALUE_SOFTENING_RATE], &issues);
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct tresca *tresca = constants;
    *tresca = (struct tresca){
        .elasticity = elasticity_read(values),
        .cohesion = decay_read(values[VALUE_COHESION], values[VALUE_RESIDUAL_COHESION]),
        .softening = softening_read(values[VALUE_SOFTENING_RATE]),
    };
}

static void surfaces_of(const void *model, const real *shear, size_t count,
                        struct surfaces *surfaces)
{
    const struct tresca *tresca = model;
    const real residual = (real)(2.0 * tresca->cohesion.residual);
    const real drop = (real)(2.0 * tresca->cohesion.drop);
    MATERIAL_ALIGNED real share[MATERIAL_CHUNK];
    count = whole_rows(count);
    const bool softened = softening_shares(&tresca->softening, shear, count, share);
    for (size_t index = 0; index < count; index++) {
        surfaces->slope[index] = surfaces->flow[index] = 1;
        surfaces->strength[index] = residual + drop * (softened ? share[index] : 1);
        surfaces->limit[index] = (real)INFINITY;
    }
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct tresca *tresca = constants;
    return multi_surface_update(&tresca->elasticity, batch, surfaces_of, tresca, batch->history[0]);
}

const struct material tresca = {
    .name = "tresca",
    .reference = "Andersen and Andersen 2012, eq. 45-48 with phi = 0",
    .summary = "largest shear stress (undrained clay), from a peak to a residual strength",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .state_count = 1,
    .state_names = softening_state_names,
    .constants_size = sizeof(struct tresca),
    .check = check,
    .prepare = prepare,
    .wave_speed = elasticity_wave_speed,
    .update_stress = update_stress,
    .strain_energy = elasticity_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
};
