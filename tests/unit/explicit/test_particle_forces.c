/* SPDX-License-Identifier: Apache-2.0 */
/* Forces on particles beside stress and gravity: a body force that equals gravity does what gravity
 * does, crossers included, and its impulse and work are in the books. */
#include "simulation_fixture.h"

static const double pull[3] = {1.5, -9.81, 0};

static void uniform_pull(void *context, uint32_t id, const double position[3], double time,
                         double out[3])
{
    (void)context;
    (void)id;
    (void)position;
    (void)time;
    memcpy(out, pull, sizeof pull);
}

static void thrown(void *context, uint32_t id, const double position[3], double time, double out[3])
{
    (void)context;
    (void)id;
    (void)time;
    out[0] = 2.0 + position[1];
    out[1] = 0.5;
}

static void fill(struct simulation_fixture *fixture, enum talus_stress_update ordering)
{
    const int64_t count[3] = {40, 40, 1};
    const double min[3] = {0.5, 0.1, 0}, max[3] = {1.0, 0.6, 0};
    static const struct setting elastic[] = {
        {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material = simulation_fixture_add_material(fixture, "linear_elastic", elastic,
                                                            sizeof elastic / sizeof elastic[0]);
    simulation_fixture_add_box(fixture, material, min, max, 2);
    simulation_fixture_add_plane(fixture, "floor", TALUS_Y, 0.0, 1.0, "friction", 0.3);
    fixture->scene.solver.stress_update = ordering;
    fixture->scene.solver.time_step = 2e-4;
}

static struct talus_simulation *start(const struct simulation_fixture *fixture, int threads,
                                      talus_particle_function *force)
{
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {
        .threads = threads, .all_threads = true, .body_force = force, .initial_velocity = thrown};
    if (talus_simulation_create(&fixture->scene, &options, &simulation, &error) != TALUS_OK)
        fail_msg("create: %s", error.text);
    return simulation;
}

/* [J] */
static double numerical_loss(struct talus_simulation *simulation)
{
    size_t count = 0;
    (void)talus_simulation_columns(simulation, &count);
    double *row = calloc(count, sizeof *row);
    assert_non_null(row);
    talus_simulation_sample(simulation, row);
    const double loss = row[simulation_column(simulation, "energy.numerical")];
    free(row);
    return loss;
}

static void check_like_gravity(enum talus_stress_update ordering)
{
    struct simulation_fixture forced, heavy;
    fill(&forced, ordering);
    fill(&heavy, ordering);
    memcpy(heavy.scene.gravity, pull, sizeof pull);
    struct talus_simulation *a = start(&forced, 1, uniform_pull), *b = start(&heavy, 1, NULL);
    simulation_run_steps(a, 1500);
    simulation_run_steps(b, 1500);
    double *left = simulation_field(a, TALUS_FIELD_VELOCITY, 3);
    double *right = simulation_field(b, TALUS_FIELD_VELOCITY, 3);
    for (size_t index = 0; index < 3 * simulation_particle_count(a); index++)
        assert_close(left[index], right[index], 1e-9, 1.0);
    struct talus_error error = {0};
    assert_int_equal(talus_simulation_audit(a, &error), TALUS_OK);
    assert_close(numerical_loss(a), numerical_loss(b), 1e-6, 1.0);
    free(left);
    free(right);
    talus_simulation_destroy(a);
    talus_simulation_destroy(b);
}

static void like_gravity_modified_last(void **state)
{
    (void)state;
    check_like_gravity(TALUS_STRESS_MODIFIED_LAST);
}

static void like_gravity_last(void **state)
{
    (void)state;
    check_like_gravity(TALUS_STRESS_LAST);
}

static void same_bits_for_two_threads(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    fill(&fixture, TALUS_STRESS_MODIFIED_LAST);
    struct talus_simulation *one = start(&fixture, 1, uniform_pull),
                            *two = start(&fixture, 2, uniform_pull);
    simulation_run_steps(one, 800);
    simulation_run_steps(two, 800);
    assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
    talus_simulation_destroy(one);
    talus_simulation_destroy(two);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(like_gravity_modified_last),
        cmocka_unit_test(like_gravity_last),
        cmocka_unit_test(same_bits_for_two_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
