/* SPDX-License-Identifier: Apache-2.0 */
/* Local damping: it never gives, the books hold with it, and what it damps comes to rest. */
#include "explicit/run.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

static const struct setting elastic[] = {{"density", 1000},
                                         {"young_modulus", 1e6},
                                         {"poisson_ratio", 0.3}},
                            stiff[] = {
                                {"density", 1000}, {"young_modulus", 1e7}, {"poisson_ratio", 0.3}};

static const char *const shapes[] = {"linear", "bspline2", "bspline3", "gimp"};
static const double dampings[] = {0.1, 0.8};
static const char *const update_names[] = {"modified_last", "last", "first"};

/* A cantilever that falls from its straight form. */
static void build_cantilever(struct simulation_fixture *fixture)
{
    static const int64_t count[3] = {20, 20, 1};
    static const double min[3] = {0, 1.25, 0}, max[3] = {4, 2.25, 0};
    simulation_fixture_init(fixture, 2, 0.25, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", stiff, LENGTH(stiff));
    simulation_fixture_add_box(fixture, material, min, max, 2);
    simulation_fixture_add_plane(fixture, "clamp", 0, 0, 1, "stick", 0);
    fixture->scene.gravity[1] = -10;
}

/* A stressed block that drifts through cells and meets nothing: light nodes. */
static void build_drift(struct simulation_fixture *fixture)
{
    static const int64_t count[3] = {40, 20, 1};
    static const double min[3] = {0.52, 0.52, 0}, max[3] = {1.32, 0.92, 0};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(fixture, material, min, max, 2);
    body->velocity[0] = 2;
    body->velocity[1] = 0.4;
    body->stress[0] = -2e4;
    body->initial_stress = TALUS_INITIAL_GIVEN;
}

/* A block that lands on a rough floor, slides, and leans on a wall. */
static void build_slide(struct simulation_fixture *fixture)
{
    static const int64_t count[3] = {20, 20, 1};
    static const double min[3] = {0.5, 0.12, 0}, max[3] = {1.1, 0.52, 0};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(fixture, material, min, max, 2);
    body->velocity[0] = 2;
    simulation_fixture_add_plane(fixture, "floor", 1, 0.1, 1, "friction", 0.3);
    simulation_fixture_add_plane(fixture, "side", 0, 1.5, -1, "slip", 0);
    fixture->scene.gravity[1] = -10;
}

struct problem {
    const char *name;
    void (*build)(struct simulation_fixture *fixture);
    size_t steps;
};

static const struct problem problems[] = {{"cantilever", build_cantilever, 500},
                                          {"drift", build_drift, 400},
                                          {"slide", build_slide, 400}};

/* Takes the steps of a problem. The audit allows the energy to grow by 1 % of the turnover beyond
 * the books; what damping has taken may not fall at all, but for rounding. */
static void check_books(const struct problem *problem, const char *shape, double damping,
                        enum talus_stress_update update)
{
    struct simulation_fixture fixture;
    problem->build(&fixture);
    fixture.scene.solver.shape_index = simulation_fixture_shape(shape);
    fixture.scene.solver.stress_update = update;
    fixture.scene.solver.local_damping = damping;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct run *run = &simulation->run;
    double before = 0, given_back = 0, growth = 0;
    for (size_t step = 0; step < problem->steps; step++) {
        simulation_run_steps(simulation, 1);
        given_back = fmax(given_back, before - run->energy.damping);
        before = run->energy.damping;
        if (step % 16 == 15) {
            run_measure_energy(run);
            growth = fmax(growth, -run_numerical_loss(run) / run_energy_turnover(run));
        }
    }
    const double turnover = run_energy_turnover(run);
    print_message("%s, %s, %s, %g: growth %.2f %%, damping took %.3f and gave back %.1e\n",
                  problem->name, shape, update_names[update], damping, 100 * growth,
                  before / turnover, given_back / turnover);
    assert_true(growth < 0.01);
    assert_true(given_back <= 1e-12 * turnover);
    assert_true(before > 0.02 * turnover);
    assert_true(simulation_metric(simulation, "momentum_error") <= 1e-12);
    talus_simulation_destroy(simulation);
}

/* With hat functions `last` is unstable at light nodes, and `first` where particles lie on the
 * edges of cells at a wall, damped or not. */
static void test_books(void **state)
{
    (void)state;
    for (size_t problem = 0; problem < LENGTH(problems); problem++) {
        for (size_t shape = 0; shape < LENGTH(shapes); shape++) {
            for (size_t damping = 0; damping < LENGTH(dampings); damping++) {
                for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
                    if (shape > 0 || update == TALUS_STRESS_MODIFIED_LAST)
                        check_books(&problems[problem], shapes[shape], dampings[damping],
                                    (enum talus_stress_update)update);
                }
            }
        }
    }
}

/* What is damped comes to rest: the clamp carries the weight of the beam, within 1 %. */
static void test_rest(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < 2; shape++) {
        struct simulation_fixture fixture;
        build_cantilever(&fixture);
        fixture.scene.solver.shape_index = simulation_fixture_shape(shapes[shape]);
        fixture.scene.solver.local_damping = 0.3;
        fixture.scene.duration = 100;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        simulation_run_steps(simulation, 3000);
        size_t columns = 0;
        (void)talus_simulation_columns(simulation, &columns);
        double *row = calloc(columns, sizeof *row);
        assert_non_null(row);
        talus_simulation_sample(simulation, row);
        simulation_run_steps(simulation, 1000);
        talus_simulation_sample(simulation, row);
        const double force = row[simulation_column(simulation, "reaction.clamp.force.y")];
        print_message("%s: the clamp carries %.4f of the weight\n", shapes[shape], -force / 4e4);
        assert_close(force, -4e4, 0.01, 4e4);
        free(row);
        talus_simulation_destroy(simulation);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_books),
        cmocka_unit_test(test_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
