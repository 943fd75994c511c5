/* SPDX-License-Identifier: Apache-2.0 */
/* Kernels of shapes that interpolate at points (point_support.h), for DIMENSION axes; included once
 * per dimension by cpdi.c (no guard). One particle at a time: the points of neighbours lie anywhere
 * around, so lanes have nothing to share but the window of the block. */
#define POINT_CONCAT_(a, b) a##_##b
#define POINT_CONCAT(a, b) POINT_CONCAT_(a, b)
#define LOCAL(name) POINT_CONCAT(name, DIMENSION)
#define POINT_ROWS                                                                                 \
    (DIMENSION == 1   ? 1                                                                          \
     : DIMENSION == 2 ? 2 * POINT_REACH + 2                                                        \
                      : (2 * POINT_REACH + 2) * (2 * POINT_REACH + 2))

#include "shapes/point_support.h"

struct LOCAL(window) {
    _Alignas(64) real values[POINT_ROWS * WINDOW_WIDTH];
};

static void LOCAL(load_windows)(const struct LOCAL(geometry) * geometry, uint32_t first,
                                struct LOCAL(window) * windows, uint32_t count)
{
    for (uint32_t index = 0; index < count; index++)
        window_load(geometry->context->nodes, geometry->block, POINT_ROWS, first + index,
                    windows[index].values);
}

static void LOCAL(add_windows)(const struct LOCAL(geometry) * geometry, uint32_t first,
                               const struct LOCAL(window) * windows, uint32_t count)
{
    for (uint32_t index = 0; index < count; index++)
        window_add(geometry->context->nodes, geometry->block, POINT_ROWS, first + index,
                   windows[index].values);
}

/* From the lower node of a point to one of the nodes around it, in a window. */
TALUS_INLINE size_t LOCAL(node_step)(int node)
{
    const size_t rows = 2 * POINT_REACH + 2;
    return (size_t)(node & 1) +
           WINDOW_WIDTH * ((size_t)(node >> 1 & 1) + rows * (size_t)(node >> 2));
}

/* Linear weight of one of the nodes around a point. */
TALUS_INLINE real LOCAL(node_weight)(const struct LOCAL(point) * point, int node)
{
    real weight = 1;
    for (int axis = 0; axis < DIMENSION; axis++)
        weight *= node >> axis & 1 ? point->t[axis] : 1 - point->t[axis];
    return weight;
}

/* sum N u, and per cell width its slopes where they are asked for. */
static real LOCAL(evaluate)(const struct LOCAL(support) * support, const real *window, real *slope)
{
    real value = 0;
    for (int axis = 0; slope != NULL && axis < DIMENSION; axis++)
        slope[axis] = 0;
    for (int k = 0; k < support->count; k++) {
        const struct LOCAL(point) *point = &support->points[k];
        real u = 0;
        for (int node = 0; node < 1 << DIMENSION; node++)
            u += LOCAL(node_weight)(point, node) * window[point->index + LOCAL(node_step)(node)];
        value += point->value * u;
        for (int axis = 0; slope != NULL && axis < DIMENSION; axis++)
            slope[axis] += point->slope[axis] * u;
    }
    return value;
}

/* What a particle gives to its nodes: N scalar, dN/dx . flux (per cell width) and, where the affine
 * part of the velocity is asked for, N mass A (node - particle). */
struct LOCAL(gift) {
    real scalar, flux[DIMENSION];
    real affine[DIMENSION]; /* mass A, per cell width */
    real centre[DIMENSION]; /* of the particle */
    bool is_affine;
};

static void LOCAL(give)(const struct LOCAL(support) * support, const struct LOCAL(gift) * gift,
                        real *window)
{
    for (int k = 0; k < support->count; k++) {
        const struct LOCAL(point) *point = &support->points[k];
        real given = gift->scalar * point->value;
        for (int axis = 0; axis < DIMENSION; axis++)
            given += gift->flux[axis] * point->slope[axis];
        for (int node = 0; node < 1 << DIMENSION; node++) {
            real all = given;
            for (int axis = 0; gift->is_affine && axis < DIMENSION; axis++)
                all += point->value * gift->affine[axis] *
                       ((real)(point->base[axis] + (node >> axis & 1)) - gift->centre[axis]);
            window[point->index + LOCAL(node_step)(node)] += LOCAL(node_weight)(point, node) * all;
        }
    }
}

static void LOCAL(give_momentum)(const struct LOCAL(geometry) * geometry, size_t slot, real mass,
                                 const struct LOCAL(support) * support,
                                 struct LOCAL(window) windows[DIMENSION])
{
    const struct particle_layout *layout = geometry->context->particles;
    for (uint32_t row = 0; row < DIMENSION; row++) {
        struct LOCAL(gift) gift = {.is_affine = layout->component_count[PARTICLE_AFFINE] > 0};
        gift.scalar = mass * particle_values(layout, geometry->block, PARTICLE_VELOCITY, row)[slot];
        for (uint32_t axis = 0; gift.is_affine && axis < DIMENSION; axis++) {
            gift.affine[axis] = mass * particle_values(layout, geometry->block, PARTICLE_AFFINE,
                                                       DIMENSION * row + axis)[slot];
            gift.centre[axis] = (real)0.5 + geometry->position[axis][slot];
        }
        LOCAL(give)(support, &gift, windows[row].values);
    }
}

/* v_p += what the windows hold at the particle; with `affine` its slopes to the affine part. */
static void LOCAL(add_velocity)(const struct LOCAL(geometry) * geometry, size_t slot,
                                const struct LOCAL(support) * support,
                                const struct LOCAL(window) windows[DIMENSION], bool affine)
{
    const struct particle_layout *layout = geometry->context->particles;
    for (uint32_t row = 0; row < DIMENSION; row++) {
        real slope[DIMENSION];
        particle_values(layout, geometry->block, PARTICLE_VELOCITY, row)[slot] +=
            LOCAL(evaluate)(support, windows[row].values, affine ? slope : NULL);
        for (uint32_t axis = 0; affine && axis < DIMENSION; axis++)
            particle_values(layout, geometry->block, PARTICLE_AFFINE,
                            DIMENSION * row + axis)[slot] += slope[axis];
    }
}

static void LOCAL(kick)(const struct shape_context *context, struct particle_block *block)
{
    const bool affine = context->particles->component_count[PARTICLE_AFFINE] > 0;
    const struct node_layout *layout = &context->nodes->layout;
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    struct LOCAL(window) kicks[DIMENSION], momenta[DIMENSION] = {0};
    struct LOCAL(geometry) geometry;
    LOCAL(geometry_init)(context, block, &geometry);
    LOCAL(load_windows)(&geometry, layout->kick, kicks, DIMENSION);
    for (size_t slot = 0; slot < slot_count; slot++) {
        struct LOCAL(support) support;
        if (!(geometry.mass[slot] > 0))
            continue;
        LOCAL(support_at)(&geometry, slot, &support);
        LOCAL(add_velocity)(&geometry, slot, &support, kicks, affine);
        LOCAL(give_momentum)(&geometry, slot, geometry.mass[slot], &support, momenta);
    }
    LOCAL(add_windows)(&geometry, layout->momentum, momenta, DIMENSION);
}

/* Nodes that a gather reads. */
struct LOCAL(motion) {
    struct LOCAL(window) correction[DIMENSION], velocity[DIMENSION], motion[DIMENSION];
};

static void LOCAL(gather_slot)(const struct LOCAL(geometry) * geometry, size_t slot,
                               const struct LOCAL(motion) * nodes, unsigned what,
                               struct block_scratch *scratch)
{
    const struct shape_context *context = geometry->context;
    struct LOCAL(support) support;
    LOCAL(support_at)(geometry, slot, &support);
    if (what & GATHER_CORRECTION)
        LOCAL(add_velocity)(geometry, slot, &support, nodes->correction, false);
    for (uint32_t row = 0; row < DIMENSION; row++) {
        const real factor = context->displacement[row];
        real slope[DIMENSION] = {0};
        if (what & GATHER_DISPLACEMENT)
            scratch->displacement[row][slot] =
                factor * LOCAL(evaluate)(&support, nodes->motion[row].values, NULL);
        if (what & (GATHER_GRADIENT | GATHER_AFFINE))
            (void)LOCAL(evaluate)(&support, nodes->velocity[row].values, slope);
        for (uint32_t axis = 0; what & GATHER_GRADIENT && axis < DIMENSION; axis++)
            scratch->gradient[3 * row + axis][slot] =
                factor * context->cell_ratio[row][axis] * slope[axis];
        for (uint32_t axis = 0; what & GATHER_AFFINE && axis < DIMENSION; axis++)
            particle_values(context->particles, geometry->block, PARTICLE_AFFINE,
                            DIMENSION * row + axis)[slot] = slope[axis];
    }
}

static void LOCAL(clear_slot)(size_t slot, unsigned what, struct block_scratch *scratch)
{
    for (uint32_t row = 0; row < DIMENSION; row++) {
        if (what & GATHER_DISPLACEMENT)
            scratch->displacement[row][slot] = 0;
        for (uint32_t axis = 0; what & GATHER_GRADIENT && axis < DIMENSION; axis++)
            scratch->gradient[3 * row + axis][slot] = 0;
    }
}

static void LOCAL(gather)(const struct shape_context *context, const struct particle_block *block,
                          unsigned what, struct block_scratch *scratch)
{
    const struct node_layout *layout = &context->nodes->layout;
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    struct LOCAL(motion) nodes;
    struct LOCAL(geometry) geometry;
    LOCAL(geometry_init)(context, block, &geometry);
    if (what & GATHER_CORRECTION)
        LOCAL(load_windows)(&geometry, layout->correction, nodes.correction, DIMENSION);
    LOCAL(load_windows)(&geometry, layout->velocity, nodes.velocity, DIMENSION);
    LOCAL(load_windows)(&geometry, layout->motion, nodes.motion, DIMENSION);
    for (size_t slot = 0; slot < slot_count; slot++) {
        if (geometry.mass[slot] > 0)
            LOCAL(gather_slot)(&geometry, slot, &nodes, what, scratch);
        else
            LOCAL(clear_slot)(slot, what, scratch);
    }
}

/* Windows of what a scatter leaves. */
struct LOCAL(gifts) {
    struct LOCAL(window) mass, momentum[DIMENSION], force[DIMENSION];
};

/* One particle: its mass, momentum and forces, as asked. `force_stress` is V0 tau. */
static void LOCAL(scatter_slot)(const struct LOCAL(geometry) * geometry, size_t slot, real mass,
                                const real force_stress[6], unsigned what,
                                struct LOCAL(gifts) * gifts)
{
    struct LOCAL(support) support;
    LOCAL(support_at)(geometry, slot, &support);
    if (what & SCATTER_MASS) {
        const struct LOCAL(gift) gift = {.scalar = mass};
        LOCAL(give)(&support, &gift, gifts->mass.values);
    }
    if (what & SCATTER_MOMENTUM)
        LOCAL(give_momentum)(geometry, slot, mass, &support, gifts->momentum);
    for (uint32_t row = 0; what & SCATTER_FORCE && row < DIMENSION; row++) {
        struct LOCAL(gift) gift = {.scalar = 0};
        for (int axis = 0; axis < DIMENSION; axis++)
            gift.flux[axis] =
                -force_stress[sym3_component[row][axis]] * geometry->context->inverse_cell[axis];
        LOCAL(give)(&support, &gift, gifts->force[row].values);
    }
}

static void LOCAL(merge)(const struct LOCAL(geometry) * geometry, unsigned what,
                         const struct LOCAL(gifts) * gifts)
{
    const struct node_layout *layout = &geometry->context->nodes->layout;
    if (what & SCATTER_MASS)
        LOCAL(add_windows)(geometry, layout->mass, &gifts->mass, 1);
    if (what & SCATTER_MOMENTUM)
        LOCAL(add_windows)(geometry, layout->momentum, gifts->momentum, DIMENSION);
    if (what & SCATTER_FORCE)
        LOCAL(add_windows)(geometry, layout->force, gifts->force, DIMENSION);
}

static void LOCAL(scatter)(const struct shape_context *context, const struct particle_block *block,
                           const struct scatter_source *source, unsigned what)
{
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    struct LOCAL(gifts) gifts = {0};
    struct LOCAL(geometry) geometry;
    LOCAL(geometry_init)(context, block, &geometry);
    for (size_t slot = 0; slot < slot_count; slot++) {
        real force_stress[6] = {0};
        if (!(source->mass[slot] > 0))
            continue;
        for (size_t component = 0; what & SCATTER_FORCE && component < 6; component++)
            force_stress[component] = source->volume[slot] * source->stress[component][slot];
        LOCAL(scatter_slot)(&geometry, slot, source->mass[slot], force_stress, what, &gifts);
    }
    LOCAL(merge)(&geometry, what, &gifts);
}

static void LOCAL(scatter_one)(const struct shape_context *context,
                               const struct particle_block *block, size_t slot,
                               const real force_stress[6], unsigned what)
{
    struct LOCAL(gifts) gifts = {0};
    struct LOCAL(geometry) geometry;
    LOCAL(geometry_init)(context, block, &geometry);
    LOCAL(scatter_slot)(&geometry, slot, geometry.mass[slot], force_stress, what, &gifts);
    LOCAL(merge)(&geometry, what, &gifts);
}

static void LOCAL(scatter_values)(const struct shape_context *context,
                                  const struct particle_block *block, const real *weight,
                                  size_t count, const real *const *values, uint32_t first)
{
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    struct LOCAL(geometry) geometry;
    LOCAL(geometry_init)(context, block, &geometry);
    for (size_t index = 0; index < count; index++) {
        struct LOCAL(window) window = {0};
        for (size_t slot = 0; slot < slot_count; slot++) {
            const real value = values[index] == NULL ? 1 : values[index][slot];
            const struct LOCAL(gift) gift = {.scalar = weight[slot] * value};
            struct LOCAL(support) support;
            if (weight[slot] == 0 || !(geometry.mass[slot] > 0))
                continue;
            LOCAL(support_at)(&geometry, slot, &support);
            LOCAL(give)(&support, &gift, window.values);
        }
        LOCAL(add_windows)(&geometry, first + (uint32_t)index, &window, 1);
    }
}

static void LOCAL(gather_values)(const struct shape_context *context,
                                 const struct particle_block *block, size_t count,
                                 real *const *values, uint32_t first)
{
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    struct LOCAL(geometry) geometry;
    LOCAL(geometry_init)(context, block, &geometry);
    for (size_t index = 0; index < count; index++) {
        struct LOCAL(window) window;
        LOCAL(load_windows)(&geometry, first + (uint32_t)index, &window, 1);
        for (size_t slot = 0; slot < slot_count; slot++) {
            struct LOCAL(support) support;
            values[index][slot] = 0;
            if (!(geometry.mass[slot] > 0))
                continue;
            LOCAL(support_at)(&geometry, slot, &support);
            values[index][slot] = LOCAL(evaluate)(&support, window.values, NULL);
        }
    }
}

const struct shape_kernels LOCAL(cpdi_kernels) = {
    .kick = LOCAL(kick),
    .gather = LOCAL(gather),
    .scatter = LOCAL(scatter),
    .scatter_one = LOCAL(scatter_one),
    .scatter_values = LOCAL(scatter_values),
    .gather_values = LOCAL(gather_values),
};

#undef POINT_ROWS
#undef LOCAL
#undef POINT_CONCAT
#undef POINT_CONCAT_
