/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/probe_scan.h"

#include "base/inline.h"
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
    double half; /* of its largest particle, in each direction [m]; below 0: not looked for yet */
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
    view->half = -1;
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

/* Half the edge of a cube, square or line of that volume, or of the square that makes it in going
 * around the axis at that x. */
static double half_size(const struct run *run, double volume, double x)
{
    const size_t axes = run->grid.domain.axis_count;
    const double size = volume / domain_circle(&run->grid.domain, x);
    return 0.5 * (axes == 1 ? size : axes == 2 ? sqrt(size) : cbrt(size));
}

/* Where the particles of a row are [m]; 0 on axes that the domain lacks. */
struct row {
    size_t slot;
    wide_lanes position[3];
};

TALUS_INLINE struct row row_at(const struct view *view, size_t axis_count, size_t slot)
{
    struct row row = {.slot = slot};
    for (size_t axis = 0; axis < axis_count; axis++)
        row.position[axis] =
            view->centre[axis] +
            view->width[axis] * lanes_widen(lanes_load(view->position[axis] + slot));
    return row;
}

/* direction . x of a row: along a probe, or along the normal of a plane. */
TALUS_INLINE wide_lanes row_along(const struct row *row, size_t axis_count,
                                  const double direction[3])
{
    wide_lanes sum = {0};
    for (size_t axis = 0; axis < axis_count; axis++)
        sum += direction[axis] * row->position[axis];
    return sum;
}

/* Which particles of a row lie on a boundary that is no plane. */
static wide_mask row_on_shape(const struct look *look, size_t slot)
{
    const struct view *view = look->view;
    wide_mask mask;
    for (size_t lane = 0; lane < LANE_COUNT; lane++) {
        double position[3];
        sparse_grid_slot_position(&view->run->grid, view->block, slot + lane, position);
        mask[lane] = -(wall_set_distance(&view->run->walls, (size_t)look->probe->on_boundary,
                                         position) <= view->boundary_reach);
    }
    return mask;
}

/* Which slots of a row a probe selects; empty ones may be among them. */
TALUS_INLINE wide_mask row_selected(const struct look *look, size_t axis_count,
                                    const struct row *row)
{
    const struct talus_probe *probe = look->probe;
    wide_mask mask = ~(wide_mask){0};
    for (size_t axis = 0; (look->questions & ASK_PLACE) != 0 && axis < axis_count; axis++)
        mask &= (row->position[axis] >= probe->within_min[axis]) &
                (row->position[axis] <= probe->within_max[axis]);
    for (size_t lane = 0; (look->questions & ASK_BODY) != 0 && lane < LANE_COUNT; lane++)
        mask[lane] &= -(int64_t)(look->view->block->body[row->slot + lane] == probe->body_index);
    if ((look->questions & ASK_BOUNDARY) == 0)
        return mask;
    if (look->plane == NULL)
        return mask & row_on_shape(look, row->slot);
    const double reach = look->view->boundary_reach;
    const wide_lanes distance =
        row_along(row, axis_count, look->plane->normal) - look->plane_offset;
    return mask & (distance <= reach) & (distance >= -reach);
}

/* Mass and first moments. Empty slots have no mass. */
TALUS_INLINE void add_rows(const struct look *look, size_t axis_count)
{
    const struct view *view = look->view;
    wide_lanes total = {0}, first[3] = {{0}, {0}, {0}};
    for (size_t slot = 0; slot < view->slot_count; slot += LANE_COUNT) {
        const struct row row = row_at(view, axis_count, slot);
        const wide_mask mask = row_selected(look, axis_count, &row);
        const wide_lanes m = wide_lanes_keep(mask, lanes_widen(lanes_load(view->mass + slot)));
        total += m;
        for (size_t axis = 0; axis < axis_count; axis++)
            first[axis] += m * row.position[axis];
    }
    look->sums->mass += wide_lanes_sum(total);
    for (size_t axis = 0; axis < axis_count; axis++)
        look->sums->first[axis] += wide_lanes_sum(first[axis]);
}

/* The number of axes known to the compiler keeps the sums in registers. */
static void add_moments(const struct look *look)
{
    if (look->view->axis_count == 2)
        add_rows(look, 2);
    else if (look->view->axis_count == 3)
        add_rows(look, 3);
    else
        add_rows(look, 1);
}

/* Two rows at a time, which do not wait for each other. */
static double largest_volume(const struct view *view)
{
    wide_lanes even = {0}, odd = {0};
    for (size_t slot = 0; slot < view->slot_count; slot += (size_t)2 * LANE_COUNT) {
        const size_t next = slot + LANE_COUNT < view->slot_count ? slot + LANE_COUNT : slot;
        even = wide_lanes_maximum(even, lanes_widen(lanes_load(view->volume + slot)));
        odd = wide_lanes_maximum(odd, lanes_widen(lanes_load(view->volume + next)));
    }
    return wide_lanes_largest(wide_lanes_maximum(even, odd));
}

static double x_of(const struct view *view, size_t slot)
{
    return view->centre[0][slot % LANE_COUNT] + view->width[0] * (double)view->position[0][slot];
}

/* Size does not go with volume where the circles of the particles differ. */
static double largest_revolved(const struct view *view)
{
    double largest = 0;
    for (size_t slot = 0; slot < view->slot_count; slot++) {
        if (view->block->id[slot] != PARTICLE_NONE)
            largest = fmax(largest, half_size(view->run, view->volume[slot], x_of(view, slot)));
    }
    return largest;
}

/* Half of the largest particle of a block, and a rounding more. */
static double largest_half(struct view *view)
{
    if (view->half < 0 && view->run->grid.domain.revolves)
        view->half = largest_revolved(view) * (1 + 1e-12);
    else if (view->half < 0)
        view->half = half_size(view->run, largest_volume(view), 1) * (1 + 1e-12);
    return view->half;
}

static void add_reach(const struct look *look, size_t slot, double reach)
{
    struct probe_sums *sums = look->sums;
    if (look->view->block->id[slot] == PARTICLE_NONE)
        return;
    const double half =
        half_size(look->view->run, look->view->volume[slot], x_of(look->view, slot));
    sums->low = reach - half < sums->low ? reach - half : sums->low;
    sums->high = reach + half > sums->high ? reach + half : sums->high;
}

/* Where the cells of a block begin and end in the direction of a probe [m]. */
struct span {
    double low, high;
};

static struct span block_span(const struct view *view, const struct talus_probe *probe)
{
    struct span span = {0, 0};
    for (size_t axis = 0; axis < view->axis_count; axis++) {
        const double edge = (0.5 + COVER_MARGIN) * view->width[axis];
        const double one = probe->along[axis] * (view->centre[axis][0] - edge);
        const double other = probe->along[axis] * (view->centre[axis][LANE_COUNT - 1] + edge);
        span.low += one < other ? one : other;
        span.high += one < other ? other : one;
    }
    return span;
}

/* True if a particle anywhere in the block would reach beyond what has been found. */
static bool block_reaches(struct view *view, const struct talus_probe *probe,
                          const struct probe_sums *sums)
{
    const double half = largest_half(view);
    const struct span span = block_span(view, probe);
    return span.high + half > sums->high || span.low - half < sums->low;
}

/* Only those few particles are looked at one by one that reach beyond what has been found if they
 * are as large as the largest of the block. */
TALUS_INLINE void stretch_rows(const struct look *look, size_t axis_count)
{
    const struct view *view = look->view;
    const struct probe_sums *sums = look->sums;
    for (size_t slot = 0; slot < view->slot_count; slot += LANE_COUNT) {
        const struct row row = row_at(view, axis_count, slot);
        const wide_lanes reach = row_along(&row, axis_count, look->probe->along);
        wide_mask beyond = (reach + view->half > sums->high) | (reach - view->half < sums->low);
        if (!wide_lanes_any(beyond))
            continue;
        beyond &= row_selected(look, axis_count, &row);
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            if (beyond[lane] != 0)
                add_reach(look, slot + lane, reach[lane]);
        }
    }
}

static void add_extremes(const struct look *look)
{
    if (look->view->axis_count == 2)
        stretch_rows(look, 2);
    else if (look->view->axis_count == 3)
        stretch_rows(look, 3);
    else
        stretch_rows(look, 1);
}

static void add_integral(const struct look *look)
{
    const struct view *view = look->view;
    const size_t components = field_components(look->probe->field);
    for (size_t slot = 0; slot < view->slot_count; slot++) {
        const size_t lane = slot % LANE_COUNT;
        if (view->block->id[slot] == PARTICLE_NONE)
            continue;
        const struct row row = row_at(view, view->axis_count, slot - lane);
        if (row_selected(look, view->axis_count, &row)[lane] == 0)
            continue;
        double values[9] = {0};
        field_values(view->run, view->block, slot, look->probe->field, values);
        for (size_t component = 0; component < components; component++)
            look->sums->integral[component] += (double)view->volume[slot] * values[component];
    }
}

static void add_block(struct view *view, const struct talus_probe *probe, struct probe_sums *sums)
{
    struct look look;
    if (wants_extremes(probe) && !block_reaches(view, probe, sums))
        return;
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

/* The outermost block that a probe looks at goes first, so that most others need no look: what is
 * outermost does not depend on the order. */
static void add_outermost(const struct run *run, const struct talus_probe *probe,
                          struct probe_sums *sums)
{
    struct view view, outermost;
    struct look look;
    double farthest = -INFINITY;
    for (size_t index = 0; index < run->grid.block_count; index++) {
        if (run->grid.blocks[index].row_count == 0)
            continue;
        view_block(run, &run->grid.blocks[index], &view);
        const double high = block_span(&view, probe).high;
        if (high > farthest && look_at(&view, probe, &look)) {
            farthest = high;
            outermost = view;
        }
    }
    if (farthest > -INFINITY)
        add_block(&outermost, probe, sums);
}

/* Returns true if a probe wants particles. */
static bool scan_start(const struct run *run, struct probe_sums *sums)
{
    bool any = false;
    for (size_t index = 0; index < run->scene.probe_count; index++) {
        const struct talus_probe *probe = &run->scene.probes[index];
        const bool extent = probe->kind == TALUS_PROBE_EXTENT;
        sums[index] = (struct probe_sums){.low = extent ? INFINITY : -INFINITY, .high = -INFINITY};
        if (wants_extremes(probe))
            add_outermost(run, probe, &sums[index]);
        any = any || wants_particles(probe);
    }
    return any;
}

void probe_scan(const struct run *run, struct probe_sums *sums)
{
    if (!scan_start(run, sums))
        return;
    for (size_t index = 0; index < run->grid.block_count; index++) {
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
            const struct row row = row_at(&view, view.axis_count, slot);
            const wide_lanes away = row_along(&row, view.axis_count, probe->along) - mean;
            const wide_lanes m = lanes_widen(lanes_load(view.mass + slot));
            spread += wide_lanes_keep(row_selected(&look, view.axis_count, &row), m) *
                      wide_lanes_maximum(away, -away);
        }
    }
    return wide_lanes_sum(spread);
}
