/* SPDX-License-Identifier: Apache-2.0 */
/* Sizes as found in the folders of the shipped scenes (docs/performance.md). */
#include "scene/scene_output_size.h"

#include "scene/scene_component.h"

#include <math.h>

enum { GRID_MASS = 1, GRID_VELOCITY = 2, GRID_REACTION = 4 };

/* Bytes of an HDF5 file of a frame besides its numbers. */
static const double header_low = 8000.0, header_high = 20000.0;
/* Connectivity, offset and cell type of a vertex: regular, so next to nothing once compressed. */
static const double topology_bytes = 8.0 + 8.0 + 1.0;
/* What shuffle and gzip leave of particle fields: 0.9 of 1,024 particles that swing, 0.5 of 73,728
 * that flow, 0.15 of a lattice at rest. */
static const double packed_low = 0.1, packed_expected = 0.7;
/* Files that do not grow with the rows: scene, receipt, log, heads of the tables. */
static const double small_files_low = 20e3, small_files_high = 150e3;
/* One entry of a frame in receipt, list of frames and events. */
static const double frame_entry_bytes = 800.0;

static double frame_count(const struct talus_scene *scene)
{
    double every = scene->output.frames_every;
    return every > 0.0 ? ceil(scene->duration / every - 1e-9) + 1.0 : 2.0;
}

static double frame_components(const struct talus_scene *scene)
{
    double components = 3.0;
    for (size_t field = 0; field < TALUS_FIELD_COUNT; field++) {
        if ((scene->output.frame_fields & (1u << field)) != 0)
            components += (double)scene_field_components(field);
    }
    return components;
}

static double probe_columns(const struct talus_scene *scene, const struct talus_probe *probe)
{
    if (probe->component >= 0)
        return 1.0;
    if (probe->kind == TALUS_PROBE_POINT || probe->kind == TALUS_PROBE_INTEGRAL)
        return (double)scene_field_components((size_t)probe->field);
    return (double)scene->axis_count;
}

/* Of one face, or of a whole boundary: force, instant, moment, area. */
static double reaction_columns(const struct talus_scene *scene)
{
    double moments = scene->axis_count == 3 ? 3.0 : 1.0;
    return 2.0 * (double)scene->axis_count + moments + 1.0;
}

static double reaction_count(const struct talus_scene *scene)
{
    double count = 0.0;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        count += boundary->face_count > 1 ? 1.0 + (double)boundary->face_count : 1.0;
    }
    return count;
}

static double column_count(const struct talus_scene *scene)
{
    double columns = 1.0 + TALUS_ENERGY_PART_COUNT;
    for (size_t index = 0; index < scene->probe_count; index++)
        columns += probe_columns(scene, &scene->probes[index]);
    return columns + reaction_count(scene) * reaction_columns(scene);
}

/* Bytes of the history in history.bin and results.h5, and as text, reactions twice; numbers that
 * are zero are short as text. */
static void add_history(const struct talus_scene *scene, struct scene_output_size *size)
{
    const double binary = 16.0, text_low = 2.0, text_expected = 12.0, text_high = 24.0;
    double numbers = size->row_count * size->column_count;
    double texts = numbers + size->row_count * reaction_count(scene) * reaction_columns(scene);
    size->low += 0.5 * binary * numbers + text_low * texts;
    size->expected += binary * numbers + text_expected * texts;
    size->history_bytes = binary * numbers + text_high * texts;
    size->high += size->history_bytes;
}

/* Bytes of the numbers of one grid file, uncompressed: of nodes with mass, or on boundaries. */
static double grid_bytes(const struct talus_scene *scene, double cells)
{
    unsigned fields = scene->output.grid_fields;
    double components = 3.0 + ((fields & GRID_MASS) != 0 ? 1.0 : 0.0) +
                        ((fields & GRID_VELOCITY) != 0 ? 3.0 : 0.0) +
                        ((fields & GRID_REACTION) != 0 ? 4.0 : 0.0);
    /* A body that spreads gets at most so many nodes. */
    double nodes = 3.0 * cells + 100.0;
    if ((fields & (GRID_MASS | GRID_VELOCITY)) == 0)
        nodes = cells + 100.0;
    return nodes * (topology_bytes + (scene->output.frame_double ? 8.0 : 4.0) * components);
}

static void add_frames(const struct talus_scene *scene, const struct talus_estimate *estimate,
                       struct scene_output_size *size)
{
    double particles = (double)estimate->particle_count;
    double plain = particles * size->frame_numbers * (scene->output.frame_double ? 8.0 : 4.0);
    double grid =
        scene->output.grid_fields != 0 ? grid_bytes(scene, (double)estimate->active_cell_count) : 0;
    double files = scene->output.grid_fields != 0 ? 2.0 : 1.0;
    double copies = size->frame_count * (scene->output.vtu ? 2.0 : 1.0);
    size->low += copies * (files * header_low + packed_low * plain);
    size->expected += copies * (files * 1.3 * header_low + packed_expected * plain + 0.2 * grid);
    size->frame_bytes = copies * (header_high + plain + particles * topology_bytes);
    size->high += size->frame_bytes + copies * ((files - 1.0) * header_high + grid) +
                  size->frame_count * frame_entry_bytes;
}

struct scene_output_size scene_output_size(const struct talus_scene *scene,
                                           const struct talus_estimate *estimate)
{
    struct scene_output_size size = {
        .frame_count = frame_count(scene),
        .frame_numbers = frame_components(scene),
        .row_count = scene->duration / scene->output.history_every + 2.0,
        .column_count = column_count(scene),
        .checkpoint_bytes = (double)estimate->particle_count * (double)estimate->bytes_per_particle,
        .low = small_files_low,
        .expected = 0.5 * (small_files_low + small_files_high),
        .high = small_files_high,
    };
    /* A row is a step at most. */
    size.row_count = fmin(size.row_count, (double)estimate->step_count_high + 1.0);
    add_history(scene, &size);
    add_frames(scene, estimate, &size);
    return size;
}
