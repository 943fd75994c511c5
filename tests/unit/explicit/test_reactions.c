/* SPDX-License-Identifier: Apache-2.0 */
/* Reactions: impulse and momentum, peaks, running means, release, contact areas, moments. */
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};

/* A block of 0.4 x 0.3 m, 120 kg/m, that falls a little and lands on a floor. */
static void build(struct simulation_fixture *fixture, double gap)
{
    static const int64_t count[3] = {20, 20, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(
        fixture, material, (double[3]){0.6, 0.5 + gap}, (double[3]){1.0, 0.8 + gap}, 2);
    body->velocity[1] = -1.0;
    body->velocity[0] = 0.3;
    fixture->scene.gravity[1] = -9.81;
    struct talus_boundary *floor =
        simulation_fixture_add_plane(fixture, "floor", 1, 0.5, 1, "friction", 0.2);
    floor->tension_release = true;
}

static double momentum(const struct talus_simulation *simulation, size_t axis)
{
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
    double *mass = simulation_field(simulation, TALUS_FIELD_MASS, 1), sum = 0;
    for (size_t k = 0; k < simulation_particle_count(simulation); k++)
        sum += mass[k] * velocity[3 * k + axis];
    free(velocity);
    free(mass);
    return sum;
}

/* The forces of the samples, times the intervals between them, are the change of momentum. */
static void test_no_momentum_is_lost_between_samples(void **state)
{
    (void)state;
    for (int variant = 0; variant < 2 * TALUS_STRESS_UPDATE_COUNT; variant++) {
        struct simulation_fixture fixture;
        build(&fixture, 0.02);
        fixture.boundaries[0].wall = variant % 2 ? TALUS_WALL_KEEP : TALUS_WALL_STOP;
        fixture.scene.solver.stress_update = (enum talus_stress_update)(variant / 2);
        if (fixture.scene.solver.stress_update != TALUS_STRESS_MODIFIED_LAST)
            fixture.scene.solver.courant = 0.05; /* light nodes; walls that keep velocities */
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        size_t columns = 0;
        (void)talus_simulation_columns(simulation, &columns);
        double *row = calloc(columns, sizeof *row), impulse[2] = {0, 0}, last = 0;
        assert_non_null(row);
        const size_t force[2] = {simulation_column(simulation, "reaction.floor.force.x"),
                                 simulation_column(simulation, "reaction.floor.force.y")};
        const double start[2] = {momentum(simulation, 0), momentum(simulation, 1)};
        for (size_t sample = 0; sample < 40; sample++) {
            simulation_run_steps(simulation, 1 + sample % 7);
            talus_simulation_sample(simulation, row);
            for (size_t axis = 0; axis < 2; axis++)
                impulse[axis] += row[force[axis]] * (row[0] - last);
            last = row[0];
            assert_close(momentum(simulation, 0) - start[0], -impulse[0], 1e-11, 120);
            assert_close(momentum(simulation, 1) - start[1], -impulse[1] - 120 * 9.81 * row[0],
                         1e-11, 120);
        }
        assert_true(impulse[1] < -50); /* it did land */
        assert_true(impulse[0] > 1);   /* and was slowed down */
        assert_true(impulse[0] < 0.2 * -impulse[1] * (1 + 1e-12));
        free(row);
        talus_simulation_destroy(simulation);
    }
}

/* The peak of every step is the largest of all steps; samples see some of them. */
static void test_peaks_are_those_of_every_step(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 0.02);
    struct talus_simulation *every = simulation_fixture_start(&fixture, 1);
    struct talus_simulation *sampled = simulation_fixture_start(&fixture, 1);
    size_t columns = 0;
    (void)talus_simulation_columns(every, &columns);
    double *row = calloc(columns, sizeof *row), peak = 0, when = 0, seen = 0, averaged = 0;
    assert_non_null(row);
    const size_t instant = simulation_column(every, "reaction.floor.instant.x");
    const size_t force = simulation_column(every, "reaction.floor.force.x");
    for (size_t step = 0; step < 200; step++) {
        simulation_run_steps(every, 1);
        talus_simulation_sample(every, row);
        const double size = hypot(row[instant], row[instant + 1]);
        assert_close(row[force + 1], row[instant + 1], 1e-12, size + 1);
        if (size > peak) {
            peak = size;
            when = row[0];
        }
        simulation_run_steps(sampled, 1);
        if (step % 9 != 8)
            continue;
        talus_simulation_sample(sampled, row);
        seen = fmax(seen, hypot(row[instant], row[instant + 1]));
        averaged = fmax(averaged, hypot(row[force], row[force + 1]));
    }
    assert_true(peak > 120 * 9.81);
    assert_close(simulation_metric(every, "reaction.floor.peak"), peak, 1e-13, peak);
    assert_true(simulation_metric(every, "reaction.floor.peak_time") == when);
    assert_true(simulation_metric(sampled, "reaction.floor.peak") ==
                simulation_metric(every, "reaction.floor.peak"));
    assert_true(seen <= peak && averaged <= peak && averaged > 0);
    assert_close(hypot(simulation_metric(every, "reaction.floor.peak.x"),
                       simulation_metric(every, "reaction.floor.peak.y")),
                 peak, 1e-13, peak);
    free(row);
    talus_simulation_destroy(every);
    talus_simulation_destroy(sampled);
}

enum { STEPS = 200 };

/* Mean over the last steps that together last at least the window, in a run that is younger than
 * the window over the whole window. */
static double mean_force(const double impulse[STEPS][2], const double *step, size_t last,
                         double window)
{
    double time = 0, sum[2] = {0, 0};
    for (size_t k = last + 1; k-- > 0;) {
        if (time >= window * (1 - 1e-12))
            break;
        time += step[k];
        sum[0] += impulse[k][0];
        sum[1] += impulse[k][1];
    }
    return hypot(sum[0], sum[1]) / fmax(time, window);
}

static void test_running_mean(void **state)
{
    (void)state;
    static const double windows[3] = {1e-3, 0.0107, 5.0};
    for (size_t index = 0; index < LENGTH(windows); index++) {
        struct simulation_fixture fixture;
        static double impulse[STEPS][2], length[STEPS];
        build(&fixture, 0.02);
        fixture.boundaries[0].peak_window = windows[index];
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        size_t columns = 0;
        (void)talus_simulation_columns(simulation, &columns);
        double *row = calloc(columns, sizeof *row), peak = 0, when = 0, time = 0;
        assert_non_null(row);
        const size_t instant = simulation_column(simulation, "reaction.floor.instant.x");
        for (size_t step = 0; step < STEPS; step++) {
            simulation_run_steps(simulation, 1);
            talus_simulation_sample(simulation, row);
            length[step] = row[0] - time;
            time = row[0];
            impulse[step][0] = row[instant] * length[step];
            impulse[step][1] = row[instant + 1] * length[step];
            const double mean =
                mean_force((const double(*)[2])impulse, length, step, windows[index]);
            if (mean > peak) {
                peak = mean;
                when = time;
            }
            assert_close(simulation_metric(simulation, "reaction.floor.peak"), peak, 1e-9,
                         peak + 1e-6);
        }
        assert_true(peak > 10);
        assert_close(simulation_metric(simulation, "reaction.floor.peak_time"), when, 1e-12, 1);
        free(row);
        talus_simulation_destroy(simulation);
    }
}

/* With release the block may fly up again; without it the floor holds it. */
static void test_tension_release(void **state)
{
    (void)state;
    double lowest[2];
    for (int release = 0; release < 2; release++) {
        struct simulation_fixture fixture;
        build(&fixture, 0.0);
        fixture.scene.gravity[1] = 0;
        fixture.boundaries[0].tension_release = release != 0;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        size_t columns = 0;
        (void)talus_simulation_columns(simulation, &columns);
        double *row = calloc(columns, sizeof *row), pull = 0;
        assert_non_null(row);
        const size_t force = simulation_column(simulation, "reaction.floor.instant.y");
        for (size_t step = 0; step < 400; step++) {
            simulation_run_steps(simulation, 1);
            talus_simulation_sample(simulation, row);
            pull = fmax(pull, row[force]);
        }
        double *position = calloc(3 * simulation_particle_count(simulation), sizeof *position);
        assert_non_null(position);
        talus_simulation_read_positions(simulation, position);
        lowest[release] = INFINITY;
        for (size_t k = 0; k < simulation_particle_count(simulation); k++)
            lowest[release] = fmin(lowest[release], position[3 * k + 1]);
        assert_true(release ? pull <= 0 : pull > 0);
        free(position);
        free(row);
        talus_simulation_destroy(simulation);
    }
    assert_true(lowest[0] < 0.53);
    assert_true(lowest[1] > 0.6);
}

/* A block at rest: weight, its place, and the area it stands on. */
static void test_weight_area_and_moment(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 0.0);
    fixture.bodies[0].velocity[0] = fixture.bodies[0].velocity[1] = 0;
    fixture.bodies[0].initial_stress = TALUS_INITIAL_NONE;
    fixture.scene.solver.local_damping = 0.3;
    fixture.boundaries[0].moment_about[0] = 0.5;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    size_t columns = 0;
    (void)talus_simulation_columns(simulation, &columns);
    double *row = calloc(columns, sizeof *row);
    assert_non_null(row);
    talus_simulation_sample(simulation, row);
    assert_true(row[simulation_column(simulation, "reaction.floor.force.y")] == 0);
    simulation_run_steps(simulation, 600);
    talus_simulation_sample(simulation, row);
    simulation_run_steps(simulation, 300);
    talus_simulation_sample(simulation, row);
    const double force = row[simulation_column(simulation, "reaction.floor.force.y")];
    assert_close(force, -120 * 9.81, 1e-3, 120 * 9.81);
    /* The centre of the block is at 0.8 m, the moment about 0.5 m. */
    assert_close(row[simulation_column(simulation, "reaction.floor.moment.z")], 0.3 * force, 1e-3,
                 400);
    /* Five nodes in the block's foot, of 0.1 m each: nodes stand for what is on their cells. */
    assert_close(row[simulation_column(simulation, "reaction.floor.contact_area")], 0.5, 1e-12, 1);
    free(row);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_momentum_is_lost_between_samples),
        cmocka_unit_test(test_peaks_are_those_of_every_step),
        cmocka_unit_test(test_running_mean),
        cmocka_unit_test(test_tension_release),
        cmocka_unit_test(test_weight_area_and_moment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
