/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/probe_scan.h"

#include "simulation/simulation_private.h"
#include "state/wide_lanes.h"

#include <math.h>

/* Rounding of positions, in cells. */
#define COVER_MARGIN 1e-9

enum cover { COVER_NONE, COVER_SOME, COVER_ALL };

static bool is_geometry(const struct talus_probe *probe)
{
    return probe->kind == TALUS_PROBE_FRONT || probe->kind == TALUS_PROBE_HEIGHT ||
           probe->kind == TALUS_PROBE_EXTENT;
}

static bool wants_particles(const struct talus_probe *probe)
{
    return is_geometry(probe) || probe->kind == TALUS_PROBE_MASS ||
           probe->kind == TALUS_PROBE_CENTRE_OF_MASS || probe->kind == TALUS_PROBE_INTEGRAL;
}

static bool wants_extremes(const struct talus_probe *probe)
{
    return is_geometry(probe) && probe->measure == TALUS_MEASURE_PARTICLE;
}

/* The part of the block's cells that a probe may look at. */
static enum cover cover_within(const struct run *run, const struct talus_probe *probe,
                               const struct particle_block *block)
{
    const struct domain *domain = &run->grid.domain;
    enum cover cover = COVER_ALL;
    for (uint32_t axis = 0; axis < domain->axis_count; axis++) {
        const int32_t cells = axis == 0 ? LANE_COUNT : 1;
        const double margin = COVER_MARGIN * domain->cell[axis];
        const double low = domain_node_position(domain, axis, block->cell[axis]) - margin;
        const double high = domain_node_position(domain, axis, block->cell[axis] + cells) + margin;
        if (high < probe->within_min[axis] || low > probe->within_max[axis])
            return COVER_NONE;
        if (low < probe->within_min[axis] || high > probe->within_max[axis])
            cover = COVER_SOME;
    }
    return cover;
}

/* Distance of a probe's particles from the boundary that they lie on, at most [m]. */
static double reach_of_boundary(const struct run *run)
{
    return 0.5 * domain_smallest_cell(&run->grid.domain) * (1 + 1e-9);
}

/* No point of a block is nearer to a boundary than its centre less half its diagonal. */
static enum cover cover_boundary(const struct run *run, const struct talus_probe *probe,
                                 const struct particle_block *block)
{
    const struct domain *domain = &run->grid.domain;
    double centre[3] = {0, 0, 0}, square = 0;
    for (uint32_t axis = 0; axis < domain->axis_count; axis++) {
        const double half = 0.5 * (axis == 0 ? LANE_COUNT : 1) * domain->cell[axis];
        centre[axis] = domain_node_position(domain, axis, block->cell[axis]) + half;
        square += half * half;
    }
    const double distance = wall_set_distance(&run->walls, (size_t)probe->on_boundary, centre);
    const bool away =
        isfinite(distance) && distance > (reach_of_boundary(run) + sqrt(square)) * (1 + 1e-9);
    return away ? COVER_NONE : COVER_SOME;
}

static enum cover cover_of(const struct run *run, const struct talus_probe *probe,
                           const struct particle_block *block)
{
    if (block->row_count == 0 || (block->body == NULL && probe->body_index > 0))
        return COVER_NONE;
    enum cover cover = cover_within(run, probe, block);
    if (cover != COVER_NONE && probe->on_boundary >= 0)
        cover = cover_boundary(run, probe, block);
    if (cover == COVER_ALL && block->body != NULL && probe->body_index >= 0)
        cover = COVER_SOME;
    return cover;
}

static bool probe_selects(const struct run *run, const struct talus_probe *probe,
                          const struct particle_block *block, size_t slot, const double position[3])
{
    if (block->id[slot] == PARTICLE_NONE)
        return false;
    if (probe->body_index >= 0 && probe->body_index != (block->body ? block->body[slot] : 0))
        return false;
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        if (position[axis] < probe->within_min[axis] || position[axis] > probe->within_max[axis])
            return false;
    }
    return probe->on_boundary < 0 || wall_set_distance(&run->walls, (size_t)probe->on_boundary,
                                                       position) <= reach_of_boundary(run);
}

static double along_of(const struct talus_probe *probe, const double position[3])
{
    return position[0] * probe->along[0] + position[1] * probe->along[1] +
           position[2] * probe->along[2];
}

/* Half the edge of a cube, square or line of that volume. */
static double half_size(const struct run *run, double volume)
{
    const size_t axes = run->grid.domain.axis_count;
    return 0.5 * (axes == 1 ? volume : axes == 2 ? sqrt(volume) : cbrt(volume));
}

static void add_reach(const struct run *run, const struct particle_block *block, size_t slot,
                      double reach, struct probe_sums *sums)
{
    if (block->id[slot] == PARTICLE_NONE)
        return;
    const double half =
        half_size(run, particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0)[slot]);
    sums->low = reach - half < sums->low ? reach - half : sums->low;
    sums->high = reach + half > sums->high ? reach + half : sums->high;
}

static void add_particle(const struct run *run, const struct talus_probe *probe,
                         const struct particle_block *block, size_t slot, const double position[3],
                         struct probe_sums *sums)
{
    const struct particle_layout *layout = &run->grid.layout;
    const double mass = particle_values(layout, block, PARTICLE_MASS, 0)[slot];
    const double volume = particle_values(layout, block, PARTICLE_VOLUME, 0)[slot];
    sums->count++;
    sums->mass += mass;
    for (size_t axis = 0; axis < 3; axis++)
        sums->first[axis] += mass * position[axis];
    if (wants_extremes(probe)) {
        add_reach(run, block, slot, along_of(probe, position), sums);
    }
    if (probe->kind == TALUS_PROBE_INTEGRAL) {
        double values[9] = {0};
        field_values(run, block, slot, probe->field, values);
        for (size_t component = 0; component < field_components(probe->field); component++)
            sums->integral[component] += volume * values[component];
    }
}

static void add_selected(const struct run *run, const struct talus_probe *probe,
                         const struct particle_block *block, struct probe_sums *sums)
{
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
        double position[3];
        run_slot_position(run, block, slot, position);
        if (probe_selects(run, probe, block, slot, position))
            add_particle(run, probe, block, slot, position, sums);
    }
}

/* Where the cells of a block have their centres on an axis. */
static wide_lanes cell_centres(const struct run *run, const struct particle_block *block,
                               uint32_t axis)
{
    wide_lanes centre;
    for (int32_t lane = 0; lane < LANE_COUNT; lane++)
        centre[lane] =
            domain_position(&run->grid.domain, axis, block->cell[axis] + (axis == 0 ? lane : 0), 0);
    return centre;
}

/* Mass and first moments of a whole block. Empty slots have no mass. */
static void add_moments(const struct run *run, const struct particle_block *block,
                        struct probe_sums *sums)
{
    const struct particle_layout *layout = &run->grid.layout;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const real *mass = particle_values(layout, block, PARTICLE_MASS, 0);
    wide_lanes total = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT)
        total += lanes_widen(lanes_load(mass + slot));
    sums->mass += wide_lanes_sum(total);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const real *position = particle_values(layout, block, PARTICLE_POSITION, axis);
        wide_lanes moment = {0};
        for (size_t slot = 0; slot < count; slot += LANE_COUNT)
            moment +=
                lanes_widen(lanes_load(mass + slot)) * lanes_widen(lanes_load(position + slot));
        sums->first[axis] += wide_lanes_sum(total * cell_centres(run, block, axis) +
                                            run->grid.domain.cell[axis] * moment);
    }
    for (size_t lane = 0; lane < LANE_COUNT; lane++)
        sums->count += block->lane_count[lane];
}

/* x . along of a row of a block; `origin` is that of the centres of its cells. */
static wide_lanes reach_of_row(const struct run *run, const struct talus_probe *probe,
                               const struct particle_block *block, wide_lanes origin, size_t slot)
{
    wide_lanes reach = origin;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double slope = probe->along[axis] * run->grid.domain.cell[axis];
        if (slope != 0)
            reach +=
                slope *
                lanes_widen(lanes_load(
                    particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis) + slot));
    }
    return reach;
}

static double largest_volume(const struct run *run, const struct particle_block *block)
{
    const real *volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    wide_lanes largest = {0};
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot += LANE_COUNT)
        largest = wide_lanes_maximum(largest, lanes_widen(lanes_load(volume + slot)));
    return wide_lanes_largest(largest);
}

/* Extremes of a whole block: only those few particles are looked at one by one that reach beyond
 * what has been found if they are as large as the largest. */
static void add_extremes(const struct run *run, const struct talus_probe *probe,
                         const struct particle_block *block, struct probe_sums *sums)
{
    const double half = half_size(run, largest_volume(run, block)) * (1 + 1e-12);
    wide_lanes origin = {0};
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        origin += probe->along[axis] * cell_centres(run, block, axis);
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot += LANE_COUNT) {
        const wide_lanes reach = reach_of_row(run, probe, block, origin, slot);
        const wide_mask beyond = (reach + half > sums->high) | (reach - half < sums->low);
        for (size_t lane = 0; wide_lanes_any(beyond) && lane < LANE_COUNT; lane++)
            add_reach(run, block, slot + lane, reach[lane], sums);
    }
    for (size_t lane = 0; lane < LANE_COUNT; lane++)
        sums->count += block->lane_count[lane];
}

static void add_block(const struct run *run, const struct talus_probe *probe,
                      const struct particle_block *block, struct probe_sums *sums)
{
    const enum cover cover = cover_of(run, probe, block);
    if (cover == COVER_NONE)
        return;
    if (cover == COVER_SOME || probe->kind == TALUS_PROBE_INTEGRAL)
        add_selected(run, probe, block, sums);
    else if (wants_extremes(probe))
        add_extremes(run, probe, block, sums);
    else
        add_moments(run, block, sums);
}

void probe_scan(const struct run *run, struct probe_sums *sums)
{
    for (size_t probe = 0; probe < run->scene.probe_count; probe++)
        sums[probe] = (struct probe_sums){.low = INFINITY, .high = -INFINITY};
    for (size_t index = 0; index < run->grid.block_count; index++) {
        for (size_t probe = 0; probe < run->scene.probe_count; probe++) {
            if (wants_particles(&run->scene.probes[probe]))
                add_block(run, &run->scene.probes[probe], &run->grid.blocks[index], &sums[probe]);
        }
    }
}

double probe_scan_spread(const struct run *run, const struct talus_probe *probe, double mean)
{
    double spread = 0;
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        if (cover_of(run, probe, block) == COVER_NONE)
            continue;
        const real *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            double position[3];
            run_slot_position(run, block, slot, position);
            if (probe_selects(run, probe, block, slot, position))
                spread += (double)mass[slot] * fabs(along_of(probe, position) - mean);
        }
    }
    return spread;
}
