/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation_fixture.h"

#include "boundaries/boundary.h"
#include "shapes/shape.h"

#include <stdio.h>

void simulation_fixture_init(struct simulation_fixture *fixture, size_t axis_count, double cell,
                             const int64_t count[3])
{
    static const enum talus_dimension dimensions[3] = {TALUS_LINE, TALUS_PLANE_STRAIN, TALUS_SOLID};
    memset(fixture, 0, sizeof *fixture);
    struct talus_scene *scene = &fixture->scene;
    scene->axis_count = axis_count;
    scene->dimension = dimensions[axis_count - 1];
    scene->duration = 1.0;
    for (size_t axis = 0; axis < 3; axis++) {
        scene->grid.cell[axis] = axis < axis_count ? cell : 1.0;
        scene->grid.cell_count[axis] = axis < axis_count ? count[axis] : 1;
    }
    scene->solver.courant = 0.4;
    scene->solver.flip_ratio = NAN;
    scene->solver.theta = scene->solver.strain_theta = 1.0;
    scene->solver.precision = talus_simulation_precision();
    scene->energy_growth_limit = 0.01;
    scene->materials = fixture->materials;
    scene->bodies = fixture->bodies;
    scene->boundaries = fixture->boundaries;
    scene->probes = fixture->probes;
}

static size_t add_material(struct simulation_fixture *fixture, const struct material *material)
{
    const size_t index = fixture->scene.material_count++;
    assert_true(index < SIMULATION_FIXTURE_MATERIALS);
    size_t model = 0;
    while (material_table[model] != material)
        model++;
    fixture->materials[index] = (struct talus_material){
        .name = (char *)material->name, .model_index = model, .values = fixture->values[index]};
    return index;
}

size_t simulation_fixture_add_material(struct simulation_fixture *fixture, const char *model,
                                       const struct setting *settings, size_t count)
{
    const struct material *material = material_find(model);
    assert_non_null(material);
    const size_t index = add_material(fixture, material);
    values_set(material, settings, count, fixture->values[index]);
    return index;
}

size_t simulation_fixture_add_sample(struct simulation_fixture *fixture,
                                     const struct material *material)
{
    struct fixture sample;
    const size_t index = add_material(fixture, material);
    fixture_init_sample(&sample, material);
    memcpy(fixture->values[index], sample.values, sizeof sample.values);
    fixture_release(&sample);
    return index;
}

size_t simulation_fixture_shape(const char *name)
{
    size_t index = 0;
    while (index < shape_count && strcmp(shape_table[index]->name, name) != 0)
        index++;
    assert_true(index < shape_count);
    return index;
}

struct talus_body *simulation_fixture_add_box(struct simulation_fixture *fixture, size_t material,
                                              const double min[3], const double max[3],
                                              double per_cell)
{
    static const char *const names[SIMULATION_FIXTURE_BODIES] = {"body", "second", "third",
                                                                 "fourth"};
    const size_t index = fixture->scene.body_count++;
    assert_true(index < SIMULATION_FIXTURE_BODIES);
    struct talus_body *body = &fixture->bodies[index];
    body->name = (char *)names[index];
    body->material_index = material;
    body->shape = TALUS_BODY_BOX;
    body->lattice = TALUS_LATTICE_PER_CELL;
    body->surface = NAN;
    for (size_t axis = 0; axis < 3; axis++) {
        const bool used = axis < fixture->scene.axis_count;
        body->box_min[axis] = used ? min[axis] : 0.0;
        body->box_max[axis] = used ? max[axis] : 0.0;
        body->clip_min[axis] = -INFINITY;
        body->clip_max[axis] = INFINITY;
        body->lattice_value[axis] = per_cell;
    }
    return body;
}

static size_t condition_index(const char *name)
{
    size_t index = 0;
    while (index < boundary_count && strcmp(boundary_table[index]->name, name) != 0)
        index++;
    assert_true(index < boundary_count);
    return index;
}

static struct talus_boundary *add_boundary(struct simulation_fixture *fixture, const char *name,
                                           size_t face_count, const char *condition,
                                           double friction)
{
    const size_t index = fixture->scene.boundary_count++;
    assert_true(index < SIMULATION_FIXTURE_BOUNDARIES);
    struct talus_boundary *boundary = &fixture->boundaries[index];
    boundary->name = (char *)name;
    boundary->face_count = face_count;
    boundary->body_index = -1;
    for (size_t face = 0; face < face_count; face++) {
        boundary->faces[face].condition_index = condition_index(condition);
        boundary->faces[face].friction_coefficient = friction;
    }
    return boundary;
}

struct talus_boundary *simulation_fixture_add_plane(struct simulation_fixture *fixture,
                                                    const char *name, size_t axis,
                                                    double coordinate, double direction,
                                                    const char *condition, double friction)
{
    struct talus_boundary *boundary = add_boundary(fixture, name, 1, condition, friction);
    boundary->shape = TALUS_BOUNDARY_PLANE;
    boundary->point[axis] = coordinate;
    boundary->normal[axis] = direction;
    memcpy(boundary->moment_about, boundary->point, sizeof boundary->point);
    return boundary;
}

struct talus_boundary *simulation_fixture_add_obstacle(struct simulation_fixture *fixture,
                                                       const char *name, const double min[3],
                                                       const double max[3], const char *condition,
                                                       double friction)
{
    struct talus_boundary *boundary =
        add_boundary(fixture, name, 2 * fixture->scene.axis_count, condition, friction);
    boundary->shape = TALUS_BOUNDARY_BOX;
    for (size_t axis = 0; axis < fixture->scene.axis_count; axis++) {
        boundary->box_min[axis] = min[axis];
        boundary->box_max[axis] = max[axis];
    }
    return boundary;
}

struct talus_probe *simulation_fixture_add_probe(struct simulation_fixture *fixture,
                                                 const char *name, enum talus_probe_kind kind)
{
    const size_t index = fixture->scene.probe_count++;
    assert_true(index < SIMULATION_FIXTURE_PROBES);
    struct talus_probe *probe = &fixture->probes[index];
    probe->name = (char *)name;
    probe->kind = kind;
    probe->body_index = probe->on_boundary = probe->component = probe->face_index = -1;
    probe->mean_from = NAN;
    for (size_t axis = 0; axis < 3; axis++) {
        probe->within_min[axis] = -INFINITY;
        probe->within_max[axis] = INFINITY;
    }
    return probe;
}

struct talus_simulation *simulation_fixture_start(const struct simulation_fixture *fixture,
                                                  int threads)
{
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = threads, .all_threads = true};
    if (talus_simulation_create(&fixture->scene, &options, &simulation, &error) != TALUS_OK)
        fail_msg("create: %s", error.text);
    return simulation;
}

void simulation_run_steps(struct talus_simulation *simulation, size_t count)
{
    for (size_t step = 0; step < count; step++) {
        struct talus_error error = {0};
        if (talus_simulation_step(simulation, &error) != TALUS_OK)
            fail_msg("step %zu: %s", step, error.text);
    }
}

size_t simulation_column(const struct talus_simulation *simulation, const char *name)
{
    size_t count = 0;
    const struct talus_column *columns = talus_simulation_columns(simulation, &count);
    for (size_t index = 0; index < count; index++) {
        if (strcmp(columns[index].name, name) == 0)
            return index;
    }
    fail_msg("no column %s", name);
    return 0;
}

double simulation_metric(struct talus_simulation *simulation, const char *name)
{
    size_t count = 0;
    const struct talus_metric *metrics = talus_simulation_metrics(simulation, &count);
    for (size_t index = 0; index < count; index++) {
        if (strcmp(metrics[index].name, name) == 0)
            return metrics[index].value;
    }
    fail_msg("no metric %s", name);
    return NAN;
}

size_t simulation_particle_count(const struct talus_simulation *simulation)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(simulation, &state);
    return state.particle_count;
}

double *simulation_field(const struct talus_simulation *simulation, enum talus_field field,
                         size_t components)
{
    struct talus_error error = {0};
    double *values = calloc(simulation_particle_count(simulation) * components + 1, sizeof *values);
    assert_non_null(values);
    if (talus_simulation_read_field(simulation, field, values, &error) != TALUS_OK)
        fail_msg("field: %s", error.text);
    return values;
}

void assert_close(double actual, double expected, double tolerance, double scale)
{
    if (!(fabs(actual - expected) <= tolerance * scale))
        fail_msg("%.17g is not %.17g within %.3g", actual, expected, tolerance * scale);
}
