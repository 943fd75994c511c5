/* SPDX-License-Identifier: Apache-2.0 */
/* Probes: what is measured on particles, energies and reactions at each sample. */
#include "simulation/simulation_private.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const vector_suffix[3] = {"x", "y", "z"};
static const char *const tensor_suffix[6] = {"xx", "yy", "zz", "xy", "yz", "xz"};
static const char *const matrix_suffix[9] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};

static const char *const field_units[TALUS_FIELD_COUNT] = {
#define TALUS_FIELD(ENUM, name, components, unit, text) [TALUS_FIELD_##ENUM] = unit,
#include "talus/fields.def"
#undef TALUS_FIELD
};

/* All components of what a probe reads, before one is chosen. */
static size_t full_components(const struct talus_scene *scene, const struct talus_probe *probe)
{
    switch (probe->kind) {
    case TALUS_PROBE_POINT:
    case TALUS_PROBE_INTEGRAL:
        return field_components(probe->field);
    case TALUS_PROBE_CENTRE_OF_MASS:
        return scene->axis_count;
    case TALUS_PROBE_REACTION:
        return probe->quantity == TALUS_REACTION_CONTACT_AREA ? 1
               : probe->quantity == TALUS_REACTION_FORCE      ? scene->axis_count
                                                              : 3;
    default:
        return 1;
    }
}

static const char *suffix_of(size_t full, size_t component)
{
    assert(component < full && full <= 9 && (full == 9 || full == 6 || full <= 3));
    return full == 9   ? matrix_suffix[component]
           : full == 6 ? tensor_suffix[component]
                       : vector_suffix[component];
}

static void probe_unit(const struct talus_scene *scene, const struct talus_probe *probe, char *unit,
                       size_t size)
{
    static const char *const mass[3] = {"kg/m^2", "kg/m", "kg"};
    static const char *const energy[3] = {"J/m^2", "J/m", "J"};
    static const char *const force[3] = {"N/m^2", "N/m", "N"};
    static const char *const moment[3] = {"N/m", "N", "N m"};
    static const char *const area[3] = {"1", "m", "m^2"};
    static const char *const volume[3] = {"m", "m^2", "m^3"};
    assert(scene->axis_count >= 1 && scene->axis_count <= 3);
    const size_t axes = extensive_axis_count(scene) - 1;
    const char *name = "m";
    if (probe->kind == TALUS_PROBE_POINT)
        name = field_units[probe->field];
    else if (probe->kind == TALUS_PROBE_ENERGY)
        name = energy[axes];
    else if (probe->kind == TALUS_PROBE_MASS)
        name = mass[axes];
    else if (probe->kind == TALUS_PROBE_REACTION)
        name = probe->quantity == TALUS_REACTION_FORCE    ? force[axes]
               : probe->quantity == TALUS_REACTION_MOMENT ? moment[axes]
                                                          : area[axes];
    if (probe->kind == TALUS_PROBE_INTEGRAL)
        (void)snprintf(unit, size, "%s %s", field_units[probe->field], volume[axes]);
    else
        (void)snprintf(unit, size, "%s", name);
}

size_t probe_columns(const struct talus_scene *scene, const struct talus_probe *probe,
                     struct talus_column *columns)
{
    const size_t full = full_components(scene, probe);
    const bool single = full == 1 || probe->component >= 0;
    for (size_t index = 0; columns != NULL && index < (single ? 1 : full); index++) {
        if (single)
            (void)snprintf(columns[index].name, sizeof columns[index].name, "probe.%s",
                           probe->name);
        else
            (void)snprintf(columns[index].name, sizeof columns[index].name, "probe.%s.%s",
                           probe->name, suffix_of(full, index));
        probe_unit(scene, probe, columns[index].unit, sizeof columns[index].unit);
    }
    return single ? 1 : full;
}

double run_energy_part(const struct run *run, enum talus_energy_part part)
{
    const struct run_energy *energy = &run->energy;
    switch (part) {
    case TALUS_ENERGY_TOTAL:
        return energy->kinetic + energy->strain + energy->potential;
    case TALUS_ENERGY_KINETIC:
        return energy->kinetic;
    case TALUS_ENERGY_STRAIN:
        return energy->strain;
    case TALUS_ENERGY_POTENTIAL:
        return energy->potential;
    case TALUS_ENERGY_DISSIPATED:
        return energy->plastic + energy->viscous + energy->damping + energy->wall;
    case TALUS_ENERGY_EXTERNAL:
        return energy->external - energy->eliminated;
    case TALUS_ENERGY_NUMERICAL:
        return run_numerical_loss(run);
    case TALUS_ENERGY_PART_COUNT:
        break;
    }
    return 0;
}

/* Front, height and extent; 0 where nothing is selected. */
static double geometry_value(const struct run *run, const struct talus_probe *probe,
                             const struct probe_sums *sums)
{
    if (probe->measure == TALUS_MEASURE_PARTICLE && isinf(sums->high))
        return 0;
    if (probe->measure == TALUS_MEASURE_PARTICLE)
        return probe->kind == TALUS_PROBE_EXTENT ? sums->high - sums->low : sums->high;
    if (sums->mass == 0)
        return 0;
    const double mean = (sums->first[0] * probe->along[0] + sums->first[1] * probe->along[1] +
                         sums->first[2] * probe->along[2]) /
                        sums->mass;
    if (probe->kind != TALUS_PROBE_EXTENT)
        return 2 * mean;
    /* A uniform bar has a mean distance of a quarter of its length from its centre. */
    return 4 * probe_scan_spread(run, probe, mean) / sums->mass;
}

static void choose(const struct talus_probe *probe, const double *all, size_t full, double *values)
{
    if (full > 1 && probe->component >= 0)
        values[0] = all[probe->component];
    else
        memcpy(values, all, full * sizeof *values);
}

static void sample_reaction(const struct run *run, const struct talus_probe *probe, double *values)
{
    const size_t boundary = (size_t)probe->boundary_index;
    const struct wall_record *record =
        probe->face_index < 0
            ? &run->boundaries[boundary]
            : &run->faces[run->walls.shapes[boundary].first_face + (size_t)probe->face_index];
    double all[3] = {record->contact_area, 0, 0};
    const double *sum = probe->quantity == TALUS_REACTION_FORCE ? record->interval_impulse
                                                                : record->interval_moment;
    for (size_t axis = 0; probe->quantity != TALUS_REACTION_CONTACT_AREA && axis < 3; axis++)
        all[axis] = run->interval > 0 ? sum[axis] / run->interval : 0.0;
    choose(probe, all, full_components(&run->scene, probe), values);
}

/* Where a particle is. It mostly stays in its slot from one sample to the next. */
static bool find_particle(const struct run *run, uint32_t id, struct probe_place *place)
{
    if (place->block < run->grid.block_count) {
        const struct particle_block *block = &run->grid.blocks[place->block];
        if (place->slot < (size_t)block->row_count * LANE_COUNT && block->id[place->slot] == id)
            return true;
    }
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            if (block->id[slot] == id) {
                *place = (struct probe_place){.block = index, .slot = slot};
                return true;
            }
        }
    }
    return false;
}

static void sample_point(struct talus_simulation *simulation, size_t probe_index, double *values)
{
    const struct run *run = &simulation->run;
    const struct talus_probe *probe = &run->scene.probes[probe_index];
    const uint32_t id = simulation->probe_ids[probe_index];
    struct probe_place *place = &simulation->probe_places[probe_index];
    double all[9] = {0};
    if (id != PARTICLE_NONE && find_particle(run, id, place))
        field_values(run, &run->grid.blocks[place->block], place->slot, probe->field, all);
    choose(probe, all, field_components(probe->field), values);
}

void probe_sample(struct talus_simulation *simulation, size_t probe_index, double *values)
{
    const struct run *run = &simulation->run;
    const struct talus_probe *probe = &run->scene.probes[probe_index];
    if (probe->kind == TALUS_PROBE_ENERGY) {
        values[0] = run_energy_part(run, probe->part);
        return;
    }
    if (probe->kind == TALUS_PROBE_REACTION) {
        sample_reaction(run, probe, values);
        return;
    }
    if (probe->kind == TALUS_PROBE_POINT) {
        sample_point(simulation, probe_index, values);
        return;
    }
    const struct probe_sums *sums = &simulation->probe_sums[probe_index];
    if (probe->kind == TALUS_PROBE_MASS) {
        values[0] = sums->mass;
    } else if (probe->kind == TALUS_PROBE_INTEGRAL) {
        choose(probe, sums->integral, field_components(probe->field), values);
    } else if (probe->kind == TALUS_PROBE_CENTRE_OF_MASS) {
        double centre[3] = {0};
        for (size_t axis = 0; sums->mass > 0 && axis < 3; axis++)
            centre[axis] = sums->first[axis] / sums->mass;
        choose(probe, centre, run->scene.axis_count, values);
    } else {
        values[0] = geometry_value(run, probe, sums);
    }
}

/* Looks through one block for a particle nearer to the probe than *nearest; of several equally near
 * ones the one with the smallest id counts. */
static void locate_in_block(const struct run *run, const struct talus_probe *probe,
                            const struct particle_block *block, double *nearest, uint32_t *id)
{
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
        double position[3], square = 0;
        const bool other =
            probe->body_index >= 0 && block->body != NULL && block->body[slot] != probe->body_index;
        if (block->id[slot] == PARTICLE_NONE || other)
            continue;
        sparse_grid_slot_position(&run->grid, block, slot, position);
        for (size_t axis = 0; axis < 3; axis++)
            square += (position[axis] - probe->at[axis]) * (position[axis] - probe->at[axis]);
        if (square < *nearest || (square == *nearest && block->id[slot] < *id)) {
            *nearest = square;
            *id = block->id[slot];
        }
    }
}

int probes_reserve(struct talus_simulation *simulation)
{
    const size_t count = simulation->run.scene.probe_count + 1;
    simulation->probe_ids = calloc(count, sizeof *simulation->probe_ids);
    simulation->probe_places = calloc(count, sizeof *simulation->probe_places);
    simulation->probe_sums = calloc(count, sizeof *simulation->probe_sums);
    return simulation->probe_ids == NULL || simulation->probe_places == NULL ||
                   simulation->probe_sums == NULL
               ? -1
               : 0;
}

void probes_locate(struct talus_simulation *simulation)
{
    const struct run *run = &simulation->run;
    for (size_t index = 0; index < run->scene.probe_count; index++) {
        const struct talus_probe *probe = &run->scene.probes[index];
        double nearest = INFINITY;
        simulation->probe_ids[index] = PARTICLE_NONE;
        if (probe->kind != TALUS_PROBE_POINT)
            continue;
        for (size_t entry = 0; entry < run->grid.block_count; entry++)
            locate_in_block(run, probe, &run->grid.blocks[entry], &nearest,
                            &simulation->probe_ids[index]);
    }
}
