/* SPDX-License-Identifier: Apache-2.0 */
/* Every kind of probe against sums over what the C API reads from the particles. */
#include "simulation_fixture.h"

#include <stdio.h>

struct particles { /* everything of a simulation, read by id */
    size_t count;
    double *position, *velocity, *volume, *mass, *body, *stress;
};

static struct particles read_particles(const struct talus_simulation *simulation)
{
    struct particles p = {.count = simulation_particle_count(simulation)};
    p.position = calloc(3 * p.count, sizeof *p.position);
    assert_non_null(p.position);
    talus_simulation_read_positions(simulation, p.position);
    p.velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
    p.volume = simulation_field(simulation, TALUS_FIELD_VOLUME, 1);
    p.mass = simulation_field(simulation, TALUS_FIELD_MASS, 1);
    p.body = simulation_field(simulation, TALUS_FIELD_BODY, 1);
    p.stress = simulation_field(simulation, TALUS_FIELD_STRESS, 6);
    return p;
}

static void particles_release(struct particles *p)
{
    free(p->position);
    free(p->velocity);
    free(p->volume);
    free(p->mass);
    free(p->body);
    free(p->stress);
}

/* Two bodies on a floor. */
static void build(struct simulation_fixture *fixture)
{
    static const int64_t count[3] = {30, 20, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    struct talus_scene *scene = &fixture->scene;
    const size_t soil = simulation_fixture_add_sample(fixture, material_find("matsuoka_nakai"));
    const size_t water = simulation_fixture_add_sample(fixture, material_find("newtonian_fluid"));
    simulation_fixture_add_box(fixture, soil, (double[3]){0.3, 0.2}, (double[3]){0.9, 0.7}, 2)
        ->velocity[0] = 1.0;
    simulation_fixture_add_box(fixture, water, (double[3]){1.3, 0.2}, (double[3]){1.8, 0.5}, 3);
    scene->gravity[1] = -9.81;
    scene->output.frame_fields = 1u << TALUS_FIELD_STRESS;
    simulation_fixture_add_plane(fixture, "floor", 1, 0.2, 1, "friction", 0.3);
    simulation_fixture_add_obstacle(fixture, "pile", (double[3]){1.8, 0.2}, (double[3]){2.0, 0.8},
                                    "slip", 0);
}

static bool selected(const struct particles *p, size_t k, const struct talus_probe *probe)
{
    for (size_t axis = 0; axis < 2; axis++) {
        if (p->position[3 * k + axis] < probe->within_min[axis] ||
            p->position[3 * k + axis] > probe->within_max[axis])
            return false;
    }
    if (probe->body_index >= 0 && p->body[k] != probe->body_index)
        return false;
    return probe->on_boundary != 0 || fabs(p->position[3 * k + 1] - 0.2) <= 0.05 + 1e-9;
}

static double along(const struct particles *p, size_t k, const struct talus_probe *probe)
{
    return p->position[3 * k] * probe->along[0] + p->position[3 * k + 1] * probe->along[1];
}

/* What front, height and extent should be. */
static double expected_geometry(const struct particles *p, const struct talus_probe *probe)
{
    double low = INFINITY, high = -INFINITY, mass = 0, first = 0, spread = 0;
    for (size_t k = 0; k < p->count; k++) {
        if (!selected(p, k, probe))
            continue;
        const double half = 0.5 * sqrt(p->volume[k]);
        low = fmin(low, along(p, k, probe) - half);
        high = fmax(high, along(p, k, probe) + half);
        mass += p->mass[k];
        first += p->mass[k] * along(p, k, probe);
    }
    for (size_t k = 0; k < p->count; k++)
        spread += selected(p, k, probe) ? p->mass[k] * fabs(along(p, k, probe) - first / mass) : 0;
    if (probe->kind == TALUS_PROBE_EXTENT)
        return probe->measure == TALUS_MEASURE_PARTICLE ? high - low : 4 * spread / mass;
    return probe->measure == TALUS_MEASURE_PARTICLE ? high : 2 * first / mass;
}

static double column(const struct talus_simulation *simulation, const double *row, const char *name)
{
    return row[simulation_column(simulation, name)];
}

static double *sample(struct talus_simulation *simulation)
{
    size_t count = 0;
    (void)talus_simulation_columns(simulation, &count);
    double *row = calloc(count, sizeof *row);
    assert_non_null(row);
    talus_simulation_sample(simulation, row);
    return row;
}

static void test_geometry(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    static const enum talus_probe_kind kinds[3] = {TALUS_PROBE_FRONT, TALUS_PROBE_HEIGHT,
                                                   TALUS_PROBE_EXTENT};
    static const double directions[3][2] = {{1, 0}, {0, 1}, {0.6, 0.8}};
    static char names[18][8];
    build(&fixture);
    for (size_t index = 0; index < 18; index++) {
        (void)snprintf(names[index], sizeof names[index], "p%zu", index);
        struct talus_probe *probe =
            simulation_fixture_add_probe(&fixture, names[index], kinds[index % 3]);
        memcpy(probe->along, directions[index / 3 % 3], 2 * sizeof(double));
        probe->measure = index < 9 ? TALUS_MEASURE_PARTICLE : TALUS_MEASURE_CENTRE_OF_MASS;
        probe->body_index = (int)(index % 4) - 1 > 1 ? -1 : (int)(index % 4) - 1;
        probe->on_boundary = index % 5 == 4 ? 0 : -1;
        if (index % 7 == 6)
            probe->within_max[1] = 0.45;
    }
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    for (size_t turn = 0; turn < 3; turn++) {
        double *row = sample(simulation);
        struct particles p = read_particles(simulation);
        for (size_t index = 0; index < 18; index++) {
            char name[160];
            (void)snprintf(name, sizeof name, "probe.%s", names[index]);
            assert_close(column(simulation, row, name),
                         expected_geometry(&p, &fixture.probes[index]), 1e-13, 1);
        }
        particles_release(&p);
        free(row);
        simulation_run_steps(simulation, 40);
    }
    talus_simulation_destroy(simulation);
}

static void test_sums(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    simulation_fixture_add_probe(&fixture, "m", TALUS_PROBE_MASS)->body_index = 1;
    simulation_fixture_add_probe(&fixture, "c", TALUS_PROBE_CENTRE_OF_MASS)->body_index = 0;
    simulation_fixture_add_probe(&fixture, "cy", TALUS_PROBE_CENTRE_OF_MASS)->component = 1;
    struct talus_probe *integral =
        simulation_fixture_add_probe(&fixture, "i", TALUS_PROBE_INTEGRAL);
    integral->field = TALUS_FIELD_STRESS;
    integral->within_min[0] = 0.5;
    struct talus_probe *moving = simulation_fixture_add_probe(&fixture, "v", TALUS_PROBE_INTEGRAL);
    moving->field = TALUS_FIELD_VELOCITY;
    moving->component = 0;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 60);
    double *row = sample(simulation);
    struct particles p = read_particles(simulation);
    double mass[3] = {0}, first[2] = {0}, height = 0, integrals[6] = {0}, velocity = 0;
    for (size_t k = 0; k < p.count; k++) {
        mass[(size_t)p.body[k]] += p.mass[k];
        mass[2] += p.mass[k];
        height += p.mass[k] * p.position[3 * k + 1];
        velocity += p.volume[k] * p.velocity[3 * k];
        for (size_t axis = 0; axis < 2 && p.body[k] == 0; axis++)
            first[axis] += p.mass[k] * p.position[3 * k + axis];
        for (size_t component = 0; component < 6 && p.position[3 * k] >= 0.5; component++)
            integrals[component] += p.volume[k] * p.stress[6 * k + component];
    }
    assert_close(column(simulation, row, "probe.m"), mass[1], 1e-14, mass[1]);
    assert_close(column(simulation, row, "probe.c.x"), first[0] / mass[0], 1e-14, 1);
    assert_close(column(simulation, row, "probe.c.y"), first[1] / mass[0], 1e-14, 1);
    assert_close(column(simulation, row, "probe.cy"), height / mass[2], 1e-14, 1);
    assert_close(column(simulation, row, "probe.v"), velocity, 1e-14, 1);
    static const char *const names[6] = {"probe.i.xx", "probe.i.yy", "probe.i.zz",
                                         "probe.i.xy", "probe.i.yz", "probe.i.xz"};
    assert_true(fabs(integrals[1]) > 1);
    for (size_t component = 0; component < 6; component++)
        assert_close(column(simulation, row, names[component]), integrals[component], 1e-12,
                     fabs(integrals[1]));
    particles_release(&p);
    free(row);
    talus_simulation_destroy(simulation);
}

static void test_point_follows_its_particle(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    struct talus_probe *probe = simulation_fixture_add_probe(&fixture, "v", TALUS_PROBE_POINT);
    probe->field = TALUS_FIELD_VELOCITY;
    probe->at[0] = 0.68;
    probe->at[1] = 0.41;
    struct talus_probe *other = simulation_fixture_add_probe(&fixture, "s", TALUS_PROBE_POINT);
    other->field = TALUS_FIELD_STRESS;
    other->component = 1;
    other->body_index = 1; /* the nearest of the other body */
    memcpy(other->at, probe->at, sizeof other->at);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct particles p = read_particles(simulation);
    size_t nearest[2] = {0, 0};
    double distance[2] = {INFINITY, INFINITY};
    for (size_t k = 0; k < p.count; k++) {
        const double d =
            hypot(p.position[3 * k] - probe->at[0], p.position[3 * k + 1] - probe->at[1]);
        for (size_t which = 0; which < 2; which++) {
            if ((which == 0 || p.body[k] == 1) && d < distance[which]) {
                distance[which] = d;
                nearest[which] = k;
            }
        }
    }
    particles_release(&p);
    simulation_run_steps(simulation, 80);
    p = read_particles(simulation);
    double *row = sample(simulation);
    assert_true(column(simulation, row, "probe.v.x") == p.velocity[3 * nearest[0]]);
    assert_true(column(simulation, row, "probe.v.y") == p.velocity[3 * nearest[0] + 1]);
    assert_true(column(simulation, row, "probe.s") == p.stress[6 * nearest[1] + 1]);
    assert_true(p.stress[6 * nearest[1] + 1] < 0);
    particles_release(&p);
    free(row);
    talus_simulation_destroy(simulation);
}

static void test_energy_and_reaction(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    static const char *const parts[TALUS_ENERGY_PART_COUNT] = {
        "total", "kinetic", "strain", "potential", "dissipated", "external", "numerical"};
    static char names[TALUS_ENERGY_PART_COUNT][24];
    for (int part = 0; part < TALUS_ENERGY_PART_COUNT; part++)
        simulation_fixture_add_probe(&fixture, parts[part], TALUS_PROBE_ENERGY)->part =
            (enum talus_energy_part)part;
    struct talus_probe *force = simulation_fixture_add_probe(&fixture, "f", TALUS_PROBE_REACTION);
    force->quantity = TALUS_REACTION_FORCE;
    force->component = 1;
    struct talus_probe *face = simulation_fixture_add_probe(&fixture, "pf", TALUS_PROBE_REACTION);
    face->boundary_index = 1;
    face->face_index = 0;
    face->quantity = TALUS_REACTION_FORCE;
    struct talus_probe *area = simulation_fixture_add_probe(&fixture, "a", TALUS_PROBE_REACTION);
    area->quantity = TALUS_REACTION_CONTACT_AREA;
    struct talus_probe *moment = simulation_fixture_add_probe(&fixture, "mz", TALUS_PROBE_REACTION);
    moment->quantity = TALUS_REACTION_MOMENT;
    moment->component = 2;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 80);
    double *row = sample(simulation);
    for (size_t part = 0; part < TALUS_ENERGY_PART_COUNT; part++) {
        char column_name[32];
        (void)snprintf(names[part], sizeof names[part], "probe.%s", parts[part]);
        (void)snprintf(column_name, sizeof column_name, "energy.%s", parts[part]);
        assert_true(column(simulation, row, names[part]) == column(simulation, row, column_name));
    }
    assert_true(column(simulation, row, "probe.f") ==
                column(simulation, row, "reaction.floor.force.y"));
    assert_true(column(simulation, row, "probe.f") < 0); /* weight presses down */
    assert_true(column(simulation, row, "probe.pf.x") ==
                column(simulation, row, "reaction.pile.x_min.force.x"));
    assert_true(column(simulation, row, "probe.pf.x") > 0); /* water leans on the pile */
    assert_true(column(simulation, row, "probe.a") ==
                column(simulation, row, "reaction.floor.contact_area"));
    assert_true(column(simulation, row, "probe.mz") ==
                column(simulation, row, "reaction.floor.moment.z"));
    /* The boundary is the sum of its faces. */
    double sum = 0;
    static const char *const faces[4] = {
        "reaction.pile.x_min.force.x", "reaction.pile.x_max.force.x", "reaction.pile.y_min.force.x",
        "reaction.pile.y_max.force.x"};
    for (size_t index = 0; index < 4; index++)
        sum += column(simulation, row, faces[index]);
    assert_close(column(simulation, row, "reaction.pile.force.x"), sum, 1e-13, fabs(sum));
    free(row);
    talus_simulation_destroy(simulation);
}

/* Energies that the step added up along the way are those that a pass of its own finds, and the
 * run is the same. */
static void test_expected_samples(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    struct talus_simulation *expecting = simulation_fixture_start(&fixture, 2);
    struct talus_simulation *surprised = simulation_fixture_start(&fixture, 1);
    for (size_t step = 1; step <= 70; step++) {
        talus_simulation_expect_sample(expecting);
        simulation_run_steps(expecting, 1);
        simulation_run_steps(surprised, 1);
        if (step % 7 != 0)
            continue;
        double *one = sample(expecting), *other = sample(surprised);
        size_t count = 0;
        (void)talus_simulation_columns(expecting, &count);
        const double scale = column(surprised, other, "energy.kinetic") +
                             column(surprised, other, "energy.strain") +
                             fabs(column(surprised, other, "energy.potential"));
        assert_true(column(surprised, other, "energy.strain") > 1e-6 * scale);
        for (size_t index = 0; index < count; index++)
            assert_close(one[index], other[index], 1e-12, fmax(scale, fabs(other[index])));
        free(one);
        free(other);
    }
    assert_int_equal(talus_simulation_state_hash(expecting),
                     talus_simulation_state_hash(surprised));
    assert_true(simulation_metric(expecting, "energy_error") ==
                simulation_metric(surprised, "energy_error"));
    talus_simulation_destroy(expecting);
    talus_simulation_destroy(surprised);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_expected_samples),
        cmocka_unit_test(test_geometry),
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_point_follows_its_particle),
        cmocka_unit_test(test_energy_and_reaction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
