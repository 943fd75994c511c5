/* SPDX-License-Identifier: Apache-2.0 */
/* The velocity at the start of a step, of which material moves or strains with a share. */
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};

/* A block under pressure, whose particles at the edge have just entered new cells: its share of the
 * mass of a particle is eps = 0.005 an axis at the nodes there. */
static void build(struct simulation_fixture *fixture, enum talus_stress_update update)
{
    static const int64_t count[3] = {20, 20, 1};
    static const double min[3] = {0.4755, 0.4755, 0}, max[3] = {0.8755, 0.8755, 0};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(fixture, material, min, max, 2);
    for (size_t axis = 0; axis < 2; axis++) {
        body->velocity[axis] = -0.1;
        body->stress[axis] = -1e5;
    }
    body->initial_stress = TALUS_INITIAL_GIVEN;
    fixture->scene.solver.stress_update = update;
    fixture->scene.solver.theta = 0.5;
    fixture->scene.energy_growth_limit = 1;
}

static double fastest_particle(const struct talus_simulation *simulation)
{
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3), fastest = 0;
    for (size_t k = 0; k < 3 * simulation_particle_count(simulation); k++)
        fastest = fmax(fastest, fabs(velocity[k]));
    free(velocity);
    return fastest;
}

static double fastest_start(const struct run *run)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    double fastest = 0;
    for (size_t block = 0; block < nodes->count; block++) {
        for (uint32_t axis = 0; axis < 2; axis++) {
            for (size_t lane = 0; lane < LANE_COUNT; lane++)
                fastest =
                    fmax(fastest,
                         fabs((double)node_values(nodes, block, nodes->layout.start + axis)[lane]));
        }
    }
    return fastest;
}

/* It is a mean of the velocities of the particles, none of which it can exceed. */
static void test_light_nodes(void **state)
{
    (void)state;
    for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
        struct simulation_fixture fixture;
        build(&fixture, (enum talus_stress_update)update);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        double worst = 0;
        for (size_t step = 0; step < 3; step++) {
            const double before = fastest_particle(simulation);
            simulation_run_steps(simulation, 1);
            worst = fmax(worst, fastest_start(&simulation->run) / before);
        }
        print_message("stress update %d: start velocity %.3g of the fastest particle\n", update,
                      worst);
        assert_true(worst > 0.5);
        assert_true(worst <= 1 + 1e-12);
        talus_simulation_destroy(simulation);
    }
}

/* Strained by a mean of start and end, at a step at which bulk damping carries the waves of that
 * (method.md), a block that springs back drifts through cells, and has no more motion than it had
 * energy. */
static void test_drift(void **state)
{
    (void)state;
    for (int lags = 0; lags < 2; lags++) {
        struct simulation_fixture fixture;
        build(&fixture, TALUS_STRESS_MODIFIED_LAST);
        fixture.scene.solver.theta = 1;
        fixture.scene.solver.strain_theta = lags ? 0.5 : 1;
        fixture.scene.solver.allow_unstable = true;
        fixture.scene.solver.viscous_damping = 0.4;
        fixture.scene.solver.courant = 0.2;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        simulation_run_steps(simulation, 400);
        run_measure_energy(&simulation->run);
        const double stored = simulation->run.audit.initial_stored;
        print_message("strain_theta %g: kinetic energy %.3g of that at the start\n",
                      lags ? 0.5 : 1.0, simulation->run.energy.kinetic / stored);
        assert_true(simulation->run.energy.kinetic < stored);
        talus_simulation_destroy(simulation);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_nodes),
        cmocka_unit_test(test_drift),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
