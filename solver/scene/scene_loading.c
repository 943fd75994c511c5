/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_loading.h"
#include "scene/scene_geometry.h"

#include "materials/material.h"
#include "scene/scene_condition.h"
#include "transfers/velocity_transfer.h"

#include <math.h>
#include <string.h>

static const struct material *model_of(const struct talus_scene *scene,
                                       const struct talus_body *body)
{
    return material_table[scene->materials[body->material_index].model_index];
}

static double length_of(const double vector[3])
{
    return sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
}

/* Rates or damping that belong to the process, or motion that is not a response to the loads:
 * nothing that a slower or faster run would leave alone. */
static bool has_own_rate(const struct talus_scene *scene)
{
    const struct talus_solver_options *solver = &scene->solver;
    if (scene->slope_count > 0 || scene->grid.outside == TALUS_OUTSIDE_ELIMINATE ||
        solver->viscous_damping > 0.0 || solver->local_damping > 0.0 || solver->pic_rate > 0.0 ||
        !isnan(solver->flip_ratio) || solver->settle_time > 0.0 ||
        strcmp(transfer_of(solver)->name, "flip") != 0)
        return true;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        if (model_of(scene, body)->own_elasticity || body->shape == TALUS_BODY_POINTS ||
            body->velocity_field != TALUS_VELOCITY_UNIFORM || length_of(body->velocity) > 0.0)
            return true;
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        for (size_t face = 0; face < boundary->face_count; face++) {
            const struct talus_boundary_face *one = &boundary->faces[face];
            if (one->turbulence > 0.0 ||
                strcmp(scene_condition_name(one->condition_index), "eliminate") == 0)
                return true;
        }
        if (boundary->timed || boundary->stays)
            return true;
    }
    return false;
}

/* Period [s] of the slowest vibration of a body: a shear wave four times along it, or the first
 * bending mode of a clamped beam (kappa L = 1.8751) as thin as its smallest extent. */
static double period_of(const struct talus_scene *scene, const struct talus_body *body)
{
    const struct talus_material *material = &scene->materials[body->material_index];
    const double bending = 2.0 * 3.14159265358979323846 * sqrt(12.0) / (1.8751 * 1.8751);
    double bulk, shear, low[3], high[3], longest = 0.0, shortest = INFINITY;
    material_elastic_moduli(material_table[material->model_index], material->values, &bulk, &shear);
    const double density = material->values[MATERIAL_VALUE_DENSITY];
    const double young = 9.0 * bulk * shear / (3.0 * bulk + shear);
    scene_body_bounds(scene, body, low, high);
    for (size_t k = 0; k < scene->axis_count; k++) {
        longest = fmax(longest, high[k] - low[k]);
        shortest = fmin(shortest, high[k] - low[k]);
    }
    if (scene->axis_count == 1)
        return 4.0 * longest / scene_wave_speed(material);
    return fmax(4.0 * longest / sqrt(shear / density),
                bending * longest * longest / shortest / sqrt(young / density));
}

/* True if two boxes touch or overlap, with half a cell of slack. */
static bool touch(const struct talus_scene *scene, const double low_a[3], const double high_a[3],
                  const double low_b[3], const double high_b[3])
{
    for (size_t k = 0; k < scene->axis_count; k++) {
        const double slack = 0.5 * scene->grid.cell[k];
        if (low_a[k] > high_b[k] + slack || low_b[k] > high_a[k] + slack)
            return false;
    }
    return true;
}

/* True if the boundary keeps the body from moving along the axis in the sense of gravity: it
 * sticks, is moved itself, or stands across the way. */
static bool holds(const struct talus_scene *scene, const struct talus_boundary *boundary,
                  const struct talus_body *body, size_t axis)
{
    const char *condition = scene_condition_name(boundary->faces[0].condition_index);
    const double sense = scene->gravity[axis];
    const bool sticks = strcmp(condition, "stick") == 0 || boundary->prescribed != 0;
    double low[3], high[3], face_low[3], face_high[3];
    scene_body_bounds(scene, body, low, high);
    if (boundary->shape == TALUS_BOUNDARY_BOX)
        return touch(scene, low, high, boundary->box_min, boundary->box_max) &&
               (sticks || (sense < 0.0 ? fabs(low[axis] - boundary->box_max[axis])
                                       : fabs(high[axis] - boundary->box_min[axis])) <=
                              0.5 * scene->grid.cell[axis]);
    if (boundary->shape == TALUS_BOUNDARY_FACE) {
        for (size_t k = 0; k < 3; k++) {
            const double half = scene_face_half(boundary, k);
            face_low[k] = boundary->point[k] - half;
            face_high[k] = boundary->point[k] + half;
        }
        return touch(scene, low, high, face_low, face_high) &&
               (sticks || sense * boundary->normal[axis] < 0.0);
    }
    for (size_t k = 0; k < scene->axis_count; k++) {
        const bool here = scene_plane_is_at(scene, boundary, k, low[k], 1) ||
                          scene_plane_is_at(scene, boundary, k, high[k], -1);
        if (here && (sticks || (k == axis && sense * boundary->normal[axis] < 0.0)))
            return true;
    }
    return false;
}

/* Every body is held against its weight by a boundary of its own. */
static bool is_held(const struct talus_scene *scene)
{
    for (size_t index = 0; index < scene->body_count; index++) {
        for (size_t k = 0; k < scene->axis_count; k++) {
            bool held = scene->gravity[k] == 0.0 && scene->gravity_table[k].count == 0;
            for (size_t other = 0; other < scene->boundary_count && !held; other++)
                held = holds(scene, &scene->boundaries[other], &scene->bodies[index], k);
            if (!held)
                return false;
        }
    }
    return true;
}

/* Time [s] in which a table would go through all of its values at its steepest; INFINITY: it does
 * not change. */
static double table_time(const struct talus_time_table *table)
{
    double low = INFINITY, high = -INFINITY, steepest = 0.0;
    for (size_t point = 0; point < table->count; point++) {
        low = fmin(low, table->value[point]);
        high = fmax(high, table->value[point]);
        if (point > 0)
            steepest = fmax(steepest, fabs(table->value[point] - table->value[point - 1]) /
                                          (table->time[point] - table->time[point - 1]));
    }
    return steepest > 0.0 ? (high - low) / steepest : INFINITY;
}

static double tables_time(const struct talus_time_table tables[3])
{
    return fmin(table_time(&tables[0]), fmin(table_time(&tables[1]), table_time(&tables[2])));
}

bool scene_loading_has_tables(const struct talus_scene *scene)
{
    bool any = false;
    for (size_t k = 0; k < 3; k++)
        any |= scene->gravity_table[k].count > 0;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        for (size_t load = 0; load < body->traction_count; load++) {
            for (size_t k = 0; k < 3; k++)
                any |= body->tractions[load].table[k].count > 0;
        }
    }
    return any;
}

/* Shortest time [s] in which a load grows; INFINITY: all are constant. */
static double load_time(const struct talus_scene *scene)
{
    double shortest = tables_time(scene->gravity_table);
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        for (size_t load = 0; load < body->traction_count; load++)
            shortest = fmin(shortest, tables_time(body->tractions[load].table));
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        if (length_of(boundary->velocity) > 0.0)
            shortest = fmin(shortest, scene->duration);
        shortest = fmin(shortest, tables_time(boundary->velocity_tables));
    }
    return shortest;
}

/* A load that is there from the first step on and shakes what carries it. */
static bool has_sudden_load(const struct talus_scene *scene)
{
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        if ((length_of(scene->gravity) > 0.0 && body->initial_stress == TALUS_INITIAL_NONE) ||
            body->initial_stress == TALUS_INITIAL_GIVEN)
            return true;
        for (size_t load = 0; load < body->traction_count; load++) {
            if (length_of(body->tractions[load].value) > 0.0)
                return true;
        }
    }
    return false;
}

static bool any_plastic(const struct talus_scene *scene)
{
    bool any = false;
    for (size_t index = 0; index < scene->body_count; index++)
        any |= model_of(scene, &scene->bodies[index])->plastic;
    return any;
}

/* Speeds of walls, and the largest extent and slowest wave of all bodies. */
static void set_speeds(struct scene_loading *loading, const struct talus_scene *scene)
{
    const double slow_wave = 0.01, slow_fall = 0.1;
    double extent = 0.0, wave = INFINITY;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        double low[3], high[3];
        scene_body_bounds(scene, body, low, high);
        loading->period = fmax(loading->period, period_of(scene, body));
        wave = fmin(wave, scene_wave_speed(&scene->materials[body->material_index]));
        for (size_t k = 0; k < scene->axis_count; k++)
            extent = fmax(extent, high[k] - low[k]);
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        loading->push_speed = fmax(loading->push_speed, length_of(boundary->velocity));
        for (size_t k = 0; k < 3; k++) {
            const struct talus_time_table *table = &boundary->velocity_tables[k];
            for (size_t point = 0; point < table->count; point++)
                loading->push_speed = fmax(loading->push_speed, fabs(table->value[point]));
        }
    }
    loading->push_speed_max = slow_wave * wave;
    const double gravity = length_of(scene->gravity);
    if (gravity > 0.0 && any_plastic(scene)) { /* what fails slides, in its own time */
        loading->push_speed_max = fmin(loading->push_speed_max, slow_fall * sqrt(gravity * extent));
        loading->period = fmax(loading->period, sqrt(extent / gravity));
    }
}

void scene_loading_init(struct scene_loading *loading, const struct talus_scene *scene)
{
    enum { ENTRY_MAX = 64 }; /* bodies and boundaries are paired: larger scenes are left alone */
    *loading = (struct scene_loading){.kind = SCENE_LOADING_OTHER};
    if (scene->body_count > ENTRY_MAX || scene->boundary_count > ENTRY_MAX ||
        scene->body_count == 0 || has_own_rate(scene) || !is_held(scene))
        return;
    set_speeds(loading, scene);
    const bool sudden = has_sudden_load(scene);
    const double ramp = scene->solver.force_ramp;
    loading->load_time = load_time(scene);
    if (isfinite(loading->load_time)) {
        if (sudden && ramp > 0.0)
            loading->load_time = fmin(loading->load_time, ramp);
        if (!sudden || ramp > 0.0)
            loading->kind = SCENE_LOADING_SLOW;
    } else if (sudden && !any_plastic(scene)) {
        loading->kind = SCENE_LOADING_CONSTANT;
    }
}
