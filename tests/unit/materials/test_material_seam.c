/* SPDX-License-Identifier: Apache-2.0 */
/* What every model of the table must do, whatever it is: tested from the table alone. */
#include "material_fixture.h"

enum { SLOTS = 72 }; /* a whole chunk and a part of one */

/* Strains around the strength of the samples, some compressed, some not, into the components that
 * the batch has; a rate; for a fluid only the volumetric strain. */
static void fill(const struct fixture *fixture, struct slots *slots, uint64_t *state)
{
    size_t components = slots->batch.component_count;
    for (size_t slot = 0; slot < slots->batch.count; slot++) {
        double size = 1e-4 * pow(10.0, 1.0 + 1.5 * random_value(state));
        double spherical = size * (2.0 * random_value(state) - 0.5);
        for (size_t component = 0; component < SYM3_COMPONENTS; component++) {
            double strain = size * random_value(state) + (component < 3 ? spherical : 0.0);
            double rate = random_value(state);
            if (component < components) {
                slots->batch.strain[component][slot] += strain;
                slots->rate[component][slot] = rate;
            }
        }
        slots->volume_ratio[slot] = 1.0 + 0.1 * random_value(state);
        for (size_t component = 1; fixture->material->volumetric && component < components;
             component++)
            slots->batch.strain[component][slot] = 0.0;
    }
}

/* Two updates from random strains: the second starts from a history that the first left. */
static void update_twice(const struct fixture *fixture, struct slots *slots, uint64_t *state)
{
    fill(fixture, slots, state);
    fixture->material->update_stress(fixture->constants, &slots->batch);
    fill(fixture, slots, state);
    fixture->material->update_stress(fixture->constants, &slots->batch);
}

static void assert_same_tensor(struct sym3 a, struct sym3 b, double scale)
{
    assert_true(sym3_norm(sym3_add_scaled(a, -1.0, b)) <= 1e-11 * scale);
}

/* Turned strain, rate and history give turned stress; scalars do not change. */
static void check_objectivity(const struct fixture *fixture, uint64_t *state)
{
    const struct material *material = fixture->material;
    struct slots first;
    struct slots second;
    int tensor = find_tensor_state(material);
    struct mat3 rotation = random_rotation(state);
    slots_init(&first, SLOTS, 6);
    slots_init(&second, SLOTS, 6);
    fill(fixture, &first, state);
    material->update_stress(fixture->constants, &first.batch);
    fill(fixture, &first, state);
    for (size_t slot = 0; slot < SLOTS; slot++) {
        struct sym3 strain = slots_get(first.batch.strain, slot);
        if (material->volumetric)
            second.batch.strain[0][slot] = strain.xx;
        else
            slots_set(second.batch.strain, slot, sym3_push_forward(rotation, strain));
        slots_set(second.rate, slot, sym3_push_forward(rotation, slots_get(first.rate, slot)));
        second.volume_ratio[slot] = first.volume_ratio[slot];
        for (size_t index = 0; index < material->state_count; index++)
            second.history[index][slot] = first.history[index][slot];
        if (tensor >= 0)
            slots_set(second.history + tensor, slot,
                      sym3_push_forward(rotation, slots_get(first.history + tensor, slot)));
    }
    material->update_stress(fixture->constants, &first.batch);
    material->update_stress(fixture->constants, &second.batch);
    for (size_t slot = 0; slot < SLOTS; slot++) {
        struct sym3 stress = slots_get(first.batch.stress, slot);
        double scale = sym3_norm(stress) + 1e4;
        assert_same_tensor(slots_get(second.batch.stress, slot),
                           sym3_push_forward(rotation, stress), scale);
        assert_true(fabs(first.batch.plastic_strain[slot] - second.batch.plastic_strain[slot]) <
                    1e-14);
        assert_true(fabs(first.batch.dissipation[slot] - second.batch.dissipation[slot]) <
                    1e-12 * scale);
        if (tensor >= 0)
            assert_same_tensor(slots_get(second.history + tensor, slot),
                               sym3_push_forward(rotation, slots_get(first.history + tensor, slot)),
                               1e-2);
    }
    slots_release(&first);
    slots_release(&second);
}

/* A batch of 3 or 4 components gives what one of 6 gives with zeros in the others. */
static void check_components(const struct fixture *fixture, size_t components, uint64_t *state)
{
    struct slots few;
    struct slots all;
    uint64_t again = *state;
    slots_init(&few, SLOTS, components);
    slots_init(&all, SLOTS, 6);
    update_twice(fixture, &few, state);
    fill(fixture, &all, &again);
    for (size_t component = components; component < SYM3_COMPONENTS; component++) {
        memset(all.batch.strain[component], 0, SLOTS * sizeof(double));
        memset(all.rate[component], 0, SLOTS * sizeof(double));
    }
    fixture->material->update_stress(fixture->constants, &all.batch);
    fill(fixture, &all, &again);
    for (size_t component = components; component < SYM3_COMPONENTS; component++) {
        memset(all.batch.strain[component], 0, SLOTS * sizeof(double));
        memset(all.rate[component], 0, SLOTS * sizeof(double));
    }
    fixture->material->update_stress(fixture->constants, &all.batch);
    for (size_t slot = 0; slot < SLOTS; slot++) {
        double scale = 1e4 + fabs(all.batch.stress[0][slot]);
        for (size_t component = 0; component < SYM3_COMPONENTS; component++) {
            double value = component < components ? few.batch.stress[component][slot] : 0.0;
            assert_true(fabs(value - all.batch.stress[component][slot]) < 1e-11 * scale);
        }
        for (size_t index = 0; index < fixture->material->state_count; index++)
            assert_true(fabs(few.history[index][slot] - all.history[index][slot]) <=
                        1e-11 * (1e-2 + fabs(all.history[index][slot])));
        assert_true(fabs(few.batch.dissipation[slot] - all.batch.dissipation[slot]) <
                    1e-11 * scale);
    }
    slots_release(&few);
    slots_release(&all);
}

/* Nothing comes out of nothing: no stress (cohesion keeps zero stress admissible), no NAN. */
static void check_empty_slots(const struct fixture *fixture)
{
    struct slots slots;
    double energy[SLOTS];
    slots_init(&slots, SLOTS, 6);
    fixture->material->update_stress(fixture->constants, &slots.batch);
    fixture->material->strain_energy(fixture->constants, &slots.batch, energy);
    for (size_t slot = 0; slot < SLOTS; slot++) {
        for (int component = 0; component < SYM3_COMPONENTS; component++) {
            assert_true(slots.batch.stress[component][slot] == 0.0);
            assert_true(slots.batch.strain[component][slot] == 0.0);
        }
        for (size_t index = 0; index < fixture->material->state_count; index++)
            assert_true(slots.history[index][slot] == 0.0);
        assert_true(slots.batch.plastic_strain[slot] == 0.0);
        assert_true(slots.batch.dissipation[slot] == 0.0);
        assert_true(energy[slot] == 0.0);
    }
    slots_release(&slots);
}

/* A slot's result does not depend on its place or on its neighbours, to the last bit. */
static void check_slots_are_alone(const struct fixture *fixture, uint64_t *state)
{
    struct slots many;
    struct slots one;
    uint64_t again = *state;
    slots_init(&many, SLOTS, 6);
    slots_init(&one, SLOTS, 6);
    fill(fixture, &many, state);
    fill(fixture, &one, &again);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        double *arrays[] = {one.batch.strain[component], one.rate[component]};
        for (size_t index = 0; index < LENGTH(arrays); index++) {
            double kept = arrays[index][3];
            memset(arrays[index], 0, SLOTS * sizeof(double));
            arrays[index][SLOTS - 1] = kept;
        }
    }
    one.volume_ratio[SLOTS - 1] = one.volume_ratio[3];
    fixture->material->update_stress(fixture->constants, &many.batch);
    fixture->material->update_stress(fixture->constants, &one.batch);
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        assert_true(many.batch.stress[component][3] == one.batch.stress[component][SLOTS - 1]);
    slots_release(&many);
    slots_release(&one);
}

/* The elastic strain that comes out is the one that the stress belongs to. */
static void check_strain_belongs_to_stress(const struct fixture *fixture, uint64_t *state)
{
    const struct material *material = fixture->material;
    struct slots slots;
    if (material->needs_rate)
        return; /* viscous stress has no strain */
    slots_init(&slots, SLOTS, 6);
    update_twice(fixture, &slots, state);
    for (size_t slot = 0; slot < SLOTS; slot++) {
        double stress[SYM3_COMPONENTS];
        double strain[SYM3_COMPONENTS];
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            stress[component] = slots.batch.stress[component][slot];
        material->strain_from_stress(fixture->constants, stress, strain);
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            assert_true(fabs(strain[component] - slots.batch.strain[component][slot]) < 1e-14);
    }
    slots_release(&slots);
}

/* Work is stored or lost: trial energy minus energy after the return is what the plastic strain
 * takes, at least the dissipation that is booked, and dissipation is never negative. */
static void check_energy(const struct fixture *fixture, uint64_t *state)
{
    const struct material *material = fixture->material;
    struct slots slots;
    double before[SLOTS];
    double after[SLOTS];
    slots_init(&slots, SLOTS, 6);
    update_twice(fixture, &slots, state);
    fill(fixture, &slots, state);
    material->strain_energy(fixture->constants, &slots.batch, before);
    material->update_stress(fixture->constants, &slots.batch);
    material->strain_energy(fixture->constants, &slots.batch, after);
    size_t plastic_count = 0;
    for (size_t slot = 0; slot < SLOTS; slot++) {
        double dissipation = slots.batch.dissipation[slot];
        assert_true(dissipation >= 0.0);
        assert_true(slots.batch.plastic_strain[slot] >= 0.0);
        if (slots.batch.plastic_strain[slot] > 0.0)
            plastic_count++;
        else
            assert_true(before[slot] == after[slot]);
        if (!material->needs_rate) /* else viscous */
            assert_true(before[slot] - after[slot] >= dissipation - 1e-12 * before[slot]);
    }
    assert_int_equal(plastic_count > SLOTS / 4, material->plastic);
    slots_release(&slots);
}

/* Stress is the derivative of the strain energy wherever nothing flows. */
static void check_energy_derivative(const struct fixture *fixture, uint64_t *state)
{
    const struct material *material = fixture->material;
    struct slots slots;
    slots_init(&slots, 8, 6);
    fill(fixture, &slots, state);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        for (size_t slot = 0; slot < 8; slot++) {
            slots.rate[component][slot] = 0.0;
            slots.batch.strain[component][slot] = /* compressed, well inside every surface */
                1e-7 * random_value(state) - (component < 3 ? 1e-6 : 0.0);
            if (material->volumetric && component > 0)
                slots.batch.strain[component][slot] = 0.0;
        }
    }
    material->update_stress(fixture->constants, &slots.batch);
    int last = material->volumetric ? 1 : SYM3_COMPONENTS;
    for (int component = 0; component < last; component++) {
        double energy[2][8];
        const double offset = 1e-7; /* the energy is quadratic: any offset is exact */
        for (int side = 0; side < 2; side++) {
            double *strain = slots.batch.strain[component];
            double change = side == 0 ? -offset : offset;
            for (size_t slot = 0; slot < 8; slot++)
                strain[slot] += change;
            material->strain_energy(fixture->constants, &slots.batch, energy[side]);
            for (size_t slot = 0; slot < 8; slot++)
                strain[slot] -= change;
        }
        for (size_t slot = 0; slot < 8; slot++) {
            double pairs = component < 3 ? 1.0 : 2.0; /* a shear component stands for two */
            double slope = (energy[1][slot] - energy[0][slot]) / (2.0 * offset * pairs);
            assert_true(slots.batch.plastic_strain[slot] == 0.0);
            assert_true(fabs(slope - slots.batch.stress[component][slot]) < 1e-6);
        }
    }
    slots_release(&slots);
}

/* The strain of a stress gives that stress; fluids keep its mean. */
static void check_strain_from_stress(const struct fixture *fixture)
{
    const struct material *material = fixture->material;
    const double stress[SYM3_COMPONENTS] = {-900.0, -1100.0, -1000.0, 50.0, -30.0, 20.0};
    double strain[SYM3_COMPONENTS];
    double history[16] = {0};
    struct slots slots;
    slots_init(&slots, 8, 6);
    material->strain_from_stress(fixture->constants, stress, strain);
    if (material->initialise != NULL)
        material->initialise(fixture->constants, strain, history);
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        slots.batch.strain[component][0] = strain[component];
    for (size_t index = 0; index < material->state_count; index++)
        slots.history[index][0] = history[index];
    material->update_stress(fixture->constants, &slots.batch);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        double mean = component < 3 ? -1000.0 : 0.0;
        double expected = material->volumetric ? mean : stress[component];
        assert_true(fabs(slots.batch.stress[component][0] - expected) < 1e-9);
    }
    slots_release(&slots);
}

static void test_every_model(void **context)
{
    (void)context;
    uint64_t state = 11;
    for (size_t index = 0; index < material_count; index++) {
        struct fixture fixture;
        fixture_init_sample(&fixture, material_table[index]);
        for (int repeat = 0; repeat < 5; repeat++)
            check_objectivity(&fixture, &state);
        check_components(&fixture, 3, &state);
        check_components(&fixture, 4, &state);
        check_empty_slots(&fixture);
        check_slots_are_alone(&fixture, &state);
        check_strain_belongs_to_stress(&fixture, &state);
        check_energy(&fixture, &state);
        check_energy_derivative(&fixture, &state);
        check_strain_from_stress(&fixture);
        fixture_release(&fixture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_model)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
