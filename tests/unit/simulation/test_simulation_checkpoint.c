/* SPDX-License-Identifier: Apache-2.0 */
/* A restored run goes on with the same bits, and a checkpoint is refused where it does not belong.
 */
#include "shapes/shape.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

enum { STEPS = 240 };

/* A wet heap slides off a shelf with friction into a sink that eats it: cells are crossed, blocks
 * come and go, particles are eliminated; two materials, a running mean, probes;
 * gravity that varies over time and a pressure that follows the surface. */
static void build(struct simulation_fixture *fixture)
{
    static double times[] = {0.0, 0.01}, pulls[] = {-9.81, -12.0}, pressures[] = {0.0, 500.0};
    static struct talus_traction push = {
        .kind = TALUS_TRACTION_NORMAL,
        .is_pressure = true,
        .table = {{.count = 2, .time = times, .value = pressures}}};
    static const int64_t count[3] = {60, 20, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    struct talus_scene *scene = &fixture->scene;
    const size_t soil = simulation_fixture_add_sample(fixture, material_find("matsuoka_nakai"));
    const size_t water = simulation_fixture_add_sample(fixture, material_find("newtonian_fluid"));
    simulation_fixture_add_box(fixture, soil, (double[3]){1.0, 0.2}, (double[3]){2.2, 0.8}, 2)
        ->velocity[0] = 8.0;
    simulation_fixture_add_box(fixture, water, (double[3]){1.0, 0.8}, (double[3]){2.2, 1.2}, 2)
        ->velocity[0] = 9.0;
    scene->gravity[1] = -9.81;
    scene->gravity_table[1] = (struct talus_time_table){.count = 2, .time = times, .value = pulls};
    fixture->bodies[0].tractions = &push;
    fixture->bodies[0].traction_count = 1;
    scene->solver.pic_rate = 1.0;
    scene->solver.viscous_damping = 0.1;
    scene->output.frame_fields = 1u << TALUS_FIELD_STRESS | 1u << TALUS_FIELD_DISPLACEMENT;
    struct talus_boundary *floor =
        simulation_fixture_add_plane(fixture, "floor", 1, 0.2, 1, "friction", 0.3);
    floor->peak_window = 0.005;
    floor->tension_release = true;
    simulation_fixture_add_obstacle(fixture, "pile", (double[3]){3.2, 0.2}, (double[3]){3.4, 0.4},
                                    "slip", 0);
    simulation_fixture_add_plane(fixture, "sink", 0, 2.9, -1, "eliminate", 0);
    /* A ram catches up with the heap, over many grid lines, and is gone at the end. */
    struct talus_boundary *ram =
        simulation_fixture_add_plane(fixture, "ram", 0, 0.93, 1, "velocity", 0);
    ram->prescribed = 1;
    ram->velocity[0] = 9.7;
    ram->timed = true;
    ram->from = -INFINITY;
    ram->until = 0.06;
    struct talus_probe *probe = simulation_fixture_add_probe(fixture, "point", TALUS_PROBE_POINT);
    probe->at[0] = 1.0;
    probe->at[1] = 0.3;
    probe->field = TALUS_FIELD_VELOCITY;
}

/* A checkpoint of its own, as if it had been written and read. */
struct saved {
    struct talus_blob *blobs;
    size_t count;
};

static struct saved save(struct talus_simulation *simulation)
{
    struct saved saved = {0};
    const struct talus_blob *blobs = talus_simulation_checkpoint(simulation, &saved.count);
    assert_non_null(blobs);
    saved.blobs = calloc(saved.count, sizeof *saved.blobs);
    assert_non_null(saved.blobs);
    for (size_t index = 0; index < saved.count; index++) {
        void *data = malloc(blobs[index].bytes + 1);
        assert_non_null(data);
        memcpy(data, blobs[index].data, blobs[index].bytes);
        saved.blobs[index] = blobs[index];
        saved.blobs[index].data = data;
    }
    return saved;
}

static void saved_release(struct saved *saved)
{
    for (size_t index = 0; index < saved->count; index++)
        free((void *)(uintptr_t)saved->blobs[index].data);
    free(saved->blobs);
}

static struct talus_simulation *restore(const struct simulation_fixture *fixture,
                                        const struct saved *saved)
{
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = 1};
    if (talus_simulation_restore(&fixture->scene, &options, saved->blobs, saved->count, &simulation,
                                 &error) != TALUS_OK)
        fail_msg("restore: %s", error.text);
    return simulation;
}

/* Reactions at the nodes must not be lost. */
static void compare_nodes(const struct talus_simulation *a, const struct talus_simulation *b)
{
    const size_t count = talus_simulation_read_nodes(a, NULL, NULL, NULL, NULL, NULL);
    assert_int_equal(talus_simulation_read_nodes(b, NULL, NULL, NULL, NULL, NULL), count);
    double *values = calloc(count * 22, sizeof *values);
    assert_non_null(values);
    double *other = values + 11 * count;
    (void)talus_simulation_read_nodes(a, values, values + 3 * count, values + 4 * count,
                                      values + 7 * count, values + 10 * count);
    (void)talus_simulation_read_nodes(b, other, other + 3 * count, other + 4 * count,
                                      other + 7 * count, other + 10 * count);
    assert_memory_equal(values, other, 11 * count * sizeof *values);
    free(values);
}

static void compare_all(struct talus_simulation *a, struct talus_simulation *b)
{
    struct talus_simulation_state first, second;
    size_t columns = 0, metrics = 0, other_metrics = 0;
    assert_true(talus_simulation_state_hash(a) == talus_simulation_state_hash(b));
    talus_simulation_get_state(a, &first);
    talus_simulation_get_state(b, &second);
    assert_true(first.time == second.time && first.step == second.step);
    assert_true(first.time_step == second.time_step);
    assert_int_equal(first.particle_count, second.particle_count);
    assert_true(first.eliminated_mass == second.eliminated_mass);
    compare_nodes(a, b);
    (void)talus_simulation_columns(a, &columns);
    double *row = calloc(2 * columns, sizeof *row);
    assert_non_null(row);
    talus_simulation_sample(a, row);
    talus_simulation_sample(b, row + columns);
    assert_memory_equal(row, row + columns, columns * sizeof *row);
    free(row);
    const struct talus_metric *left = talus_simulation_metrics(a, &metrics);
    const struct talus_metric *right = talus_simulation_metrics(b, &other_metrics);
    assert_int_equal(metrics, other_metrics);
    for (size_t index = 0; index < metrics; index++) {
        assert_string_equal(left[index].name, right[index].name);
        assert_true(left[index].value == right[index].value);
    }
}

static void goes_on_bit_for_bit(size_t shape, enum talus_stress_update update,
                                enum talus_dimension dimension,
                                enum talus_anti_locking_control control)
{
    struct simulation_fixture fixture;
    build(&fixture);
    fixture.scene.dimension = dimension;
    fixture.scene.solver.anti_locking = control;
    if (control == TALUS_CONTROL_HYBRID)
        fixture.scene.solver.anti_locking_field = TALUS_FIT_FULL;
    fixture.scene.solver.shape_index = shape;
    fixture.scene.solver.stress_update = update;
    static const size_t moments[] = {0, 1, 17, 60, 111, 151, 200, 201, 239};
    struct talus_simulation *restored[LENGTH(moments)] = {NULL};
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    size_t next = 0, purges = 0;
    for (size_t step = 0; step <= STEPS; step++) {
        if (next < LENGTH(moments) && moments[next] == step) {
            struct saved saved = save(simulation);
            restored[next] = restore(&fixture, &saved);
            compare_nodes(simulation, restored[next]);
            saved_release(&saved);
            next++;
        }
        const size_t blocks = simulation->run.grid.block_count;
        if (step < STEPS)
            simulation_run_steps(simulation, 1);
        purges += simulation->run.grid.block_count < blocks;
        for (size_t k = 0; k < next && step < STEPS; k++)
            simulation_run_steps(restored[k], 1);
    }
    struct talus_simulation_state end;
    talus_simulation_get_state(simulation, &end);
    assert_true(purges > 0);
    assert_true(10 * end.particle_count < 7 * end.initial_particle_count);
    /* Sampling closes intervals, so all are compared with one run that is never sampled. */
    struct saved last = save(simulation);
    for (size_t k = 0; k < LENGTH(moments); k++) {
        struct talus_simulation *again = restore(&fixture, &last);
        compare_all(again, restored[k]);
        talus_simulation_destroy(again);
        talus_simulation_destroy(restored[k]);
    }
    saved_release(&last);
    talus_simulation_destroy(simulation);
}

static void test_goes_on_bit_for_bit(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < shape_count; shape++) {
        if (shape_table[shape]->may_lump_negative)
            continue; /* for small displacements only: test_quadratic.c */
        goes_on_bit_for_bit(shape, TALUS_STRESS_MODIFIED_LAST, TALUS_PLANE_STRAIN,
                            TALUS_CONTROL_NONE);
    }
    goes_on_bit_for_bit(0, TALUS_STRESS_FIRST, TALUS_PLANE_STRAIN, TALUS_CONTROL_NONE);
    goes_on_bit_for_bit(0, TALUS_STRESS_MODIFIED_LAST, TALUS_AXISYMMETRIC, TALUS_CONTROL_NONE);
    goes_on_bit_for_bit(0, TALUS_STRESS_MODIFIED_LAST, TALUS_PLANE_STRAIN, TALUS_CONTROL_HYBRID);
    goes_on_bit_for_bit(0, TALUS_STRESS_FIRST, TALUS_AXISYMMETRIC, TALUS_CONTROL_NODE);
}

static void test_equal_states_give_equal_bytes(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    struct talus_simulation *a = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(a, 30);
    struct saved first = save(a);
    struct talus_simulation *b = restore(&fixture, &first);
    struct saved second = save(b);
    assert_int_equal(first.count, second.count);
    for (size_t index = 0; index < first.count; index++) {
        assert_int_equal(first.blobs[index].bytes, second.blobs[index].bytes);
        assert_memory_equal(first.blobs[index].data, second.blobs[index].data,
                            first.blobs[index].bytes);
    }
    saved_release(&first);
    saved_release(&second);
    talus_simulation_destroy(a);
    talus_simulation_destroy(b);
}

static void assert_refused(const struct talus_scene *scene, const struct saved *saved)
{
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = 1};
    assert_int_equal(
        talus_simulation_restore(scene, &options, saved->blobs, saved->count, &simulation, &error),
        TALUS_INVALID);
    assert_null(simulation);
    assert_string_equal(error.code, "checkpoint");
}

static void test_refused_for_another_scene(void **state)
{
    (void)state;
    struct simulation_fixture fixture, other;
    build(&fixture);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 5);
    struct saved saved = save(simulation);
    build(&other);
    talus_simulation_destroy(restore(&other, &saved)); /* the same scene, built anew */
    other.scene.duration = 7;                          /* steering moves it */
    talus_simulation_destroy(restore(&other, &saved));
    build(&other);
    other.scene.gravity[1] = -9.8;
    assert_refused(&other.scene, &saved);
    build(&other);
    other.values[0][MATERIAL_VALUE_DENSITY] *= 1.0000001;
    assert_refused(&other.scene, &saved);
    build(&other);
    other.boundaries[0].faces[0].friction_coefficient = 0.31;
    assert_refused(&other.scene, &saved);
    build(&other);
    other.probes[0].field = TALUS_FIELD_MASS;
    assert_refused(&other.scene, &saved);
    build(&other);
    other.scene.solver.stress_update = TALUS_STRESS_LAST;
    assert_refused(&other.scene, &saved);
    build(&other);
    struct talus_traction changed = other.bodies[0].tractions[0];
    changed.kind = TALUS_TRACTION_FIBRE;
    other.bodies[0].tractions = &changed;
    assert_refused(&other.scene, &saved);
    build(&other);
    other.scene.gravity_table[1].count = 1;
    assert_refused(&other.scene, &saved);
    build(&other);
    other.bodies[0].velocity[0] = 1;
    assert_refused(&other.scene, &saved);
    saved_release(&saved);
    talus_simulation_destroy(simulation);
}

static void test_refused_when_not_whole(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 5);
    struct saved saved = save(simulation);
    for (size_t index = 0; index < saved.count; index++) {
        const struct talus_blob whole = saved.blobs[index];
        saved.blobs[index].bytes /= 2;
        assert_refused(&fixture.scene, &saved);
        saved.blobs[index] = whole;
        saved.blobs[index].name[0] = '?';
        assert_refused(&fixture.scene, &saved);
        saved.blobs[index] = whole;
    }
    saved_release(&saved);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_goes_on_bit_for_bit),
        cmocka_unit_test(test_equal_states_give_equal_bytes),
        cmocka_unit_test(test_refused_for_another_scene),
        cmocka_unit_test(test_refused_when_not_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
