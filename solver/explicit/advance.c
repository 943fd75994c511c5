/* SPDX-License-Identifier: Apache-2.0 */
#include "explicit/advance.h"

#include "explicit/anti_locking_stage.h"
#include "explicit/front_smoothing.h"
#include "explicit/kinematics.h"
#include "explicit/material_stage.h"
#include "explicit/out_of_plane.h"
#include "explicit/stage_clock.h"
#include "math/sticky.h"
#include "state/wide_lanes.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* The particles take their share of the nodes' velocity. */
static void blend_velocity(const struct run *run, const struct shape_context *context,
                           const struct particle_block *block, const struct block_scratch *scratch)
{
    const size_t axes = run->grid.domain.axis_count;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const real share = (real)run->pic_share;
    real *velocity[3] = {NULL};
    for (uint32_t axis = 0; axis < axes; axis++)
        velocity[axis] = particle_values(&run->grid.layout, block, PARTICLE_VELOCITY, axis);
    real *const *nodes = share < 1 ? scratch->stress : velocity; /* no stress there yet */
    run->kernels->gather_values(context, block, axes, nodes, context->nodes->layout.velocity);
    for (size_t axis = 0; share < 1 && axis < axes; axis++) {
        for (size_t slot = 0; slot < count; slot++)
            velocity[axis][slot] += share * (nodes[axis][slot] - velocity[axis][slot]);
    }
}

static void record_displacement(const struct run *run, const struct particle_block *block,
                                const struct block_scratch *scratch, size_t count)
{
    const struct particle_layout *layout = &run->grid.layout;
    for (uint32_t axis = 0; axis < layout->component_count[PARTICLE_DISPLACEMENT]; axis++) {
        real *displacement = particle_values(layout, block, PARTICLE_DISPLACEMENT, axis);
        const real width = (real)run->grid.domain.cell[axis];
        for (size_t slot = 0; slot < count; slot++)
            displacement[slot] += width * scratch->displacement[axis][slot];
    }
}

static void record_fields(const struct run *run, const struct particle_block *block,
                          const struct block_scratch *scratch, size_t count, bool flowed)
{
    const struct particle_layout *layout = &run->grid.layout;
    for (uint32_t component = 0; component < layout->component_count[PARTICLE_STRESS];
         component++) {
        real *stress = particle_values(layout, block, PARTICLE_STRESS, component);
        if (stress != scratch->stress[component]) /* it can be lent (split_passes.c) */
            memcpy(stress, scratch->stress[component], count * sizeof(real));
    }
    if (layout->component_count[PARTICLE_PLASTIC_STRAIN] == 0 || !flowed)
        return;
    real *total = particle_values(layout, block, PARTICLE_PLASTIC_STRAIN, 0);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT)
        lanes_store(total + slot,
                    lanes_load(total + slot) + lanes_load(scratch->plastic_strain + slot));
}

static void source_init(const struct run *run, const struct particle_block *block,
                        const struct block_scratch *scratch, struct scatter_source *source)
{
    source->mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
    source->volume = scratch->reference_volume;
    for (size_t component = 0; component < 6; component++)
        source->stress[component] = scratch->stress[component];
}

/* Bulk viscosity of the damping: sigma = C rho h c_b tr d on the diagonal, in the nodal forces only
 * (Mast 2013, sec. B.2.3 names the option without its formula; this is the usual linear one). */
static void damp_bulk(struct run *run, const struct particle_block *block,
                      struct block_scratch *scratch, size_t count, struct scatter_source *source,
                      struct tile_sums *sums)
{
    const double strength =
        run->scene.solver.viscous_damping * domain_smallest_cell(&run->grid.domain);
    real *divergence = scratch->mean;
    double viscous = 0;
    anti_locking_divergence(run, block, scratch, divergence);
    for (size_t slot = 0; slot < count; slot++) {
        const struct run_material *material = &run->materials[material_of_slot(run, block, slot)];
        const real viscosity = (real)(strength * material->density * material->bulk_speed);
        const real q = viscosity * divergence[slot];
        for (size_t axis = 0; axis < 3; axis++)
            scratch->damped_stress[axis][slot] = scratch->stress[axis][slot] + q;
        viscous += (double)(scratch->reference_volume[slot] * q * divergence[slot]);
    }
    for (size_t axis = 0; axis < 3; axis++)
        source->stress[axis] = scratch->damped_stress[axis];
    sums->viscous_energy += viscous * run->time_step;
}

/* Largest |relative position| and squared speed of a block after the move. */
struct reach {
    double position, speed_squared;
};

/* Moves the particles by their displacements. What is not a number passes through into the result,
 * so that health can find it. */
static struct reach move(const struct run *run, const struct particle_block *block,
                         const struct block_scratch *scratch, size_t count)
{
    const size_t axes = run->grid.domain.axis_count;
    real *position[3], *velocity[3];
    lanes farthest = {0}, fastest = {0}, poison = {0};
    assert(axes <= 3);
    for (uint32_t axis = 0; axis < axes; axis++) {
        position[axis] = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis);
        velocity[axis] = particle_values(&run->grid.layout, block, PARTICLE_VELOCITY, axis);
    }
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        lanes square = {0};
        for (size_t axis = 0; axis < axes; axis++) {
            const lanes x =
                lanes_load(position[axis] + slot) + lanes_load(scratch->displacement[axis] + slot);
            const lanes v = lanes_load(velocity[axis] + slot);
            lanes_store(position[axis] + slot, x);
            farthest = lanes_maximum(farthest, lanes_absolute(x));
            square += v * v;
            poison += x * 0;
        }
        fastest = lanes_maximum(fastest, square);
        poison += square * 0;
    }
    return (struct reach){.position = (double)lanes_largest(farthest + poison),
                          .speed_squared = (double)lanes_largest(fastest + poison)};
}

static bool is_eliminated(const struct run *run, const struct particle_block *block, size_t slot)
{
    double position[3];
    sparse_grid_slot_position(&run->grid, block, slot, position);
    return wall_set_eliminates(&run->walls, position, block->body == NULL ? 0 : block->body[slot]);
}

/* Puts the particle of a slot into the outbox. */
static void collect_slot(struct run *run, uint32_t block_index, struct block_scratch *scratch,
                         size_t slot, bool eliminated, const struct scatter_source *source,
                         struct tile *tile)
{
    struct outbox_record *record = &run->outbox[tile->outbox_begin + tile->outbox_count++];
    record->block = block_index;
    record->slot = (uint32_t)slot;
    record->eliminated = eliminated;
    memset(record->force_stress, 0, sizeof record->force_stress);
    for (size_t component = 0; run->scatters & SCATTER_FORCE && component < run->strain_components;
         component++)
        record->force_stress[component] =
            scratch->reference_volume[slot] * source->stress[component][slot];
    scratch->reference_volume[slot] = 0;
    scratch->mass[slot] = 0;
}

/* The lanes of a row that reach beyond their cells, or whose position is not a number. */
static lane_mask row_leaving(const struct run *run, const struct particle_block *block, size_t row)
{
    lane_mask outside = {0};
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const real *position = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis);
        outside |= ~(lanes_absolute(lanes_load(position + row)) <= (real)0.5);
    }
    return outside;
}

/* Puts the particles that left their cells into the outbox; they scatter after they have moved. */
static void collect_crossers(struct run *run, const struct particle_block *block,
                             uint32_t block_index, struct block_scratch *scratch, size_t count,
                             struct scatter_source *source, struct tile *tile)
{
    memcpy(scratch->mass, source->mass, count * sizeof(real));
    source->mass = scratch->mass;
    for (size_t row = 0; row < count; row += LANE_COUNT) {
        const lane_mask leaving = row_leaving(run, block, row);
        if (!block->eliminates && !lanes_any(leaving))
            continue;
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            const size_t slot = row + lane;
            if (block->id[slot] == PARTICLE_NONE)
                continue;
            const bool eliminated = block->eliminates && is_eliminated(run, block, slot);
            if (leaving[lane] != 0 || eliminated)
                collect_slot(run, block_index, scratch, slot, eliminated, source, tile);
        }
    }
}

/* What the nodes' update says about velocities and motion, and what `more` asks for. */
static void gather_motion(struct run *run, struct block_scratch *scratch,
                          const struct particle_block *block, unsigned more, bool still)
{
    const struct shape_context context = run_shape_context(run, still ? 0.0 : run->time_step);
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const bool corrects = run->pic_share < 1 && (!run_kicks(run) || block->constrained);
    const bool affine = run->grid.layout.component_count[PARTICLE_AFFINE] > 0;
    unsigned what = GATHER_DISPLACEMENT | more;
    if (!still)
        what |= (corrects ? GATHER_CORRECTION : 0U) | (affine ? GATHER_AFFINE : 0U);
    const bool smooths =
        !still && run->grid.nodes.layout.volume != 0 && front_find(run, &context, block, scratch);
    run->kernels->gather(&context, block, what, scratch);
    if (run->pic_share > 0 && !still)
        blend_velocity(run, &context, block, scratch);
    if (smooths)
        front_smooth(run, &context, block, scratch);
    record_displacement(run, block, scratch, count);
}

void advance_strain(struct run *run, struct block_scratch *scratch, struct particle_block *block,
                    struct tile_sums *sums, bool still)
{
    const double time_step = still ? 0.0 : run->time_step;
    if (run->scene.solver.stress_update == TALUS_STRESS_FIRST && !still) {
        const struct shape_context context = run_shape_context(run, time_step);
        run->kernels->gather(&context, block, GATHER_GRADIENT, scratch);
    } else {
        gather_motion(run, scratch, block, GATHER_GRADIENT, still);
    }
    fetch_portion(&scratch->ahead);
    stage_clock_lap(scratch->clock, STAGE_GATHER);
    const double jacobian = kinematics_advance(run, block, scratch, time_step);
    if (!(jacobian > 0) && sums->bad_particle == PARTICLE_NONE)
        sums->bad_particle = block->id[scratch->bad_slot];
    sums->least_jacobian = sticky_minimum(sums->least_jacobian, jacobian);
    fetch_portion(&scratch->ahead);
    stage_clock_lap(scratch->clock, STAGE_KINEMATICS);
}

void advance_stress(struct run *run, struct block_scratch *scratch, struct particle_block *block,
                    struct tile_sums *sums, bool still)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const struct material_outcome outcome =
        material_stage_run(run, block, scratch, still ? 0.0 : run->time_step);
    fetch_portion(&scratch->ahead);
    if (outcome.flowed || outcome.refitted)
        kinematics_store(run, block, scratch, outcome.refitted);
    sums->fall_backs += outcome.fall_backs;
    if (outcome.dissipated)
        sums->plastic_energy +=
            lanes_weighted_sum(scratch->reference_volume, scratch->dissipation, count);
    record_fields(run, block, scratch, count, outcome.flowed);
    fetch_portion(&scratch->ahead);
    stage_clock_lap(scratch->clock, STAGE_STORE);
}

/* Moves the particles of a block whose energy is in scratch if it is to be measured, and leaves
 * mass, momentum and forces at the nodes. */
static void carry(struct run *run, struct block_scratch *scratch, uint32_t block_index,
                  struct tile *tile, struct tile_sums *sums, bool still,
                  struct scatter_source *source)
{
    struct particle_block *block = &run->grid.blocks[block_index];
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const struct reach reach = move(run, block, scratch, count);
    if (run->shape->domain != NULL) {
        const struct shape_context context = run_shape_context(run, run->time_step);
        run->shape->domain->resize[run->scene.solver.gimp_scaling](&context, block, &sums->domains);
    }
    run_note_speed(run, scratch->materials, reach.speed_squared, sums);
    if (run->measures) {
        stage_clock_lap(scratch->clock, STAGE_MOVE);
        run_add_energy(run, block, scratch, sums);
        stage_clock_lap(scratch->clock, STAGE_ENERGY_CHECK);
    }
    if (!still && (block->eliminates || !(reach.position <= 0.5)))
        collect_crossers(run, block, block_index, scratch, count, source, tile);
    fetch_rest(&scratch->ahead);
    stage_clock_lap(scratch->clock, STAGE_MOVE);
    const struct shape_context context = run_shape_context(run, run->time_step);
    run->kernels->scatter(&context, block, source, run->scatters);
    if (run->grid.domain.revolves && run->scatters & SCATTER_FORCE)
        sums->hoop_force += hoop_scatter(run, block, source, scratch);
    if (run->force_count > 0)
        run_scatter_forces(run, block, source->mass, 0, count, scratch,
                           still ? run->time : run->time + run->time_step);
    if (run->grid.nodes.layout.volume != 0)
        front_scatter(run, block, source->mass, scratch);
    stage_clock_lap(scratch->clock, STAGE_SCATTER);
}

/* The stress in scratch as the nodes feel it: with bulk damping. */
static void damped_source(struct run *run, const struct particle_block *block,
                          struct block_scratch *scratch, struct tile_sums *sums,
                          struct scatter_source *source)
{
    source_init(run, block, scratch, source);
    if (run->scene.solver.viscous_damping > 0)
        damp_bulk(run, block, scratch, (size_t)block->row_count * LANE_COUNT, source, sums);
}

void advance_finish(struct run *run, struct block_scratch *scratch, uint32_t block_index,
                    struct tile *tile, struct tile_sums *sums, bool still)
{
    struct scatter_source source;
    damped_source(run, &run->grid.blocks[block_index], scratch, sums, &source);
    carry(run, scratch, block_index, tile, sums, still, &source);
}

void advance_forces(struct run *run, struct block_scratch *scratch, struct particle_block *block,
                    struct tile_sums *sums)
{
    const struct shape_context context = run_shape_context(run, run->time_step);
    struct scatter_source source;
    damped_source(run, block, scratch, sums, &source);
    run->kernels->scatter(&context, block, &source, SCATTER_FORCE);
    if (run->grid.domain.revolves)
        sums->hoop_force += hoop_scatter(run, block, &source, scratch);
    stage_clock_lap(scratch->clock, STAGE_SCATTER);
}

void advance_move(struct run *run, struct block_scratch *scratch, uint32_t block_index,
                  struct tile *tile, struct tile_sums *sums)
{
    struct particle_block *block = &run->grid.blocks[block_index];
    struct scatter_source source;
    source_init(run, block, scratch, &source);
    gather_motion(run, scratch, block, 0, false);
    stage_clock_lap(scratch->clock, STAGE_GATHER);
    scratch->materials = material_stage_present(run, block);
    if (run->measures)
        kinematics_load(run, block, scratch);
    carry(run, scratch, block_index, tile, sums, false, &source);
}
