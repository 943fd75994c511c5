/* SPDX-License-Identifier: Apache-2.0 */
/* The return to the planes of Mohr-Coulomb against every subset of them: with nine planes, six of
 * shear and three of tension, at most three of which act on their own, each trial has at most 129
 * candidates. The admissible one nearest in the norm of the elastic energy is the return of an
 * associated flow; the admissible one whose multipliers are not negative that of any flow. */
#include "material_fixture.h"

#include "yield_planes.h"

enum { TRIALS = 2000 };

struct model { /* one set of random parameters */
    struct fixture fixture;
    struct yield_planes planes;
};

static double between(double low, double high, uint64_t *state)
{
    return low + (high - low) * 0.5 * (1.0 + random_value(state));
}

/* Share 0 ... 1 of the largest value, often one of its ends. */
static double share(uint64_t *state)
{
    double value = between(-0.3, 1.3, state);
    return fmin(fmax(value, 0.0), 1.0);
}

static void model_init(struct model *model, bool associated, uint64_t *state)
{
    double friction_deg = 60.0 * share(state);
    double dilation_deg = associated ? friction_deg : friction_deg * share(state);
    double cohesion = 1e3 * share(state);
    double poisson = between(-0.6, 0.495, state);
    double apex = friction_deg > 0.0 ? cohesion / tan(friction_deg * M_PI / 180.0) : 2e3;
    double tension = apex * share(state) * (1.0 - 1e-12);
    const struct setting settings[] = {{"density", 1.0},
                                       {"young_modulus", 1e6},
                                       {"poisson_ratio", poisson},
                                       {"cohesion", cohesion},
                                       {"friction_angle", friction_deg},
                                       {"dilation_angle", dilation_deg},
                                       {"tensile_strength", tension}};
    fixture_init(&model->fixture, "mohr_coulomb", settings, LENGTH(settings));
    double bulk, shear;
    material_elastic_moduli(model->fixture.material, model->fixture.values, &bulk, &shear);
    model->planes = yield_planes_of(bulk, shear, friction_deg, dilation_deg, cohesion, tension);
}

/* a . C^-1 a */
static double energy(const struct model *model, const double a[3])
{
    double mean = (a[0] + a[1] + a[2]) / 3.0;
    double sum = mean * mean / model->planes.bulk;
    for (int axis = 0; axis < 3; axis++)
        sum += (a[axis] - mean) * (a[axis] - mean) / (2.0 * model->planes.shear);
    return sum;
}

static double distance(const double a[3], const double b[3])
{
    return fmax(fabs(a[0] - b[0]), fmax(fabs(a[1] - b[1]), fabs(a[2] - b[2])));
}

/* Compares with what every subset gives. */
static void check_trial(const struct model *model, bool associated, const double trial[3],
                        const double result[3])
{
    double size = hypot(hypot(trial[0], trial[1]), trial[2]) + 1.0;
    double nearest = INFINITY;
    bool found = false;
    double own[3] = {trial[0] - result[0], trial[1] - result[1], trial[2] - result[2]};
    assert_true(yield_planes_excess(&model->planes, result) <= 1e-10 * size);
    for (unsigned subset = 0; subset < SUBSETS; subset++) {
        double stress[3], multipliers[3];
        if (__builtin_popcount(subset) > 3 ||
            !yield_planes_return_to(&model->planes, subset, trial, stress, multipliers) ||
            yield_planes_excess(&model->planes, stress) > 1e-10 * size)
            continue;
        double way[3] = {trial[0] - stress[0], trial[1] - stress[1], trial[2] - stress[2]};
        nearest = fmin(nearest, energy(model, way));
        bool positive = true;
        for (int index = 0; index < __builtin_popcount(subset); index++)
            positive = positive && multipliers[index] >= 0.0;
        found = found || (positive && distance(stress, result) <= 1e-9 * size);
        /* two answers would be none */
        if (positive && distance(stress, result) > 1e-9 * size)
            fail_msg("subset %x returns %g %g %g to %g %g %g, not to %g %g %g", subset, trial[0],
                     trial[1], trial[2], stress[0], stress[1], stress[2], result[0], result[1],
                     result[2]);
    }
    assert_true(found);
    if (associated)
        assert_true(energy(model, own) <= nearest * (1.0 + 1e-9) + 1e-18 * size * size);
}

/* Trials up to a hundred times the strength, some of them with equal values. */
static void random_trial(double trial[3], uint64_t *state)
{
    double size = 1e3 * pow(10.0, between(-1.0, 2.0, state));
    double mean = size * random_value(state);
    for (int axis = 0; axis < 3; axis++)
        trial[axis] = mean + size * random_value(state);
    if (random_value(state) > 0.8)
        trial[1] = trial[0];
    if (random_value(state) > 0.8)
        trial[2] = trial[1];
}

static void check_model(bool associated, uint64_t *state)
{
    struct model model;
    struct slots slots;
    double trial[8][3];
    model_init(&model, associated, state);
    slots_init(&slots, LENGTH(trial), 3);
    for (size_t slot = 0; slot < LENGTH(trial); slot++) {
        double strain[SYM3_COMPONENTS];
        random_trial(trial[slot], state);
        double stress[SYM3_COMPONENTS] = {trial[slot][0], trial[slot][1], trial[slot][2]};
        model.fixture.material->strain_from_stress(model.fixture.constants, stress, strain);
        for (int axis = 0; axis < 3; axis++)
            slots.batch.strain[axis][slot] = strain[axis];
    }
    model.fixture.material->update_stress(model.fixture.constants, &slots.batch);
    for (size_t slot = 0; slot < LENGTH(trial); slot++) {
        double result[3];
        for (int axis = 0; axis < 3; axis++)
            result[axis] = slots.batch.stress[axis][slot];
        check_trial(&model, associated, trial[slot], result);
    }
    slots_release(&slots);
    fixture_release(&model.fixture);
}

static void test_every_subset(void **context)
{
    (void)context;
    uint64_t state = 45;
    for (int trial = 0; trial < TRIALS / 8; trial++) {
        check_model(false, &state);
        check_model(true, &state);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_subset)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
