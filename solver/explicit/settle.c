/* SPDX-License-Identifier: Apache-2.0 */
/* Settling before t = 0: the scene with its walls at rest, and a damping that takes the share
 * 1 - exp(-c dt) of all velocities before each step. */
#include "explicit/run.h"

#include <math.h>
#include <omp.h>
#include <string.h>

/* What a block loses, and its velocities afterwards. */
static void damp_block(const struct run *run, const struct particle_block *block, double left,
                       struct tile_sums *sums)
{
    const struct particle_layout *layout = &run->grid.layout;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const real *mass = particle_values(layout, block, PARTICLE_MASS, 0);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        real *velocity = particle_values(layout, block, PARTICLE_VELOCITY, axis);
        for (size_t slot = 0; slot < count; slot++) {
            const double before = (double)velocity[slot];
            velocity[slot] = (real)(left * before);
            const double after = (double)velocity[slot];
            sums->settled_momentum[axis] += (double)mass[slot] * (before - after);
            sums->settled_energy += 0.5 * (double)mass[slot] * (before * before - after * after);
        }
    }
    for (uint32_t part = 0; part < layout->component_count[PARTICLE_AFFINE]; part++) {
        real *affine = particle_values(layout, block, PARTICLE_AFFINE, part);
        for (size_t slot = 0; slot < count; slot++)
            affine[slot] *= (real)left;
    }
}

static void damp_tile(const struct run *run, size_t index, double left)
{
    const struct tile *tile = &run->grid.tiles[index];
    struct tile_sums *sums = &run->tile_sums[index];
    sums->settled_energy = 0;
    memset(sums->settled_momentum, 0, sizeof sums->settled_momentum);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry]];
        if (block->row_count > 0)
            damp_block(run, block, left, sums);
    }
}

/* Momentum that waits at the nodes since the last step goes with that of the particles. */
static void damp_nodes(const struct run *run, double left)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    if ((run->scatters & SCATTER_MOMENTUM) == 0)
        return;
    for (size_t block = 0; block < nodes->count; block++) {
        real *momentum = node_values(nodes, block, nodes->layout.momentum);
        for (size_t value = 0; value < run->grid.domain.axis_count * LANE_COUNT; value++)
            momentum[value] *= (real)left;
    }
}

static void book_damping(struct run *run)
{
    double square = 0, momentum[3] = {0, 0, 0};
    for (size_t index = 0; index < run->grid.tile_count; index++) {
        const struct tile_sums *sums = &run->tile_sums[index];
        run->energy.damping += sums->settled_energy;
        for (size_t axis = 0; axis < 3; axis++)
            momentum[axis] += sums->settled_momentum[axis];
    }
    for (size_t axis = 0; axis < 3; axis++) {
        run->audit.impulse[axis] -= momentum[axis];
        square += momentum[axis] * momentum[axis];
    }
    run->audit.exchanged += sqrt(square);
}

void run_damp_settling(struct run *run)
{
    const double left = exp(-run->scene.solver.settle_damping * run->time_step);
    if (!run_is_settling(run) || left == 1.0)
        return;
#pragma omp parallel for schedule(dynamic, 1) num_threads(run->threads) if (run->threads > 1)
    for (size_t index = 0; index < run->grid.tile_count; index++)
        damp_tile(run, index, left);
    damp_nodes(run, left);
    book_damping(run);
}

static void clear_field(struct run *run, enum particle_field field)
{
    const struct particle_layout *layout = &run->grid.layout;
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        const size_t bytes = (size_t)block->row_count * LANE_COUNT * sizeof(real);
        for (uint32_t part = 0; part < layout->component_count[field] && bytes > 0; part++)
            memset(particle_values(layout, block, field, part), 0, bytes);
    }
}

/* What was recorded is gone, but for the last step: a sample of t = 0 shows its forces. */
static void restart_record(struct wall_record *record)
{
    const struct wall_record old = *record;
    memset(record, 0, sizeof *record);
    memcpy(record->step_impulse, old.step_impulse, sizeof old.step_impulse);
    memcpy(record->step_moment, old.step_moment, sizeof old.step_moment);
    memcpy(record->interval_impulse, old.step_impulse, sizeof old.step_impulse);
    memcpy(record->interval_moment, old.step_moment, sizeof old.step_moment);
    record->contact_area = old.contact_area;
}

static void restart_records(struct run *run)
{
    for (size_t face = 0; face < run->walls.face_count; face++)
        restart_record(&run->faces[face]);
    for (size_t index = 0; index < run->scene.boundary_count; index++)
        restart_record(&run->boundaries[index]);
    for (size_t index = 0; index < run->walls.face_count + run->scene.boundary_count; index++)
        run->windows[index].first = run->windows[index].count = 0;
    run->interval = run->last_time_step;
}

void run_end_settling(struct run *run)
{
    const double hoop_force = run->audit.hoop_force;
    clear_field(run, PARTICLE_DISPLACEMENT);
    clear_field(run, PARTICLE_PLASTIC_STRAIN);
    restart_records(run);
    memset(&run->energy, 0, sizeof run->energy);
    memset(&run->audit, 0, sizeof run->audit);
    run->audit.hoop_force = hoop_force; /* of the present stresses */
    run->fall_backs = run->fall_backs_worst = 0;
    run_open_books(run);
}
