/* SPDX-License-Identifier: Apache-2.0 */
/* The second pass: one block from gather to scatter, stage by stage through scratch. */
#include "explicit/kinematics.h"
#include "explicit/material_stage.h"
#include "explicit/run.h"
#include "math/sticky.h"

#include <math.h>
#include <string.h>

static void clear_gradient(const struct run *run, struct block_scratch *scratch, size_t count)
{
    for (size_t component = 0; component < 9; component++)
        memset(scratch->gradient[component], 0, count * sizeof(double));
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        memset(scratch->velocity[axis], 0, count * sizeof(double));
}

/* The PIC share of a step, 1 - exp(-lambda dt), independent of the step. */
static void blend_velocity(const struct run *run, const struct particle_block *block,
                           const struct block_scratch *scratch, size_t count)
{
    const double share = -expm1(-run->scene.solver.pic_rate * run->time_step);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        double *velocity = particle_values(&run->grid.layout, block, PARTICLE_VELOCITY, axis);
        for (size_t i = 0; i < count; i++)
            velocity[i] += share * (scratch->velocity[axis][i] - velocity[i]);
    }
}

/* Bulk viscosity of the damping: sigma = C rho h c_b tr d on the diagonal, in the nodal forces only
 * (Mast 2013, sec. B.2.3 names the option without its formula; this is the usual linear one). */
static void force_stresses(const struct run *run, const struct particle_block *block,
                           struct block_scratch *scratch, size_t count, struct tile_sums *sums)
{
    const double damping = run->scene.solver.viscous_damping;
    const double width = domain_smallest_cell(&run->grid.domain);
    double plastic = 0, viscous = 0;
    for (size_t component = 0; component < run->strain_components; component++) {
        const double *restrict stress = scratch->stress[component];
        double *restrict out = scratch->force_stress[component];
        const double *restrict volume = scratch->reference_volume;
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            out[i] = volume[i] * stress[i];
    }
    for (size_t i = 0; damping > 0 && i < count; i++) {
        const struct run_material *material = &run->materials[material_of_slot(run, block, i)];
        const double viscosity = damping * material->density * width * material->bulk_speed;
        const double q = scratch->reference_volume[i] * viscosity * scratch->divergence[i];
        for (size_t component = 0; component < 3; component++)
            scratch->force_stress[component][i] += q;
        viscous += q * scratch->divergence[i] * run->time_step;
    }
    /* Plain order: the sum must not depend on the vector width. */
    for (size_t i = 0; i < count; i++)
        plastic += scratch->reference_volume[i] * scratch->dissipation[i];
    sums->plastic_energy += plastic;
    sums->viscous_energy += viscous;
}

static void record_fields(const struct run *run, const struct particle_block *block,
                          const struct block_scratch *scratch, size_t count)
{
    const struct particle_layout *layout = &run->grid.layout;
    for (uint32_t component = 0; component < layout->component_count[PARTICLE_STRESS]; component++)
        memcpy(particle_values(layout, block, PARTICLE_STRESS, component),
               scratch->stress[component], count * sizeof(double));
    if (layout->component_count[PARTICLE_PLASTIC_STRAIN] > 0) {
        double *total = particle_values(layout, block, PARTICLE_PLASTIC_STRAIN, 0);
        for (size_t i = 0; i < count; i++)
            total[i] += scratch->plastic_strain[i];
    }
    for (uint32_t axis = 0; axis < layout->component_count[PARTICLE_DISPLACEMENT]; axis++) {
        double *displacement = particle_values(layout, block, PARTICLE_DISPLACEMENT, axis);
        for (size_t i = 0; i < count; i++)
            displacement[i] += run->time_step * scratch->velocity[axis][i];
    }
}

/* Moves the particles with the grid velocity; returns the largest |relative position|. NAN passes
 * through, so that health can find it. */
static double move(const struct run *run, const struct particle_block *block,
                   const struct block_scratch *scratch, size_t count)
{
    lanes largest = {0};
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        double *position = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis);
        const double scale = run->time_step * run->grid.domain.inverse_cell[axis];
        for (size_t i = 0; i < count; i += LANE_COUNT) {
            const lanes x =
                lanes_load(position + i) + scale * lanes_load(scratch->velocity[axis] + i);
            lanes_store(position + i, x);
            const lanes size = lanes_absolute(x);
            largest = lanes_sticky_maximum(largest, size);
        }
    }
    double result = 0;
    for (size_t lane = 0; lane < LANE_COUNT; lane++)
        result = sticky_maximum(result, largest[lane]);
    return result;
}

static bool is_eliminated(const struct run *run, const struct particle_block *block, size_t slot)
{
    const struct domain *domain = &run->grid.domain;
    double position[3] = {0, 0, 0};
    for (uint32_t axis = 0; axis < domain->axis_count; axis++) {
        const int32_t cell = block->cell[axis] + (axis == 0 ? (int32_t)(slot % LANE_COUNT) : 0);
        position[axis] = domain_position(
            domain, axis, cell,
            particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis)[slot]);
    }
    return wall_set_eliminates(&run->walls, position, block->body == NULL ? 0 : block->body[slot]);
}

/* Puts the particles that left their cells into the outbox; they scatter after they have moved. */
static void collect_crossers(struct run *run, const struct particle_block *block,
                             uint32_t block_index, struct block_scratch *scratch, size_t count,
                             struct tile *tile)
{
    for (size_t slot = 0; slot < count; slot++) {
        if (block->id[slot] == PARTICLE_NONE)
            continue;
        bool inside = true;
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            inside = inside && fabs(particle_values(&run->grid.layout, block, PARTICLE_POSITION,
                                                    axis)[slot]) <= 0.5;
        const bool eliminated = block->eliminates && is_eliminated(run, block, slot);
        if (inside && !eliminated)
            continue;
        struct outbox_record *record = &run->outbox[tile->outbox_begin + tile->outbox_count++];
        record->block = block_index;
        record->slot = (uint32_t)slot;
        record->eliminated = eliminated;
        memset(record->force_stress, 0, sizeof record->force_stress);
        for (size_t component = 0; component < run->strain_components; component++) {
            record->force_stress[component] = scratch->force_stress[component][slot];
            scratch->force_stress[component][slot] = 0;
        }
        scratch->mass[slot] = 0;
    }
}

static double largest_speed_squared(const struct run *run, const struct particle_block *block,
                                    size_t count)
{
    lanes largest = {0};
    for (size_t i = 0; i < count; i += LANE_COUNT) {
        lanes square = {0};
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
            const lanes v =
                lanes_load(particle_values(&run->grid.layout, block, PARTICLE_VELOCITY, axis) + i);
            square += v * v;
        }
        largest = lanes_sticky_maximum(largest, square);
    }
    double result = 0;
    for (size_t lane = 0; lane < LANE_COUNT; lane++)
        result = sticky_maximum(result, largest[lane]);
    return result;
}

void run_advance_block(struct run *run, struct block_scratch *scratch, uint32_t block_index,
                       struct tile *tile, struct tile_sums *sums, bool still)
{
    struct particle_block *block = &run->grid.blocks[block_index];
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    if (count == 0)
        return;
    const struct shape_context context = run_shape_context(run);
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    const bool corrects = last || block->constrained || run->scene.solver.local_damping > 0;
    if (still) {
        clear_gradient(run, scratch, count);
    } else {
        run->kernels->gather(&context, block, corrects, scratch);
        if (run->scene.solver.pic_rate > 0)
            blend_velocity(run, block, scratch, count);
    }
    const double time_step = still ? 0.0 : run->time_step;
    const double jacobian = kinematics_advance(run, block, scratch, time_step);
    if (!(jacobian > 0) && sums->bad_particle == PARTICLE_NONE)
        sums->bad_particle = block->id[scratch->bad_slot];
    sums->least_jacobian = sticky_minimum(sums->least_jacobian, jacobian);
    material_stage_run(run, block, scratch, time_step);
    kinematics_store(run, block, scratch);
    force_stresses(run, block, scratch, count, sums);
    record_fields(run, block, scratch, count);
    const double reach = still ? 0.0 : move(run, block, scratch, count);
    memcpy(scratch->mass, particle_values(&run->grid.layout, block, PARTICLE_MASS, 0),
           count * sizeof(double));
    if (!still && (block->eliminates || !(reach <= 0.5)))
        collect_crossers(run, block, block_index, scratch, count, tile);
    const double speed = largest_speed_squared(run, block, count);
    sums->speed_squared = sticky_maximum(sums->speed_squared, speed);
    run->kernels->scatter(&context, block, scratch, last);
}
