/* SPDX-License-Identifier: Apache-2.0 */
#include "explicit/out_of_plane.h"

#include "math/log1p_series.h"
#include "state/wide_lanes.h"

/* Particles nearer to the axis count as this far from it, in cells: what they share with the axis
 * is of no weight, and rounding would take the place of their radius. */
#define LEAST_RADIUS (real)1e-4

/* Distance of the particles of a row from the axis, in cells. */
static lanes radius_at(const struct run *run, const struct particle_block *block,
                       const real *position, size_t slot)
{
    const struct domain *domain = &run->grid.domain;
    lanes centre;
    for (int32_t lane = 0; lane < LANE_COUNT; lane++)
        centre[lane] =
            (real)(domain_position(domain, 0, block->cell[0] + lane, 0) * domain->inverse_cell[0]);
    return lanes_maximum(centre + lanes_load(position + slot), lanes_splat(LEAST_RADIUS));
}

static void hoop_increment(struct run *run, const struct particle_block *block,
                           struct block_scratch *scratch, size_t count, double time_step)
{
    const struct shape_context context = run_shape_context(run, time_step);
    const real *position = particle_values(&run->grid.layout, block, PARTICLE_POSITION, 0);
    real *increment = scratch->gradient[GRADIENT_ZZ];
    run->kernels->gather_values(&context, block, 1, (real *const[]){increment},
                                run->grid.nodes.layout.velocity);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT)
        lanes_store(increment + slot, context.displacement[0] * lanes_load(increment + slot) /
                                          radius_at(run, block, position, slot));
}

static real thinning_at(const struct run *run, const struct particle_block *block, size_t slot)
{
    return (real)run->materials[material_of_slot(run, block, slot)].thinning;
}

static void free_increment(const struct run *run, const struct particle_block *block,
                           struct block_scratch *scratch, size_t count)
{
    real *increment = scratch->gradient[GRADIENT_ZZ];
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes xx = lanes_load(scratch->gradient[0] + slot);
        const lanes yy = lanes_load(scratch->gradient[4] + slot);
        lanes grown = xx + yy;
        if (run->finite_strain)
            grown += xx * yy - lanes_load(scratch->gradient[1] + slot) *
                                   lanes_load(scratch->gradient[3] + slot);
        lanes_store(increment + slot, grown);
    }
    if (run->finite_strain)
        log1p_array(count, increment, increment);
    for (size_t slot = 0; slot < count; slot++)
        increment[slot] *= -thinning_at(run, block, slot);
    if (run->finite_strain)
        expm1_array(count, increment, increment);
}

void out_of_plane_increment(struct run *run, const struct particle_block *block,
                            struct block_scratch *scratch, size_t count, double time_step)
{
    if (run->grid.domain.revolves)
        hoop_increment(run, block, scratch, count, time_step);
    else
        free_increment(run, block, scratch, count);
}

void out_of_plane_strain(const struct run *run, const struct particle_block *block,
                         struct block_scratch *scratch, size_t count)
{
    for (size_t slot = 0; slot < count; slot++)
        scratch->strain[2][slot] =
            -thinning_at(run, block, slot) * (scratch->strain[0][slot] + scratch->strain[1][slot]);
}

double hoop_scatter(struct run *run, const struct particle_block *block,
                    const struct scatter_source *source, struct block_scratch *scratch)
{
    const struct shape_context context = run_shape_context(run, run->time_step);
    const real *position = particle_values(&run->grid.layout, block, PARTICLE_POSITION, 0);
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const real inverse_cell = context.inverse_cell[0];
    wide_lanes sum = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes hoop = lanes_load(source->volume + slot) * lanes_load(source->stress[2] + slot);
        const lanes force = -inverse_cell * hoop / radius_at(run, block, position, slot);
        lanes_store(scratch->weight + slot, force);
        sum += lanes_widen(force);
    }
    run->kernels->scatter_values(&context, block, scratch->weight, 1, (const real *const[]){NULL},
                                 run->grid.nodes.layout.force);
    return wide_lanes_sum(sum);
}

double hoop_scatter_one(struct run *run, const struct particle_block *block, size_t slot, real hoop)
{
    /* The row of the slot as a block of its own. */
    const size_t lane = slot % LANE_COUNT, row = slot - lane;
    struct particle_block view = *block;
    view.row_count = 1;
    view.data += row;
    view.id += row;
    if (view.body != NULL)
        view.body += row;
    const struct shape_context context = run_shape_context(run, run->time_step);
    const real *position = particle_values(&run->grid.layout, &view, PARTICLE_POSITION, 0);
    _Alignas(lanes) real weight[LANE_COUNT] = {0};
    weight[lane] = -context.inverse_cell[0] * hoop / radius_at(run, &view, position, 0)[lane];
    run->kernels->scatter_values(&context, &view, weight, 1, (const real *const[]){NULL},
                                 run->grid.nodes.layout.force);
    return (double)weight[lane];
}
