/* SPDX-License-Identifier: Apache-2.0 */
/* Fields of particles and nodes as flat arrays, for frames and embedding programs. */
#include "math/log_strain.h"
#include "simulation/simulation_private.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const unsigned char components_of[TALUS_FIELD_COUNT] = {
#define TALUS_FIELD(ENUM, name, components, unit, text) [TALUS_FIELD_##ENUM] = components,
#include "talus/fields.def"
#undef TALUS_FIELD
};
static const char *const names_of[TALUS_FIELD_COUNT] = {
#define TALUS_FIELD(ENUM, name, components, unit, text) [TALUS_FIELD_##ENUM] = #name,
#include "talus/fields.def"
#undef TALUS_FIELD
};

size_t field_components(enum talus_field field)
{
    return components_of[field];
}

bool field_is_stored(const struct run *run, enum talus_field field)
{
    const uint32_t *count = run->grid.layout.component_count;
    switch (field) {
    case TALUS_FIELD_DISPLACEMENT:
        return count[PARTICLE_DISPLACEMENT] > 0;
    case TALUS_FIELD_STRESS:
    case TALUS_FIELD_MEAN_STRESS:
    case TALUS_FIELD_VON_MISES:
        return count[PARTICLE_STRESS] > 0;
    case TALUS_FIELD_STRAIN:
        return count[PARTICLE_GRADIENT] > 0 || count[PARTICLE_TOTAL_STRAIN] > 0;
    case TALUS_FIELD_PLASTIC_STRAIN:
        return count[PARTICLE_PLASTIC_STRAIN] > 0;
    case TALUS_FIELD_DEFORMATION_GRADIENT:
        return count[PARTICLE_GRADIENT] > 0;
    default:
        return true;
    }
}

static void load(const struct run *run, const struct particle_block *block, size_t slot,
                 enum particle_field field, double *values)
{
    for (uint32_t component = 0; component < run->grid.layout.component_count[field]; component++)
        values[component] = particle_values(&run->grid.layout, block, field, component)[slot];
}

static size_t material_index(const struct run *run, const struct particle_block *block, size_t slot)
{
    return run->body_material[block->body == NULL ? 0 : block->body[slot]];
}

/* Cauchy stress: Kirchhoff over J at finite strain. */
static void cauchy_stress(const struct run *run, const struct particle_block *block, size_t slot,
                          double stress[6])
{
    memset(stress, 0, 6 * sizeof *stress);
    load(run, block, slot, PARTICLE_STRESS, stress);
    if (!run->finite_strain)
        return;
    const double mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0)[slot];
    const double volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0)[slot];
    const double density = run->materials[material_index(run, block, slot)].density;
    const double inverse = mass / (density * volume);
    for (size_t component = 0; component < 6; component++)
        stress[component] *= inverse;
}

static void full_gradient(const struct run *run, const struct particle_block *block, size_t slot,
                          double gradient[9])
{
    const size_t axes = run->grid.domain.axis_count;
    double stored[9] = {0};
    load(run, block, slot, PARTICLE_GRADIENT, stored);
    memset(gradient, 0, 9 * sizeof *gradient);
    for (size_t row = 0; row < axes; row++) {
        for (size_t column = 0; column < axes; column++)
            gradient[3 * row + column] = stored[axes * row + column];
    }
    if (run->strains_across)
        gradient[8] = stored[axes * axes];
}

/* ln V = 1/2 ln(F F^T), through e = (F F^T - 1)/2 of the stored F - 1. */
static void logarithmic_strain(const double displacement_gradient[9], double strain[6])
{
    static const unsigned char row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    const double *g = displacement_gradient;
    real values[6], *arrays[6];
    for (size_t k = 0; k < 6; k++) {
        const size_t a = row[k], b = column[k];
        values[k] = (real)(0.5 * (g[3 * a + b] + g[3 * b + a] + g[3 * a] * g[3 * b] +
                                  g[3 * a + 1] * g[3 * b + 1] + g[3 * a + 2] * g[3 * b + 2]));
        arrays[k] = &values[k];
    }
    (void)log_strain_batch(1, 6, arrays, arrays);
    for (size_t k = 0; k < 6; k++)
        strain[k] = values[k];
}

void field_values(const struct run *run, const struct particle_block *block, size_t slot,
                  enum talus_field field, double *values)
{
    double stress[6], gradient[9];
    memset(values, 0, components_of[field] * sizeof *values);
    switch (field) {
    case TALUS_FIELD_DISPLACEMENT:
        load(run, block, slot, PARTICLE_DISPLACEMENT, values);
        break;
    case TALUS_FIELD_VELOCITY:
        load(run, block, slot, PARTICLE_VELOCITY, values);
        break;
    case TALUS_FIELD_STRESS:
        cauchy_stress(run, block, slot, values);
        break;
    case TALUS_FIELD_MEAN_STRESS:
        cauchy_stress(run, block, slot, stress);
        values[0] = (stress[0] + stress[1] + stress[2]) / 3;
        break;
    case TALUS_FIELD_VON_MISES: {
        cauchy_stress(run, block, slot, stress);
        const double mean = (stress[0] + stress[1] + stress[2]) / 3;
        double square = 0;
        for (size_t k = 0; k < 3; k++)
            square += (stress[k] - mean) * (stress[k] - mean) + 2 * stress[3 + k] * stress[3 + k];
        values[0] = sqrt(1.5 * square);
        break;
    }
    case TALUS_FIELD_STRAIN:
        if (!run->finite_strain) {
            load(run, block, slot, PARTICLE_TOTAL_STRAIN, values);
            break;
        }
        full_gradient(run, block, slot, gradient);
        logarithmic_strain(gradient, values);
        break;
    case TALUS_FIELD_PLASTIC_STRAIN:
        load(run, block, slot, PARTICLE_PLASTIC_STRAIN, values);
        break;
    case TALUS_FIELD_VOLUME:
        load(run, block, slot, PARTICLE_VOLUME, values);
        break;
    case TALUS_FIELD_DENSITY:
        values[0] = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0)[slot] /
                    particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0)[slot];
        break;
    case TALUS_FIELD_DEFORMATION_GRADIENT:
        full_gradient(run, block, slot, values);
        values[0] += 1, values[4] += 1, values[8] += 1;
        break;
    case TALUS_FIELD_BODY:
        values[0] = block->body == NULL ? 0 : block->body[slot];
        break;
    case TALUS_FIELD_MATERIAL:
        values[0] = (double)material_index(run, block, slot);
        break;
    case TALUS_FIELD_ID:
        values[0] = block->id[slot];
        break;
    case TALUS_FIELD_MASS:
        load(run, block, slot, PARTICLE_MASS, values);
        break;
    case TALUS_FIELD_COUNT:
        break;
    }
}

/* rank[id]: index of a living particle in order of id. NULL without memory; free it. */
static uint32_t *rank_particles(const struct run *run)
{
    uint32_t *rank = calloc(run->initial_particle_count + 1, sizeof *rank);
    if (rank == NULL)
        return NULL;
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            if (block->id[slot] != PARTICLE_NONE)
                rank[block->id[slot]] = 1;
        }
    }
    uint32_t next = 0;
    for (size_t id = 0; id < run->initial_particle_count; id++) {
        const uint32_t alive = rank[id];
        rank[id] = next;
        next += alive;
    }
    return rank;
}

void talus_simulation_read_positions(const struct talus_simulation *simulation, double *out)
{
    const struct run *run = &simulation->run;
    uint32_t *rank = rank_particles(run);
    for (size_t index = 0; rank != NULL && index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            if (block->id[slot] != PARTICLE_NONE)
                sparse_grid_slot_position(&run->grid, block, slot,
                                          out + 3 * (size_t)rank[block->id[slot]]);
        }
    }
    free(rank);
}

enum talus_status talus_simulation_read_field(const struct talus_simulation *simulation,
                                              enum talus_field field, double *out,
                                              struct talus_error *error)
{
    const struct run *run = &simulation->run;
    assert(field < TALUS_FIELD_COUNT);
    if (!field_is_stored(run, field))
        return talus_error_set(error, TALUS_UNSUPPORTED, "field", "/output/frames/fields",
                               "the scene did not ask for %s, so it was not tracked",
                               names_of[field]);
    uint32_t *rank = rank_particles(run);
    if (rank == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a frame");
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            if (block->id[slot] != PARTICLE_NONE)
                field_values(run, block, slot, field,
                             out + components_of[field] * (size_t)rank[block->id[slot]]);
        }
    }
    free(rank);
    return TALUS_OK;
}

struct node_output {
    double *position, *mass, *velocity, *reaction, *area;
    size_t count;
};

static void write_node(const struct run *run, size_t block, size_t lane,
                       const struct wall_node *wall, struct node_output *out)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const size_t n = out->count++;
    for (uint32_t axis = 0; axis < 3; axis++) {
        const bool used = axis < run->grid.domain.axis_count;
        const int32_t node = nodes->place[block][axis] + (axis == 0 ? (int32_t)lane : 0);
        if (out->position != NULL)
            out->position[3 * n + axis] =
                used ? domain_node_position(&run->grid.domain, axis, node) : 0.0;
        if (out->velocity != NULL)
            out->velocity[3 * n + axis] =
                used ? node_values(nodes, block, nodes->layout.velocity + axis)[lane] : 0.0;
        if (out->reaction != NULL)
            out->reaction[3 * n + axis] = wall != NULL && run->last_time_step > 0
                                              ? -wall->impulse[axis] / run->last_time_step
                                              : 0.0;
    }
    if (out->mass != NULL)
        out->mass[n] = node_values(nodes, block, nodes->layout.mass)[lane];
    if (out->area != NULL) {
        out->area[n] = 0;
        for (size_t face = 0; wall != NULL && face < wall->faces.count; face++)
            out->area[n] += wall->faces.area[face];
    }
}

/* NOLINTBEGIN(readability-non-const-parameter): written through `out` */
size_t talus_simulation_read_nodes(const struct talus_simulation *simulation, double *position,
                                   double *mass, double *velocity, double *reaction, double *area)
/* NOLINTEND(readability-non-const-parameter) */
{
    const struct run *run = &simulation->run;
    const struct node_blocks *nodes = &run->grid.nodes;
    struct node_output out = {position, mass, velocity, reaction, area, 0};
    const bool counts_only =
        position == NULL && mass == NULL && velocity == NULL && reaction == NULL && area == NULL;
    size_t next_wall = 0; /* wall nodes are in the order of node blocks */
    for (size_t block = 0; block < nodes->count; block++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            const struct wall_node *wall = NULL;
            if (next_wall < run->wall_node_count && run->wall_nodes[next_wall].block == block &&
                run->wall_nodes[next_wall].lane == lane)
                wall = &run->wall_nodes[next_wall++];
            if (node_values(nodes, block, nodes->layout.mass)[lane] <= run->mass_cutoff)
                continue;
            if (counts_only)
                out.count++;
            else
                write_node(run, block, lane, wall, &out);
        }
    }
    return out.count;
}
