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

/* Half the edge of a cube, square or line of that volume. */
static double half_size(const struct run *run, double volume)
{
    const size_t axes = run->grid.domain.axis_count;
    return 0.5 * (axes == 1 ? volume : axes == 2 ? sqrt(volume) : cbrt(volume));
}

/* Where the particles of a row are on an axis. */
static wide_lanes row_position(const struct run *run, const struct particle_block *block,
                               uint32_t axis, size_t slot)
{
    const struct domain *domain = &run->grid.domain;
    const real *position = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis);
    const double first = domain_position(domain, axis, block->cell[axis], 0);
    const double step = axis == 0 ? domain->cell[axis] : 0;
    wide_lanes centre;
    for (int32_t lane = 0; lane < LANE_COUNT; lane++)
        centre[lane] = first + lane * step;
    return centre + domain->cell[axis] * lanes_widen(lanes_load(position + slot));
}

/* from . x of a row: along a probe, or along the normal of a plane. */
static wide_lanes row_along(const struct run *run, const struct particle_block *block,
                            const double direction[3], size_t slot)
{
    wide_lanes sum = {0};
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        if (direction[axis] != 0)
            sum += direction[axis] * row_position(run, block, axis, slot);
    }
    return sum;
}

/* Which particles of a row lie on the boundary of a probe. */
static wide_mask row_on_boundary(const struct run *run, const struct talus_probe *probe,
                                 const struct particle_block *block, size_t slot)
{
    const struct wall_shape *shape = &run->walls.shapes[probe->on_boundary];
    const double reach = reach_of_boundary(run);
    if (shape->kind == TALUS_BOUNDARY_PLANE) {
        const wide_lanes distance =
            row_along(run, block, shape->normal, slot) -
            (shape->normal[0] * shape->point[0] + shape->normal[1] * shape->point[1] +
             shape->normal[2] * shape->point[2]);
        return (distance <= reach) & (distance >= -reach);
    }
    wide_mask mask;
    for (size_t lane = 0; lane < LANE_COUNT; lane++) {
        double position[3];
        run_slot_position(run, block, slot + lane, position);
        mask[lane] =
            -(wall_set_distance(&run->walls, (size_t)probe->on_boundary, position) <= reach);
    }
    return mask;
}

/* Which slots of a row a probe selects; empty ones may be among them. */
static wide_mask row_selected(const struct run *run, const struct talus_probe *probe,
                              const struct particle_block *block, size_t slot, enum cover cover)
{
    wide_mask mask = ~(wide_mask){0};
    if (cover == COVER_ALL)
        return mask;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const wide_lanes position = row_position(run, block, axis, slot);
        mask &= (position >= probe->within_min[axis]) & (position <= probe->within_max[axis]);
    }
    for (size_t lane = 0; block->body != NULL && probe->body_index >= 0 && lane < LANE_COUNT;
         lane++)
        mask[lane] &= -(int64_t)(block->body[slot + lane] == probe->body_index);
    if (probe->on_boundary >= 0 && wide_lanes_any(mask))
        mask &= row_on_boundary(run, probe, block, slot);
    return mask;
}

/* Mass and first moments. Empty slots have no mass. */
static void add_moments(const struct run *run, const struct talus_probe *probe,
                        const struct particle_block *block, enum cover cover,
                        struct probe_sums *sums)
{
    const real *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
    wide_lanes total = {0}, first[3] = {{0}, {0}, {0}};
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot += LANE_COUNT) {
        const wide_mask mask = row_selected(run, probe, block, slot, cover);
        if (!wide_lanes_any(mask))
            continue;
        const wide_lanes m = wide_lanes_keep(mask, lanes_widen(lanes_load(mass + slot)));
        total += m;
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            first[axis] += m * row_position(run, block, axis, slot);
    }
    sums->mass += wide_lanes_sum(total);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        sums->first[axis] += wide_lanes_sum(first[axis]);
}

static double largest_volume(const struct run *run, const struct particle_block *block)
{
    const real *volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    wide_lanes largest = {0};
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot += LANE_COUNT)
        largest = wide_lanes_maximum(largest, lanes_widen(lanes_load(volume + slot)));
    return wide_lanes_largest(largest);
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

/* Only those few particles are looked at one by one that reach beyond what has been found if they
 * are as large as the largest of the block. */
static void add_extremes(const struct run *run, const struct talus_probe *probe,
                         const struct particle_block *block, enum cover cover,
                         struct probe_sums *sums)
{
    const double half = half_size(run, largest_volume(run, block)) * (1 + 1e-12);
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot += LANE_COUNT) {
        const wide_lanes reach = row_along(run, block, probe->along, slot);
        wide_mask beyond = (reach + half > sums->high) | (reach - half < sums->low);
        if (wide_lanes_any(beyond))
            beyond &= row_selected(run, probe, block, slot, cover);
        for (size_t lane = 0; wide_lanes_any(beyond) && lane < LANE_COUNT; lane++) {
            if (beyond[lane] != 0)
                add_reach(run, block, slot + lane, reach[lane], sums);
        }
    }
}

static void add_integral(const struct run *run, const struct talus_probe *probe,
                         const struct particle_block *block, enum cover cover,
                         struct probe_sums *sums)
{
    const real *volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    const size_t components = field_components(probe->field);
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
        const size_t lane = slot % LANE_COUNT;
        if (block->id[slot] == PARTICLE_NONE ||
            row_selected(run, probe, block, slot - lane, cover)[lane] == 0)
            continue;
        double values[9] = {0};
        field_values(run, block, slot, probe->field, values);
        for (size_t component = 0; component < components; component++)
            sums->integral[component] += (double)volume[slot] * values[component];
    }
}

static void add_block(const struct run *run, const struct talus_probe *probe,
                      const struct particle_block *block, struct probe_sums *sums)
{
    const enum cover cover = cover_of(run, probe, block);
    if (cover == COVER_NONE)
        return;
    if (probe->kind == TALUS_PROBE_INTEGRAL)
        add_integral(run, probe, block, cover, sums);
    else if (wants_extremes(probe))
        add_extremes(run, probe, block, cover, sums);
    else
        add_moments(run, probe, block, cover, sums);
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
    wide_lanes spread = {0};
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        const enum cover cover = cover_of(run, probe, block);
        if (cover == COVER_NONE)
            continue;
        const real *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot += LANE_COUNT) {
            const wide_mask mask = row_selected(run, probe, block, slot, cover);
            const wide_lanes away = row_along(run, block, probe->along, slot) - mean;
            spread += wide_lanes_keep(mask, lanes_widen(lanes_load(mass + slot))) *
                      wide_lanes_maximum(away, -away);
        }
    }
    return wide_lanes_sum(spread);
}
