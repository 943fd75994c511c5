/* SPDX-License-Identifier: Apache-2.0 */
/* The second pass in parts, for fits over nodes, which need the strains of all particles before the
 * first stress, and all stresses before the first force. Positions stay between the parts. What
 * scratch held is brought back: strains from their stored form, stresses from the particles, the
 * motion by gathering it again. */
#include "explicit/advance.h"
#include "explicit/anti_locking_stage.h"
#include "explicit/kinematics.h"
#include "explicit/material_stage.h"
#include "explicit/out_of_plane.h"
#include "explicit/passes.h"
#include "explicit/stage_clock.h"

#include <string.h>

static bool fits_stress(const struct run *run)
{
    return run->scene.solver.anti_locking_apply == TALUS_APPLY_STRAIN_AND_STRESS;
}

/* Arrays of a tensor in scratch are those of the stress of a block's particles while it is lent. */
struct loan {
    real **tensor, *own[6];
};

static struct loan lend(const struct run *run, const struct particle_block *block, real *tensor[6])
{
    struct loan loan = {.tensor = tensor};
    memcpy(loan.own, tensor, sizeof loan.own);
    for (uint32_t component = 0; component < run->strain_components; component++)
        tensor[component] = particle_values(&run->grid.layout, block, PARTICLE_STRESS, component);
    return loan;
}

static void give_back(const struct loan *loan)
{
    memcpy(loan->tensor, loan->own, sizeof loan->own);
}

/* Trial strains to the nodes, and to where the next part finds them. */
static void fit_strain(struct run *run, struct block_scratch *scratch, struct particle_block *block,
                       struct tile_sums *sums, bool still)
{
    const bool carries = kinematics_carries(run);
    struct loan loan = {.tensor = NULL};
    if (carries)
        loan = lend(run, block, scratch->strain);
    advance_strain(run, scratch, block, sums, still);
    anti_locking_scatter_strain(run, block, scratch, still);
    if (carries)
        give_back(&loan);
}

static void fit_strain_tile(struct run *run, size_t index, struct block_scratch *scratch,
                            bool still)
{
    const struct tile *tile = &run->grid.tiles[index];
    struct tile_sums *sums = &run->tile_sums[index];
    stage_clock_lap(scratch->clock, STAGE_WAIT);
    tile_sums_clear(sums);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry]];
        tile_look_ahead(run, entry, scratch);
        if (block->row_count == 0)
            continue;
        fit_strain(run, scratch, block, sums, still);
        fetch_rest(&scratch->ahead);
        stage_clock_lap(scratch->clock, STAGE_ANTI_LOCKING);
    }
    stage_clock_lap(scratch->clock, STAGE_SECOND_PASS);
}

/* Trial strains as the strain pass has stored them, and the rates that materials want. */
static void reload_strain(struct run *run, struct block_scratch *scratch,
                          const struct particle_block *block, bool still)
{
    const double time_step = still ? 0.0 : run->time_step;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    if (run->reloads_gradient) {
        const struct shape_context context = run_shape_context(run, time_step);
        run->kernels->gather(&context, block, GATHER_GRADIENT, scratch);
        if (run->strains_across)
            out_of_plane_increment(run, block, scratch, count, time_step);
        kinematics_rates(run, scratch, count, time_step);
    }
    kinematics_recall(run, block, scratch);
    stage_clock_lap(scratch->clock, STAGE_KINEMATICS);
}

/* From the stress in scratch on: to the new positions, or with `first` only to the forces. */
static void finish(struct run *run, struct block_scratch *scratch, uint32_t block_index,
                   struct tile *tile, struct tile_sums *sums, bool still)
{
    struct particle_block *block = &run->grid.blocks[block_index];
    if (run->scene.solver.stress_update == TALUS_STRESS_FIRST && !still) {
        advance_forces(run, scratch, block, sums);
        return;
    }
    const struct shape_context context = run_shape_context(run, still ? 0.0 : run->time_step);
    run->kernels->gather(&context, block, GATHER_DISPLACEMENT, scratch);
    stage_clock_lap(scratch->clock, STAGE_GATHER);
    advance_finish(run, scratch, block_index, tile, sums, still);
}

static void fit_stress_tile(struct run *run, size_t index, struct block_scratch *scratch,
                            bool still)
{
    struct tile *tile = &run->grid.tiles[index];
    struct tile_sums *sums = &run->tile_sums[index];
    stage_clock_lap(scratch->clock, STAGE_WAIT);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const uint32_t block_index = run->grid.tile_blocks[entry];
        struct particle_block *block = &run->grid.blocks[block_index];
        tile_look_ahead(run, entry, scratch);
        if (block->row_count == 0)
            continue;
        reload_strain(run, scratch, block, still);
        if (fits_stress(run)) {
            const struct loan loan = lend(run, block, scratch->stress);
            advance_stress(run, scratch, block, sums, still);
            give_back(&loan);
            fetch_rest(&scratch->ahead);
            continue;
        }
        advance_stress(run, scratch, block, sums, still);
        finish(run, scratch, block_index, tile, sums, still);
    }
    stage_clock_lap(scratch->clock, STAGE_SECOND_PASS);
}

/* Stresses as the stress pass has left them, through their fit, and what else the forces take. */
static void reload_stress(struct run *run, struct block_scratch *scratch,
                          const struct particle_block *block)
{
    if (run->measures)
        kinematics_load(run, block, scratch);
    else
        kinematics_volumes(run, block, scratch);
    scratch->materials = material_stage_present(run, block);
    anti_locking_gather_stress(run, block, scratch);
    stage_clock_lap(scratch->clock, STAGE_ANTI_LOCKING);
}

static void fit_force_tile(struct run *run, size_t index, struct block_scratch *scratch, bool still)
{
    struct tile *tile = &run->grid.tiles[index];
    stage_clock_lap(scratch->clock, STAGE_WAIT);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const uint32_t block_index = run->grid.tile_blocks[entry];
        const struct particle_block *block = &run->grid.blocks[block_index];
        tile_look_ahead(run, entry, scratch);
        if (block->row_count == 0)
            continue;
        const struct loan loan = lend(run, block, scratch->stress);
        reload_stress(run, scratch, block);
        finish(run, scratch, block_index, tile, &run->tile_sums[index], still);
        give_back(&loan);
    }
    stage_clock_lap(scratch->clock, STAGE_SECOND_PASS);
}

#define PASS(name, part, still)                                                                    \
    static void name(struct run *run, size_t index, struct block_scratch *scratch)                 \
    {                                                                                              \
        part(run, index, scratch, still);                                                          \
    }
PASS(moving_strain_tile, fit_strain_tile, false)
PASS(moving_stress_tile, fit_stress_tile, false)
PASS(moving_force_tile, fit_force_tile, false)
PASS(still_strain_tile, fit_strain_tile, true)
PASS(still_stress_tile, fit_stress_tile, true)
PASS(still_force_tile, fit_force_tile, true)
#undef PASS

void run_split_begin(struct run *run, bool still)
{
#pragma omp parallel for schedule(static) num_threads(run->threads) if (run->threads > 1)
    for (size_t block = 0; block < run->grid.nodes.count; block++) {
        node_fit_clear(&run->node_fit, &run->grid.nodes, block);
        if (!still)
            node_fit_take_mass(&run->node_fit, &run->grid.nodes, block);
    }
}

static void solve_nodes(struct run *run, enum node_fit_what what)
{
    size_t fall_backs = 0;
#pragma omp parallel for schedule(static) num_threads(run->threads)                                \
    reduction(+ : fall_backs) if (run->threads > 1)
    for (size_t block = 0; block < run->grid.nodes.count; block++)
        fall_backs += node_fit_solve(&run->node_fit, &run->grid.nodes, block, what);
    if (what == NODE_FIT_STRAIN && run->grid.tile_count > 0)
        run->tile_sums[0].fall_backs += fall_backs;
}

void run_split_advance(struct run *run, bool still)
{
    run_pass(run, still ? still_strain_tile : moving_strain_tile);
    solve_nodes(run, NODE_FIT_STRAIN);
    run_pass(run, still ? still_stress_tile : moving_stress_tile);
    if (!fits_stress(run))
        return;
    solve_nodes(run, NODE_FIT_STRESS);
    run_pass(run, still ? still_force_tile : moving_force_tile);
}
