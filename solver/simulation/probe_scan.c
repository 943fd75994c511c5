/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/probe_scan.h"

#include "simulation/simulation_private.h"
#include "state/wide_lanes.h"

#include <math.h>

/* Rounding of positions, in cells. */
#define COVER_MARGIN 1e-9

/* What must still be asked of the particles of a block, as bits. */
enum question { ASK_PLACE = 1, ASK_BOUNDARY = 2, ASK_BODY = 4 };

/* A block as probes read it. */
struct view {
    const struct run *run;
    const struct particle_block *block;
    size_t axis_count, slot_count;
    double boundary_reach; /* distance of particles that are "on" a boundary, at most [m] */
    wide_lanes centre[3];  /* of the cells, by lane [m] */
    double width[3];       /* of a cell [m] */
    const real *position[3], *mass, *volume;
};

/* What a probe looks at in a block. */
struct look {
    const struct talus_probe *probe;
    const struct view *view;
    unsigned questions;
    const struct wall_shape *plane; /* that its particles lie on; NULL: another kind of boundary */
    double plane_offset;            /* normal . point [m] */
    struct probe_sums *sums;
};

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

static void view_block(const struct run *run, const struct particle_block *block, struct view *view)
{
    const struct particle_layout *layout = &run->grid.layout;
    const struct domain *domain = &run->grid.domain;
    view->run = run;
    view->block = block;
    view->axis_count = domain->axis_count;
    view->boundary_reach = 0.5 * domain_smallest_cell(domain) * (1 + 1e-9);
    view->slot_count = (size_t)block->row_count * LANE_COUNT;
    view->mass = particle_values(layout, block, PARTICLE_MASS, 0);
    view->volume = particle_values(layout, block, PARTICLE_VOLUME, 0);
    for (uint32_t axis = 0; axis < domain->axis_count; axis++) {
        const double first = domain_position(domain, axis, block->cell[axis], 0);
        view->width[axis] = domain->cell[axis];
        view->position[axis] = particle_values(layout, block, PARTICLE_POSITION, axis);
        for (int32_t lane = 0; lane < LANE_COUNT; lane++)
            view->centre[axis][lane] = first + (axis == 0 ? lane * domain->cell[0] : 0);
    }
}

/* False if the block lies outside of what the probe looks at. */
static bool meets_place(const struct view *view, const struct talus_probe *probe,
                        unsigned *questions)
{
    for (size_t axis = 0; axis < view->axis_count; axis++) {
        const double half = (0.5 + COVER_MARGIN) * view->width[axis];
        const double low = view->centre[axis][0] - half;
        const double high = view->centre[axis][LANE_COUNT - 1] + half;
        if (high < probe->within_min[axis] || low > probe->within_max[axis])
            return false;
        if (low < probe->within_min[axis] || high > probe->within_max[axis])
            *questions |= ASK_PLACE;
    }
    return true;
}

/* No point of a block is nearer to a boundary than its centre less half its diagonal. */
static bool meets_boundary(const struct view *view, const struct talus_probe *probe)
{
    double centre[3] = {0, 0, 0}, square = 0;
    for (size_t axis = 0; axis < view->axis_count; axis++) {
        const double low = view->centre[axis][0], high = view->centre[axis][LANE_COUNT - 1];
        const double half = 0.5 * (high - low + view->width[axis]);
        centre[axis] = 0.5 * (low + high);
        square += half * half;
    }
    const struct run *run = view->run;
    const double distance = wall_set_distance(&run->walls, (size_t)probe->on_boundary, centre);
    return !isfinite(distance) || distance <= (view->boundary_reach + sqrt(square)) * (1 + 1e-9);
}

/* What a probe must ask of the particles of a block; false if it need not look. */
static bool look_at(const struct view *view, const struct talus_probe *probe, struct look *look)
{
    const bool several = view->block->body != NULL;
    *look = (struct look){.probe = probe, .view = view};
    if (!several && probe->body_index > 0)
        return false;
    if (several && probe->body_index >= 0)
        look->questions |= ASK_BODY;
    if (!meets_place(view, probe, &look->questions))
        return false;
    if (probe->on_boundary < 0)
        return true;
    const struct wall_shape *shape = &view->run->walls.shapes[probe->on_boundary];
    look->questions |= ASK_BOUNDARY;
    if (shape->kind == TALUS_BOUNDARY_PLANE)
        look->plane = shape;
    look->plane_offset = shape->normal[0] * shape->point[0] + shape->normal[1] * shape->point[1] +
                         shape->normal[2] * shape->point[2];
    return meets_boundary(view, probe);
}

/* Half the edge of a cube, square or line of that volume. */
static double half_size(const struct run *run, double volume)
{
    const size_t axes = run->grid.domain.axis_count;
    return 0.5 * (axes == 1 ? volume : axes == 2 ? sqrt(volume) : cbrt(volume));
}

/* Where the particles of a row are on an axis [m]. */
static wide_lanes row_position(const struct view *view, size_t axis, size_t slot)
{
    return view->centre[axis] +
           view->width[axis] * lanes_widen(lanes_load(view->position[axis] + slot));
}

/* direction . x of a row: along a probe, or along the normal of a plane. */
static wide_lanes row_along(const struct view *view, const double direction[3], size_t slot)
{
    wide_lanes sum = {0};
    for (size_t axis = 0; axis < view->axis_count; axis++) {
        if (direction[axis] != 0)
            sum += direction[axis] * row_position(view, axis, slot);
    }
    return sum;
}

/* Which particles of a row lie on the boundary of a probe. */
static wide_mask row_on_boundary(const struct look *look, size_t slot)
{
    const struct view *view = look->view;
    const double reach = view->boundary_reach;
    if (look->plane != NULL) {
        const wide_lanes distance = row_along(view, look->plane->normal, slot) - look->plane_offset;
        return (distance <= reach) & (distance >= -reach);
    }
    wide_mask mask;
    for (size_t lane = 0; lane < LANE_COUNT; lane++) {
        double position[3];
        run_slot_position(view->run, view->block, slot + lane, position);
        mask[lane] = -(wall_set_distance(&view->run->walls, (size_t)look->probe->on_boundary,
                                         position) <= reach);
    }
    return mask;
}

/* Which slots of a row a probe selects; empty ones may be among them. */
static inline wide_mask row_selected(const struct look *look, size_t slot)
{
    if (look->questions == 0)
        return ~(wide_mask){0};
    const struct talus_probe *probe = look->probe;
    const struct view *view = look->view;
    wide_mask mask = ~(wide_mask){0};
    for (size_t axis = 0; (look->questions & ASK_PLACE) != 0 && axis < view->axis_count; axis++) {
        const wide_lanes position = row_position(view, axis, slot);
        mask &= (position >= probe->within_min[axis]) & (position <= probe->within_max[axis]);
    }
    for (size_t lane = 0; (look->questions & ASK_BODY) != 0 && lane < LANE_COUNT; lane++)
        mask[lane] &= -(int64_t)(view->block->body[slot + lane] == probe->body_index);
    if ((look->questions & ASK_BOUNDARY) != 0)
        mask &= row_on_boundary(look, slot);
    return mask;
}

/* Mass and first moments. Empty slots have no mass. */
static void add_moments(const struct look *look)
{
    const struct view *view = look->view;
    wide_lanes total = {0}, first[3] = {{0}, {0}, {0}};
    for (size_t slot = 0; slot < view->slot_count; slot += LANE_COUNT) {
        const wide_mask mask = row_selected(look, slot);
        const wide_lanes m = wide_lanes_keep(mask, lanes_widen(lanes_load(view->mass + slot)));
        total += m;
        for (size_t axis = 0; axis < view->axis_count; axis++)
            first[axis] += m * row_position(view, axis, slot);
    }
    look->sums->mass += wide_lanes_sum(total);
    for (size_t axis = 0; axis < view->axis_count; axis++)
        look->sums->first[axis] += wide_lanes_sum(first[axis]);
}

static double largest_volume(const struct view *view)
{
    wide_lanes largest = {0};
    for (size_t slot = 0; slot < view->slot_count; slot += LANE_COUNT)
        largest = wide_lanes_maximum(largest, lanes_widen(lanes_load(view->volume + slot)));
    return wide_lanes_largest(largest);
}

static void add_reach(const struct look *look, size_t slot, double reach)
{
    struct probe_sums *sums = look->sums;
    if (look->view->block->id[slot] == PARTICLE_NONE)
        return;
    const double half = half_size(look->view->run, look->view->volume[slot]);
    sums->low = reach - half < sums->low ? reach - half : sums->low;
    sums->high = reach + half > sums->high ? reach + half : sums->high;
}

/* True if a particle anywhere in the block would reach beyond what has been found. */
static bool block_reaches(const struct look *look, double half)
{
    const struct view *view = look->view;
    double low = -half, high = half;
    for (size_t axis = 0; axis < view->axis_count; axis++) {
        const double edge = (0.5 + COVER_MARGIN) * view->width[axis];
        const double one = look->probe->along[axis] * (view->centre[axis][0] - edge);
        const double other = look->probe->along[axis] * (view->centre[axis][LANE_COUNT - 1] + edge);
        low += one < other ? one : other;
        high += one < other ? other : one;
    }
    return high > look->sums->high || low < look->sums->low;
}

/* Only those few particles are looked at one by one that reach beyond what has been found if they
 * are as large as the largest of the block. */
static void add_extremes(const struct look *look)
{
    const struct view *view = look->view;
    const struct probe_sums *sums = look->sums;
    const double half = half_size(view->run, largest_volume(view)) * (1 + 1e-12);
    if (!block_reaches(look, half))
        return;
    for (size_t slot = 0; slot < view->slot_count; slot += LANE_COUNT) {
        const wide_lanes reach = row_along(view, look->probe->along, slot);
        wide_mask beyond = (reach + half > sums->high) | (reach - half < sums->low);
        if (!wide_lanes_any(beyond))
            continue;
        beyond &= row_selected(look, slot);
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            if (beyond[lane] != 0)
                add_reach(look, slot + lane, reach[lane]);
        }
    }
}

static void add_integral(const struct look *look)
{
    const struct view *view = look->view;
    const size_t components = field_components(look->probe->field);
    for (size_t slot = 0; slot < view->slot_count; slot++) {
        const size_t lane = slot % LANE_COUNT;
        if (view->block->id[slot] == PARTICLE_NONE || row_selected(look, slot - lane)[lane] == 0)
            continue;
        double values[9] = {0};
        field_values(view->run, view->block, slot, look->probe->field, values);
        for (size_t component = 0; component < components; component++)
            look->sums->integral[component] += (double)view->volume[slot] * values[component];
    }
}

static void add_block(const struct view *view, const struct talus_probe *probe,
                      struct probe_sums *sums)
{
    struct look look;
    if (!look_at(view, probe, &look))
        return;
    look.sums = sums;
    if (probe->kind == TALUS_PROBE_INTEGRAL)
        add_integral(&look);
    else if (wants_extremes(probe))
        add_extremes(&look);
    else
        add_moments(&look);
}

void probe_scan(const struct run *run, struct probe_sums *sums)
{
    bool any = false;
    for (size_t probe = 0; probe < run->scene.probe_count; probe++) {
        const bool extent = run->scene.probes[probe].kind == TALUS_PROBE_EXTENT;
        sums[probe] = (struct probe_sums){.low = extent ? INFINITY : -INFINITY, .high = -INFINITY};
        any = any || wants_particles(&run->scene.probes[probe]);
    }
    for (size_t index = 0; any && index < run->grid.block_count; index++) {
        struct view view;
        if (run->grid.blocks[index].row_count == 0)
            continue;
        view_block(run, &run->grid.blocks[index], &view);
        for (size_t probe = 0; probe < run->scene.probe_count; probe++) {
            if (wants_particles(&run->scene.probes[probe]))
                add_block(&view, &run->scene.probes[probe], &sums[probe]);
        }
    }
}

double probe_scan_spread(const struct run *run, const struct talus_probe *probe, double mean)
{
    wide_lanes spread = {0};
    for (size_t index = 0; index < run->grid.block_count; index++) {
        struct view view;
        struct look look;
        if (run->grid.blocks[index].row_count == 0)
            continue;
        view_block(run, &run->grid.blocks[index], &view);
        if (!look_at(&view, probe, &look))
            continue;
        for (size_t slot = 0; slot < view.slot_count; slot += LANE_COUNT) {
            const wide_lanes away = row_along(&view, probe->along, slot) - mean;
            const wide_lanes m = lanes_widen(lanes_load(view.mass + slot));
            spread +=
                wide_lanes_keep(row_selected(&look, slot), m) * wide_lanes_maximum(away, -away);
        }
    }
    return wide_lanes_sum(spread);
}
