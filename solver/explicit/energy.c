/* SPDX-License-Identifier: Apache-2.0 */
/* The energy and momentum of the present state. Looked at, never changed. */
#include "explicit/kinematics.h"
#include "explicit/material_stage.h"
#include "explicit/run.h"
#include "state/wide_lanes.h"

#include <math.h>
#include <omp.h>
#include <string.h>

static double kinetic_energy(const struct run *run, const struct particle_block *block,
                             const real *mass, size_t count)
{
    const struct particle_layout *layout = &run->grid.layout;
    wide_lanes sum = {0};
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const real *velocity = particle_values(layout, block, PARTICLE_VELOCITY, axis);
        for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
            const wide_lanes v = lanes_widen(lanes_load(velocity + slot));
            sum += lanes_widen(lanes_load(mass + slot)) * v * v;
        }
    }
    return 0.5 * wide_lanes_sum(sum);
}

/* - sum m g . x, with x = where the cell is + the position in it. */
static double potential_energy(const struct run *run, const struct particle_block *block,
                               const real *mass, size_t count)
{
    const struct domain *domain = &run->grid.domain;
    double sum = 0;
    for (uint32_t axis = 0; axis < domain->axis_count; axis++) {
        const double gravity = run->scene.gravity[axis];
        if (gravity == 0)
            continue;
        const real *position = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis);
        wide_lanes centre;
        for (int32_t lane = 0; lane < LANE_COUNT; lane++)
            centre[lane] =
                domain_position(domain, axis, block->cell[axis] + (axis == 0 ? lane : 0), 0);
        wide_lanes moment = {0};
        for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
            const wide_lanes x = lanes_widen(lanes_load(position + slot));
            moment += lanes_widen(lanes_load(mass + slot)) * (centre + domain->cell[axis] * x);
        }
        sum -= gravity * wide_lanes_sum(moment);
    }
    return sum;
}

void run_add_energy(const struct run *run, const struct particle_block *block,
                    struct block_scratch *scratch, struct tile_sums *sums)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const real *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
    real *energy = scratch->dissipation;
    material_stage_energy(run, block, scratch, energy);
    sums->strain += lanes_weighted_sum(scratch->reference_volume, energy, count);
    sums->kinetic += kinetic_energy(run, block, mass, count);
    sums->potential += potential_energy(run, block, mass, count);
}

static void measure_block(const struct run *run, const struct particle_block *block,
                          struct block_scratch *scratch, struct tile_sums *sums)
{
    if (block->row_count == 0)
        return;
    kinematics_load(run, block, scratch);
    run_add_energy(run, block, scratch, sums);
}

void run_book_energy(struct run *run)
{
    run->energy.kinetic = run->energy.strain = run->energy.potential = 0;
    for (size_t index = 0; index < run->grid.tile_count; index++) {
        run->energy.kinetic += run->tile_sums[index].kinetic;
        run->energy.strain += run->tile_sums[index].strain;
        run->energy.potential += run->tile_sums[index].potential;
    }
    run->energy_step = run->step;
}

void run_measure_energy(struct run *run)
{
#pragma omp parallel num_threads(run->threads) if (run->threads > 1)
    {
        struct block_scratch *scratch = &run->scratch[omp_get_thread_num()];
#pragma omp for schedule(dynamic, 1)
        for (size_t index = 0; index < run->grid.tile_count; index++) {
            const struct tile *tile = &run->grid.tiles[index];
            struct tile_sums *sums = &run->tile_sums[index];
            sums->kinetic = sums->strain = sums->potential = 0;
            for (size_t entry = tile->begin; entry < tile->end; entry++)
                measure_block(run, &run->grid.blocks[run->grid.tile_blocks[entry]], scratch, sums);
        }
    }
    run_book_energy(run);
}

double run_numerical_loss(const struct run *run)
{
    const struct run_energy *energy = &run->energy;
    return run->audit.initial_energy - (energy->kinetic + energy->strain + energy->potential) -
           (energy->plastic + energy->viscous + energy->damping + energy->wall) -
           energy->eliminated + energy->external;
}

double run_energy_turnover(const struct run *run)
{
    const struct run_energy *energy = &run->energy;
    return run->audit.initial_stored + energy->kinetic + energy->strain + energy->plastic +
           energy->viscous + energy->damping + energy->wall + fabs(energy->eliminated) +
           fmax(fabs(energy->external), energy->exchanged) +
           fabs(run->audit.initial_potential - energy->potential);
}

void run_measure_momentum(const struct run *run, double momentum[3], double *mass)
{
    *mass = 0;
    memset(momentum, 0, 3 * sizeof *momentum);
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        const size_t count = (size_t)block->row_count * LANE_COUNT;
        const real *masses = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
        for (size_t i = 0; i < count; i++)
            *mass += masses[i];
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
            const real *velocity =
                particle_values(&run->grid.layout, block, PARTICLE_VELOCITY, axis);
            for (size_t i = 0; i < count; i++)
                momentum[axis] += masses[i] * velocity[i];
        }
    }
}

void run_book_eliminated_energy(struct run *run, const struct particle_record *record,
                                const double position[3])
{
    /* A block of one row with this particle in its first lane, through the same code. */
    const struct particle_layout *layout = &run->grid.layout;
    _Alignas(64) real values[PARTICLE_MAX_DOUBLES * LANE_COUNT] = {0};
    uint32_t ids[LANE_COUNT] = {record->id};
    uint16_t bodies[LANE_COUNT] = {record->body};
    struct particle_block block = {.row_count = 1,
                                   .row_capacity = 1,
                                   .lane_count = {1},
                                   .data = values,
                                   .id = ids,
                                   .body = layout->has_body ? bodies : NULL};
    for (size_t lane = 1; lane < LANE_COUNT; lane++)
        ids[lane] = PARTICLE_NONE;
    for (size_t component = 0; component < layout->double_count; component++)
        values[component * LANE_COUNT] = record->values[component];
    struct tile_sums sums = {0};
    measure_block(run, &block, &run->scratch[0], &sums);
    double potential = 0;
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        potential -= record->values[layout->first_component[PARTICLE_MASS]] *
                     run->scene.gravity[axis] * position[axis];
    run->energy.eliminated += sums.kinetic + sums.strain + potential;
    if (run->energy_step == run->step) {
        run->energy.kinetic -= sums.kinetic;
        run->energy.strain -= sums.strain;
        run->energy.potential -= potential;
    }
}

void run_open_books(struct run *run)
{
    run_measure_energy(run);
    run->audit.initial_stored = run->energy.kinetic + run->energy.strain;
    run->audit.initial_potential = run->energy.potential;
    run->audit.initial_energy = run->audit.initial_stored + run->energy.potential;
    run_measure_momentum(run, run->audit.initial_momentum, &run->audit.initial_mass);
}
