/* SPDX-License-Identifier: Apache-2.0 */
/* Random trial steps of every plastic model, from virgin, hardened and softened states: strain
 * increments from 1e-8 to 10 in every direction, hydrostatic and triaxial ones among them. Every
 * return must be finite and on the surface, take energy and never give it, turn with the material,
 * and leave nothing to a second return. Tolerances are relative to the trial: 1e-8 of its stress or
 * strain, what an iterated return may leave; dissipation to 1e-12 of its energy, round-off alone.
 *
 * TALUS_FULL=1 in the environment makes a million trials of each row instead of 20,000. */
#include "trial_models.h"

#include "math/eigen.h"

enum { BATCH = 512, STATES = 16 };
static const double tolerance = 1e-8;
static const double energy_tolerance = 1e-12;

struct trials { /* a batch of steps from a start to a returned state */
    const struct trial_model *model;
    struct fixture fixture;
    double bulk, shear; /* K, G [Pa] */
    struct slots slots, turned;
    double start_history[STATES][BATCH], end_history[STATES][BATCH];
    struct sym3 trial[BATCH];  /* elastic trial strain */
    struct sym3 stress[BATCH]; /* returned */
    double plastic_strain[BATCH], dissipation[BATCH];
    size_t flow_count, elastic_count;
};

static bool is_full(void)
{
    const char *full = getenv("TALUS_FULL");
    return full != NULL && strcmp(full, "1") == 0;
}

static void history_copy(double to[STATES][BATCH], double *const from[STATES], size_t state_count)
{
    for (size_t index = 0; index < state_count; index++)
        memcpy(to[index], from[index], sizeof to[index]);
}

static void history_restore(const struct trials *trials, struct slots *slots,
                            const double from[STATES][BATCH])
{
    for (size_t index = 0; index < trials->fixture.material->state_count; index++)
        memcpy(slots->history[index], from[index], sizeof from[index]);
}

static struct sym3 random_tensor(uint64_t *state)
{
    return (struct sym3){random_value(state), random_value(state), random_value(state),
                         random_value(state), random_value(state), random_value(state)};
}

/* A direction of an increment: one of a few kinds, with components up to about 1. */
static struct sym3 random_direction(int kind, struct sym3 start, uint64_t *state)
{
    struct sym3 tensor = random_tensor(state);
    double axial = random_value(state);
    double lateral = random_value(state);
    switch (kind) {
    case 0: /* towards the apex and beyond */
        return sym3_add_diagonal(tensor, 1.0 + axial);
    case 1:
        return sym3_add_diagonal(tensor, -1.0 + axial);
    case 2:
        return (struct sym3){.xx = lateral, .yy = lateral, .zz = axial};
    case 3:
        return (struct sym3){.xx = axial, .xy = lateral};
    case 4:
        return (struct sym3){.xx = axial, .yy = axial, .zz = axial};
    case 5: { /* back, through the start and beyond */
        double norm = sym3_norm(start);
        return sym3_scale(-1.0 / (norm > 0.0 ? norm : 1.0), start);
    }
    default:
        return tensor;
    }
}

static void add_increments(struct slots *slots, double exponent, double spread, uint64_t *state)
{
    for (size_t slot = 0; slot < BATCH; slot++) {
        struct sym3 start = slots_get(slots->batch.strain, slot);
        double size = pow(10.0, exponent + spread * random_value(state));
        struct sym3 direction = random_direction((int)(slot % 8), start, state);
        slots_set(slots->batch.strain, slot, sym3_add_scaled(start, size, direction));
    }
}

static void start_virgin(struct trials *trials)
{
    const struct material *material = trials->fixture.material;
    double history[STATES] = {0};
    if (material->initialise != NULL)
        material->initialise(trials->fixture.constants, NULL, history);
    for (size_t slot = 0; slot < BATCH; slot++) {
        slots_set(trials->slots.batch.strain, slot, (struct sym3){0});
        for (size_t index = 0; index < material->state_count; index++)
            trials->slots.history[index][slot] = history[index];
    }
}

/* Up to three steps of a size that moves through hardening and softening, then the trial. */
static void make_trials(struct trials *trials, size_t preparation_count, uint64_t *state)
{
    const struct material *material = trials->fixture.material;
    struct slots *slots = &trials->slots;
    start_virgin(trials);
    for (size_t step = 0; step < preparation_count; step++) {
        add_increments(slots, -3.5, 1.5, state);
        material->update_stress(trials->fixture.constants, &slots->batch);
    }
    history_copy(trials->start_history, slots->history, material->state_count);
    add_increments(slots, -3.5, 4.5, state);
    for (size_t slot = 0; slot < BATCH; slot++)
        trials->trial[slot] = slots_get(slots->batch.strain, slot);
}

/* |sigma| of the elastic trial. */
static double trial_stress(const struct trials *trials, size_t slot)
{
    struct sym3 strain = trials->trial[slot];
    double deviator = 2.0 * trials->shear * sym3_norm(sym3_deviator(strain));
    return hypot(deviator, sqrt(3.0) * trials->bulk * sym3_trace(strain));
}

static void fail_slot(const struct trials *trials, size_t slot, const char *what, double value,
                      double limit)
{
    struct sym3 e = trials->trial[slot];
    fail_msg("%s: %s %.3g beyond %.3g, trial strain %.17g %.17g %.17g %.17g %.17g %.17g",
             trials->model->label, what, value, limit, e.xx, e.yy, e.zz, e.xy, e.yz, e.xz);
}

/* The comparison is false for NaN. */
static void check_limit(const struct trials *trials, size_t slot, const char *what, double value,
                        double limit)
{
    if (!(value <= limit))
        fail_slot(trials, slot, what, value, limit);
}

static void sort_descending(double values[3])
{
    for (int pass = 0; pass < 2; pass++) {
        for (int index = 0; index < 2; index++) {
            double low = fmin(values[index], values[index + 1]);
            values[index] = fmax(values[index], values[index + 1]);
            values[index + 1] = low;
        }
    }
}

static void check_surface(const struct trials *trials, size_t slot)
{
    double history[STATES];
    struct mat3 vectors;
    struct trial_state state = {
        .fixture = &trials->fixture, .stress = trials->stress[slot], .history = history};
    double limit = tolerance * trial_stress(trials, slot);
    for (size_t index = 0; index < trials->fixture.material->state_count; index++)
        history[index] = trials->model->surface_of_start ? trials->start_history[index][slot]
                                                         : trials->end_history[index][slot];
    sym3_eigen(state.stress, state.principal, &vectors);
    sort_descending(state.principal);
    double value = trials->model->surface(&state);
    check_limit(trials, slot, "outside the surface", value, limit);
    if (trials->plastic_strain[slot] > 0.0)
        check_limit(trials, slot, "inside the surface", -value, limit);
}

/* What backward Euler dissipates: the work on the plastic strain less what the history stores. */
static void check_dissipation(struct trials *trials)
{
    const struct material *material = trials->fixture.material;
    struct slots *slots = &trials->slots;
    double stored[BATCH], before[BATCH];
    material->strain_energy(trials->fixture.constants, &slots->batch, stored);
    history_restore(trials, slots, trials->start_history);
    material->strain_energy(trials->fixture.constants, &slots->batch, before);
    for (size_t slot = 0; slot < BATCH; slot++) {
        struct sym3 elastic = slots_get(slots->batch.strain, slot);
        struct sym3 plastic = sym3_add_scaled(trials->trial[slot], -1.0, elastic);
        double scale = trial_stress(trials, slot) * sym3_norm(trials->trial[slot]);
        double work = sym3_dot(trials->stress[slot], plastic) - (stored[slot] - before[slot]);
        check_limit(trials, slot, "negative dissipation", -work, energy_tolerance * scale);
        check_limit(trials, slot, "negative booked dissipation", -trials->dissipation[slot], 0.0);
        check_limit(trials, slot, "booked dissipation", trials->dissipation[slot] - work,
                    energy_tolerance * scale);
        check_limit(trials, slot, "norm of the plastic strain",
                    fabs(trials->plastic_strain[slot] - sym3_norm(plastic)),
                    tolerance * sym3_norm(trials->trial[slot]));
    }
}

static double distance(struct sym3 a, struct sym3 b)
{
    return sym3_norm(sym3_add_scaled(a, -1.0, b));
}

/* The step once more, with trial strain and history turned. */
static void check_rotation(struct trials *trials, uint64_t *state)
{
    const struct material *material = trials->fixture.material;
    struct slots *turned = &trials->turned;
    struct mat3 rotation = random_rotation(state);
    int tensor = find_tensor_state(material);
    history_restore(trials, turned, trials->start_history);
    for (size_t slot = 0; slot < BATCH; slot++) {
        slots_set(turned->batch.strain, slot, sym3_push_forward(rotation, trials->trial[slot]));
        if (tensor >= 0)
            slots_set(turned->history + tensor, slot,
                      sym3_push_forward(rotation, slots_get(turned->history + tensor, slot)));
    }
    material->update_stress(trials->fixture.constants, &turned->batch);
    for (size_t slot = 0; slot < BATCH; slot++) {
        double scale = trial_stress(trials, slot);
        double strain = sym3_norm(trials->trial[slot]);
        struct sym3 expected = sym3_push_forward(rotation, trials->stress[slot]);
        check_limit(trials, slot, "stress of the turned step",
                    distance(slots_get(turned->batch.stress, slot), expected), tolerance * scale);
        check_limit(trials, slot, "plastic strain of the turned step",
                    fabs(turned->batch.plastic_strain[slot] - trials->plastic_strain[slot]),
                    tolerance * strain);
        check_limit(trials, slot, "dissipation of the turned step",
                    fabs(turned->batch.dissipation[slot] - trials->dissipation[slot]),
                    tolerance * scale * strain);
    }
}

/* A second return of the returned strain, to the surface of the step. */
static void check_second_return(struct trials *trials)
{
    struct slots *slots = &trials->slots;
    history_restore(trials, slots,
                    trials->model->surface_of_start ? trials->start_history : trials->end_history);
    trials->fixture.material->update_stress(trials->fixture.constants, &slots->batch);
    for (size_t slot = 0; slot < BATCH; slot++) {
        check_limit(trials, slot, "stress of a second return",
                    distance(slots_get(slots->batch.stress, slot), trials->stress[slot]),
                    tolerance * trial_stress(trials, slot));
        check_limit(trials, slot, "plastic strain of a second return",
                    slots->batch.plastic_strain[slot], tolerance * sym3_norm(trials->trial[slot]));
    }
}

static void check_batch(struct trials *trials, uint64_t *state)
{
    const struct material *material = trials->fixture.material;
    struct slots *slots = &trials->slots;
    material->update_stress(trials->fixture.constants, &slots->batch);
    history_copy(trials->end_history, slots->history, material->state_count);
    memcpy(trials->plastic_strain, slots->batch.plastic_strain, sizeof trials->plastic_strain);
    memcpy(trials->dissipation, slots->batch.dissipation, sizeof trials->dissipation);
    for (size_t slot = 0; slot < BATCH; slot++) {
        trials->stress[slot] = slots_get(slots->batch.stress, slot);
        bool flowed = trials->plastic_strain[slot] > 0.0;
        trials->flow_count += flowed;
        trials->elastic_count += !flowed;
        check_surface(trials, slot);
    }
    check_dissipation(trials);
    check_rotation(trials, state);
    check_second_return(trials);
}

static void check_model(const struct trial_model *model, size_t trial_count)
{
    struct trials *trials = calloc(1, sizeof *trials);
    size_t setting_count = 0;
    uint64_t state = 2013;
    assert_non_null(trials);
    while (setting_count < LENGTH(model->settings) && model->settings[setting_count].key != NULL)
        setting_count++;
    trials->model = model;
    fixture_init(&trials->fixture, model->model, model->settings, setting_count);
    assert_true(trials->fixture.material->plastic);
    assert_true(trials->fixture.material->state_count <= STATES);
    material_elastic_moduli(trials->fixture.material, trials->fixture.values, &trials->bulk,
                            &trials->shear);
    slots_init(&trials->slots, BATCH, SYM3_COMPONENTS);
    slots_init(&trials->turned, BATCH, SYM3_COMPONENTS);
    for (size_t batch = 0; batch * BATCH < trial_count; batch++) {
        make_trials(trials, batch % 4, &state);
        check_batch(trials, &state);
    }
    /* the trials must have met both, or nothing was tested */
    if (trials->flow_count < trial_count / 4 || trials->elastic_count < trial_count / 100)
        fail_msg("%s: %zu trials flowed, %zu did not", model->label, trials->flow_count,
                 trials->elastic_count);
    slots_release(&trials->slots);
    slots_release(&trials->turned);
    fixture_release(&trials->fixture);
    free(trials);
}

static void test_random_trials(void **context)
{
    (void)context;
    for (size_t index = 0; index < trial_model_count; index++)
        check_model(&trial_models[index], is_full() ? 1000000 : 20000);
}

/* A plastic model without a row would go untested. */
static void test_every_plastic_model_has_a_row(void **context)
{
    (void)context;
    for (size_t material = 0; material < material_count; material++) {
        bool found = !material_table[material]->plastic;
        for (size_t index = 0; index < trial_model_count && !found; index++)
            found = strcmp(trial_models[index].model, material_table[material]->name) == 0;
        if (!found)
            fail_msg("no random trials of %s: add a row to trial_models.c",
                     material_table[material]->name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_plastic_model_has_a_row),
        cmocka_unit_test(test_random_trials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
