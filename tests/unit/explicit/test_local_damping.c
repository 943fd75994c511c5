/* SPDX-License-Identifier: Apache-2.0 */
/* Local damping: what it takes is never negative, and the books hold with it. */
#include "explicit/run.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}}, stiff[] = {
    {"density", 1000}, {"young_modulus", 1e7}, {"poisson_ratio", 0.3}};

static const char *const shapes[] = {"linear", "bspline2", "bspline3", "gimp"};
static const double dampings[] = {0, 0.1, 0.3, 0.8};

static size_t shape_named(const char *name)
{
    size_t shape = 0;
    while (strcmp(shape_table[shape]->name, name) != 0)
        shape++;
    return shape;
}

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

static const struct problem problems[] = {
    {"cantilever", build_cantilever, 1200}, {"drift", build_drift, 600}, {"slide", build_slide, 800}};

/* Runs it; the largest growth of energy beyond the books, over the turnover. */
static double run_problem(const struct problem *problem, const char *shape, double damping,
                          enum talus_stress_update update)
{
    struct simulation_fixture fixture;
    problem->build(&fixture);
    fixture.scene.solver.shape_index = shape_named(shape);
    fixture.scene.solver.stress_update = update;
    fixture.scene.solver.local_damping = damping;
    fixture.scene.energy_growth_limit = 1;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct run *run = &simulation->run;
    double before = 0, worst = 0, taken = 0;
    struct talus_error error;
    for (size_t step = 0; step < problem->steps; step++) {
        if (run_take_step(run, &error) != TALUS_OK) {print_message("%s\n", error.text); worst=9; break;}
        taken = fmax(taken, before - run->energy.damping);
        before = run->energy.damping;
        if (step % 16 == 15) {
            run_measure_energy(run);
            worst = fmax(worst, -run_numerical_loss(run) / run_energy_turnover(run));
        }
    }
    print_message("%-10s %-8s %.1f %d: growth %6.2f %%, end %6.2f %%, taken %.3f back %.3g kinetic %.3g, mom %.1e\n", problem->name, shape, damping,
                  (int)update, 100 * worst, 100*run_numerical_loss(run) / run_energy_turnover(run), run->energy.damping / run_energy_turnover(run), taken / run_energy_turnover(run), run->energy.kinetic/run_energy_turnover(run), simulation_metric(simulation, "momentum_error"));
    talus_simulation_destroy(simulation);
    return worst;
}

static void test_books(void **state)
{
    (void)state;
    for (size_t problem = 0; problem < LENGTH(problems); problem++) {
        for (size_t shape = 0; shape < LENGTH(shapes); shape++) {
            for (size_t damping = 0; damping < LENGTH(dampings); damping++)
              for (int u=0;u<3;u++)
                run_problem(&problems[problem], shapes[shape], dampings[damping], u);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_books),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
