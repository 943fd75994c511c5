/* SPDX-License-Identifier: Apache-2.0 */
/* Plane stress: no stress across the plane, and the stiffness in it that follows. */
#include "simulation_fixture.h"

#include <math.h>

static const double young = 1e6, poisson = 0.3, density = 1000;

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};

static void begin(struct simulation_fixture *fixture)
{
    const int64_t count[3] = {30, 20, 1};
    const double min[3] = {0.5, 0.5, 0}, max[3] = {1.5, 1.0, 0};
    simulation_fixture_init(fixture, 2, 0.1, count);
    fixture->scene.dimension = TALUS_PLANE_STRESS;
    fixture->scene.output.frame_fields = 1u << TALUS_FIELD_STRESS | 1u << TALUS_FIELD_STRAIN |
                                         1u << TALUS_FIELD_DEFORMATION_GRADIENT;
    (void)simulation_fixture_add_material(fixture, "linear_elastic", elastic,
                                          sizeof elastic / sizeof elastic[0]);
    simulation_fixture_add_box(fixture, 0, min, max, 2);
}

static void stretching(void *context, uint32_t id, const double position[3], double time,
                       double out[3])
{
    (void)context;
    (void)id;
    (void)time;
    out[0] = 3.0 * position[0] + 0.5 * position[1];
    out[1] = -1.0 * position[1];
}

/* E / (1 - nu^2) (e_xx + nu e_yy), of the mean state in the middle of the body; e_zz and the volume
 * go with it, particle by particle. */
static void check_law(enum talus_strain strain, enum talus_anti_locking_control control,
                      enum talus_anti_locking_field field)
{
    struct simulation_fixture fixture;
    begin(&fixture);
    fixture.scene.solver.strain = strain;
    fixture.scene.solver.anti_locking = control;
    fixture.scene.solver.anti_locking_field = field;
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = 1, .initial_velocity = stretching};
    assert_true(talus_simulation_create(&fixture.scene, &options, &simulation, &error) == TALUS_OK);
    simulation_run_steps(simulation, 30);
    double *stress = simulation_field(simulation, TALUS_FIELD_STRESS, 6);
    double *total = simulation_field(simulation, TALUS_FIELD_STRAIN, 6);
    double *volume = simulation_field(simulation, TALUS_FIELD_VOLUME, 1);
    double *mass = simulation_field(simulation, TALUS_FIELD_MASS, 1);
    double largest = 0;
    for (size_t index = 0; index < simulation_particle_count(simulation); index++) {
        const double *s = stress + 6 * index, *e = total + 6 * index;
        const double ratio = density * volume[index] / mass[index];
        const double modulus = young / (1 - poisson * poisson);
        assert_true(s[2] == 0);
        assert_close(e[2], -poisson / (1 - poisson) * (e[0] + e[1]), 1e-12, 1);
        if (strain == TALUS_STRAIN_FINITE)
            assert_close(log(ratio), e[0] + e[1] + e[2], 1e-12, 1);
        largest = fmax(largest, fabs(e[0]));
        if (control != TALUS_CONTROL_NONE)
            continue;
        const double kirchhoff = strain == TALUS_STRAIN_FINITE ? ratio : 1;
        assert_close(kirchhoff * s[0], modulus * (e[0] + poisson * e[1]), 1e-9, young);
        assert_close(kirchhoff * s[1], modulus * (e[1] + poisson * e[0]), 1e-9, young);
        assert_close(kirchhoff * s[3], young / (1 + poisson) * e[3], 1e-9, young);
    }
    assert_true(largest > 0.01);
    assert_true(simulation_metric(simulation, "energy_error") < 0.01);
    free(stress);
    free(total);
    free(volume);
    free(mass);
    talus_simulation_destroy(simulation);
}

static void law_small(void **state)
{
    (void)state;
    check_law(TALUS_STRAIN_SMALL, TALUS_CONTROL_NONE, TALUS_FIT_VOLUMETRIC);
}

static void law_finite(void **state)
{
    (void)state;
    check_law(TALUS_STRAIN_FINITE, TALUS_CONTROL_NONE, TALUS_FIT_VOLUMETRIC);
}

static void anti_locking_leaves_the_plane(void **state)
{
    (void)state;
    for (int control = TALUS_CONTROL_CELL; control <= (int)TALUS_CONTROL_HYBRID; control++) {
        for (int field = TALUS_FIT_VOLUMETRIC; field <= (int)TALUS_FIT_FULL_CONSTANT_VOLUME;
             field++) {
            check_law(TALUS_STRAIN_SMALL, (enum talus_anti_locking_control)control,
                      (enum talus_anti_locking_field)field);
            check_law(TALUS_STRAIN_FINITE, (enum talus_anti_locking_control)control,
                      (enum talus_anti_locking_field)field);
        }
    }
}

/* The critical step goes by sqrt(E / (rho (1 - nu^2))). */
static void wave_speed(void **state)
{
    (void)state;
    struct simulation_fixture stress, strain;
    struct talus_simulation_state thin, thick;
    begin(&stress);
    begin(&strain);
    strain.scene.dimension = TALUS_PLANE_STRAIN;
    struct talus_simulation *a = simulation_fixture_start(&stress, 1);
    struct talus_simulation *b = simulation_fixture_start(&strain, 1);
    talus_simulation_get_state(a, &thin);
    talus_simulation_get_state(b, &thick);
    const double plane = 1 / (1 - poisson * poisson);
    const double solid = (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
    assert_close(thin.critical_time_step / thick.critical_time_step, sqrt(solid / plane), 1e-12, 1);
    talus_simulation_destroy(a);
    talus_simulation_destroy(b);
}

static void turning(void *context, uint32_t id, const double position[3], double time,
                    double out[3])
{
    (void)context;
    (void)id;
    (void)time;
    out[0] = -20 * (position[1] - 0.75);
    out[1] = 20 * (position[0] - 1.0);
}

/* A plate that spins: the same strain energy as a rod under its centrifugal force, and no growth of
 * energy over a third of a turn. */
static void spin_keeps_energy(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    begin(&fixture);
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = 1, .initial_velocity = turning};
    assert_true(talus_simulation_create(&fixture.scene, &options, &simulation, &error) == TALUS_OK);
    simulation_run_steps(simulation, 150);
    assert_true(talus_simulation_audit(simulation, &error) == TALUS_OK);
    talus_simulation_destroy(simulation);
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
    begin(&fixture);
    fixture.bodies[0].initial_stress = TALUS_INITIAL_GIVEN;
    fixture.bodies[0].stress[2] = -1;
    refused(&fixture, "/bodies/0/initial_stress/2");
    fixture.bodies[0].initial_stress = TALUS_INITIAL_NONE;
    (void)simulation_fixture_add_sample(&fixture, material_find("j2"));
    refused(&fixture, "/materials/j2/model");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(law_small),
        cmocka_unit_test(law_finite),
        cmocka_unit_test(anti_locking_leaves_the_plane),
        cmocka_unit_test(wave_speed),
        cmocka_unit_test(spin_keeps_energy),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
