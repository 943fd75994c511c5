/* SPDX-License-Identifier: Apache-2.0 */
/* What no single entry of a scene can tell: bodies in the grid, initial states, cost. */
#include "scene/scene_sections.h"

#include "materials/material.h"
#include "seeding/seeding.h"
#include "seeding/seeding_shape.h"
#include "shapes/shape.h"
#include "talus/simulation.h"

#include <stdio.h>
#include <string.h>

/* Geometry of the bodies that were read without a mistake. */
static void check_bodies(struct scene_reader *reader)
{
    const struct talus_scene *scene = reader->scene;
    const struct scene_issues *issues = reader->issues;
    if (scene->axis_count == 0 || scene_issues_under(issues, "/grid") ||
        scene_issues_under(issues, "/boundaries"))
        return;
    for (size_t index = 0; index < scene->body_count; index++) {
        char pointer[32];
        struct talus_error error = {.status = TALUS_OK};
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu", index);
        if (!scene_issues_under(issues, pointer) && seeding_check(scene, index, &error) != TALUS_OK)
            scene_mistake_at(reader, error.pointer, error.code, error.text);
    }
    uint64_t particles, cells;
    if (scene_issues_under(issues, "/bodies"))
        return;
    seeding_count(scene, &particles, &cells);
    if (particles > SEEDING_PARTICLE_MAX)
        scene_mistake_at(reader, "/bodies", "limit",
                         "all bodies together ask for more than 200 million particles");
}

static bool has_shear(const double stress[6])
{
    double largest = fmax(fabs(stress[0]), fmax(fabs(stress[1]), fabs(stress[2])));
    double slack = 1e-9 * largest;
    return fabs(stress[0] - stress[1]) > slack || fabs(stress[1] - stress[2]) > slack ||
           stress[3] != 0.0 || stress[4] != 0.0 || stress[5] != 0.0;
}

/* Initial stresses that the material or the scene cannot have. */
static void check_initial_stress(struct scene_reader *reader, size_t body_index)
{
    const struct talus_scene *scene = reader->scene;
    const struct talus_body *body = &scene->bodies[body_index];
    const struct talus_material *entry = &scene->materials[body->material_index];
    const struct material *model = material_table[entry->model_index];
    struct scene_path bodies = {.key = "bodies"};
    struct scene_path parent = {.parent = &bodies, .index = body_index};
    struct scene_path here = {.parent = &parent, .key = "initial_stress"};
    bool depth = body->initial_stress == TALUS_INITIAL_HYDROSTATIC ||
                 body->initial_stress == TALUS_INITIAL_GEOSTATIC;
    if (depth && seeding_vertical_axis(scene) == TALUS_NO_AXIS)
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "a stress that grows with depth needs gravity");
    if (body->shape == TALUS_BODY_POINTS && depth && isnan(body->surface))
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "a list of points has no surface from which depth could run: give "
                      "{\"hydrostatic\": {\"surface\": ...}} or six components");
    if (!model->volumetric)
        return;
    if (body->initial_stress == TALUS_INITIAL_GIVEN && has_shear(body->stress))
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "a fluid at rest carries no shear: the stress must be a pressure");
    if (body->initial_stress == TALUS_INITIAL_GEOSTATIC &&
        fabs(seeding_k0(scene, body) - 1.0) > 1e-9)
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "a fluid at rest has k0 = 1: use \"hydrostatic\"");
}

/* K0 beyond the active or passive limit of a material without cohesion: the first step would
 * return the state to the yield surface. */
static void warn_of_k0(struct scene_reader *reader, size_t body_index)
{
    const double radians_per_degree = 3.14159265358979323846 / 180.0;
    const struct talus_scene *scene = reader->scene;
    const struct talus_body *body = &scene->bodies[body_index];
    const struct talus_material *entry = &scene->materials[body->material_index];
    const struct material *model = material_table[entry->model_index];
    struct scene_path bodies = {.key = "bodies"};
    struct scene_path parent = {.parent = &bodies, .index = body_index};
    struct scene_path stress = {.parent = &parent, .key = "initial_stress"};
    struct scene_path rule = {.parent = &stress, .key = "geostatic"};
    struct scene_path here = {.parent = &rule, .key = "k0"};
    double sine =
        sin(material_initial_friction_angle_deg(model, entry->values) * radians_per_degree);
    if (body->initial_stress != TALUS_INITIAL_GEOSTATIC || sine <= 0.0)
        return;
    double active = (1.0 - sine) / (1.0 + sine), k0 = seeding_k0(scene, body);
    if (k0 < active * (1.0 - 1e-9) || k0 > 1.0 / active * (1.0 + 1e-9))
        scene_warn(reader, &here, "k0_yield",
                   "k0 = %.3g is outside of the active and passive limits %.3g and %.3g of the "
                   "friction angle: without enough cohesion the first step returns it to yield",
                   k0, active, 1.0 / active);
}

static void check_courant(struct scene_reader *reader)
{
    const struct talus_solver_options *solver = &reader->scene->solver;
    struct scene_path parent = {.key = "solver"};
    struct scene_path here = {.parent = &parent, .key = "courant"};
    if (solver->courant > 1.0 && !solver->allow_unstable)
        scene_mistake(reader, &here, "over_critical", NULL, NULL,
                      "%g times the critical step needs \"allow_unstable\": true", solver->courant);
}

/* What would have no effect. */
static void check_anti_locking(struct scene_reader *reader)
{
    const struct talus_solver_options *solver = &reader->scene->solver;
    struct scene_path top = {.key = "solver"};
    struct scene_path parent = {.parent = &top, .key = "anti_locking"};
    struct scene_path field = {.parent = &parent, .key = "field"};
    struct scene_path averaging = {.parent = &parent, .key = "averaging"};
    const bool nodes =
        solver->anti_locking == TALUS_CONTROL_NODE || solver->anti_locking == TALUS_CONTROL_HYBRID;
    if (solver->anti_locking == TALUS_CONTROL_NONE &&
        solver->anti_locking_field != TALUS_FIT_VOLUMETRIC)
        scene_mistake(reader, &field, "contradiction", NULL, NULL,
                      "nothing is fitted with control \"none\": name a control volume");
    if (solver->anti_locking_averaging == TALUS_AVERAGING_WEIGHTED)
        return;
    if (!nodes)
        scene_mistake(reader, &averaging, "contradiction", NULL, NULL,
                      "only fits over nodes have weights: control \"node\" or \"hybrid\"");
    else if (shape_table[solver->shape_index]->reach > 0)
        scene_mistake(reader, &averaging, "contradiction", NULL, NULL,
                      "sums without weights are over the cells of a node: they need the shape "
                      "\"linear\"");
}

/* Keys of `solver` that only one shape knows. */
static void check_shape(struct scene_reader *reader)
{
    static const struct {
        const char *key, *shape, *why;
    } owned[] = {
        {"gimp_scaling", "gimp_scaled",
         "only the particles of shape \"gimp_scaled\" change their size"},
        {"cpdi_hybrid", "cpdi_hybrid", "only the shape \"cpdi_hybrid\" chooses where to take CPDI"},
    };
    const struct talus_scene *scene = reader->scene;
    const char *shape = shape_table[scene->solver.shape_index]->name;
    struct scene_path parent = {.key = "solver"};
    for (size_t index = 0; index < sizeof owned / sizeof owned[0]; index++) {
        struct scene_path here = {.parent = &parent, .key = owned[index].key};
        if (strcmp(shape, owned[index].shape) != 0 &&
            !scene_field_is_default(scene_field_find(scene_solver_fields, owned[index].key), scene))
            scene_mistake(reader, &here, "contradiction", NULL, NULL, "%s", owned[index].why);
    }
}

/* Two boxes in the same place make twice the material there. */
static void warn_of_overlap(struct scene_reader *reader)
{
    enum { COMPARED_MAX = 100 }; /* pairs are compared: larger scenes are left alone */
    const struct talus_scene *scene = reader->scene;
    struct scene_path bodies = {.key = "bodies"};
    for (size_t index = 1; index < scene->body_count && index < COMPARED_MAX; index++) {
        struct scene_path here = {.parent = &bodies, .index = index};
        struct seeding_shape shape;
        seeding_shape_init(&shape, scene, &scene->bodies[index]);
        if (shape.turned || shape.body->shape == TALUS_BODY_POINTS)
            continue;
        double volume = seeding_shape_volume(&shape);
        for (size_t before = 0; before < index; before++) {
            struct seeding_shape common = shape, other;
            if (scene->bodies[before].shape != TALUS_BODY_BOX)
                continue;
            seeding_shape_init(&other, scene, &scene->bodies[before]);
            if (other.turned)
                continue;
            seeding_shape_cut(&common, other.min, other.max);
            double shared = seeding_shape_volume(&common);
            if (shared > 1e-6 * volume)
                scene_warn(reader, &here, "overlap",
                           "%.3g %% of '%s' lies inside '%s': there is material of both there",
                           100.0 * shared / volume, scene->bodies[index].name,
                           scene->bodies[before].name);
        }
    }
}

/* Curves are compared over their own times; what lies after the end is not. */
static void warn_of_references(struct scene_reader *reader)
{
    const struct talus_scene *scene = reader->scene;
    struct scene_path references = {.key = "references"};
    for (size_t index = 0; index < scene->reference_count; index++) {
        const struct talus_reference *reference = &scene->references[index];
        struct scene_path entry = {.parent = &references, .index = index};
        struct scene_path here = {.parent = &entry, .key = "curve"};
        size_t last = reference->point_count;
        if (last > 1 && reference->time[last - 1] > scene->duration)
            scene_warn(reader, &here, "beyond_end",
                       "the curve goes on to %g s, but the run ends at %g s",
                       reference->time[last - 1], scene->duration);
    }
}

/* Single precision that is safe, but can be seen. */
static void warn_of_precision(struct scene_reader *reader, const struct talus_estimate *estimate)
{
    const double motion_limit = 0.01, noise_limit = 0.03;
    struct scene_path parent = {.key = "solver"};
    struct scene_path here = {.parent = &parent, .key = "precision"};
    if (estimate->motion_error > motion_limit)
        scene_warn(reader, &here, "precision",
                   "single precision may take up to %.2g of the motion of the slowest body, in the "
                   "rounding of its positions",
                   estimate->motion_error);
    if (estimate->force_noise > noise_limit)
        scene_warn(reader, &here, "precision",
                   "single precision may add noise of up to %.2g of the stress of the weight to "
                   "single samples of stresses and forces; means are not affected",
                   estimate->force_noise);
}

/* What settles comes to rest: a velocity at the start would be damped away. */
static void check_settling(struct scene_reader *reader)
{
    const struct talus_scene *scene = reader->scene;
    struct scene_path bodies = {.key = "bodies"};
    if (scene->solver.settle_damping > 0.0 && scene->solver.settle_time == 0.0)
        scene_mistake_at(reader, "/solver/stabilise/settle/time", "incomplete",
                         "damping acts in the time before t = 0, of which there is none");
    for (size_t index = 0; index < scene->body_count && scene->solver.settle_time > 0.0; index++) {
        const struct talus_body *body = &scene->bodies[index];
        struct scene_path entry = {.parent = &bodies, .index = index};
        struct scene_path here = {.parent = &entry, .key = "velocity"};
        if (body->velocity_field != TALUS_VELOCITY_UNIFORM || body->velocity[0] != 0.0 ||
            body->velocity[1] != 0.0 || body->velocity[2] != 0.0)
            scene_mistake(reader, &here, "contradiction", NULL, NULL,
                          "'settle' brings all bodies to rest before t = 0: it cannot be combined "
                          "with a velocity at the start");
    }
}

/* A fixed step above the critical one, and whatever else the solver refuses. */
static void check_estimate(struct scene_reader *reader)
{
    struct talus_estimate estimate;
    struct talus_error error = {.status = TALUS_OK};
    if (talus_simulation_estimate(reader->scene, &estimate, &error) != TALUS_OK)
        scene_mistake_at(reader, error.pointer, error.code, error.text);
    else
        warn_of_precision(reader, &estimate);
}

void scene_check(struct scene_reader *reader)
{
    const struct talus_scene *scene = reader->scene;
    if (reader->out_of_memory)
        return;
    check_bodies(reader);
    if (!scene_issues_under(reader->issues, "/solver"))
        check_courant(reader);
    check_settling(reader);
    if (!scene_issues_under(reader->issues, "/solver"))
        check_anti_locking(reader);
    if (!scene_issues_under(reader->issues, "/solver"))
        check_shape(reader);
    if (reader->issues->count > 0)
        return;
    check_estimate(reader);
    for (size_t index = 0; index < scene->body_count; index++) {
        check_initial_stress(reader, index);
        warn_of_k0(reader, index);
    }
    warn_of_overlap(reader);
    warn_of_references(reader);
    scene_check_boundaries(reader);
}
