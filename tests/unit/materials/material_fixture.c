/* SPDX-License-Identifier: Apache-2.0 */
#include "material_fixture.h"

static size_t find_parameter(const struct material *material, const char *key)
{
    size_t index = material_parameter_index(material, key);
    if (index == (size_t)-1)
        fail_msg("%s has no parameter %s", material->name, key);
    return index;
}

void values_set(const struct material *material, const struct setting *settings, size_t count,
                double values[MATERIAL_PARAMETER_MAX])
{
    const struct parameter *parameters[MATERIAL_PARAMETER_MAX];
    size_t parameter_count = material_parameters(material, parameters, MATERIAL_PARAMETER_MAX);
    for (size_t index = 0; index < parameter_count; index++)
        values[index] = parameters[index]->default_value;
    for (size_t setting = 0; setting < count; setting++) {
        const char *group =
            parameters[find_parameter(material, settings[setting].key)]->alternative;
        for (size_t index = 0; group != NULL && index < parameter_count; index++) {
            const struct parameter *other = parameters[index];
            if (other->alternative != NULL && strcmp(other->alternative, group) == 0 &&
                strchr(other->key, '.') == NULL)
                values[index] = NAN;
        }
    }
    for (size_t setting = 0; setting < count; setting++)
        values[find_parameter(material, settings[setting].key)] = settings[setting].value;
}

static void prepare(struct fixture *fixture, const struct material *material,
                    const struct setting *settings, size_t count)
{
    struct material_issue issues[4];
    fixture->material = material;
    values_set(material, settings, count, fixture->values);
    if (material->check(fixture->values, issues, LENGTH(issues)) != 0)
        fail_msg("%s: %s %s", material->name, issues[0].key, issues[0].text);
    fixture->constants = calloc(1, material->constants_size);
    assert_non_null(fixture->constants);
    material->prepare(fixture->values, fixture->constants);
}

void fixture_init(struct fixture *fixture, const char *name, const struct setting *settings,
                  size_t count)
{
    const struct material *material = material_find(name);
    assert_non_null(material);
    prepare(fixture, material, settings, count);
}

#define ELASTIC                                                                                    \
    {"density", 2000.0}, {"bulk_modulus", 5e6},                                                    \
    {                                                                                              \
        "shear_modulus", 3e6                                                                       \
    }

void fixture_init_sample(struct fixture *fixture, const struct material *material)
{
    static const struct {
        const char *name;
        struct setting settings[12];
    } samples[] = {
        {"linear_elastic", {ELASTIC}},
        {"neo_hookean", {ELASTIC}},
        {"newtonian_fluid", {{"density", 1000.0}, {"bulk_modulus", 5e6}, {"viscosity", 200.0}}},
        {"j2",
         {ELASTIC,
          {"yield_stress", 5e3},
          {"isotropic_hardening", 2e5},
          {"kinematic_hardening", 4e5}}},
        {"drucker_prager",
         {ELASTIC,
          {"friction_angle", 25.0},
          {"cohesion", 2.5e3},
          {"flow_ratio", 0.3},
          {"isotropic_hardening", 2e5},
          {"kinematic_hardening", 4e5}}},
        {"drucker_prager_cap",
         {ELASTIC, {"friction_angle", 25.0}, {"cone_strength", 4e3}, {"flow_ratio", 0.3}}},
        {"drucker_prager_mobilised",
         {ELASTIC,
          {"friction.a0", 30.0},
          {"friction.a1", 3000.0},
          {"friction.a2", 1e-6},
          {"friction.a3", 150.0},
          {"friction.a4", 15.0},
          {"friction.a5", 200.0},
          {"cohesion", 1e3}}},
        {"matsuoka_nakai",
         {ELASTIC,
          {"friction.a0", 30.0},
          {"friction.a1", 3000.0},
          {"friction.a2", 1e-6},
          {"friction.a3", 150.0},
          {"friction.a4", 15.0},
          {"friction.a5", 200.0},
          {"cohesion", 1e3}}},
        {"mohr_coulomb",
         {ELASTIC,
          {"friction_angle", 25.0},
          {"dilation_angle", 10.0},
          {"cohesion", 1e3},
          {"tensile_strength", 5e2},
          {"residual_friction_angle", 20.0},
          {"residual_cohesion", 2e2},
          {"softening_rate", 20.0}}},
        {"tresca",
         {ELASTIC, {"cohesion", 4e3}, {"residual_cohesion", 1e3}, {"softening_rate", 20.0}}},
    };
    for (size_t sample = 0; sample < LENGTH(samples); sample++) {
        if (strcmp(samples[sample].name, material->name) != 0)
            continue;
        size_t count = 0;
        while (count < LENGTH(samples[sample].settings) &&
               samples[sample].settings[count].key != NULL)
            count++;
        prepare(fixture, material, samples[sample].settings, count);
        return;
    }
    fail_msg("no sample parameters for %s: add them here", material->name);
}

void fixture_release(struct fixture *fixture)
{
    free(fixture->constants);
    memset(fixture, 0, sizeof *fixture);
}

void slots_init(struct slots *slots, size_t count, size_t component_count)
{
    enum { ARRAYS = 4 * SYM3_COMPONENTS + 3 + 3 + 16 };
    memset(slots, 0, sizeof *slots);
    slots->memory = calloc(count * ARRAYS, sizeof *slots->memory);
    assert_non_null(slots->memory);
    real *next = slots->memory;
    slots->batch.count = count;
    slots->batch.component_count = component_count;
    slots->batch.time_step = 1e-3;
    for (size_t component = 0; component < component_count; component++) {
        slots->batch.strain[component] = next;
        slots->batch.stress[component] = next + count;
        slots->rate[component] = next + 2 * count;
        slots->batch.rate[component] = slots->rate[component];
        next += 3 * count;
    }
    for (int component = 0; component < 3; component++, next += count)
        slots->spin[component] = next;
    slots->volume_ratio = next;
    slots->batch.volume_ratio = next;
    slots->batch.plastic_strain = next + count;
    slots->batch.dissipation = next + 2 * count;
    next += 3 * count;
    for (size_t state = 0; state < LENGTH(slots->history); state++, next += count)
        slots->history[state] = next;
    slots->batch.history = slots->history;
    for (size_t slot = 0; slot < count; slot++)
        slots->volume_ratio[slot] = 1.0;
}

void slots_release(struct slots *slots)
{
    free(slots->memory);
    memset(slots, 0, sizeof *slots);
}

double random_value(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 4503599627370496.0 - 1.0;
}

double slots_trace(real *const arrays[SYM3_COMPONENTS], size_t slot, size_t component_count)
{
    (void)component_count;
    return arrays[0][slot] + arrays[1][slot] + arrays[2][slot];
}

double slots_deviator_norm(real *const arrays[SYM3_COMPONENTS], size_t slot, size_t component_count)
{
    double mean = slots_trace(arrays, slot, component_count) / 3.0;
    double sum = 0.0;
    for (size_t component = 0; component < component_count; component++) {
        double value = arrays[component][slot] - (component < 3 ? mean : 0.0);
        sum += (component < 3 ? 1.0 : 2.0) * value * value;
    }
    return sqrt(sum);
}

struct sym3 slots_get(real *const arrays[SYM3_COMPONENTS], size_t slot)
{
    return (struct sym3){arrays[0][slot], arrays[1][slot], arrays[2][slot],
                         arrays[3][slot], arrays[4][slot], arrays[5][slot]};
}

void slots_set(real *const arrays[SYM3_COMPONENTS], size_t slot, struct sym3 tensor)
{
    const real values[SYM3_COMPONENTS] = {tensor.xx, tensor.yy, tensor.zz,
                                          tensor.xy, tensor.yz, tensor.xz};
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        arrays[component][slot] = values[component];
}

int find_tensor_state(const struct material *material)
{
    for (size_t index = 0; index < material->state_count; index++) {
        const char *end = strrchr(material->state_names[index], '_');
        if (end != NULL && strcmp(end, "_xx") == 0)
            return (int)index;
    }
    return -1;
}

struct mat3 random_rotation(uint64_t *state)
{
    struct mat3 rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int axis = 0; axis < 3; axis++) {
        int p = (axis + 1) % 3;
        int q = (axis + 2) % 3;
        double angle = 3.0 * random_value(state);
        struct mat3 turn = {{{0}}};
        turn.m[axis][axis] = 1.0;
        turn.m[p][p] = turn.m[q][q] = (real)cos(angle);
        turn.m[q][p] = (real)sin(angle);
        turn.m[p][q] = -turn.m[q][p];
        rotation = mat3_multiply(turn, rotation);
    }
    return rotation;
}

static void keep(void *context, const struct material_point_step *step)
{
    struct record *record = context;
    assert_true(record->count < record->capacity);
    struct material_point_step *kept = &record->steps[record->count];
    double *history = record->history[record->count++];
    *kept = *step;
    for (size_t state = 0; state < record->state_count; state++)
        history[state] = step->history[state];
    kept->history = history;
}

void record_run(struct record *record, const struct fixture *fixture, bool finite_strain,
                const double initial_stress[SYM3_COMPONENTS],
                const struct material_point_segment *path, size_t segment_count)
{
    struct talus_error error = {.status = TALUS_OK};
    *record = (struct record){.capacity = 1, .state_count = fixture->material->state_count};
    for (size_t segment = 0; segment < segment_count; segment++)
        record->capacity += path[segment].step_count;
    record->steps = calloc(record->capacity, sizeof *record->steps);
    record->history = calloc(record->capacity, sizeof *record->history);
    assert_non_null(record->steps);
    assert_non_null(record->history);
    struct material_point_path run = {
        .finite_strain = finite_strain, .segments = path, .segment_count = segment_count};
    memcpy(run.initial_stress, initial_stress, sizeof run.initial_stress);
    enum talus_status status =
        material_point_run(fixture->material, fixture->values, &run, keep, record, &error);
    if (status != TALUS_OK)
        fail_msg("%s: %s %s", talus_status_name(status), error.pointer, error.text);
    assert_int_equal(record->count, record->capacity);
}

void record_release(struct record *record)
{
    free(record->steps);
    free(record->history);
    memset(record, 0, sizeof *record);
}
