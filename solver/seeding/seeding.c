/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding.h"
#include "materials/material.h"
#include "seeding/seeding_lattice.h"
#include "seeding/seeding_stress.h"
#include "seeding/seeding_traction.h"
#include "seeding/seeding_velocity.h"
#include "state/traction_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void seeding_release(struct particle_seed *seed)
{
    for (size_t k = 0; k < 3; k++) {
        free(seed->position[k]);
        free(seed->velocity[k]);
    }
    for (size_t k = 0; k < 6; k++)
        free(seed->stress[k]);
    for (size_t k = 0; seed->traction != NULL && k < seed->traction_components; k++)
        free(seed->traction[k]);
    free(seed->traction);
    free(seed->volume);
    free(seed->mass);
    free(seed->body);
    free(seed->volume_factor);
    free(seed->spacing);
    memset(seed, 0, sizeof *seed);
}

/* Checks all bodies and counts their particles, exactly. */
static enum talus_status count_kept(const struct talus_scene *scene, size_t *count,
                                    struct talus_error *error)
{
    double total = 0.0;
    *count = 0;
    for (size_t index = 0; index < scene->body_count; index++) {
        struct seeding_lattice lattice;
        enum talus_status status = seeding_check(scene, index, error);
        if (status != TALUS_OK)
            return status;
        seeding_lattice_init(&lattice, scene, &scene->bodies[index]);
        total += seeding_lattice_point_count(&lattice);
        if (total > SEEDING_PARTICLE_MAX)
            return talus_error_set(error, TALUS_INVALID, "limit", "/bodies",
                                   "the bodies ask for about %.3g particles; %d are allowed", total,
                                   SEEDING_PARTICLE_MAX);
        *count += (size_t)seeding_lattice_kept(&lattice);
    }
    return TALUS_OK;
}

static bool has_stress(const struct talus_scene *scene)
{
    for (size_t index = 0; index < scene->body_count; index++) {
        if (scene->bodies[index].initial_stress != TALUS_INITIAL_NONE)
            return true;
    }
    return false;
}

static bool allocate(struct particle_seed *seed, const struct talus_scene *scene)
{
    size_t slots = seed->count > 0 ? seed->count : 1;
    bool complete = true;
    for (size_t k = 0; k < 3; k++) {
        seed->position[k] = calloc(slots, sizeof(double));
        seed->velocity[k] = calloc(slots, sizeof(double));
        complete &= seed->position[k] != NULL && seed->velocity[k] != NULL;
    }
    for (size_t k = 0; k < 6 && has_stress(scene); k++) {
        seed->stress[k] = calloc(slots, sizeof(double));
        complete &= seed->stress[k] != NULL;
    }
    seed->traction_components = traction_component_count(scene);
    seed->traction = calloc(seed->traction_components + 1, sizeof *seed->traction);
    for (size_t k = 0; seed->traction != NULL && k < seed->traction_components; k++) {
        seed->traction[k] = calloc(slots, sizeof(double));
        complete &= seed->traction[k] != NULL;
    }
    complete &= seed->traction != NULL;
    seed->volume = calloc(slots, sizeof(double));
    seed->mass = calloc(slots, sizeof(double));
    seed->body = calloc(slots, sizeof(uint16_t));
    seed->volume_factor = calloc(scene->body_count + 1, sizeof(double));
    seed->spacing = calloc(scene->body_count + 1, sizeof *seed->spacing);
    return complete && seed->volume != NULL && seed->mass != NULL && seed->body != NULL &&
           seed->volume_factor != NULL && seed->spacing != NULL;
}

/* What all particles of a body have in common. */
struct body_values {
    struct seeding_lattice lattice;
    struct seeding_stress stress;
    double volume, density;
};

static void write_particle(struct particle_seed *seed, size_t particle, size_t body_index,
                           const struct body_values *values, const uint64_t index[3])
{
    const struct talus_body *body = values->lattice.shape.body;
    const bool listed = body->shape == TALUS_BODY_POINTS;
    const double volume = listed ? body->point_volumes[index[0]] : values->volume;
    double position[3], velocity[3], stress[6];
    seeding_lattice_world(&values->lattice, index, position);
    seeding_velocity_at(body, position, velocity);
    for (size_t k = 0; k < 3; k++) {
        seed->position[k][particle] = position[k];
        seed->velocity[k][particle] = velocity[k];
    }
    const double circle = seeding_circle(&values->lattice.shape, position[0]);
    seed->volume[particle] = circle * volume;
    seed->mass[particle] = circle * values->density * volume;
    seed->body[particle] = (uint16_t)body_index;
    if (seed->stress[0] == NULL)
        return;
    seeding_stress_at(&values->stress, position, stress);
    for (size_t k = 0; k < 6; k++)
        seed->stress[k][particle] = stress[k];
}

/* Writes the particles of one body from *particle on, which is moved behind them. */
static enum talus_status seed_body(const struct talus_scene *scene, size_t body_index,
                                   struct particle_seed *seed, size_t *particle,
                                   struct talus_error *error)
{
    const struct talus_body *body = &scene->bodies[body_index];
    struct body_values values;
    seeding_lattice_init(&values.lattice, scene, body);
    double factor = seeding_lattice_factor(&values.lattice, seeding_lattice_kept(&values.lattice));
    if (!(factor >= 0.9 && factor <= 1.1)) {
        char pointer[64];
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu", body_index);
        return talus_error_set(error, TALUS_INVALID, "volume_factor", pointer,
                               "the particles of body '%s' need the volume factor %.3f (0.9 to 1.1 "
                               "is allowed): use more particles",
                               body->name, factor);
    }
    enum talus_status status =
        seeding_stress_init(&values.stress, scene, body_index, &values.lattice.shape, error);
    if (status != TALUS_OK)
        return status;
    seed->volume_factor[body_index] = factor;
    values.volume = factor;
    for (size_t k = 0; k < scene->axis_count; k++) {
        values.volume *= values.lattice.spacing[k];
        if (body->shape != TALUS_BODY_POINTS)
            seed->spacing[body_index][k] =
                values.lattice.spacing[k] * pow(factor, 1.0 / (double)scene->axis_count);
    }
    const struct talus_material *material = &scene->materials[body->material_index];
    values.density = material->values[MATERIAL_VALUE_DENSITY];
    const size_t first = *particle;
    struct seeding_row row;
    uint64_t index[3];
    for (index[2] = 0; index[2] < (uint64_t)values.lattice.count[2]; index[2]++) {
        for (index[1] = 0; index[1] < (uint64_t)values.lattice.count[1]; index[1]++) {
            seeding_lattice_row(&values.lattice, index, &row);
            for (size_t range = 0; range < row.count; range++)
                for (index[0] = row.first[range]; index[0] < row.end[range]; index[0]++)
                    write_particle(seed, (*particle)++, body_index, &values, index);
        }
    }
    if (seeding_write_tractions(scene, &values.lattice, first, seed) != 0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "/bodies",
                               "no memory for the loaded faces");
    return TALUS_OK;
}

enum talus_status seeding_create(const struct talus_scene *scene, struct particle_seed *seed,
                                 struct talus_error *error)
{
    memset(seed, 0, sizeof *seed);
    enum talus_status status = count_kept(scene, &seed->count, error);
    if (status != TALUS_OK)
        return status;
    if (!allocate(seed, scene)) {
        seeding_release(seed);
        return talus_error_set(error, TALUS_MEMORY, "memory", "/bodies",
                               "no memory for the particles");
    }
    size_t particle = 0;
    for (size_t index = 0; index < scene->body_count && status == TALUS_OK; index++)
        status = seed_body(scene, index, seed, &particle, error);
    if (status != TALUS_OK)
        seeding_release(seed);
    return status;
}
