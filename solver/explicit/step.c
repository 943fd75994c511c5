/* SPDX-License-Identifier: Apache-2.0 */
/* One time step: the passes over tiles and nodes in their order. */
#include "explicit/passes.h"
#include "explicit/run.h"
#include "explicit/stage_clock.h"
#include "health/health.h"
#include "math/sticky.h"
#include "transfers/velocity_transfer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

static void add_findings(struct domain_findings *total, const struct domain_findings *part)
{
    if (total->capped == 0)
        total->capped_particle = part->capped_particle;
    if (total->stretched == 0)
        total->stretched_particle = part->stretched_particle;
    total->capped += part->capped;
    total->stretched += part->stretched;
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
        total.fall_backs += sums->fall_backs;
        total.hoop_force += sums->hoop_force;
        add_findings(&total.domains, &sums->domains);
    }
    return total;
}

static void count_crossers(const struct run *run, struct stage_clock *clock)
{
    for (size_t index = 0; clock != NULL && index < run->grid.tile_count; index++)
        clock->crossers += run->grid.tiles[index].outbox_count;
}

/* The first pass: what the forces add, and what local damping takes of it. */
static void take_kicks(struct run *run, struct stage_clock *clock)
{
    run_kick_nodes(run);
    stage_clock_lap(clock, STAGE_KICK_NODES);
    run_pass(run, kick_tile);
    if (run->grid.nodes.layout.passed == 0)
        return;
    run_brake_nodes(run);
    run_pass(run, kick_tile);
}

/* The passes in the order of `stress_update`. */
static void take_passes(struct run *run, struct stage_clock *clock)
{
    const bool first = run->scene.solver.stress_update == TALUS_STRESS_FIRST;
    const struct talus_solver_options *options = &run->scene.solver;
    if (run->grid.nodes.layout.volume != 0)
        run_mark_empty_nodes(run);
    if (run->node_fit.active)
        run_split_begin(run, false);
    run->pic_share = transfer_of(options)->pic_share(options, run->time_step);
    if (!first)
        run_treat_light_nodes(run);
    if (first) {
        run_start_nodes(run);
        stage_clock_lap(clock, STAGE_KICK_NODES);
        if (run->node_fit.active)
            run_split_advance(run, false);
        else
            run_pass(run, stress_tile);
        run->audit.hoop_force = sum_tiles(run).hoop_force;
        run_treat_light_nodes(run);
    }
    if (run_kicks(run))
        take_kicks(run, clock);
    run_update_nodes(run);
    stage_clock_lap(clock, STAGE_UPDATE_NODES);
    if (run->node_fit.active && !first)
        run_split_advance(run, false);
    else
        run_pass(run, first ? move_tile : advance_tile);
}

/* Mass and forces of the particles where they are. */
static void start_pass(struct run *run)
{
    if (!run->node_fit.active) {
        run_pass(run, start_tile);
        return;
    }
    run_split_begin(run, true);
    run_split_advance(run, true);
}

/* What the last step left at the nodes, once more. */
static void renew_nodes(struct run *run)
{
    struct node_blocks *nodes = &run->grid.nodes;
    memset(nodes->values, 0, nodes->count * node_block_bytes(nodes));
    partition_outbox(run);
    start_pass(run);
}

/* Blocks and walls as the step needs them. */
static enum talus_status prepare_grid(struct run *run, struct talus_error *error)
{
    const uint64_t walls = run->walls.change_count;
    enum talus_status status = run_purge(run, error);
    if (status == TALUS_OK && run_prepare_walls(run) != 0)
        status = talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at step %llu",
                                 (unsigned long long)run->step);
    if (status != TALUS_OK)
        return status;
    /* Shape functions that fold at walls have changed with them: mass and forces at the nodes must
     * be of the same ones as the momentum that is to come. */
    if (walls != run->walls.change_count && run->shape->reach > 0)
        renew_nodes(run);
    partition_outbox(run);
    return TALUS_OK;
}

enum talus_status run_take_step(struct run *run, struct talus_error *error)
{
    struct stage_clock *clock = run->scratch[0].clock;
    const bool settles = run_is_settling(run);
    stage_clock_start(clock);
    enum talus_status status = prepare_grid(run, error);
    if (status != TALUS_OK) {
        run->failed = true;
        return status;
    }
    run_set_gravity(run);
    run_damp_settling(run);
    stage_clock_lap(clock, STAGE_HOUSEKEEPING);
    run->measures = run->sample_expected || health_checks_energy(run->step + 1);
    run->sample_expected = false;
    take_passes(run, clock);
    run_move_walls(run);
    run->time += run->time_step;
    run->interval += run->time_step;
    run->last_time_step = run->time_step;
    run->step++;
    const struct tile_sums sums = sum_tiles(run);
    run->signal_speed = sums.signal_speed;
    run->materials_present = sums.materials;
    run->energy.plastic += sums.plastic_energy;
    run->energy.viscous += sums.viscous_energy;
    run->domains = sums.domains;
    run->fall_backs += sums.fall_backs;
    if (sums.fall_backs > run->fall_backs_worst)
        run->fall_backs_worst = sums.fall_backs;
    run->audit.hoop_force = sums.hoop_force;
    if (run->measures)
        run_book_energy(run);
    count_crossers(run, clock);
    stage_clock_lap(clock, STAGE_HOUSEKEEPING);
    status = health_check_deformation(run, &sums, error);
    if (status == TALUS_OK)
        status = run_rebin(run, error);
    stage_clock_lap(clock, STAGE_REBIN);
    if (status == TALUS_OK)
        status = health_check_step(run, &sums, error);
    if (status == TALUS_OK)
        status = health_check_lumping(run, error);
    stage_clock_lap(clock, STAGE_ENERGY_CHECK);
    if (status != TALUS_OK) {
        run->failed = true;
        return status;
    }
    if (settles && !run_is_settling(run))
        run_end_settling(run);
    run_choose_time_step(run);
    stage_clock_lap(clock, STAGE_TIME_STEP);
    return TALUS_OK;
}

enum talus_status run_start(struct run *run, struct talus_error *error)
{
    run->wall_node_count = 0;
    run->walled_block_count = 0;
    run->time = 0.0 - run->scene.solver.settle_time; /* and not -0 */
    wall_set_prepare(&run->walls, &run->scene, &run->grid.domain, run->time, 0);
    if (sparse_grid_purge(&run->grid) != 0 || run_find_walls(run) != 0 ||
        run_prepare_tiles(run) != 0 || sparse_grid_pack(&run->grid) != 0 ||
        run_reserve_scratch(run) != 0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at the start");
    partition_outbox(run);
    start_pass(run);
    if (run->grid.layout.component_count[PARTICLE_AFFINE] > 0)
        run_start_affine(run);
    const struct tile_sums sums = sum_tiles(run);
    run->largest_speed = sqrt(sums.speed_squared);
    run->signal_speed = sums.signal_speed;
    run->domains = sums.domains;
    run->materials_present = sums.materials;
    run->audit.hoop_force = sums.hoop_force;
    run_choose_time_step(run);
    run_open_books(run);
    return health_check_lumping(run, error);
}
