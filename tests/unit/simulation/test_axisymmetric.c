/* SPDX-License-Identifier: Apache-2.0 */
/* Bodies of revolution: what holds exactly, and a vibration with a known frequency. */
#include "shapes/shape.h"
#include "simulation_fixture.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double young = 1e6, poisson = 0.3, density = 1000;

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};

static void begin(struct simulation_fixture *fixture, double cell, int64_t radial, int64_t axial)
{
    const int64_t count[3] = {radial, axial, 1};
    simulation_fixture_init(fixture, 2, cell, count);
    fixture->scene.dimension = TALUS_AXISYMMETRIC;
    (void)simulation_fixture_add_material(fixture, "linear_elastic", elastic,
                                          sizeof elastic / sizeof elastic[0]);
}

static struct talus_simulation *start_moving(const struct simulation_fixture *fixture,
                                             talus_particle_function *velocity, void *context)
{
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {
        .threads = 1, .all_threads = true, .initial_velocity = velocity, .context = context};
    if (talus_simulation_create(&fixture->scene, &options, &simulation, &error) != TALUS_OK)
        fail_msg("create: %s", error.text);
    return simulation;
}

/* Homogeneous motion: as fast outwards as there is radius. */
static const double rate = 3.0, axial_rate = -2.0;

static void stretching(void *context, uint32_t id, const double position[3], double time,
                       double out[3])
{
    (void)context;
    (void)id;
    (void)time;
    out[0] = rate * position[0];
    out[1] = axial_rate * (position[1] - 0.2);
}

/* In the cells at the axis the velocity is linear in r, because it is zero on the axis: hoop and
 * radial strain are one, particle by particle. Their size is what the first node makes of the
 * particles around it, at 1/4, 3/4, 5/4 and 7/4 of a cell: with masses that grow with r,
 * sum N r^2 / sum N r = 1.1875 of its own place. */
static void stretch_is_exact(enum talus_strain strain)
{
    struct simulation_fixture fixture;
    const double min[3] = {0, 0, 0}, max[3] = {0.8, 0.4, 0};
    begin(&fixture, 0.1, 12, 8);
    fixture.scene.solver.strain = strain;
    fixture.scene.solver.time_step = 1e-3;
    fixture.scene.output.frame_fields =
        1u << TALUS_FIELD_STRAIN | 1u << TALUS_FIELD_DEFORMATION_GRADIENT;
    simulation_fixture_add_box(&fixture, 0, min, max, 2);
    struct talus_simulation *simulation = start_moving(&fixture, stretching, NULL);
    simulation_run_steps(simulation, 1);
    double *values = simulation_field(simulation, TALUS_FIELD_STRAIN, 6);
    double *volume = simulation_field(simulation, TALUS_FIELD_VOLUME, 1);
    double *mass = simulation_field(simulation, TALUS_FIELD_MASS, 1);
    double *position = calloc(3 * simulation_particle_count(simulation), sizeof *position);
    talus_simulation_read_positions(simulation, position);
    size_t seen = 0;
    for (size_t index = 0; index < simulation_particle_count(simulation); index++) {
        const double *e = values + 6 * index;
        /* Hoop and radial strain are one there: dr/r = du/dr. */
        if (position[3 * index] < 0.1 && position[3 * index + 1] > 0.1 &&
            position[3 * index + 1] < 0.3) {
            assert_close(e[2], e[0], 1e-9, 1e-3);
            assert_close(strain == TALUS_STRAIN_FINITE ? expm1(e[0]) : e[0], 1.1875 * rate * 1e-3,
                         1e-9, 1e-3);
            seen++;
        }
        /* The volume follows all three. */
        const double ratio = volume[index] * density / mass[index];
        if (strain == TALUS_STRAIN_FINITE)
            assert_close(log(ratio), e[0] + e[1] + e[2], 1e-9, 1e-3);
    }
    assert_true(seen > 0);
    free(values);
    free(volume);
    free(mass);
    free(position);
    talus_simulation_destroy(simulation);
}

static void uniform_stretch_small(void **state)
{
    (void)state;
    stretch_is_exact(TALUS_STRAIN_SMALL);
}

static void uniform_stretch_finite(void **state)
{
    (void)state;
    stretch_is_exact(TALUS_STRAIN_FINITE);
}

/* Through many cells without a trace: exactly, since every node carries the same velocity. */
static void axial_flight(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    const double min[3] = {0, 0.2, 0}, max[3] = {0.75, 0.6, 0};
    begin(&fixture, 0.1, 10, 40);
    fixture.scene.solver.time_step = 1e-3;
    fixture.scene.output.frame_fields = 1u << TALUS_FIELD_STRAIN;
    simulation_fixture_add_box(&fixture, 0, min, max, 2)->velocity[1] = 2.0;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1000);
    double *strain = simulation_field(simulation, TALUS_FIELD_STRAIN, 6);
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
    for (size_t index = 0; index < simulation_particle_count(simulation); index++) {
        for (size_t k = 0; k < 6; k++)
            assert_close(strain[6 * index + k], 0.0, 1e-10, 1.0);
        assert_close(velocity[3 * index], 0.0, 1e-10, 1.0);
        assert_close(velocity[3 * index + 1], 2.0, 1e-10, 1.0);
    }
    assert_close(simulation_metric(simulation, "momentum_error"), 0.0, 1e-12, 1.0);
    free(strain);
    free(velocity);
    talus_simulation_destroy(simulation);
}

/* Mass, weight and the thrust on a tube wall are those of the whole circle. */
static void fluid_at_rest(void **state)
{
    (void)state;
    static const struct setting water[] = {{"density", 1000}, {"bulk_modulus", 2e6}};
    struct simulation_fixture fixture;
    const double min[3] = {0, 0, 0}, max[3] = {0.5, 1.0, 0};
    const int64_t count[3] = {5, 14, 1};
    simulation_fixture_init(&fixture, 2, 0.1, count);
    fixture.scene.dimension = TALUS_AXISYMMETRIC;
    fixture.scene.gravity[1] = -10;
    (void)simulation_fixture_add_material(&fixture, "newtonian_fluid", water, 2);
    simulation_fixture_add_box(&fixture, 0, min, max, 2)->initial_stress =
        TALUS_INITIAL_HYDROSTATIC;
    simulation_fixture_add_plane(&fixture, "floor", TALUS_Y, 0.0, 1.0, "slip", 0);
    simulation_fixture_add_plane(&fixture, "wall", TALUS_X, 0.5, -1.0, "slip", 0);
    simulation_fixture_add_probe(&fixture, "mass", TALUS_PROBE_MASS);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1);
    double row[64];
    talus_simulation_sample(simulation, row);
    const double volume = pi * 0.25;
    assert_close(row[simulation_column(simulation, "probe.mass")], 1000 * volume, 1e-12, 1000);
    assert_close(row[simulation_column(simulation, "reaction.floor.force.y")], -1e4 * volume, 1e-9,
                 1e4);
    /* rho g H^2 / 2 times the circle. */
    assert_close(row[simulation_column(simulation, "reaction.wall.force.x")],
                 1000 * 10 * 0.5 * 2 * pi * 0.5, 1e-9, 1e4);
    assert_close(row[simulation_column(simulation, "reaction.floor.contact_area")], volume, 1e-12,
                 1);
    assert_close(row[simulation_column(simulation, "reaction.wall.contact_area")],
                 2 * pi * 0.5 * 1.05, 1e-12, 1); /* the last node stands for half a cell above */
    size_t columns = 0;
    const struct talus_column *column = talus_simulation_columns(simulation, &columns);
    for (size_t index = 0; index < columns; index++) {
        assert_null(strstr(column[index].name, "axis"));
        if (strcmp(column[index].name, "reaction.wall.force.x") == 0)
            assert_string_equal(column[index].unit, "N");
    }
    talus_simulation_destroy(simulation);
}

/* Radial mode of a solid cylinder between smooth plates: u = J1(k r) with
 * (lambda + 2 G) k J0(k R) = 2 G J1(k R) / R and omega = k c (Love 1927, sec. 199). */
static double mode_wave_number(double radius)
{
    const double shear = young / (2 * (1 + poisson));
    const double lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    double low = 1.0 / radius, high = 3.0 / radius;
    for (int halving = 0; halving < 60; halving++) {
        const double k = 0.5 * (low + high);
        const double rest = (lambda + 2 * shear) * k * j0(k * radius) - 2 * shear * j1(k * radius);
        if (rest > 0)
            low = k;
        else
            high = k;
    }
    return low;
}

static void first_mode(void *context, uint32_t id, const double position[3], double time,
                       double out[3])
{
    (void)id;
    (void)time;
    out[0] = 1e-3 * j1(*(const double *)context * position[0]);
    out[1] = 0;
}

/* Time at which the outermost particle has come back to where it began. */
static double half_period(struct talus_simulation *simulation, double expected)
{
    struct talus_simulation_state clock;
    double before = 0, time_before = 0;
    talus_simulation_get_clock(simulation, &clock);
    while (clock.time < 2 * expected) {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_clock(simulation, &clock);
        double *way = simulation_field(simulation, TALUS_FIELD_DISPLACEMENT, 3);
        const double now = way[3 * (simulation_particle_count(simulation) - 1)];
        free(way);
        if (now < 0 && before > 0)
            return time_before + (clock.time - time_before) * before / (before - now);
        before = now;
        time_before = clock.time;
    }
    return NAN;
}

/* 20 cells along the radius: the lumped mass matrix lowers omega by (k h)^2 / 24 = 0.04 %, and the
 * free surface lies within half a particle; 0.5 % is asked. */
static void vibrate(size_t shape)
{
    struct simulation_fixture fixture;
    const double radius = 1.0, min[3] = {0, 0, 0}, max[3] = {1.0, 0.1, 0};
    begin(&fixture, 0.05, 22, 2);
    fixture.scene.output.frame_fields = 1u << TALUS_FIELD_DISPLACEMENT;
    fixture.scene.solver.shape_index = shape;
    simulation_fixture_add_box(&fixture, 0, min, max, 2);
    simulation_fixture_add_plane(&fixture, "below", TALUS_Y, 0.0, 1.0, "slip", 0);
    simulation_fixture_add_plane(&fixture, "above", TALUS_Y, 0.1, -1.0, "slip", 0);
    double k = mode_wave_number(radius);
    const double modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
    const double expected = pi / (k * sqrt(modulus / density));
    struct talus_simulation *simulation = start_moving(&fixture, first_mode, &k);
    assert_close(half_period(simulation, expected), expected, 0.005, expected);
    assert_close(simulation_metric(simulation, "momentum_error"), 0.0, 1e-12, 1.0);
    struct talus_error error = {0};
    assert_int_equal(talus_simulation_audit(simulation, &error), TALUS_OK);
    talus_simulation_destroy(simulation);
}

static void radial_vibration(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < shape_count; shape++) {
        /* Elements on the axis have a node there whose lumped mass is zero: refused. */
        if (!shape_table[shape]->may_lump_negative)
            vibrate(shape);
    }
}

/* A block that lands: particles change cells, and the books of force, hoop included, stay closed.
 */
static void check_landing(enum talus_stress_update ordering, size_t shape,
                          enum talus_anti_locking_control control)
{
    struct simulation_fixture fixture;
    const double min[3] = {0, 0.05, 0}, max[3] = {0.8, 0.85, 0};
    begin(&fixture, 0.1, 12, 14);
    fixture.scene.gravity[1] = -10;
    fixture.scene.solver.stress_update = ordering;
    fixture.scene.solver.shape_index = shape;
    fixture.scene.solver.anti_locking = control;
    if (ordering == TALUS_STRESS_LAST) /* it does not bear light nodes at larger steps */
        fixture.scene.solver.courant = 0.1;
    simulation_fixture_add_box(&fixture, 0, min, max, 2)->velocity[1] = -3.0;
    simulation_fixture_add_plane(&fixture, "floor", TALUS_Y, 0.0, 1.0, "friction", 0.5);
    struct talus_simulation *one = simulation_fixture_start(&fixture, 1);
    struct talus_simulation *two = simulation_fixture_start(&fixture, 2);
    simulation_run_steps(one, 150);
    simulation_run_steps(two, 150);
    assert_close(simulation_metric(one, "momentum_error"), 0.0, 1e-12, 1.0);
    assert_close(simulation_metric(one, "mass_error"), 0.0, 1e-12, 1.0);
    assert_true(simulation_metric(one, "energy_error") < 0.01);
    assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
    talus_simulation_destroy(one);
    talus_simulation_destroy(two);
}

static void landing(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < shape_count; shape++) {
        /* Elements on the axis have a node there whose lumped mass is zero: refused. */
        if (!shape_table[shape]->may_lump_negative)
            check_landing(TALUS_STRESS_MODIFIED_LAST, shape, TALUS_CONTROL_NONE);
    }
}

static void landing_first(void **state)
{
    (void)state;
    check_landing(TALUS_STRESS_FIRST, 0, TALUS_CONTROL_NONE);
}

static void landing_last(void **state)
{
    (void)state;
    check_landing(TALUS_STRESS_LAST, 0, TALUS_CONTROL_NONE);
}

static void landing_with_anti_locking(void **state)
{
    (void)state;
    for (int control = TALUS_CONTROL_CELL; control <= (int)TALUS_CONTROL_HYBRID; control++)
        check_landing(TALUS_STRESS_MODIFIED_LAST, 0, (enum talus_anti_locking_control)control);
    check_landing(TALUS_STRESS_FIRST, 0, TALUS_CONTROL_NODE);
}

static void refused(struct simulation_fixture *fixture, const char *pointer)
{
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = 1};
    assert_true(talus_simulation_create(&fixture->scene, &options, &simulation, &error) ==
                TALUS_INVALID);
    assert_string_equal(error.pointer, pointer);
}

static void refusals(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    const double min[3] = {0, 0, 0}, max[3] = {0.8, 0.8, 0};
    begin(&fixture, 0.1, 12, 14);
    struct talus_body *body = simulation_fixture_add_box(&fixture, 0, min, max, 2);
    fixture.scene.gravity[0] = 1;
    refused(&fixture, "/gravity/0");
    fixture.scene.gravity[0] = 0;
    fixture.scene.grid.min[0] = -0.1;
    refused(&fixture, "/grid/min/0");
    fixture.scene.grid.min[0] = 0;
    body->velocity_field = TALUS_VELOCITY_ROTATION;
    refused(&fixture, "/bodies/0/velocity");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_stretch_small),
        cmocka_unit_test(uniform_stretch_finite),
        cmocka_unit_test(axial_flight),
        cmocka_unit_test(fluid_at_rest),
        cmocka_unit_test(radial_vibration),
        cmocka_unit_test(landing),
        cmocka_unit_test(landing_first),
        cmocka_unit_test(landing_last),
        cmocka_unit_test(landing_with_anti_locking),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
