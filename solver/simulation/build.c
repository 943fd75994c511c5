/* SPDX-License-Identifier: Apache-2.0 */
/* From a scene to a run without particles: materials, walls, layout, scratch. */
#include "explicit/courant_limit.h"
#include "simulation/method_check.h"
#include "simulation/scene_copy.h"
#include "simulation/simulation_private.h"
#include "state/traction_layout.h"

#include "transfers/velocity_transfer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool scene_wants(const struct talus_scene *scene, enum talus_field field)
{
    if (scene->output.frame_fields >> field & 1)
        return true;
    for (size_t index = 0; index < scene->probe_count; index++) {
        const struct talus_probe *probe = &scene->probes[index];
        if ((probe->kind == TALUS_PROBE_POINT || probe->kind == TALUS_PROBE_INTEGRAL) &&
            probe->field == field)
            return true;
    }
    return false;
}

static const struct material *model_of(const struct talus_scene *scene, size_t index)
{
    return material_table[scene->materials[index].model_index];
}

/* Plane bodies that strain along zz. */
static bool strains_across(const struct talus_scene *scene)
{
    return scene->dimension == TALUS_PLANE_STRESS || scene->dimension == TALUS_AXISYMMETRIC;
}

/* True if a traction turns with the material. */
static bool tractions_follow(const struct talus_scene *scene)
{
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        for (size_t entry = 0; entry < body->traction_count; entry++) {
            if (body->tractions[entry].kind != TALUS_TRACTION_DEAD)
                return true;
        }
    }
    return false;
}

static bool shows_stress(const struct talus_scene *scene)
{
    return scene_wants(scene, TALUS_FIELD_STRESS) || scene_wants(scene, TALUS_FIELD_MEAN_STRESS) ||
           scene_wants(scene, TALUS_FIELD_VON_MISES);
}

/* From pass to pass, where strains are fitted over nodes: logarithms of tensors, then stresses. */
static bool carries_stress(const struct talus_scene *scene, bool volumetric)
{
    const struct talus_solver_options *solver = &scene->solver;
    return (solver->anti_locking == TALUS_CONTROL_NODE ||
            solver->anti_locking == TALUS_CONTROL_HYBRID) &&
           (solver->anti_locking_apply == TALUS_APPLY_STRAIN_AND_STRESS ||
            (!volumetric && solver->strain == TALUS_STRAIN_FINITE));
}

static size_t strain_components(const struct talus_scene *scene)
{
    return scene->axis_count == 1 ? 3 : scene->axis_count == 2 ? 4 : 6;
}

void run_layout(const struct talus_scene *scene, struct particle_layout *layout)
{
    const uint32_t axes = (uint32_t)scene->axis_count;
    const uint32_t tensor = (uint32_t)strain_components(scene);
    bool volumetric = true;
    uint32_t history = 0;
    memset(layout, 0, sizeof *layout);
    for (size_t index = 0; index < scene->material_count; index++) {
        volumetric = volumetric && model_of(scene, index)->volumetric;
        const uint32_t states = (uint32_t)model_of(scene, index)->state_count;
        history = states > history ? states : history;
    }
    uint32_t *count = layout->component_count;
    count[PARTICLE_POSITION] = count[PARTICLE_VELOCITY] = axes;
    count[PARTICLE_AFFINE] = transfer_of(&scene->solver)->affine ? axes * axes : 0;
    count[PARTICLE_MASS] = count[PARTICLE_VOLUME] = 1;
    count[PARTICLE_STRAIN] = volumetric ? 1 : tensor;
    count[PARTICLE_HISTORY] = history;
    count[PARTICLE_PLASTIC_STRAIN] = scene_wants(scene, TALUS_FIELD_PLASTIC_STRAIN);
    count[PARTICLE_STRESS] = shows_stress(scene) || carries_stress(scene, volumetric) ? tensor : 0;
    count[PARTICLE_DISPLACEMENT] = scene_wants(scene, TALUS_FIELD_DISPLACEMENT) ? axes : 0;
    const bool finite = scene->solver.strain == TALUS_STRAIN_FINITE;
    const bool strain = scene_wants(scene, TALUS_FIELD_STRAIN);
    if (scene_wants(scene, TALUS_FIELD_DEFORMATION_GRADIENT) || (strain && finite) ||
        tractions_follow(scene))
        count[PARTICLE_GRADIENT] = axes * axes + strains_across(scene);
    count[PARTICLE_TRACTION] = (uint32_t)traction_component_count(scene);
    count[PARTICLE_TOTAL_STRAIN] = strain && !finite ? tensor : 0;
    const struct shape_domain *domain = shape_table[scene->solver.shape_index]->domain;
    count[PARTICLE_DOMAIN] = domain != NULL ? domain->component_count(axes) : 0;
    count[PARTICLE_CONVECTED] = domain != NULL && domain->chooses;
    if (domain != NULL && domain->needs_gradient)
        count[PARTICLE_GRADIENT] = axes * axes + strains_across(scene);
    layout->has_body = scene->body_count > 1;
    particle_layout_finish(layout);
}

static void build_domain(const struct talus_scene *scene, struct domain *domain)
{
    const bool halves = shape_table[scene->solver.shape_index]->halves_cells;
    domain->axis_count = scene->axis_count;
    domain->revolves = scene->dimension == TALUS_AXISYMMETRIC;
    for (size_t axis = 0; axis < 3; axis++) {
        const bool used = axis < scene->axis_count;
        domain->cell[axis] = used ? (halves ? 0.5 : 1.0) * scene->grid.cell[axis] : 1.0;
        domain->inverse_cell[axis] = 1.0 / domain->cell[axis];
        domain->min[axis] = used ? scene->grid.min[axis] : 0.0;
        domain->cell_count[axis] =
            used ? (halves ? 2 : 1) * (int32_t)scene->grid.cell_count[axis] : 1;
    }
}

/* In plane stress waves and volumes in the plane are softer: E / (1 - nu^2) takes the place of
 * K + 4 G / 3, and E / (2 (1 - nu)) that of K. */
static void soften(struct run_material *material, double bulk, double shear)
{
    const double young = 9 * bulk * shear / (3 * bulk + shear);
    const double poisson = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear));
    material->thinning = poisson / (1 - poisson);
    material->wave_speed = sqrt(young / (1 - poisson * poisson) / material->density);
    material->bulk_speed = sqrt(young / (2 * (1 - poisson)) / material->density);
}

static enum talus_status build_materials(struct run *run, struct talus_error *error)
{
    const size_t count = run->scene.material_count;
    run->materials = calloc(count + 1, sizeof *run->materials);
    run->body_material = calloc(run->scene.body_count + 1, sizeof *run->body_material);
    if (run->materials == NULL || run->body_material == NULL)
        return talus_error_memory(error);
    run->reference_density = INFINITY;
    for (size_t index = 0; index < count; index++) {
        struct run_material *material = &run->materials[index];
        const double *values = run->scene.materials[index].values;
        double bulk = 0, shear = 0;
        material->model = model_of(&run->scene, index);
        material->constants = calloc(1, material->model->constants_size + 1);
        if (material->constants == NULL)
            return talus_error_memory(error);
        material->model->prepare(values, material->constants);
        material->density = values[MATERIAL_VALUE_DENSITY];
        material->wave_speed = material->model->wave_speed(material->constants);
        material_elastic_moduli(material->model, values, &bulk, &shear);
        material->bulk_speed = sqrt(bulk / material->density);
        if (run->scene.dimension == TALUS_PLANE_STRESS)
            soften(material, bulk, shear);
        material->viscosity = material->model->viscosity == NULL
                                  ? 0
                                  : material->model->viscosity(material->constants);
        run->any_volumetric = run->any_volumetric || material->model->volumetric;
        run->any_tensor = run->any_tensor || !material->model->volumetric;
        run->any_plastic = run->any_plastic || material->model->plastic;
        const bool spins =
            material->model->needs_spin != NULL && material->model->needs_spin(material->constants);
        run->any_spin = run->any_spin || spins;
        run->reloads_gradient = run->reloads_gradient || material->model->needs_rate || spins;
        run->any_rate =
            run->any_rate || material->model->needs_rate || run->scene.solver.viscous_damping > 0;
        run->reference_density = fmin(run->reference_density, material->density);
    }
    for (size_t index = 0; index < run->scene.body_count; index++)
        run->body_material[index] = (uint16_t)run->scene.bodies[index].material_index;
    return TALUS_OK;
}

static enum talus_status build_walls(struct run *run, struct talus_error *error)
{
    if (wall_set_create(&run->walls, &run->scene, &run->grid.domain) != 0)
        return talus_error_memory(error);
    const size_t windows = run->walls.face_count + run->scene.boundary_count;
    run->faces = calloc(run->walls.face_count + 1, sizeof *run->faces);
    run->boundaries = calloc(run->scene.boundary_count + 1, sizeof *run->boundaries);
    run->windows = calloc(windows + 1, sizeof *run->windows);
    run->scratch = calloc((size_t)run->thread_capacity, sizeof *run->scratch);
    if (run->faces == NULL || run->boundaries == NULL || run->windows == NULL ||
        run->scratch == NULL)
        return talus_error_memory(error);
    return TALUS_OK;
}

/* Bodies share one velocity field: a condition at a node acts on all that is there. */
static enum talus_status refuse_body_filters(const struct talus_scene *scene,
                                             struct talus_error *error)
{
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        char pointer[64];
        if (boundary->body_index < 0 ||
            boundary_table[boundary->faces[0].condition_index]->eliminates)
            continue;
        (void)snprintf(pointer, sizeof pointer, "/boundaries/%zu/body", index);
        return talus_error_set(error, TALUS_UNSUPPORTED, "unsupported", pointer,
                               "only the condition eliminate can act on one body: bodies share one "
                               "velocity field, so a wall acts on all that is there");
    }
    return TALUS_OK;
}

/* Particles are taken out by a whole boundary, not by one face of a box. */
static enum talus_status refuse_mixed_elimination(const struct talus_scene *scene,
                                                  struct talus_error *error)
{
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        size_t eliminating = 0;
        char pointer[64];
        for (size_t face = 0; face < boundary->face_count; face++)
            eliminating += boundary_table[boundary->faces[face].condition_index]->eliminates;
        if (eliminating == 0 || eliminating == boundary->face_count)
            continue;
        (void)snprintf(pointer, sizeof pointer, "/boundaries/%zu/faces", index);
        return talus_error_set(error, TALUS_UNSUPPORTED, "unsupported", pointer,
                               "a box eliminates particles with all its faces or with none");
    }
    return TALUS_OK;
}

static double fastest_wave(const struct run *run)
{
    double wave = 0;
    for (size_t index = 0; index < run->scene.body_count; index++)
        wave = fmax(wave, run->materials[run->body_material[index]].wave_speed);
    return wave;
}

/* The ring of a running mean holds the steps of a window, with room for steps four times shorter.
 */
static enum talus_status build_windows(struct run *run, struct talus_error *error)
{
    const double step = run->scene.solver.time_step > 0
                            ? run->scene.solver.time_step
                            : run->scene.solver.courant *
                                  run_critical_time_step(run, fastest_wave(run), UINT64_MAX) / 4;
    const size_t windows = run->walls.face_count + run->scene.boundary_count;
    for (size_t index = 0; index < windows; index++) {
        const size_t boundary = index < run->walls.face_count
                                    ? run->walls.faces[index].boundary_index
                                    : index - run->walls.face_count;
        const double length = run->scene.boundaries[boundary].peak_window;
        if (!(length > 0))
            continue;
        run->windows[index].capacity = (size_t)fmin(1e6, ceil(length / step)) + 4;
        run->windows[index].entries = calloc(4 * run->windows[index].capacity, sizeof(double));
        if (run->windows[index].entries == NULL)
            return talus_error_memory(error);
    }
    return TALUS_OK;
}

static unsigned scatters_of(const struct run *run)
{
    const enum talus_stress_update update = run->scene.solver.stress_update;
    const unsigned forces = update == TALUS_STRESS_FIRST ? 0U : SCATTER_FORCE;
    const bool momentum = !run_kicks(run) || run->grid.nodes.layout.start != 0;
    return SCATTER_MASS | forces | (momentum ? SCATTER_MOMENTUM : 0U);
}

enum talus_status run_build(struct run *run, const struct talus_scene *scene,
                            const struct talus_simulation_options *options,
                            struct talus_error *error)
{
    memset(run, 0, sizeof *run);
    if (scene_copy(scene, &run->scene) != 0)
        return talus_error_memory(error);
    if (scene->dimension == TALUS_AXISYMMETRIC && scene_add_axis(&run->scene) != 0)
        return talus_error_memory(error);
    if (scene->material_count > 64)
        return talus_error_set(error, TALUS_INVALID, "length", "/materials",
                               "%zu materials; at most 64 are possible", scene->material_count);
    if (scene_check_dimension(scene, error) != TALUS_OK || method_check(scene, error) != TALUS_OK)
        return error->status;
    if (refuse_body_filters(scene, error) != TALUS_OK ||
        refuse_mixed_elimination(scene, error) != TALUS_OK)
        return TALUS_UNSUPPORTED;
    run->threads = run->thread_capacity = options->threads < 1 ? 1 : options->threads;
    run->finite_strain = scene->solver.strain == TALUS_STRAIN_FINITE;
    run->strain_components = strain_components(scene);
    run->strains_across = strains_across(scene);
    run->normal_components = scene->dimension == TALUS_PLANE_STRESS ? 2 : 3;
    build_domain(scene, &run->grid.domain);
    run_layout(&run->scene, &run->grid.layout);
    run->stored_components = run->grid.layout.component_count[PARTICLE_STRAIN];
    node_layout_init(&run->grid.nodes.layout, scene->axis_count,
                     scene->solver.stress_update != TALUS_STRESS_MODIFIED_LAST);
    node_fit_init(&run->node_fit, scene, run->strain_components);
    node_fit_place(&run->node_fit,
                   node_layout_extend(&run->grid.nodes.layout, run->node_fit.component_count));
    run_set_callbacks(run, options);
    run_add_slopes(run);
    run_add_tractions(run);
    run_set_gravity(run);
    run_keep_start_velocity(run);
    run_keep_volume(run);
    run->shape = shape_table[scene->solver.shape_index];
    run->grid.reach = run->shape->reach;
    run->kernels = run->shape->kernels[scene->axis_count - 1];
    run_make_context(run);
    run->courant_limit = courant_limit_of(&scene->solver);
    run->scatters = scatters_of(run);
    enum talus_status status = build_materials(run, error);
    if (status == TALUS_OK)
        status = build_walls(run, error);
    if (status == TALUS_OK)
        status = build_windows(run, error);
    return status;
}

void run_release(struct run *run)
{
    for (size_t index = 0; run->materials != NULL && index < run->scene.material_count; index++)
        free(run->materials[index].constants);
    for (size_t index = 0;
         run->windows != NULL && index < run->walls.face_count + run->scene.boundary_count; index++)
        free(run->windows[index].entries);
    for (int thread = 0; run->scratch != NULL && thread < run->thread_capacity; thread++)
        block_scratch_release(&run->scratch[thread]);
    free(run->materials);
    free(run->body_material);
    free(run->wall_nodes);
    free(run->block_walled);
    free(run->faces);
    free(run->boundaries);
    free(run->windows);
    free(run->wall_partials);
    free(run->node_sums);
    free(run->scratch);
    free(run->outbox);
    free(run->tile_sums);
    wall_set_release(&run->walls);
    sparse_grid_release(&run->grid);
    talus_scene_release(&run->scene);
    memset(run, 0, sizeof *run);
}
