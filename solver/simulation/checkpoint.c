/* SPDX-License-Identifier: Apache-2.0 */
/* The complete state as blobs, and back. Particles keep their blocks, lanes and rows, and nodes
 * their masses and forces, so that a restored run goes on with the same bits. */
#include "simulation/scene_fingerprint.h"
#include "simulation/simulation_private.h"

#include <stdlib.h>
#include <string.h>

enum { CHECKPOINT_VERSION = 6, BLOB_COUNT = 11 };

static const char *const blob_names[BLOB_COUNT] = {
    "header",     "blocks",  "particles",       "node_places",   "node_values", "faces",
    "boundaries", "windows", "probe_particles", "wall_impulses", "wall_motions"};

struct checkpoint_header {
    uint32_t version, double_count, node_component_count, lane_count;
    uint64_t block_count, node_block_count, particle_count, face_count, boundary_count, probe_count;
    uint64_t step, energy_step, initial_particle_count, wall_node_count;
    uint64_t scene; /* fingerprint */
    uint32_t row_max, over_critical_warned;
    double time, time_step, critical_time_step, last_time_step, interval, duration;
    double largest_speed, signal_speed, checked_speed, least_mass, mass_cutoff;
    uint64_t materials_present, fall_backs, fall_backs_worst, fall_back_warned;
    struct domain_findings domains;
    uint32_t capped_warned, stretched_warned;
    struct run_energy energy;
    struct run_audit audit;
};

struct checkpoint_block {
    int32_t cell[3];
    uint32_t row_count, row_capacity, lane_count[LANE_COUNT];
};

static struct checkpoint_header make_header(const struct talus_simulation *simulation)
{
    const struct run *run = &simulation->run;
    struct checkpoint_header header;
    memset(&header, 0, sizeof header); /* padding too: equal states give equal bytes */
    header.version = CHECKPOINT_VERSION;
    header.scene = scene_fingerprint(&run->scene);
    header.wall_node_count = run->wall_node_count;
    header.double_count = run->grid.layout.double_count;
    header.node_component_count = run->grid.nodes.layout.component_count;
    header.lane_count = LANE_COUNT;
    header.block_count = run->grid.block_count;
    header.node_block_count = run->grid.nodes.count;
    header.particle_count = sparse_grid_particle_count(&run->grid);
    header.face_count = run->walls.face_count;
    header.boundary_count = run->scene.boundary_count;
    header.probe_count = run->scene.probe_count;
    header.step = run->step;
    header.energy_step = run->energy_step;
    header.initial_particle_count = run->initial_particle_count;
    header.row_max = run->grid.row_max;
    header.over_critical_warned = run->over_critical_warned;
    header.time = run->time;
    header.time_step = run->time_step;
    header.critical_time_step = run->critical_time_step;
    header.last_time_step = run->last_time_step;
    header.interval = run->interval;
    header.duration = run->scene.duration;
    header.largest_speed = run->largest_speed;
    header.signal_speed = run->signal_speed;
    header.materials_present = run->materials_present;
    header.fall_backs = run->fall_backs;
    header.fall_backs_worst = run->fall_backs_worst;
    header.fall_back_warned = run->fall_back_warned;
    header.domains = run->domains;
    header.capped_warned = run->capped_warned;
    header.stretched_warned = run->stretched_warned;
    header.checked_speed = run->checked_speed;
    header.least_mass = run->least_mass;
    header.mass_cutoff = run->mass_cutoff;
    header.energy = run->energy;
    header.audit = run->audit;
    return header;
}

static size_t window_count(const struct run *run)
{
    return run->walls.face_count + run->scene.boundary_count;
}

/* Bytes of the rings with their fill. */
static size_t windows_bytes(const struct run *run)
{
    size_t bytes = 0;
    for (size_t index = 0; index < window_count(run); index++)
        bytes += 3 * sizeof(uint64_t) + 4 * run->windows[index].capacity * sizeof(double);
    return bytes;
}

static size_t particle_bytes(const struct run *run)
{
    size_t bytes = 0;
    for (size_t index = 0; index < run->grid.block_count; index++)
        bytes += particle_chunk_bytes(&run->grid.layout, run->grid.blocks[index].row_capacity);
    return bytes;
}

static void save_windows(const struct run *run, unsigned char *out)
{
    for (size_t index = 0; index < window_count(run); index++) {
        const struct peak_window *window = &run->windows[index];
        const uint64_t numbers[3] = {window->capacity, window->first, window->count};
        memcpy(out, numbers, sizeof numbers);
        out += sizeof numbers;
        if (window->capacity > 0)
            memcpy(out, window->entries, 4 * window->capacity * sizeof(double));
        out += 4 * window->capacity * sizeof(double);
    }
}

/* What grid output shows as reactions until the next step. */
static void save_wall_impulses(const struct run *run, unsigned char *out)
{
    for (size_t index = 0; index < run->wall_node_count; index++)
        memcpy(out + index * sizeof run->wall_nodes[index].impulse, run->wall_nodes[index].impulse,
               sizeof run->wall_nodes[index].impulse);
}

static bool restore_wall_impulses(struct run *run, const struct talus_blob *blob)
{
    const unsigned char *in = blob->data;
    if (blob->bytes != run->wall_node_count * 3 * sizeof(double))
        return false;
    for (size_t index = 0; index < run->wall_node_count; index++)
        memcpy(run->wall_nodes[index].impulse, in + index * sizeof run->wall_nodes[index].impulse,
               sizeof run->wall_nodes[index].impulse);
    return true;
}

static void save_blocks(const struct run *run, struct checkpoint_block *blocks,
                        unsigned char *chunks)
{
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        const size_t bytes = particle_chunk_bytes(&run->grid.layout, block->row_capacity);
        memset(&blocks[index], 0, sizeof blocks[index]);
        memcpy(blocks[index].cell, block->cell, sizeof block->cell);
        blocks[index].row_count = block->row_count;
        blocks[index].row_capacity = block->row_capacity;
        memcpy(blocks[index].lane_count, block->lane_count, sizeof block->lane_count);
        if (bytes > 0)
            memcpy(chunks, block->data, bytes);
        chunks += bytes;
    }
}

const struct talus_blob *talus_simulation_checkpoint(struct talus_simulation *simulation,
                                                     size_t *count)
{
    const struct run *run = &simulation->run;
    const struct checkpoint_header header = make_header(simulation);
    const size_t sizes[BLOB_COUNT] = {
        sizeof header,
        run->grid.block_count * sizeof(struct checkpoint_block),
        particle_bytes(run),
        run->grid.nodes.count * sizeof *run->grid.nodes.place,
        run->grid.nodes.count * run->grid.nodes.layout.component_count * LANE_COUNT * sizeof(real),
        run->walls.face_count * sizeof *run->faces,
        run->scene.boundary_count * sizeof *run->boundaries,
        windows_bytes(run),
        run->scene.probe_count * sizeof *simulation->probe_ids,
        run->wall_node_count * 3 * sizeof(double),
        run->scene.boundary_count * sizeof(struct wall_motion)};
    size_t total = 0;
    for (size_t index = 0; index < BLOB_COUNT; index++)
        total += (sizes[index] + 63) / 64 * 64;
    free(simulation->blob_memory);
    simulation->blob_memory = malloc(total);
    if (simulation->blobs == NULL)
        simulation->blobs = calloc(BLOB_COUNT, sizeof *simulation->blobs);
    if (simulation->blob_memory == NULL || simulation->blobs == NULL)
        return NULL;
    unsigned char *next = simulation->blob_memory;
    unsigned char *data[BLOB_COUNT];
    for (size_t index = 0; index < BLOB_COUNT; index++) {
        (void)strncpy(simulation->blobs[index].name, blob_names[index],
                      sizeof simulation->blobs[index].name - 1);
        simulation->blobs[index].data = data[index] = next;
        simulation->blobs[index].bytes = sizes[index];
        next += (sizes[index] + 63) / 64 * 64;
    }
    const void *const sources[BLOB_COUNT] = {&header,
                                             NULL,
                                             NULL,
                                             run->grid.nodes.place,
                                             run->grid.nodes.values,
                                             run->faces,
                                             run->boundaries,
                                             NULL,
                                             simulation->probe_ids,
                                             NULL,
                                             NULL};
    for (size_t index = 0; index < BLOB_COUNT; index++) {
        if (sources[index] != NULL && sizes[index] > 0)
            memcpy(data[index], sources[index], sizes[index]);
    }
    save_blocks(run, (struct checkpoint_block *)(void *)data[1], data[2]);
    save_windows(run, data[7]);
    save_wall_impulses(run, data[9]);
    wall_set_get_motions(&run->walls, (struct wall_motion *)(void *)data[10]);
    *count = simulation->blob_count = BLOB_COUNT;
    return simulation->blobs;
}

static const struct talus_blob *find_blob(const struct talus_blob *blobs, size_t count,
                                          const char *name)
{
    for (size_t index = 0; index < count; index++) {
        if (strcmp(blobs[index].name, name) == 0)
            return &blobs[index];
    }
    return NULL;
}

/* Does the checkpoint belong to this scene and build, and is it whole? */
static bool header_fits(const struct run *run, const struct checkpoint_header *header,
                        const struct talus_blob *const found[BLOB_COUNT])
{
    return header->version == CHECKPOINT_VERSION && header->lane_count == LANE_COUNT &&
           header->scene == scene_fingerprint(&run->scene) &&
           header->double_count == run->grid.layout.double_count &&
           header->node_component_count == run->grid.nodes.layout.component_count &&
           header->face_count == run->walls.face_count &&
           header->boundary_count == run->scene.boundary_count &&
           header->probe_count == run->scene.probe_count &&
           found[1]->bytes == header->block_count * sizeof(struct checkpoint_block) &&
           found[3]->bytes == header->node_block_count * 3 * sizeof(int32_t) &&
           found[4]->bytes == header->node_block_count * header->node_component_count * LANE_COUNT *
                                  sizeof(real) &&
           found[5]->bytes == run->walls.face_count * sizeof *run->faces &&
           found[6]->bytes == run->scene.boundary_count * sizeof *run->boundaries &&
           found[8]->bytes == run->scene.probe_count * sizeof(uint32_t) &&
           found[9]->bytes == header->wall_node_count * 3 * sizeof(double) &&
           found[10]->bytes == run->scene.boundary_count * sizeof(struct wall_motion);
}

static bool restore_nodes(struct run *run, const struct checkpoint_header *header,
                          const struct talus_blob *places, const struct talus_blob *values)
{
    const int32_t(*place)[3] = places->data;
    for (size_t index = 0; index < header->node_block_count; index++) {
        if (node_blocks_require(&run->grid.nodes, place[index][0], place[index][1],
                                place[index][2]) != index)
            return false;
    }
    if (values->bytes > 0)
        memcpy(run->grid.nodes.values, values->data, values->bytes);
    return true;
}

static bool restore_blocks(struct run *run, const struct checkpoint_header *header,
                           const struct talus_blob *blocks, const struct talus_blob *chunks)
{
    const struct checkpoint_block *saved = blocks->data;
    const unsigned char *chunk = chunks->data;
    size_t left = chunks->bytes;
    for (size_t index = 0; index < header->block_count; index++) {
        if (sparse_grid_require_block(&run->grid, saved[index].cell) != index)
            return false;
        struct particle_block *block = &run->grid.blocks[index];
        const size_t bytes = particle_chunk_bytes(&run->grid.layout, saved[index].row_capacity);
        if (bytes > left ||
            particle_block_attach(&run->grid.layout, block, saved[index].row_capacity, chunk) != 0)
            return false;
        block->row_count = saved[index].row_count;
        memcpy(block->lane_count, saved[index].lane_count, sizeof block->lane_count);
        chunk += bytes;
        left -= bytes;
    }
    return left == 0;
}

static bool restore_windows(struct run *run, const struct talus_blob *blob)
{
    const unsigned char *in = blob->data;
    if (blob->bytes != windows_bytes(run))
        return false;
    for (size_t index = 0; index < window_count(run); index++) {
        struct peak_window *window = &run->windows[index];
        uint64_t numbers[3];
        memcpy(numbers, in, sizeof numbers);
        in += sizeof numbers;
        if (numbers[0] != window->capacity)
            return false;
        window->first = numbers[1];
        window->count = numbers[2];
        if (window->capacity > 0)
            memcpy(window->entries, in, 4 * window->capacity * sizeof(double));
        in += 4 * window->capacity * sizeof(double);
    }
    return true;
}

static void restore_header(struct run *run, const struct checkpoint_header *header)
{
    run->step = header->step;
    run->energy_step = header->energy_step;
    run->initial_particle_count = header->initial_particle_count;
    run->grid.row_max = header->row_max;
    run->over_critical_warned = header->over_critical_warned != 0;
    run->fall_backs = header->fall_backs;
    run->fall_backs_worst = header->fall_backs_worst;
    run->fall_back_warned = header->fall_back_warned != 0;
    run->domains = header->domains;
    run->capped_warned = header->capped_warned != 0;
    run->stretched_warned = header->stretched_warned != 0;
    run->time = header->time;
    run->time_step = header->time_step;
    run->critical_time_step = header->critical_time_step;
    run->last_time_step = header->last_time_step;
    run->interval = header->interval;
    run->scene.duration = header->duration;
    run->largest_speed = header->largest_speed;
    run->signal_speed = header->signal_speed;
    run->materials_present = header->materials_present;
    run->checked_speed = header->checked_speed;
    run->least_mass = header->least_mass;
    run->mass_cutoff = header->mass_cutoff;
    run->energy = header->energy;
    run->audit = header->audit;
}

static bool restore_state(struct talus_simulation *simulation,
                          const struct talus_blob *const found[BLOB_COUNT])
{
    struct run *run = &simulation->run;
    struct checkpoint_header header;
    if (found[0]->bytes != sizeof header)
        return false;
    memcpy(&header, found[0]->data, sizeof header);
    if (!header_fits(run, &header, found) || !restore_nodes(run, &header, found[3], found[4]) ||
        !restore_blocks(run, &header, found[1], found[2]) || !restore_windows(run, found[7]))
        return false;
    if (found[5]->bytes > 0)
        memcpy(run->faces, found[5]->data, found[5]->bytes);
    if (found[6]->bytes > 0)
        memcpy(run->boundaries, found[6]->data, found[6]->bytes);
    restore_header(run, &header);
    run->outbox = malloc((run->initial_particle_count + 1) * sizeof *run->outbox);
    if (run->outbox == NULL || probes_reserve(simulation) != 0 ||
        simulation_make_columns(simulation) != 0)
        return false;
    if (found[8]->bytes > 0)
        memcpy(simulation->probe_ids, found[8]->data, found[8]->bytes);
    wall_set_set_motions(&run->walls, &run->scene, &run->grid.domain, found[10]->data);
    return run_find_walls(run) == 0 && run_prepare_tiles(run) == 0 &&
           run_reserve_scratch(run) == 0 && restore_wall_impulses(run, found[9]);
}

enum talus_status talus_simulation_restore(const struct talus_scene *scene,
                                           const struct talus_simulation_options *options,
                                           const struct talus_blob *blobs, size_t blob_count,
                                           struct talus_simulation **simulation,
                                           struct talus_error *error)
{
    const struct talus_blob *found[BLOB_COUNT];
    *simulation = NULL;
    for (size_t index = 0; index < BLOB_COUNT; index++) {
        found[index] = find_blob(blobs, blob_count, blob_names[index]);
        if (found[index] == NULL)
            return talus_error_set(error, TALUS_INVALID, "checkpoint", "",
                                   "the checkpoint has no part '%s'", blob_names[index]);
    }
    struct talus_simulation *created;
    enum talus_status status = simulation_begin(scene, options, &created, error);
    if (status == TALUS_OK && !restore_state(created, found))
        status = talus_error_set(error, TALUS_INVALID, "checkpoint", "",
                                 "the checkpoint does not belong to this scene and build");
    if (status != TALUS_OK) {
        talus_simulation_destroy(created);
        return status;
    }
    *simulation = created;
    return TALUS_OK;
}
