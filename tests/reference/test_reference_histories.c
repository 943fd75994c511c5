/* SPDX-License-Identifier: Apache-2.0 */
/* Energies, momentum, reactions and positions of the solver against the textbook code over 1,000
 * steps, for every material, in scenes without free flight. */
#include "reference_mpm.h"
#include "simulation_fixture.h"
#include "transfers/velocity_transfer.h"

#include <stdio.h>

/* Sanitizers look at the code, not at the figures: a tenth of the steps is enough for them. */
#ifdef __SANITIZE_ADDRESS__
enum { STEPS = 100 };
#else
enum { STEPS = 1000 };
#endif
#define AGREEMENT 1e-10
/* Impulses of single steps at walls that release and grip again, which amplifies rounding: builds
 * of the solver that differ in nothing but fused multiply-adds are apart by 0.7e-10 to 1.7e-10
 * there, while energy and momentum, their sums, agree within 1e-12. */
#define RELEASE_AGREEMENT 1e-9

enum motion { COLUMN, SLIDE, BAR };

struct variant {
    const char *name;
    enum motion motion;
    size_t axis_count;
    enum talus_stress_update stress_update;
    enum talus_strain strain;
    enum talus_anti_locking_control anti_locking;
    enum talus_anti_locking_apply apply;
    double viscous_damping, local_damping, pic_rate, force_ramp;
    enum talus_wall wall;
    bool tension_release;
    const char *transfer;   /* NULL: flip */
    double lag, strain_lag; /* 1 - theta, 1 - strain_theta */
};

/* Local damping is not combined with sliding and release: the sign of a velocity around zero and a
 * contact that comes and goes amplify the last bit by 1e5 (seen in the textbook code alone). */
static const struct variant variants[] = {
    {.name = "column, line, modified_last, finite", .motion = COLUMN, .axis_count = 1},
    {.name = "bar, line, last, small, anti-locking",
     .motion = BAR,
     .axis_count = 1,
     .stress_update = TALUS_STRESS_LAST,
     .strain = TALUS_STRAIN_SMALL,
     .anti_locking = TALUS_CONTROL_CELL,
     .viscous_damping = 0.1},
    {.name = "slide, plane strain, modified_last, finite", .motion = SLIDE, .axis_count = 2},
    {.name = "slide, plane strain, modified_last, small, anti-locking, release",
     .motion = SLIDE,
     .axis_count = 2,
     .strain = TALUS_STRAIN_SMALL,
     .anti_locking = TALUS_CONTROL_CELL,
     .apply = TALUS_APPLY_STRAIN,
     .viscous_damping = 0.2,
     .tension_release = true},
    {.name = "column, plane strain, last, finite, keep, ramp",
     .motion = COLUMN,
     .axis_count = 2,
     .stress_update = TALUS_STRESS_LAST,
     .local_damping = 0.1,
     .force_ramp = 0.05,
     .wall = TALUS_WALL_KEEP},
    {.name = "column, plane strain, modified_last, finite, anti-locking, damping",
     .motion = COLUMN,
     .axis_count = 2,
     .anti_locking = TALUS_CONTROL_CELL,
     .viscous_damping = 0.1,
     .local_damping = 0.05,
     .wall = TALUS_WALL_KEEP},
    {.name = "slide, solid, modified_last, finite, anti-locking",
     .motion = SLIDE,
     .axis_count = 3,
     .anti_locking = TALUS_CONTROL_CELL,
     .pic_rate = 5.0},
    {.name = "column, solid, last, small",
     .motion = COLUMN,
     .axis_count = 3,
     .stress_update = TALUS_STRESS_LAST,
     .strain = TALUS_STRAIN_SMALL},
    {.name = "column, line, first, finite, keep, ramp",
     .motion = COLUMN,
     .axis_count = 1,
     .stress_update = TALUS_STRESS_FIRST,
     .local_damping = 0.1,
     .force_ramp = 0.05,
     .wall = TALUS_WALL_KEEP},
    {.name = "slide, plane strain, first, finite, anti-locking",
     .motion = SLIDE,
     .axis_count = 2,
     .stress_update = TALUS_STRESS_FIRST,
     .anti_locking = TALUS_CONTROL_CELL,
     .viscous_damping = 0.1,
     .pic_rate = 5.0},
    {.name = "slide, plane strain, first, small, release",
     .motion = SLIDE,
     .axis_count = 2,
     .stress_update = TALUS_STRESS_FIRST,
     .strain = TALUS_STRAIN_SMALL,
     .viscous_damping = 0.2,
     .tension_release = true},
    {.name = "column, solid, first, finite",
     .motion = COLUMN,
     .axis_count = 3,
     .stress_update = TALUS_STRESS_FIRST},
    {.name = "column, plane strain, modified_last, apic",
     .motion = COLUMN,
     .axis_count = 2,
     .transfer = "apic"},
    {.name = "column, solid, first, apic",
     .motion = COLUMN,
     .axis_count = 3,
     .stress_update = TALUS_STRESS_FIRST,
     .transfer = "apic"},
    {.name = "column, plane strain, last, theta, strain_theta",
     .motion = COLUMN,
     .axis_count = 2,
     .stress_update = TALUS_STRESS_LAST,
     .viscous_damping = 0.4,
     .force_ramp = 0.05,
     .lag = 0.5,
     .strain_lag = 0.1},
    {.name = "column, plane strain, modified_last, theta",
     .motion = COLUMN,
     .axis_count = 2,
     .lag = 0.5},
    {.name = "slide, plane strain, first, theta, pic",
     .motion = SLIDE,
     .axis_count = 2,
     .stress_update = TALUS_STRESS_FIRST,
     .transfer = "pic",
     .lag = 1.0},
    {.name = "column, line, last, pic",
     .motion = COLUMN,
     .axis_count = 1,
     .stress_update = TALUS_STRESS_LAST,
     .transfer = "pic"},
    {.name = "slide, plane strain, first, pic",
     .motion = SLIDE,
     .axis_count = 2,
     .stress_update = TALUS_STRESS_FIRST,
     .strain = TALUS_STRAIN_SMALL,
     .transfer = "pic"},
};

/* Other fits than the volumetric one over cells. */
struct fit_variant {
    struct variant base;
    enum talus_anti_locking_field field;
    enum talus_anti_locking_averaging averaging;
};

static const struct fit_variant fit_variants[] = {
    {.base = {.name = "slide, plane strain, modified_last, finite, cell full",
              .motion = SLIDE,
              .axis_count = 2,
              .stress_update = TALUS_STRESS_MODIFIED_LAST,
              .strain = TALUS_STRAIN_FINITE,
              .anti_locking = TALUS_CONTROL_CELL,
              .apply = TALUS_APPLY_STRAIN_AND_STRESS,
              .viscous_damping = 0.1},
     .field = TALUS_FIT_FULL,
     .averaging = TALUS_AVERAGING_WEIGHTED},
    {.base = {.name = "bar, line, modified_last, small, cell full with constant volume",
              .motion = BAR,
              .axis_count = 1,
              .stress_update = TALUS_STRESS_MODIFIED_LAST,
              .strain = TALUS_STRAIN_SMALL,
              .anti_locking = TALUS_CONTROL_CELL,
              .apply = TALUS_APPLY_STRAIN},
     .field = TALUS_FIT_FULL_CONSTANT_VOLUME,
     .averaging = TALUS_AVERAGING_WEIGHTED},
    {.base = {.name = "slide, plane strain, modified_last, finite, node volumetric, damping",
              .motion = SLIDE,
              .axis_count = 2,
              .stress_update = TALUS_STRESS_MODIFIED_LAST,
              .strain = TALUS_STRAIN_FINITE,
              .anti_locking = TALUS_CONTROL_NODE,
              .apply = TALUS_APPLY_STRAIN_AND_STRESS,
              .viscous_damping = 0.1,
              .pic_rate = 5.0},
     .field = TALUS_FIT_VOLUMETRIC,
     .averaging = TALUS_AVERAGING_WEIGHTED},
    {.base = {.name = "column, plane strain, first, finite, node volumetric",
              .motion = COLUMN,
              .axis_count = 2,
              .stress_update = TALUS_STRESS_FIRST,
              .strain = TALUS_STRAIN_FINITE,
              .anti_locking = TALUS_CONTROL_NODE,
              .apply = TALUS_APPLY_STRAIN_AND_STRESS},
     .field = TALUS_FIT_VOLUMETRIC,
     .averaging = TALUS_AVERAGING_WEIGHTED},
    {.base = {.name = "column, plane strain, last, small, node volumetric, sums without weights",
              .motion = COLUMN,
              .axis_count = 2,
              .stress_update = TALUS_STRESS_LAST,
              .strain = TALUS_STRAIN_SMALL,
              .anti_locking = TALUS_CONTROL_NODE,
              .apply = TALUS_APPLY_STRAIN,
              .viscous_damping = 0.1},
     .field = TALUS_FIT_VOLUMETRIC,
     .averaging = TALUS_AVERAGING_UNWEIGHTED_SUMS},
    {.base = {.name = "column, plane strain, modified_last, finite, node full, without weights",
              .motion = COLUMN,
              .axis_count = 2,
              .stress_update = TALUS_STRESS_MODIFIED_LAST,
              .strain = TALUS_STRAIN_FINITE,
              .anti_locking = TALUS_CONTROL_NODE,
              .apply = TALUS_APPLY_STRAIN_AND_STRESS},
     .field = TALUS_FIT_FULL,
     .averaging = TALUS_AVERAGING_UNWEIGHTED},
    {.base = {.name = "bar, line, modified_last, finite, node full with constant volume",
              .motion = BAR,
              .axis_count = 1,
              .stress_update = TALUS_STRESS_MODIFIED_LAST,
              .strain = TALUS_STRAIN_FINITE,
              .anti_locking = TALUS_CONTROL_NODE,
              .apply = TALUS_APPLY_STRAIN_AND_STRESS},
     .field = TALUS_FIT_FULL_CONSTANT_VOLUME,
     .averaging = TALUS_AVERAGING_WEIGHTED},
    {.base = {.name = "slide, solid, modified_last, finite, hybrid full",
              .motion = SLIDE,
              .axis_count = 3,
              .stress_update = TALUS_STRESS_MODIFIED_LAST,
              .strain = TALUS_STRAIN_FINITE,
              .anti_locking = TALUS_CONTROL_HYBRID,
              .apply = TALUS_APPLY_STRAIN_AND_STRESS},
     .field = TALUS_FIT_FULL,
     .averaging = TALUS_AVERAGING_WEIGHTED},
};

/* Side walls and a floor that hold a column which settles under sudden gravity. */
static void build_column(struct simulation_fixture *fixture, size_t material, size_t axes)
{
    static const double min[3] = {0.1, 0.1, 0.1}, max[3][3] = {{0.9}, {0.4, 0.7}, {0.3, 0.3, 0.5}};
    struct talus_scene *scene = &fixture->scene;
    const size_t up = axes - 1;
    scene->gravity[up] = -40; /* strong, for strains well above round-off */
    simulation_fixture_add_box(fixture, material, min, max[axes - 1], axes == 1 ? 3 : 2);
    simulation_fixture_add_plane(fixture, "floor", up, 0.1, 1, "stick", 0);
    static const char *const low[2] = {"x low", "y low"}, *const high[2] = {"x high", "y high"};
    for (size_t axis = 0; axis < up; axis++) {
        simulation_fixture_add_plane(fixture, low[axis], axis, 0.1, 1, "slip", 0);
        simulation_fixture_add_plane(fixture, high[axis], axis, max[axes - 1][axis], -1, "slip", 0);
    }
}

/* A block that settles on a floor with friction while it slides along it over several cells. */
static void build_slide(struct simulation_fixture *fixture, size_t material, size_t axes)
{
    static const double min[3] = {0.2, 0.1, 0.2}, max[3] = {0.5, 0.3, 0.4};
    const size_t up = 1;
    fixture->scene.gravity[up] = -9.81;
    struct talus_body *body = simulation_fixture_add_box(fixture, material, min, max, 2);
    body->velocity[0] = 1.0;
    if (axes == 3)
        body->velocity[2] = 0.5;
    simulation_fixture_add_plane(fixture, "floor", up, 0.1, 1, "friction", 0.15);
}

/* A bar that runs into a wall and stays there: released tension would let it fly. */
static void build_bar(struct simulation_fixture *fixture, size_t material, size_t axes)
{
    static const double min[3] = {0.1, 0.1, 0.1}, max[3] = {0.9, 0.2, 0.2};
    struct talus_body *body = simulation_fixture_add_box(fixture, material, min, max, 2);
    body->velocity[0] = -0.2;
    simulation_fixture_add_plane(fixture, "wall", 0, 0.1, 1, axes == 1 ? "slip" : "stick", 0);
}

static void build(struct simulation_fixture *fixture, const struct material *material,
                  const struct variant *variant)
{
    static const int64_t count[3] = {16, 10, 12};
    simulation_fixture_init(fixture, variant->axis_count, 0.1, count);
    struct talus_scene *scene = &fixture->scene;
    const size_t index = simulation_fixture_add_sample(fixture, material);
    const bool last = variant->stress_update == TALUS_STRESS_LAST;
    scene->solver.time_step = last ? 2e-4 : 4e-4;
    scene->duration = 10;
    scene->solver.stress_update = variant->stress_update;
    scene->solver.strain = variant->strain;
    scene->solver.anti_locking = variant->anti_locking;
    scene->solver.anti_locking_apply = variant->apply;
    scene->solver.viscous_damping = variant->viscous_damping;
    scene->solver.local_damping = variant->local_damping;
    scene->solver.pic_rate = variant->pic_rate;
    scene->solver.force_ramp = variant->force_ramp;
    scene->solver.allow_unstable = true; /* apic: edges stay in their cells; strain_theta: damped */
    scene->solver.theta = 1 - variant->lag;
    scene->solver.strain_theta = 1 - variant->strain_lag;
    while (variant->transfer != NULL &&
           strcmp(transfer_of(&scene->solver)->name, variant->transfer) != 0)
        scene->solver.transfer_index++;
    if (variant->motion == COLUMN)
        build_column(fixture, index, variant->axis_count);
    else if (variant->motion == SLIDE)
        build_slide(fixture, index, variant->axis_count);
    else
        build_bar(fixture, index, variant->axis_count);
    for (size_t wall = 0; wall < scene->boundary_count; wall++) {
        fixture->boundaries[wall].wall = variant->wall;
        fixture->boundaries[wall].tension_release = variant->tension_release;
    }
}

/* Largest differences so far, and what they are relative to. */
struct comparison {
    double energy, energy_scale;
    double momentum, momentum_scale;
    double impulse, impulse_scale;
    double position, moved;
    size_t crossings;
    double plastic;
};

static void raise_to(double *largest, double value)
{
    /* Not a number must not pass. */
    *largest = value <= *largest ? *largest : value;
}

static void compare_energies(struct comparison *comparison, const struct reference *reference,
                             const double *row, const double *first)
{
    const struct reference_energy energy = reference_energies(reference);
    raise_to(&comparison->energy, fabs(row[2] - energy.kinetic));
    raise_to(&comparison->energy, fabs(row[3] - energy.strain));
    raise_to(&comparison->energy, fabs(row[4] - energy.potential));
    raise_to(&comparison->energy, fabs(row[5] - energy.dissipated));
    raise_to(&comparison->energy, fabs(row[6] - energy.external));
    raise_to(&comparison->energy_scale,
             energy.kinetic + energy.strain + energy.dissipated + fabs(row[4] - first[4]));
}

static void compare_momenta(struct comparison *comparison, const struct reference *reference,
                            const struct talus_simulation *simulation)
{
    double expected[3], actual[3] = {0, 0, 0};
    reference_momentum(reference, expected);
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
    for (size_t k = 0; k < reference->particle_count; k++) {
        for (size_t axis = 0; axis < 3; axis++)
            actual[axis] += reference->particles[k].mass * velocity[3 * k + axis];
    }
    free(velocity);
    for (size_t axis = 0; axis < 3; axis++) {
        raise_to(&comparison->momentum, fabs(actual[axis] - expected[axis]));
        raise_to(&comparison->momentum_scale, fabs(expected[axis]));
    }
}

static void compare_reactions(struct comparison *comparison, const struct reference *reference,
                              const struct talus_simulation *simulation, const double *row)
{
    static const char axis_names[3] = {'x', 'y', 'z'};
    for (int wall = 0; wall < reference->wall_count; wall++) {
        for (size_t axis = 0; axis < reference->scene->axis_count; axis++) {
            char name[128];
            (void)snprintf(name, sizeof name, "reaction.%s.instant.%c",
                           reference->scene->boundaries[wall].name, axis_names[axis]);
            const double actual = row[simulation_column(simulation, name)] * reference->time_step;
            const double expected = reference->wall_impulse[wall][axis];
            raise_to(&comparison->impulse, fabs(actual - expected));
            raise_to(&comparison->impulse_scale, fabs(expected));
        }
    }
}

static void compare_positions(struct comparison *comparison, const struct reference *reference,
                              const struct talus_simulation *simulation, const double *start)
{
    double *position = calloc(3 * reference->particle_count, sizeof *position);
    double *plastic = simulation_field(simulation, TALUS_FIELD_PLASTIC_STRAIN, 1);
    assert_non_null(position);
    talus_simulation_read_positions(simulation, position);
    for (size_t k = 0; k < reference->particle_count; k++) {
        const struct reference_particle *p = &reference->particles[k];
        bool crossed = false;
        for (size_t axis = 0; axis < reference->scene->axis_count; axis++) {
            const double h = reference->scene->grid.cell[axis];
            raise_to(&comparison->position, fabs(position[3 * k + axis] - p->position[axis]) / h);
            raise_to(&comparison->moved, fabs(position[3 * k + axis] - start[3 * k + axis]) / h);
            crossed =
                crossed || floor(position[3 * k + axis] / h) != floor(start[3 * k + axis] / h);
        }
        comparison->crossings += crossed;
        raise_to(&comparison->plastic, p->plastic);
        assert_close(plastic[k], p->plastic, 1e-9, p->plastic + 1e-4);
    }
    free(plastic);
    free(position);
}

static struct comparison compare(const struct simulation_fixture *fixture)
{
    struct talus_simulation *simulation = simulation_fixture_start(fixture, 1);
    struct reference reference;
    reference_start(&reference, &fixture->scene, simulation);
    struct comparison comparison = {0};
    size_t columns = 0;
    (void)talus_simulation_columns(simulation, &columns);
    double *row = calloc(2 * columns, sizeof *row), *first = row + columns;
    double *start = calloc(3 * reference.particle_count, sizeof *start);
    assert_non_null(row);
    assert_non_null(start);
    talus_simulation_read_positions(simulation, start);
    talus_simulation_sample(simulation, first);
    compare_energies(&comparison, &reference, first, first);
    for (size_t step = 0; step < STEPS; step++) {
        simulation_run_steps(simulation, 1);
        reference_step(&reference);
        talus_simulation_sample(simulation, row);
        compare_energies(&comparison, &reference, row, first);
        compare_momenta(&comparison, &reference, simulation);
        compare_reactions(&comparison, &reference, simulation, row);
    }
    compare_positions(&comparison, &reference, simulation, start);
    free(row);
    free(start);
    reference_release(&reference);
    talus_simulation_destroy(simulation);
    return comparison;
}

/* Runs one variant with one material; prints what was found. */
static void run_variant(const struct material *material, const struct fit_variant *variant)
{
    struct simulation_fixture fixture;
    build(&fixture, material, &variant->base);
    fixture.scene.solver.anti_locking_field = variant->field;
    fixture.scene.solver.anti_locking_averaging = variant->averaging;
    fixture.scene.output.frame_fields = 1u << TALUS_FIELD_PLASTIC_STRAIN;
    const struct comparison c = compare(&fixture);
    print_message("%s, %s: energy %.1e, momentum %.1e, reactions %.1e, position %.1e; moved "
                  "%.2f cells, %zu particles crossed, plastic strain %.1e\n",
                  material->name, variant->base.name, c.energy / c.energy_scale,
                  c.momentum / c.momentum_scale, c.impulse / c.impulse_scale, c.position, c.moved,
                  c.crossings, c.plastic);
    assert_true(c.energy <= AGREEMENT * c.energy_scale);
    assert_true(c.momentum <= AGREEMENT * c.momentum_scale);
    assert_true(c.impulse <=
                (variant->base.tension_release ? RELEASE_AGREEMENT : AGREEMENT) * c.impulse_scale);
    assert_true(c.position <= AGREEMENT);
    if (variant->base.motion == SLIDE && STEPS >= 1000)
        assert_true(c.crossings > 0);
    /* Columns and bars yield; a block that slides calmly need not. */
    if (material->plastic && variant->base.motion != SLIDE && STEPS >= 1000)
        assert_true(c.plastic > 1e-6);
}

static void run_material(const struct material *material)
{
    assert_true(reference_material_known(material));
    for (size_t index = 0; index < LENGTH(variants); index++) {
        const struct fit_variant variant = {variants[index], TALUS_FIT_VOLUMETRIC,
                                            TALUS_AVERAGING_WEIGHTED};
        run_variant(material, &variant);
    }
    /* What is fitted differs between solids and fluids, and where strains change twice. */
    static const char *const fitted_models[3] = {"linear_elastic", "newtonian_fluid", "j2"};
    bool fitted = false;
    for (size_t index = 0; index < LENGTH(fitted_models); index++)
        fitted = fitted || strcmp(material->name, fitted_models[index]) == 0;
    for (size_t index = 0; fitted && index < LENGTH(fit_variants); index++)
        run_variant(material, &fit_variants[index]);
}

static void test_material(void **state)
{
    run_material(*state);
}

/* Three materials in shared cells, one of them a fluid: blocks are taken apart and put together. */
static void test_mixture(void **state)
{
    (void)state;
    static const char *const names[3] = {"newtonian_fluid", "j2", "matsuoka_nakai"};
    static const int64_t count[3] = {16, 10, 1};
    static const enum talus_anti_locking_control controls[] = {
        TALUS_CONTROL_NONE, TALUS_CONTROL_CELL, TALUS_CONTROL_NODE, TALUS_CONTROL_HYBRID};
    for (size_t index = 0; index < LENGTH(controls); index++) {
        struct simulation_fixture fixture;
        simulation_fixture_init(&fixture, 2, 0.1, count);
        struct talus_scene *scene = &fixture.scene;
        scene->solver.time_step = 2e-4;
        scene->duration = 10;
        scene->solver.anti_locking = controls[index];
        if (controls[index] == TALUS_CONTROL_HYBRID)
            scene->solver.anti_locking_field = TALUS_FIT_FULL;
        scene->gravity[1] = -40;
        scene->output.frame_fields = 1u << TALUS_FIELD_PLASTIC_STRAIN;
        for (size_t body = 0; body < 3; body++) {
            const double width = 0.35 / 3, low = 0.1 + (double)body * width;
            const double min[3] = {low, 0.1}, max[3] = {low + width, 0.5};
            const size_t material =
                simulation_fixture_add_sample(&fixture, material_find(names[body]));
            simulation_fixture_add_box(&fixture, material, min, max, 3);
        }
        simulation_fixture_add_plane(&fixture, "floor", 1, 0.1, 1, "friction", 0.2);
        simulation_fixture_add_plane(&fixture, "x low", 0, 0.1, 1, "slip", 0);
        simulation_fixture_add_plane(&fixture, "x high", 0, 0.5, -1, "slip", 0);
        const struct comparison c = compare(&fixture);
        print_message("mixture: energy %.1e, momentum %.1e, reactions %.1e, position %.1e; plastic "
                      "strain %.1e\n",
                      c.energy / c.energy_scale, c.momentum / c.momentum_scale,
                      c.impulse / c.impulse_scale, c.position, c.plastic);
        assert_true(c.energy <= AGREEMENT * c.energy_scale);
        assert_true(c.momentum <= AGREEMENT * c.momentum_scale);
        assert_true(c.impulse <= AGREEMENT * c.impulse_scale);
        assert_true(c.position <= AGREEMENT);
        assert_true(c.plastic > 1e-6);
    }
}

int main(void)
{
    /* One test a model of the table: a model that the reference does not know fails here. */
    struct CMUnitTest *tests = calloc(material_count + 1, sizeof *tests);
    if (tests == NULL)
        return 1;
    for (size_t index = 0; index < material_count; index++) {
        tests[index] = (struct CMUnitTest){.name = material_table[index]->name,
                                           .test_func = test_material,
                                           .initial_state = (void *)material_table[index]};
    }
    tests[material_count] = (struct CMUnitTest){.name = "mixture", .test_func = test_mixture};
    const int failed =
        _cmocka_run_group_tests("reference_histories", tests, material_count + 1, NULL, NULL);
    free(tests);
    return failed;
}
