/* SPDX-License-Identifier: Apache-2.0 */
/* What frames read: fields of particles that follow from each other, and nodes. */
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"bulk_modulus", 2e6}, {"shear_modulus", 1e6}};

/* Everything tracked; a block that tumbles on a floor. */
static void build(struct simulation_fixture *fixture, size_t axes, enum talus_strain strain)
{
    static const int64_t count[3] = {30, 16, 12};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(
        fixture, material, (double[3]){0.4, 0.2, 0.4}, (double[3]){0.8, 0.5, 0.7}, 2);
    body->velocity[0] = axes == 1 ? -1.5 : 1.5;
    fixture->scene.gravity[axes == 1 ? 0 : 1] = -9.81;
    fixture->scene.solver.strain = strain;
    fixture->scene.output.frame_fields = (1u << TALUS_FIELD_COUNT) - 1;
    if (strain == TALUS_STRAIN_SMALL)
        fixture->scene.output.frame_fields &= ~(1u << TALUS_FIELD_DEFORMATION_GRADIENT);
    simulation_fixture_add_plane(fixture, "floor", axes == 1 ? 0 : 1, 0.2, 1, "friction", 0.5);
}

static double determinant(const double *f)
{
    return f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
           f[2] * (f[3] * f[7] - f[4] * f[6]);
}

static void check_stress_measures(const struct talus_simulation *simulation, size_t count)
{
    double *stress = simulation_field(simulation, TALUS_FIELD_STRESS, 6);
    double *mean = simulation_field(simulation, TALUS_FIELD_MEAN_STRESS, 1);
    double *mises = simulation_field(simulation, TALUS_FIELD_VON_MISES, 1);
    double largest = 0;
    for (size_t k = 0; k < count; k++) {
        const double *s = stress + 6 * k;
        const double difference = (s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2]) +
                                  (s[2] - s[0]) * (s[2] - s[0]);
        const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
        largest = fmax(largest, mises[k]);
        assert_close(mean[k], (s[0] + s[1] + s[2]) / 3, 1e-12, fabs(mean[k]) + 1);
        assert_close(mises[k], sqrt(0.5 * difference + 3 * shear), 1e-12, mises[k] + 1);
    }
    assert_true(largest > 100);
    free(stress);
    free(mean);
    free(mises);
}

static void test_displacement_and_identity(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        struct simulation_fixture fixture;
        build(&fixture, axes, TALUS_STRAIN_FINITE);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        const size_t count = simulation_particle_count(simulation);
        double *start = calloc(6 * count, sizeof *start), *now = start + 3 * count;
        assert_non_null(start);
        talus_simulation_read_positions(simulation, start);
        simulation_run_steps(simulation, 150);
        talus_simulation_read_positions(simulation, now);
        double *displacement = simulation_field(simulation, TALUS_FIELD_DISPLACEMENT, 3);
        double *id = simulation_field(simulation, TALUS_FIELD_ID, 1);
        double *material = simulation_field(simulation, TALUS_FIELD_MATERIAL, 1);
        for (size_t k = 0; k < count; k++) {
            assert_true(id[k] == (double)k); /* in order of id */
            assert_true(material[k] == 0);
            for (size_t axis = 0; axis < 3; axis++)
                assert_close(displacement[3 * k + axis], now[3 * k + axis] - start[3 * k + axis],
                             1e-13, 1);
        }
        if (axes > 1)
            assert_true(displacement[0] > 0.1); /* a cell at least */
        free(start);
        free(displacement);
        free(id);
        free(material);
        talus_simulation_destroy(simulation);
    }
}

static void test_volume_follows_the_gradient(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        struct simulation_fixture fixture;
        build(&fixture, axes, TALUS_STRAIN_FINITE);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        const size_t count = simulation_particle_count(simulation);
        double *first = simulation_field(simulation, TALUS_FIELD_VOLUME, 1);
        simulation_run_steps(simulation, 150);
        double *volume = simulation_field(simulation, TALUS_FIELD_VOLUME, 1);
        double *density = simulation_field(simulation, TALUS_FIELD_DENSITY, 1);
        double *mass = simulation_field(simulation, TALUS_FIELD_MASS, 1);
        double *gradient = simulation_field(simulation, TALUS_FIELD_DEFORMATION_GRADIENT, 9);
        double *strain = simulation_field(simulation, TALUS_FIELD_STRAIN, 6);
        double *stress = simulation_field(simulation, TALUS_FIELD_STRESS, 6);
        double change = 0;
        for (size_t k = 0; k < count; k++) {
            const double ratio = volume[k] / first[k];
            const double trace = strain[6 * k] + strain[6 * k + 1] + strain[6 * k + 2];
            change = fmax(change, fabs(ratio - 1));
            assert_close(determinant(gradient + 9 * k), ratio, 1e-12, 1);
            assert_close(density[k] * volume[k], mass[k], 1e-13, mass[k]);
            assert_close(mass[k], 1000 * first[k], 1e-13, mass[k]);
            /* tr ln V = ln J; elastic without plasticity: Kirchhoff = K tr + 2 G dev. */
            assert_close(trace, log(ratio), 1e-12, 1);
            for (size_t component = 0; component < 6; component++) {
                const double expected =
                    (component < 3 ? (2e6 - 2e6 / 3) * trace : 0) + 2e6 * strain[6 * k + component];
                assert_close(stress[6 * k + component] * ratio, expected, 1e-9, 1e4);
            }
        }
        assert_true(change > 1e-5);
        check_stress_measures(simulation, count);
        free(first);
        free(volume);
        free(density);
        free(mass);
        free(gradient);
        free(strain);
        free(stress);
        talus_simulation_destroy(simulation);
    }
}

static void test_small_strain(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2, TALUS_STRAIN_SMALL);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 100);
    const size_t count = simulation_particle_count(simulation);
    double *strain = simulation_field(simulation, TALUS_FIELD_STRAIN, 6);
    double *stress = simulation_field(simulation, TALUS_FIELD_STRESS, 6);
    for (size_t k = 0; k < count; k++) {
        const double trace = strain[6 * k] + strain[6 * k + 1] + strain[6 * k + 2];
        assert_true(strain[6 * k + 2] == 0); /* plane strain */
        for (size_t component = 0; component < 6; component++)
            assert_close(stress[6 * k + component],
                         (component < 3 ? (2e6 - 2e6 / 3) * trace : 0) +
                             2e6 * strain[6 * k + component],
                         1e-9, 1e4);
    }
    check_stress_measures(simulation, count);
    free(strain);
    free(stress);
    talus_simulation_destroy(simulation);
}

static void test_fields_that_nobody_asked_for(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2, TALUS_STRAIN_FINITE);
    fixture.scene.output.frame_fields = 1u << TALUS_FIELD_VELOCITY;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    static const enum talus_field tracked[] = {
        TALUS_FIELD_DISPLACEMENT,   TALUS_FIELD_STRESS,    TALUS_FIELD_STRAIN,
        TALUS_FIELD_PLASTIC_STRAIN, TALUS_FIELD_VON_MISES, TALUS_FIELD_DEFORMATION_GRADIENT};
    double *out = calloc(9 * simulation_particle_count(simulation), sizeof *out);
    assert_non_null(out);
    for (size_t index = 0; index < LENGTH(tracked); index++) {
        struct talus_error error = {0};
        assert_int_equal(talus_simulation_read_field(simulation, tracked[index], out, &error),
                         TALUS_UNSUPPORTED);
    }
    free(out);
    free(simulation_field(simulation, TALUS_FIELD_VOLUME, 1));
    talus_simulation_destroy(simulation);
}

/* Initial stress reads back as it was given, under every strain. */
static void test_initial_stress(void **state)
{
    (void)state;
    static const double given[6] = {-3e4, -5e4, -2e4, 4e3, 0, 0};
    for (int strain = 0; strain < 2; strain++) {
        struct simulation_fixture fixture;
        build(&fixture, 2, strain ? TALUS_STRAIN_SMALL : TALUS_STRAIN_FINITE);
        fixture.bodies[0].initial_stress = TALUS_INITIAL_GIVEN;
        memcpy(fixture.bodies[0].stress, given, sizeof given);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        double *stress = simulation_field(simulation, TALUS_FIELD_STRESS, 6);
        for (size_t k = 0; k < simulation_particle_count(simulation); k++) {
            for (size_t component = 0; component < 6; component++)
                assert_close(stress[6 * k + component], given[component], 1e-10, 5e4);
        }
        free(stress);
        talus_simulation_destroy(simulation);
    }
}

static void test_nodes(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2, TALUS_STRAIN_FINITE);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 60);
    const size_t count = talus_simulation_read_nodes(simulation, NULL, NULL, NULL, NULL, NULL);
    double *position = calloc(11 * count, sizeof *position), *mass = position + 3 * count;
    double *velocity = mass + count, *reaction = velocity + 3 * count, *area = reaction + 3 * count;
    assert_non_null(position);
    assert_int_equal(
        talus_simulation_read_nodes(simulation, position, mass, velocity, reaction, area), count);
    double total = 0, push = 0, held = 0;
    for (size_t n = 0; n < count; n++) {
        const bool on_floor = fabs(position[3 * n + 1] - 0.2) < 1e-12;
        total += mass[n];
        push += reaction[3 * n + 1];
        held += area[n];
        assert_true(mass[n] > 0);
        assert_true((area[n] > 0) == on_floor);
        if (on_floor)
            assert_true(velocity[3 * n + 1] == 0);
        else
            assert_true(reaction[3 * n + 1] == 0 && reaction[3 * n] == 0);
        for (size_t axis = 0; axis < 2; axis++) {
            const double line = position[3 * n + axis] / 0.1;
            assert_close(line, round(line), 1e-12, 1);
        }
    }
    size_t columns = 0;
    (void)talus_simulation_columns(simulation, &columns);
    double *row = calloc(columns, sizeof *row);
    assert_non_null(row);
    talus_simulation_sample(simulation, row);
    assert_close(total, 1000 * 0.4 * 0.3, 1e-12, 1000);
    assert_close(push, row[simulation_column(simulation, "reaction.floor.instant.y")], 1e-12,
                 fabs(push));
    assert_true(push != 0 && held > 0.3);
    free(row);
    free(position);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_displacement_and_identity),
        cmocka_unit_test(test_volume_follows_the_gradient),
        cmocka_unit_test(test_small_strain),
        cmocka_unit_test(test_fields_that_nobody_asked_for),
        cmocka_unit_test(test_initial_stress),
        cmocka_unit_test(test_nodes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
