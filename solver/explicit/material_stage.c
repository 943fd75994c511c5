/* SPDX-License-Identifier: Apache-2.0 */
#include "explicit/material_stage.h"

#include "explicit/anti_locking_stage.h"
#include "explicit/out_of_plane.h"
#include "explicit/stage_clock.h"

#include <assert.h>
#include <string.h>

uint64_t material_stage_present(const struct run *run, const struct particle_block *block)
{
    if (block->body == NULL || run->scene.material_count == 1)
        return (uint64_t)1 << run->body_material[0];
    uint64_t present = 0;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    for (size_t slot = 0; slot < count; slot++) {
        if (block->id[slot] != PARTICLE_NONE)
            present |= (uint64_t)1 << run->body_material[block->body[slot]];
    }
    return present;
}

static bool is_single(uint64_t set)
{
    return (set & (set - 1)) == 0;
}

const real *material_stage_weights(const struct run *run, const struct particle_block *block,
                                   struct block_scratch *scratch, size_t material, uint64_t present)
{
    const real *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
    if (is_single(present))
        return mass;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    for (size_t slot = 0; slot < count; slot++)
        scratch->weight[slot] = material_of_slot(run, block, slot) == material ? mass[slot] : 0;
    return scratch->weight;
}

static void history_arrays(const struct run *run, const struct particle_block *block,
                           real *history[SCRATCH_HISTORY_MAX])
{
    for (uint32_t index = 0; index < run->grid.layout.component_count[PARTICLE_HISTORY]; index++)
        history[index] = particle_values(&run->grid.layout, block, PARTICLE_HISTORY, index);
}

/* What a model does not write is zero. */
static void clear_unwritten(const struct material *model, const struct material_batch *batch)
{
    if (!model->plastic)
        memset(batch->plastic_strain, 0, batch->count * sizeof(real));
    if (!model->dissipates)
        memset(batch->dissipation, 0, batch->count * sizeof(real));
}

static bool update_single(const struct run *run, const struct particle_block *block,
                          struct block_scratch *scratch, size_t material, double time_step)
{
    real *history[SCRATCH_HISTORY_MAX] = {NULL};
    history_arrays(run, block, history);
    struct material_batch batch = {.count = (size_t)block->row_count * LANE_COUNT,
                                   .component_count = run->strain_components,
                                   .time_step = time_step,
                                   .volume_ratio = scratch->volume_ratio,
                                   .history = history,
                                   .plastic_strain = scratch->plastic_strain,
                                   .dissipation = scratch->dissipation};
    for (size_t component = 0; component < run->strain_components; component++) {
        batch.strain[component] = scratch->strain[component];
        batch.rate[component] = scratch->rate[component];
        batch.stress[component] = scratch->stress[component];
    }
    for (size_t component = 0; run->finite_strain && component < 3; component++)
        batch.spin[component] = scratch->spin[component];
    return run->materials[material].model->update_stress(run->materials[material].constants,
                                                         &batch);
}

/* Copies the slots of one material side by side, and fills the last row with slots at rest. Returns
 * the number of slots, a multiple of LANE_COUNT. */
static size_t compact_slots(const struct run *run, const struct particle_block *block,
                            struct block_scratch *scratch, size_t material,
                            real *const history[SCRATCH_HISTORY_MAX])
{
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    const size_t state_count = run->materials[material].model->state_count;
    assert(state_count <= run->grid.layout.component_count[PARTICLE_HISTORY]);
    size_t used = 0;
    for (size_t slot = 0; slot < slot_count; slot++) {
        if (block->id[slot] == PARTICLE_NONE || material_of_slot(run, block, slot) != material)
            continue;
        for (size_t component = 0; component < run->strain_components; component++) {
            scratch->compact_strain[component][used] = scratch->strain[component][slot];
            scratch->compact_rate[component][used] = scratch->rate[component][slot];
        }
        for (size_t component = 0; component < 3; component++)
            scratch->compact_spin[component][used] = scratch->spin[component][slot];
        for (size_t index = 0; index < state_count; index++)
            scratch->compact_history[index][used] = history[index][slot];
        scratch->compact_volume_ratio[used++] = scratch->volume_ratio[slot];
    }
    const size_t count = (used + LANE_COUNT - 1) / LANE_COUNT * LANE_COUNT;
    for (size_t empty = used; empty < count; empty++) {
        for (size_t component = 0; component < run->strain_components; component++)
            scratch->compact_strain[component][empty] = scratch->compact_rate[component][empty] = 0;
        for (size_t component = 0; component < 3; component++)
            scratch->compact_spin[component][empty] = 0;
        for (size_t index = 0; index < state_count; index++)
            scratch->compact_history[index][empty] = 0;
        scratch->compact_volume_ratio[empty] = 1;
    }
    return count;
}

/* The way back. */
static void spread_slots(const struct run *run, const struct particle_block *block,
                         struct block_scratch *scratch, size_t material,
                         real *const history[SCRATCH_HISTORY_MAX])
{
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    size_t used = 0;
    for (size_t slot = 0; slot < slot_count; slot++) {
        if (block->id[slot] == PARTICLE_NONE || material_of_slot(run, block, slot) != material)
            continue;
        for (size_t component = 0; component < run->strain_components; component++) {
            scratch->strain[component][slot] = scratch->compact_strain[component][used];
            scratch->stress[component][slot] = scratch->compact_stress[component][used];
        }
        for (size_t index = 0; index < run->materials[material].model->state_count; index++)
            history[index][slot] = scratch->compact_history[index][used];
        scratch->plastic_strain[slot] = scratch->compact_plastic_strain[used];
        scratch->dissipation[slot] = scratch->compact_dissipation[used++];
    }
}

/* Compacts the slots of one material, runs it, and puts the results back. */
static bool update_compacted(const struct run *run, const struct particle_block *block,
                             struct block_scratch *scratch, size_t material, double time_step)
{
    real *history[SCRATCH_HISTORY_MAX] = {NULL};
    history_arrays(run, block, history);
    struct material_batch batch = {.count = compact_slots(run, block, scratch, material, history),
                                   .component_count = run->strain_components,
                                   .time_step = time_step,
                                   .volume_ratio = scratch->compact_volume_ratio,
                                   .history = scratch->compact_history,
                                   .plastic_strain = scratch->compact_plastic_strain,
                                   .dissipation = scratch->compact_dissipation};
    for (size_t component = 0; component < run->strain_components; component++) {
        batch.strain[component] = scratch->compact_strain[component];
        batch.rate[component] = scratch->compact_rate[component];
        batch.stress[component] = scratch->compact_stress[component];
    }
    for (size_t component = 0; run->finite_strain && component < 3; component++)
        batch.spin[component] = scratch->compact_spin[component];
    const struct run_material *entry = &run->materials[material];
    const bool flowed = entry->model->update_stress(entry->constants, &batch);
    clear_unwritten(entry->model, &batch);
    spread_slots(run, block, scratch, material, history);
    return flowed;
}

static void clear_results(const struct run *run, struct block_scratch *scratch, size_t count)
{
    for (size_t component = 0; component < run->strain_components; component++)
        memset(scratch->stress[component], 0, count * sizeof(real));
    memset(scratch->plastic_strain, 0, count * sizeof(real));
    memset(scratch->dissipation, 0, count * sizeof(real));
}

struct material_outcome material_stage_run(struct run *run, const struct particle_block *block,
                                           struct block_scratch *scratch, double time_step)
{
    struct material_outcome outcome = {.flowed = false, .dissipated = false};
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const bool smooths = run->scene.solver.anti_locking != TALUS_CONTROL_NONE;
    const uint64_t present = material_stage_present(run, block);
    scratch->materials = present;
    const bool single = is_single(present);
    if (!single)
        clear_results(run, scratch, count);
    for (size_t material = 0; material < run->scene.material_count; material++) {
        if ((present >> material & 1) == 0)
            continue;
        const struct material *model = run->materials[material].model;
        const real *weight =
            smooths ? material_stage_weights(run, block, scratch, material, present) : NULL;
        struct anti_locking fit;
        if (smooths) {
            anti_locking_begin(run, block, material, weight, &fit);
            const bool refitted = anti_locking_strain(run, block, &fit, scratch);
            outcome.refitted = outcome.refitted || refitted;
            outcome.fall_backs += fit.cells.fall_backs;
        }
        if (run->scene.dimension == TALUS_PLANE_STRESS)
            out_of_plane_strain(run, block, scratch, count);
        stage_clock_lap(scratch->clock, STAGE_ANTI_LOCKING);
        const bool flowed = single ? update_single(run, block, scratch, material, time_step)
                                   : update_compacted(run, block, scratch, material, time_step);
        outcome.flowed = outcome.flowed || flowed;
        outcome.dissipated = outcome.dissipated || flowed || (model->dissipates && !model->plastic);
        stage_clock_lap(scratch->clock, STAGE_MATERIAL);
        if (smooths)
            anti_locking_stress(run, block, &fit, scratch);
        stage_clock_lap(scratch->clock, STAGE_ANTI_LOCKING);
    }
    if (run->scene.dimension == TALUS_PLANE_STRESS) /* exactly, not up to rounding */
        memset(scratch->stress[2], 0, count * sizeof(real));
    return outcome;
}

void material_stage_energy(const struct run *run, const struct particle_block *block,
                           struct block_scratch *scratch, real *energy)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const uint64_t present = material_stage_present(run, block);
    real *history[SCRATCH_HISTORY_MAX] = {NULL};
    history_arrays(run, block, history);
    struct material_batch batch = {.count = count,
                                   .component_count = run->strain_components,
                                   .volume_ratio = scratch->volume_ratio,
                                   .history = history};
    for (size_t component = 0; component < run->strain_components; component++)
        batch.strain[component] = scratch->strain[component];
    if (is_single(present)) {
        const struct run_material *entry = &run->materials[__builtin_ctzll(present)];
        entry->model->strain_energy(entry->constants, &batch, energy);
        return;
    }
    memset(energy, 0, count * sizeof *energy);
    for (size_t material = 0; material < run->scene.material_count; material++) {
        if ((present >> material & 1) == 0)
            continue;
        real *part = scratch->compact_dissipation;
        const struct run_material *entry = &run->materials[material];
        entry->model->strain_energy(entry->constants, &batch, part);
        for (size_t slot = 0; slot < count; slot++) {
            if (block->id[slot] != PARTICLE_NONE && material_of_slot(run, block, slot) == material)
                energy[slot] = part[slot];
        }
    }
}
