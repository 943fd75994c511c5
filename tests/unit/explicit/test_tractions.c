/* SPDX-License-Identifier: Apache-2.0 */
/* Loads on faces: impulse and work are in the books, whatever moves; directions follow as asked. */
#include "simulation_fixture.h"

static void fill(struct simulation_fixture *fixture, double young_modulus, double speed)
{
    const int64_t count[3] = {60, 40, 1};
    const double min[3] = {1.0, 1.0, 0}, max[3] = {1.5, 1.4, 0};
    const struct setting elastic[] = {
        {"density", 1000}, {"young_modulus", young_modulus}, {"poisson_ratio", 0.3}};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material = simulation_fixture_add_material(fixture, "linear_elastic", elastic,
                                                            sizeof elastic / sizeof elastic[0]);
    struct talus_body *body = simulation_fixture_add_box(fixture, material, min, max, 2);
    body->velocity[0] = speed;
    fixture->scene.solver.time_step = 2e-4;
}

static void load(struct talus_body *body, struct talus_traction *tractions, size_t count)
{
    body->tractions = tractions;
    body->traction_count = count;
}

static double mean_velocity(const struct talus_simulation *simulation, size_t axis, size_t begin,
                            size_t end)
{
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3), sum = 0;
    for (size_t index = begin; index < end; index++)
        sum += velocity[3 * index + axis];
    free(velocity);
    return sum / (double)(end - begin);
}

static void check_audit(struct talus_simulation *simulation, double loss)
{
    struct talus_error error = {0};
    if (talus_simulation_audit(simulation, &error) != TALUS_OK)
        fail_msg("audit: %s", error.text);
    assert_true(fabs(simulation_metric(simulation, "energy_numerical")) < loss);
}

/* Steadily pulled while it drifts through cells: every particle changes cells, none of the load is
 * lost. 200 kg; a force of 40 kPa x 0.4 m2 along x and, from 0.1 s on, 5 kPa x 0.5 m2 down. */
static void check_impulse(enum talus_stress_update ordering)
{
    double times[] = {0.1, 0.1 + 1e-9}, values[] = {0.0, -5e3};
    struct simulation_fixture fixture;
    struct talus_traction tractions[2] = {{.face = 1, .value = {4e4, 0, 0}}, {.face = 3}};
    tractions[1].table[1] = (struct talus_time_table){.count = 2, .time = times, .value = values};
    fill(&fixture, 1e6, 3.0);
    load(&fixture.bodies[0], tractions, 2);
    fixture.scene.solver.stress_update = ordering;
    fixture.scene.solver.time_step = 1e-4;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 3000);
    const size_t count = simulation_particle_count(simulation);
    assert_close(mean_velocity(simulation, 0, 0, count), 3.0 + 0.3 * 4e4 * 0.4 / 200, 1e-9, 1.0);
    assert_close(mean_velocity(simulation, 1, 0, count), -0.2 * 5e3 * 0.5 / 200, 2e-3, 1.0);
    check_audit(simulation, 0.01);
    talus_simulation_destroy(simulation);
}

static void impulse_modified_last(void **state)
{
    (void)state;
    check_impulse(TALUS_STRESS_MODIFIED_LAST);
}

static void impulse_last(void **state)
{
    (void)state;
    check_impulse(TALUS_STRESS_LAST);
}

/* The force of 2 kPa on the face x_max, whose 8 particles share 0.4 m^2, out of their deformation
 * gradients: F n / |F n| along the fibre n = e_x, cof(F) n for a pressure on the present surface.
 */
static void expected_force(const struct talus_simulation *simulation, enum talus_traction_kind kind,
                           double force[2])
{
    double *gradient = simulation_field(simulation, TALUS_FIELD_DEFORMATION_GRADIENT, 9);
    force[0] = force[1] = 0;
    for (size_t row = 0; row < 8; row++) {
        const double *f = gradient + 9 * (10 * row + 9);
        const double along[2] = {f[0], f[3]}, across[2] = {f[4], -f[1]};
        const double *n = kind == TALUS_TRACTION_FIBRE ? along : across;
        const double length = kind == TALUS_TRACTION_FIBRE ? hypot(n[0], n[1]) : 1.0;
        for (size_t axis = 0; axis < 2; axis++)
            force[axis] += 2e3 * 0.05 * n[axis] / length;
    }
    free(gradient);
}

/* A soft block that turns by more than 40 degrees and is strained by its spin. */
static void loads_follow_the_deformation(void **state)
{
    (void)state;
    for (int kind = TALUS_TRACTION_FIBRE; kind <= (int)TALUS_TRACTION_NORMAL; kind++) {
        struct simulation_fixture fixture;
        struct talus_traction traction = {.face = 1, .kind = (enum talus_traction_kind)kind};
        double impulse[2] = {0, 0}, force[2];
        traction.is_pressure = kind == (int)TALUS_TRACTION_NORMAL;
        traction.value[0] = traction.is_pressure ? -2e3 : 2e3;
        fill(&fixture, 2e5, 0.0);
        fixture.scene.output.frame_fields = 1u << TALUS_FIELD_DEFORMATION_GRADIENT;
        struct talus_body *body = &fixture.bodies[0];
        body->velocity_field = TALUS_VELOCITY_ROTATION;
        body->rotation_about[0] = 1.25;
        body->rotation_about[1] = 1.2;
        body->rotation_rate[2] = 8.0;
        load(body, &traction, 1);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        for (int step = 0; step < 600; step++) {
            expected_force(simulation, (enum talus_traction_kind)kind, force);
            for (size_t axis = 0; axis < 2; axis++)
                impulse[axis] += 2e-4 * force[axis];
            simulation_run_steps(simulation, 1);
        }
        assert_true(force[1] > 0.7 * 800); /* it has turned by more than 40 degrees */
        for (size_t axis = 0; axis < 2; axis++)
            assert_close(200 * mean_velocity(simulation, axis, 0, 80), impulse[axis], 1e-9, 100.0);
        talus_simulation_destroy(simulation);
    }
}

static void stretching(void *context, uint32_t id, const double position[3], double time,
                       double out[3])
{
    (void)context;
    (void)id;
    (void)time;
    out[0] = position[0] - 1.25;
    out[1] = 0;
}

/* A body without stiffness that stretches along x by (1 + t): its upper face grows, and with it the
 * force of a pressure that stays normal (Nanson); a dead one, per initial area, stays. */
static void normal_pressure_acts_on_the_present_area(void **state)
{
    (void)state;
    for (int kind = TALUS_TRACTION_DEAD; kind <= (int)TALUS_TRACTION_NORMAL; kind++) {
        struct simulation_fixture fixture;
        struct talus_traction traction = {.face = 3,
                                          .kind = (enum talus_traction_kind)kind,
                                          .is_pressure = true,
                                          .value = {1e-3, 0, 0}};
        struct talus_simulation *simulation = NULL;
        struct talus_error error = {0};
        const struct talus_simulation_options options = {
            .threads = 1, .all_threads = true, .initial_velocity = stretching};
        fill(&fixture, 1e-3, 0.0);
        fixture.scene.solver.time_step = 1e-3;
        fixture.bodies[0].box_max[0] = 4.0;
        load(&fixture.bodies[0], &traction, 1);
        if (talus_simulation_create(&fixture.scene, &options, &simulation, &error) != TALUS_OK)
            fail_msg("create: %s", error.text);
        simulation_run_steps(simulation, 500);
        const bool grows = kind == (int)TALUS_TRACTION_NORMAL;
        const double impulse = -1e-3 * 3.0 * (0.5 + (grows ? 0.5 * 0.25 : 0.0));
        /* The two outermost of 30 cells see 5/8 of the stretch: 0.5 % of the impulse. */
        assert_close(1200 * mean_velocity(simulation, 1, 0, 480), impulse, 1e-2, fabs(impulse));
        talus_simulation_destroy(simulation);
    }
}

/* Two bodies side by side in the same blocks, loaded in opposite directions with the same
 * components: each gets its own. */
static void each_body_has_its_own_load(void **state)
{
    (void)state;
    const double min[3] = {1.0, 1.6, 0}, max[3] = {1.5, 2.0, 0};
    struct simulation_fixture fixture;
    struct talus_traction lower = {.face = 1, .value = {4e4, 0, 0}};
    struct talus_traction upper = {.face = 1, .value = {-1e4, 0, 0}};
    fill(&fixture, 1e7, 0.0);
    struct talus_body *second = simulation_fixture_add_box(&fixture, 0, min, max, 2);
    load(&fixture.bodies[0], &lower, 1);
    load(second, &upper, 1);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1000);
    assert_close(mean_velocity(simulation, 0, 0, 80), 0.2 * 4e4 * 0.4 / 200, 1e-10, 1.0);
    assert_close(mean_velocity(simulation, 0, 80, 160), -0.2 * 1e4 * 0.4 / 200, 1e-10, 1.0);
    check_audit(simulation, 0.01);
    talus_simulation_destroy(simulation);
}

/* The ramp holds tractions back as it holds gravity back. */
static void the_ramp_acts_on_tractions(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_traction traction = {.face = 1, .value = {4e4, 0, 0}};
    fill(&fixture, 1e7, 0.0);
    load(&fixture.bodies[0], &traction, 1);
    fixture.scene.solver.force_ramp = 0.2;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1000);
    assert_close(mean_velocity(simulation, 0, 0, 80), 0.1 * 4e4 * 0.4 / 200, 2e-3, 8.0);
    check_audit(simulation, 0.01);
    talus_simulation_destroy(simulation);
}

static void same_bits_for_two_threads(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_traction traction = {
        .face = 1, .kind = TALUS_TRACTION_NORMAL, .is_pressure = true, .value = {1e4, 0, 0}};
    fill(&fixture, 1e6, 1.0);
    load(&fixture.bodies[0], &traction, 1);
    struct talus_simulation *one = simulation_fixture_start(&fixture, 1);
    struct talus_simulation *two = simulation_fixture_start(&fixture, 2);
    simulation_run_steps(one, 300);
    simulation_run_steps(two, 300);
    assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
    talus_simulation_destroy(one);
    talus_simulation_destroy(two);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impulse_modified_last),
        cmocka_unit_test(impulse_last),
        cmocka_unit_test(loads_follow_the_deformation),
        cmocka_unit_test(normal_pressure_acts_on_the_present_area),
        cmocka_unit_test(each_body_has_its_own_load),
        cmocka_unit_test(the_ramp_acts_on_tractions),
        cmocka_unit_test(same_bits_for_two_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
