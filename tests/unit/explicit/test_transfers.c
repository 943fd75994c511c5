/* SPDX-License-Identifier: Apache-2.0 */
/* What each transfer keeps: momentum always; an affine velocity field and the angular momentum with
 * `apic`; and what of it is refused. */
#include "shapes/shape.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"
#include "transfers/velocity_transfer.h"

#define CELL 0.1

static size_t transfer_index(const char *name)
{
    size_t index = 0;
    while (index < transfer_count && strcmp(transfer_table[index]->name, name) != 0)
        index++;
    assert_true(index < transfer_count);
    return index;
}

/* v = a + B x */
static const double slopes[3][3] = {{0.3, -2.0, 0.7}, {1.5, -0.4, 0.2}, {-0.6, 0.9, 0.1}};

static void affine_field(void *context, uint32_t id, const double position[3], double time,
                         double out[3])
{
    (void)context;
    (void)id;
    (void)time;
    for (size_t row = 0; row < 3; row++) {
        out[row] = 0.2 * (double)row - 0.1;
        for (size_t column = 0; column < 3; column++)
            out[row] += slopes[row][column] * position[column];
    }
}

/* Turning, and something that no cell can follow. */
static void rough_field(void *context, uint32_t id, const double position[3], double time,
                        double out[3])
{
    affine_field(context, id, position, time, out);
    out[0] += 0.3 * sin(100.0 * (double)id);
    out[1] += 0.3 * cos(70.0 * (double)id);
}

static void build(struct simulation_fixture *fixture, size_t axes, const char *transfer)
{
    static const struct setting elastic[] = {
        {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};
    static const int64_t count[3] = {20, 20, 20};
    static const double min[3] = {0.63, 0.71, 0.6}, max[3] = {1.13, 1.01, 0.9};
    simulation_fixture_init(fixture, axes, CELL, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    simulation_fixture_add_box(fixture, material, min, max, 2);
    fixture->scene.solver.transfer_index = transfer_index(transfer);
    fixture->scene.solver.allow_unstable = true;
    fixture->scene.solver.time_step = 1e-4;
}

static struct talus_simulation *start(const struct simulation_fixture *fixture,
                                      talus_particle_function *velocity)
{
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {
        .threads = 1, .all_threads = true, .initial_velocity = velocity};
    if (talus_simulation_create(&fixture->scene, &options, &simulation, &error) != TALUS_OK)
        fail_msg("create: %s", error.text);
    return simulation;
}

/* Calls `visit` for every particle. */
typedef void visit_particle(struct run *run, const struct particle_block *block, size_t slot,
                            void *context);

static void visit_all(struct talus_simulation *simulation, visit_particle *visit, void *context)
{
    struct run *run = &simulation->run;
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            if (block->id[slot] != PARTICLE_NONE)
                visit(run, block, slot, context);
        }
    }
}

static double value_of(const struct run *run, const struct particle_block *block, size_t slot,
                       enum particle_field field, uint32_t component)
{
    return particle_values(&run->grid.layout, block, field, component)[slot];
}

/* The slopes that the start estimates are off at the edge of a body; these are exact. */
static void set_slopes(struct run *run, const struct particle_block *block, size_t slot,
                       void *context)
{
    const uint32_t axes = (uint32_t)run->grid.domain.axis_count;
    (void)context;
    for (uint32_t entry = 0; entry < axes * axes; entry++)
        particle_values(&run->grid.layout, block, PARTICLE_AFFINE, entry)[slot] =
            CELL * slopes[entry / axes][entry % axes];
}

static void check_slopes(struct run *run, const struct particle_block *block, size_t slot,
                         void *context)
{
    const uint32_t axes = (uint32_t)run->grid.domain.axis_count;
    const double *start = (const double *)context + (size_t)6 * block->id[slot];
    for (uint32_t axis = 0; axis < axes; axis++)
        assert_close(value_of(run, block, slot, PARTICLE_VELOCITY, axis), start[3 + axis], 1e-12,
                     1);
    for (uint32_t entry = 0; entry < axes * axes; entry++)
        assert_close(value_of(run, block, slot, PARTICLE_AFFINE, entry),
                     CELL * slopes[entry / axes][entry % axes], 1e-12, 1);
}

/* Positions and velocities by id: [6 id], [6 id + 3]. */
static void save_motion(struct run *run, const struct particle_block *block, size_t slot,
                        void *context)
{
    double *motion = (double *)context + (size_t)6 * block->id[slot];
    sparse_grid_slot_position(&run->grid, block, slot, motion);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        motion[3 + axis] = value_of(run, block, slot, PARTICLE_VELOCITY, axis);
}

/* From particles to nodes and back without force: nothing changes, whatever the shape. */
static void test_affine_field_is_kept(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < shape_count; shape++) {
        if (shape_table[shape]->halves_cells)
            continue; /* refused: method_check.c */
        for (size_t axes = 1; axes <= 3; axes++) {
            struct simulation_fixture fixture;
            build(&fixture, axes, "apic");
            fixture.scene.solver.shape_index = shape;
            struct talus_simulation *simulation = start(&fixture, affine_field);
            double *motion = calloc(6 * simulation_particle_count(simulation), sizeof *motion);
            assert_non_null(motion);
            visit_all(simulation, set_slopes, NULL);
            visit_all(simulation, save_motion, motion);
            simulation_run_steps(simulation, 1);
            visit_all(simulation, check_slopes, motion);
            free(motion);
            talus_simulation_destroy(simulation);
        }
    }
}

/* About the origin: of the positions saved in `motion`, the present velocities, and within the
 * particles, where D of hat functions is 1/4 - x^2 cell widths squared. */
struct spin {
    const double *motion;
    double total, scale;
};

static void add_spin(struct run *run, const struct particle_block *block, size_t slot,
                     void *context)
{
    struct spin *spin = context;
    const double *x = spin->motion + (size_t)6 * block->id[slot];
    const double m = value_of(run, block, slot, PARTICLE_MASS, 0);
    const double u = value_of(run, block, slot, PARTICLE_VELOCITY, 0);
    const double v = value_of(run, block, slot, PARTICLE_VELOCITY, 1);
    double own = 0;
    for (uint32_t axis = 0; axis < 2 && run->grid.layout.component_count[PARTICLE_AFFINE] > 0;
         axis++) {
        const double cells = (x[axis] - run->grid.domain.min[axis]) / CELL;
        const double offset = cells - floor(cells) - 0.5;
        const double slope = value_of(run, block, slot, PARTICLE_AFFINE, 2 * (1 - axis) + axis);
        own += (axis == 0 ? 1 : -1) * slope * CELL * (0.25 - offset * offset);
    }
    spin->total += m * (x[0] * v - x[1] * u + own);
    spin->scale += m * hypot(x[0], x[1]) * hypot(u, v);
}

/* Change of the angular momentum by a step, relative to the sum of its parts. */
static double spin_change(struct talus_simulation *simulation)
{
    double *motion = calloc(6 * simulation_particle_count(simulation), sizeof *motion);
    assert_non_null(motion);
    visit_all(simulation, save_motion, motion);
    struct spin before = {.motion = motion}, after = {.motion = motion};
    visit_all(simulation, add_spin, &before);
    simulation_run_steps(simulation, 1);
    visit_all(simulation, add_spin, &after);
    free(motion);
    return fabs(after.total - before.total) / before.scale;
}

/* With the affine part, a step keeps the angular momentum of velocities and slopes at the positions
 * from which they went to the nodes, forces included; FLIP changes it by what lumping the mass
 * takes, PIC by all that the nodes do not see. */
static void test_angular_momentum(void **state)
{
    (void)state;
    for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
        static const char *const names[3] = {"apic", "flip", "pic"};
        double worst[3] = {0, 0, 0};
        for (size_t index = 0; index < 3; index++) {
            struct simulation_fixture fixture;
            build(&fixture, 2, names[index]);
            fixture.scene.solver.stress_update = (enum talus_stress_update)update;
            struct talus_simulation *simulation = start(&fixture, rough_field);
            for (size_t step = 0; step < 20; step++)
                worst[index] = fmax(worst[index], spin_change(simulation));
            talus_simulation_destroy(simulation);
        }
        print_message("ordering %d: change of angular momentum per step: apic %.1e, flip %.1e, "
                      "pic %.1e\n",
                      update, worst[0], worst[1], worst[2]);
        assert_true(worst[0] < 1e-14);
        assert_true(worst[1] > 1e-8 && worst[2] > 1e-4);
    }
}

/* Two bodies that meet, with every transfer and ordering. */
static void test_momentum(void **state)
{
    (void)state;
    for (size_t transfer = 0; transfer < transfer_count; transfer++) {
        for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
            struct simulation_fixture fixture;
            build(&fixture, 2, transfer_table[transfer]->name);
            simulation_fixture_add_box(&fixture, 0, (double[3]){1.13, 0.71},
                                       (double[3]){1.43, 1.01}, 2)
                ->velocity[0] = -0.5;
            fixture.bodies[0].velocity[0] = 0.5;
            fixture.scene.solver.stress_update = (enum talus_stress_update)update;
            if (transfer == 0)
                fixture.scene.solver.flip_ratio = 0.98;
            struct talus_simulation *simulation = start(&fixture, NULL);
            simulation_run_steps(simulation, 60);
            assert_true(simulation_metric(simulation, "mass_error") <= 1e-14);
            assert_true(simulation_metric(simulation, "momentum_error") <= 1e-13);
            assert_true(simulation_metric(simulation, "energy_error") <= 0.01);
            talus_simulation_destroy(simulation);
        }
    }
}

/* A ratio per step is a rate of its logarithm over the step. */
static void test_flip_ratio(void **state)
{
    (void)state;
    double loss[2];
    for (int by_rate = 0; by_rate < 2; by_rate++) {
        struct simulation_fixture fixture;
        build(&fixture, 2, "flip");
        if (by_rate)
            fixture.scene.solver.pic_rate = -log(0.9) / fixture.scene.solver.time_step;
        else
            fixture.scene.solver.flip_ratio = 0.9;
        struct talus_simulation *simulation = start(&fixture, rough_field);
        simulation_run_steps(simulation, 50);
        loss[by_rate] = simulation_metric(simulation, "energy_numerical");
        talus_simulation_destroy(simulation);
    }
    assert_true(loss[0] > 0.01);
    assert_close(loss[0], loss[1], 1e-12, 1);
}

static void assert_refused(const struct simulation_fixture *fixture, const char *pointer)
{
    struct talus_estimate estimate;
    struct talus_error error = {0};
    assert_int_equal(talus_simulation_estimate(&fixture->scene, &estimate, &error), TALUS_INVALID);
    assert_string_equal(error.pointer, pointer);
}

static void test_refusals(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_estimate estimate;
    struct talus_error error = {0};
    build(&fixture, 2, "flip");
    simulation_fixture_add_plane(&fixture, "floor", 1, 0.1, 1, "slip", 0)->wall = TALUS_WALL_KEEP;
    assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
    fixture.scene.solver.pic_rate = 1;
    assert_refused(&fixture, "/boundaries/0/wall");
    fixture.scene.solver.pic_rate = 0;
    fixture.scene.solver.transfer_index = transfer_index("pic");
    assert_refused(&fixture, "/boundaries/0/wall");
    build(&fixture, 2, "apic");
    fixture.scene.solver.allow_unstable = false;
    assert_refused(&fixture, "/solver/transfer");
    fixture.scene.solver.flip_ratio = 0.5;
    assert_refused(&fixture, "/solver/flip_ratio");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_affine_field_is_kept),
        cmocka_unit_test(test_angular_momentum),
        cmocka_unit_test(test_momentum),
        cmocka_unit_test(test_flip_ratio),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
