/* SPDX-License-Identifier: Apache-2.0 */
/* One time step: the passes over tiles and nodes in their order. */
#include "base/inline.h"
#include "explicit/run.h"
#include "explicit/stage_clock.h"
#include "health/health.h"
#include "math/sticky.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Blocks between what is fetched and what is worked on: about the time of a memory access. */
enum { FIRST_PASS_AHEAD = 3, SECOND_PASS_AHEAD = 2 };

int run_prepare_tiles(struct run *run)
{
    if (sparse_grid_update_tiles(&run->grid) != 0)
        return -1;
    if (run->grid.tile_count <= run->tile_sums_capacity)
        return 0;
    const size_t capacity = 2 * run->grid.tile_count;
    struct tile_sums *sums = realloc(run->tile_sums, capacity * sizeof *sums);
    if (sums == NULL)
        return -1;
    run->tile_sums = sums;
    run->tile_sums_capacity = capacity;
    return 0;
}

int run_reserve_scratch(struct run *run)
{
    for (int thread = 0; thread < run->threads; thread++) {
        if (block_scratch_reserve(&run->scratch[thread], (size_t)run->grid.row_max * LANE_COUNT) !=
            0)
            return -1;
    }
    return 0;
}

/* The outbox of a tile can take all its particles. */
static void partition_outbox(struct run *run)
{
    size_t next = 0;
    for (size_t index = 0; index < run->grid.tile_count; index++) {
        struct tile *tile = &run->grid.tiles[index];
        tile->outbox_begin = next;
        tile->outbox_count = 0;
        for (size_t entry = tile->begin; entry < tile->end; entry++) {
            const struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry]];
            for (size_t lane = 0; lane < LANE_COUNT; lane++)
                next += block->lane_count[lane];
        }
    }
}

/* Asks for bytes of memory in the second-level cache. */
TALUS_INLINE void fetch(const void *memory, size_t bytes)
{
    enum { LINE = 64 };
    for (size_t offset = 0; offset < bytes; offset += LINE)
        __builtin_prefetch((const char *)memory + offset, 0, 2);
}

/* The block that comes `distance` after one, in this tile or the next of the colour; or NULL.
 * Fetches the nodes that no block before it touches. */
TALUS_INLINE const struct particle_block *block_ahead(const struct run *run, size_t entry,
                                                      size_t distance)
{
    if (entry + distance >= run->grid.block_count)
        return NULL;
    const struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry + distance]];
    const size_t last = ((size_t)1 << run->grid.domain.axis_count) - 1;
    const size_t bytes = node_block_bytes(&run->grid.nodes);
    fetch(node_values(&run->grid.nodes, block->nodes[last - 1], 0), bytes);
    fetch(node_values(&run->grid.nodes, block->nodes[last], 0), bytes);
    return block;
}

static void kick_tile(struct run *run, const struct tile *tile, struct stage_clock *clock)
{
    const struct shape_context context = run_shape_context(run, run->time_step);
    stage_clock_lap(clock, STAGE_WAIT);
    const uint32_t kicked = run->grid.layout.first_component[PARTICLE_MASS] + 1;
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const struct particle_block *ahead = block_ahead(run, entry, FIRST_PASS_AHEAD);
        if (ahead != NULL)
            fetch(ahead->data, particle_block_bytes(ahead, kicked));
        run->kernels->kick(&context, &run->grid.blocks[run->grid.tile_blocks[entry]]);
    }
    stage_clock_lap(clock, STAGE_FIRST_PASS);
}

static void advance_tile(struct run *run, size_t index, struct block_scratch *scratch, bool still)
{
    struct tile *tile = &run->grid.tiles[index];
    struct tile_sums *sums = &run->tile_sums[index];
    stage_clock_lap(scratch->clock, STAGE_WAIT);
    memset(sums, 0, sizeof *sums);
    sums->least_jacobian = 1.0;
    sums->bad_particle = PARTICLE_NONE;
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const struct particle_block *ahead = block_ahead(run, entry, SECOND_PASS_AHEAD);
        scratch->ahead = (struct fetch_ahead){NULL, NULL};
        if (ahead != NULL) {
            scratch->ahead.next = (const char *)ahead->data;
            scratch->ahead.end = (const char *)ahead->data +
                                 particle_block_bytes(ahead, run->grid.layout.double_count);
        }
        run_advance_block(run, scratch, run->grid.tile_blocks[entry], tile, sums, still);
    }
    stage_clock_lap(scratch->clock, STAGE_SECOND_PASS);
}

/* Tiles that a thread takes at once: neighbours, so that what it fetches ahead is its own, and few
 * enough that the threads end together. */
static int tiles_at_once(const struct run *run, size_t colour)
{
    enum { MOST = 16, SHARES = 8 };
    const size_t count = run->grid.colour_begin[colour + 1] - run->grid.colour_begin[colour];
    const size_t share = count / ((size_t)run->threads * SHARES);
    return share < 1 ? 1 : share > MOST ? MOST : (int)share;
}

/* All tiles on the calling thread, which lie colour after colour. libgomp would set up a team for
 * one thread too, and a small step feels it. */
static void first_pass_alone(struct run *run)
{
    struct stage_clock *clock = run->scratch[0].clock;
    stage_clock_start(clock);
    for (size_t index = 0; index < run->grid.tile_count; index++)
        kick_tile(run, &run->grid.tiles[index], clock);
    stage_clock_lap(clock, STAGE_WAIT);
}

static void first_pass(struct run *run)
{
    if (run->threads == 1) {
        first_pass_alone(run);
        return;
    }
#pragma omp parallel num_threads(run->threads)
    {
        struct stage_clock *clock = run->scratch[omp_get_thread_num()].clock;
        stage_clock_start(clock);
        for (size_t colour = 0; colour < TILE_COLOURS; colour++) {
#pragma omp for schedule(dynamic, tiles_at_once(run, colour))
            for (size_t index = run->grid.colour_begin[colour];
                 index < run->grid.colour_begin[colour + 1]; index++)
                kick_tile(run, &run->grid.tiles[index], clock);
        }
        stage_clock_lap(clock, STAGE_WAIT);
    }
}

static void second_pass_alone(struct run *run, bool still)
{
    struct block_scratch *scratch = &run->scratch[0];
    stage_clock_start(scratch->clock);
    for (size_t index = 0; index < run->grid.tile_count; index++)
        advance_tile(run, index, scratch, still);
    stage_clock_lap(scratch->clock, STAGE_WAIT);
}

static void second_pass(struct run *run, bool still)
{
    if (run->threads == 1) {
        second_pass_alone(run, still);
        return;
    }
#pragma omp parallel num_threads(run->threads)
    {
        struct block_scratch *scratch = &run->scratch[omp_get_thread_num()];
        stage_clock_start(scratch->clock);
        for (size_t colour = 0; colour < TILE_COLOURS; colour++) {
#pragma omp for schedule(dynamic, tiles_at_once(run, colour))
            for (size_t index = run->grid.colour_begin[colour];
                 index < run->grid.colour_begin[colour + 1]; index++)
                advance_tile(run, index, scratch, still);
        }
        stage_clock_lap(scratch->clock, STAGE_WAIT);
    }
}

static struct tile_sums sum_tiles(const struct run *run)
{
    struct tile_sums total = {.least_jacobian = 1.0, .bad_particle = PARTICLE_NONE};
    for (size_t index = 0; index < run->grid.tile_count; index++) {
        const struct tile_sums *sums = &run->tile_sums[index];
        total.speed_squared = sticky_maximum(total.speed_squared, sums->speed_squared);
        total.signal_speed = fmax(total.signal_speed, sums->signal_speed);
        total.materials |= sums->materials;
        total.least_jacobian = sticky_minimum(total.least_jacobian, sums->least_jacobian);
        if (total.bad_particle == PARTICLE_NONE)
            total.bad_particle = sums->bad_particle;
        total.plastic_energy += sums->plastic_energy;
        total.viscous_energy += sums->viscous_energy;
    }
    return total;
}

static void count_crossers(const struct run *run, struct stage_clock *clock)
{
    for (size_t index = 0; clock != NULL && index < run->grid.tile_count; index++)
        clock->crossers += run->grid.tiles[index].outbox_count;
}

enum talus_status run_take_step(struct run *run, struct talus_error *error)
{
    struct stage_clock *clock = run->scratch[0].clock;
    stage_clock_start(clock);
    enum talus_status status = run_purge(run, error);
    if (status != TALUS_OK) {
        run->failed = true;
        return status;
    }
    partition_outbox(run);
    stage_clock_lap(clock, STAGE_HOUSEKEEPING);
    if (run->scene.solver.stress_update == TALUS_STRESS_MODIFIED_LAST) {
        run_kick_nodes(run);
        stage_clock_lap(clock, STAGE_KICK_NODES);
        first_pass(run);
    }
    run_update_nodes(run);
    stage_clock_lap(clock, STAGE_UPDATE_NODES);
    run->measures = run->sample_expected || health_checks_energy(run->step + 1);
    run->sample_expected = false;
    second_pass(run, false);
    run->time += run->time_step;
    run->interval += run->time_step;
    run->last_time_step = run->time_step;
    run->step++;
    const struct tile_sums sums = sum_tiles(run);
    run->signal_speed = sums.signal_speed;
    run->materials_present = sums.materials;
    run->energy.plastic += sums.plastic_energy;
    run->energy.viscous += sums.viscous_energy;
    if (run->measures)
        run_book_energy(run);
    count_crossers(run, clock);
    stage_clock_lap(clock, STAGE_HOUSEKEEPING);
    status = run_rebin(run, error);
    stage_clock_lap(clock, STAGE_REBIN);
    if (status == TALUS_OK)
        status = health_check_step(run, &sums, error);
    stage_clock_lap(clock, STAGE_ENERGY_CHECK);
    if (status != TALUS_OK) {
        run->failed = true;
        return status;
    }
    run_choose_time_step(run);
    stage_clock_lap(clock, STAGE_TIME_STEP);
    return TALUS_OK;
}

enum talus_status run_start(struct run *run, struct talus_error *error)
{
    run->wall_node_count = 0;
    run->walled_block_count = 0;
    if (sparse_grid_purge(&run->grid) != 0 || run_find_walls(run) != 0 ||
        run_prepare_tiles(run) != 0 || sparse_grid_pack(&run->grid) != 0 ||
        run_reserve_scratch(run) != 0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at the start");
    partition_outbox(run);
    second_pass(run, true);
    const struct tile_sums sums = sum_tiles(run);
    run->largest_speed = sqrt(sums.speed_squared);
    run->signal_speed = sums.signal_speed;
    run->materials_present = sums.materials;
    run_choose_time_step(run);
    run_measure_energy(run);
    run->audit.initial_stored = run->energy.kinetic + run->energy.strain;
    run->audit.initial_potential = run->energy.potential;
    run->audit.initial_energy = run->audit.initial_stored + run->energy.potential;
    run_measure_momentum(run, run->audit.initial_momentum, &run->audit.initial_mass);
    return TALUS_OK;
}
