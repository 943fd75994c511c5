/* SPDX-License-Identifier: Apache-2.0 */
/* Member by member: padding has no defined bytes. */
#include "simulation/scene_fingerprint.h"

#include "materials/material.h"
#include "talus/version.h"

#include <stddef.h>

static void add_bytes(uint64_t *hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t index = 0; index < size; index++)
        *hash = (*hash ^ bytes[index]) * 0x100000001b3u; /* FNV-1a */
}

static void add_number(uint64_t *hash, uint64_t number)
{
    add_bytes(hash, &number, sizeof number);
}

static void add_reals(uint64_t *hash, const double *values, size_t count)
{
    add_bytes(hash, values, count * sizeof *values);
}

static void add_tables(uint64_t *hash, const struct talus_time_table *tables, size_t count)
{
    for (size_t index = 0; index < count; index++) {
        add_number(hash, tables[index].count);
        add_reals(hash, tables[index].time, tables[index].count);
        add_reals(hash, tables[index].value, tables[index].count);
    }
}

static void add_text(uint64_t *hash, const char *text)
{
    for (; text != NULL && *text != '\0'; text++)
        add_bytes(hash, text, 1);
    add_number(hash, 0); /* "ab" + "c" is not "a" + "bc" */
}

static void add_solver(uint64_t *hash, const struct talus_scene *scene)
{
    const struct talus_solver_options *solver = &scene->solver;
    const double reals[] = {
        solver->time_step,       solver->courant,        solver->pic_rate,
        solver->viscous_damping, solver->local_damping,  solver->force_ramp,
        solver->settle_time,     solver->settle_damping, scene->grid.outside_mass_limit};
    add_number(hash, scene->axis_count);
    add_number(hash, (uint64_t)scene->dimension);
    add_reals(hash, scene->grid.cell, 3);
    add_reals(hash, scene->grid.min, 3);
    for (size_t axis = 0; axis < 3; axis++)
        add_number(hash, (uint64_t)scene->grid.cell_count[axis]);
    add_number(hash, (uint64_t)scene->grid.outside);
    add_number(hash, solver->shape_index);
    add_number(hash, (uint64_t)solver->gimp_scaling);
    add_number(hash, solver->transfer_index);
    add_number(hash, (uint64_t)solver->small_mass);
    add_number(hash, (uint64_t)solver->front_reading);
    add_reals(hash, &solver->front_threshold, 1);
    add_reals(hash, &solver->hybrid_scale, 1);
    add_reals(hash, &solver->hybrid_count, 1);
    add_number(hash, (uint64_t)solver->stress_update);
    add_number(hash, (uint64_t)solver->strain);
    add_number(hash, (uint64_t)solver->anti_locking);
    add_number(hash, (uint64_t)solver->anti_locking_field);
    add_number(hash, (uint64_t)solver->anti_locking_apply);
    add_number(hash, (uint64_t)solver->anti_locking_averaging);
    add_number(hash, (uint64_t)solver->precision);
    add_reals(hash, reals, sizeof reals / sizeof reals[0]);
    add_reals(hash, (const double[]){solver->flip_ratio, solver->theta, solver->strain_theta}, 3);
    add_reals(hash, scene->gravity, 3);
    add_tables(hash, scene->gravity_table, 3);
    add_number(hash, scene->slope_count);
    for (size_t index = 0; index < scene->slope_count; index++) {
        const struct talus_slope *slope = &scene->slopes[index];
        const double zone[] = {slope->below, slope->beyond, slope->angle_deg};
        add_reals(hash, slope->along, 3);
        add_reals(hash, slope->about, 3);
        add_reals(hash, zone, sizeof zone / sizeof zone[0]);
    }
    add_number(hash, scene->output.frame_fields);
}

static void add_materials(uint64_t *hash, const struct talus_scene *scene)
{
    add_number(hash, scene->material_count);
    for (size_t index = 0; index < scene->material_count; index++) {
        const struct talus_material *material = &scene->materials[index];
        const struct material *model = material_table[material->model_index];
        add_text(hash, model->name);
        add_reals(hash, material->values, material_parameters(model, NULL, 0));
    }
}

static void add_tractions(uint64_t *hash, const struct talus_body *body)
{
    add_number(hash, body->traction_count);
    for (size_t index = 0; index < body->traction_count; index++) {
        const struct talus_traction *traction = &body->tractions[index];
        add_number(hash, traction->face);
        add_number(hash, traction->last_face);
        add_number(hash, (uint64_t)traction->kind);
        add_number(hash, traction->is_pressure);
        add_reals(hash, traction->value, 3);
        add_tables(hash, traction->table, 3);
    }
}

static void add_bodies(uint64_t *hash, const struct talus_scene *scene)
{
    add_number(hash, scene->body_count);
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        const double reals[] = {body->radius, body->surface, body->k0, body->surcharge};
        add_number(hash, body->material_index);
        add_number(hash, (uint64_t)body->shape);
        add_number(hash, (uint64_t)body->lattice);
        add_number(hash, (uint64_t)body->initial_stress);
        add_number(hash, (uint64_t)body->k0_rule);
        add_reals(hash, body->box_min, 3);
        add_reals(hash, body->box_max, 3);
        add_reals(hash, body->centre, 3);
        add_reals(hash, body->from, 3);
        add_reals(hash, body->to, 3);
        add_number(hash, body->vertex_count);
        add_reals(hash, body->vertices, 2 * body->vertex_count);
        add_number(hash, body->point_count);
        add_reals(hash, body->point_positions, 3 * body->point_count);
        add_reals(hash, body->point_volumes, body->point_count);
        add_reals(hash, &body->rotate_angle_deg, 1);
        add_reals(hash, body->rotate_about, 3);
        add_reals(hash, body->rotate_axis, 3);
        add_reals(hash, body->clip_min, 3);
        add_reals(hash, body->clip_max, 3);
        add_reals(hash, body->lattice_value, 3);
        add_number(hash, (uint64_t)body->velocity_field);
        add_reals(hash, body->velocity, 3);
        add_reals(hash, body->rotation_about, 3);
        add_reals(hash, body->rotation_rate, 3);
        add_reals(hash, &body->beam_mode, 1);
        add_reals(hash, body->beam_from, 3);
        add_reals(hash, body->beam_to, 3);
        add_reals(hash, body->beam_tip, 3);
        add_reals(hash, body->stress, 6);
        add_tractions(hash, body);
        add_reals(hash, reals, sizeof reals / sizeof reals[0]);
    }
}

static void add_boundary(uint64_t *hash, const struct talus_boundary *boundary)
{
    add_text(hash, boundary->name);
    add_number(hash, (uint64_t)boundary->shape);
    add_reals(hash, boundary->point, 3);
    add_reals(hash, boundary->normal, 3);
    add_reals(hash, boundary->axis_1, 3);
    add_reals(hash, boundary->axis_2, 3);
    add_reals(hash, boundary->size, 2);
    add_reals(hash, boundary->box_min, 3);
    add_reals(hash, boundary->box_max, 3);
    add_reals(hash, boundary->moment_about, 3);
    add_reals(hash, &boundary->peak_window, 1);
    add_reals(hash, &boundary->tension_force, 1);
    add_number(hash, (uint64_t)boundary->wall);
    add_number(hash, boundary->tension_release);
    add_number(hash, boundary->area_source_rule);
    add_number(hash, (uint64_t)boundary->body_index);
    add_number(hash, boundary->prescribed);
    add_number(hash, boundary->stays);
    add_reals(hash, boundary->velocity, 3);
    add_tables(hash, boundary->velocity_tables, 3);
    add_number(hash, boundary->timed);
    add_reals(hash, &boundary->from, 1);
    add_reals(hash, &boundary->until, 1);
    add_number(hash, boundary->face_count);
    for (size_t face = 0; face < boundary->face_count; face++) {
        add_number(hash, boundary->faces[face].condition_index);
        add_reals(hash, &boundary->faces[face].friction_coefficient, 1);
        add_reals(hash, &boundary->faces[face].adhesion, 1);
        add_reals(hash, &boundary->faces[face].turbulence, 1);
    }
}

static void add_probe(uint64_t *hash, const struct talus_probe *probe)
{
    add_text(hash, probe->name);
    add_number(hash, (uint64_t)probe->kind);
    add_number(hash, (uint64_t)probe->body_index);
    add_number(hash, (uint64_t)probe->on_boundary);
    add_reals(hash, probe->within_min, 3);
    add_reals(hash, probe->within_max, 3);
    add_reals(hash, probe->along, 3);
    add_reals(hash, probe->at, 3);
    add_number(hash, (uint64_t)probe->measure);
    add_number(hash, (uint64_t)probe->field);
    add_number(hash, (uint64_t)probe->component);
    add_number(hash, (uint64_t)probe->part);
    add_number(hash, (uint64_t)probe->boundary_index);
    add_number(hash, (uint64_t)probe->face_index);
    add_number(hash, (uint64_t)probe->quantity);
}

uint64_t scene_fingerprint(const struct talus_scene *scene)
{
    uint64_t hash = 0xcbf29ce484222325u;
    add_text(&hash, talus_build());
    add_solver(&hash, scene);
    add_materials(&hash, scene);
    add_bodies(&hash, scene);
    add_number(&hash, scene->boundary_count);
    for (size_t index = 0; index < scene->boundary_count; index++)
        add_boundary(&hash, &scene->boundaries[index]);
    add_number(&hash, scene->probe_count);
    for (size_t index = 0; index < scene->probe_count; index++)
        add_probe(&hash, &scene->probes[index]);
    return hash;
}
