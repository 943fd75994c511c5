/* SPDX-License-Identifier: Apache-2.0 */
/* Kernels of tensor-product shapes that reach one cell beyond their own; included once per
 * dimension by the file of a shape (no guard). Stencils are worked out once per row of particles
 * and pass, for a chunk of rows at a time; what is scattered is summed by offset and reaches the
 * nodes once a block. The file defines before:
 *
 * DIMENSION: 1, 2 or 3.
 *
 * WIDE_KERNELS: name of what is defined here, to which the dimension is added.
 *
 * WIDE_WEIGHTS(lanes x, lanes half, lane_mask odd, lanes w[4], lanes dw[4]): weights and slopes per
 * cell width at the position x in -1/2..1/2 of the cell, of a particle with half its length `half`,
 * in cell widths; `odd`: upper cell of an element.
 *
 * WIDE_USES_DOMAIN: 1 if `half` is PARTICLE_DOMAIN, 0 if it is not used.
 *
 * WIDE_FOLDS: 1 if the shape folds at walls, 0 if none of its supports lies across one. */
#define WIDE_CONCAT_(a, b) a##_##b
#define WIDE_CONCAT(a, b) WIDE_CONCAT_(a, b)
#define LOCAL(name) WIDE_CONCAT(name, DIMENSION)
#define Y_AXIS (DIMENSION > 1 ? 1 : 0)
#define Z_AXIS (DIMENSION > 2 ? 2 : 0)
#define WIDE_COLUMNS (DIMENSION > 1 ? WIDE_NODES : 1)
#define WIDE_LAYERS (DIMENSION > 2 ? WIDE_NODES : 1)
#define WIDE_ROWS (WIDE_COLUMNS * WIDE_LAYERS)
#ifdef __OPTIMIZE__
#define UNROLL _Pragma("GCC unroll 8")
#else
#define UNROLL /* gcc warns where it cannot follow it */
#endif

#include "shapes/wide_stencil.h"

#include "shapes/wide_chunk.h"

#include "shapes/wide_spread.h"

#include "shapes/wide_scatter.h"

/* particle values += sum N u, or = factor sum N u; 0 in empty slots. */
static void LOCAL(gather_value)(const struct LOCAL(chunk) * chunk, const real *window, bool adds,
                                real factor, real *values)
{
    for (size_t r = 0; r < chunk->rows; r++) {
        const size_t slot = (chunk->begin + r) * LANE_COUNT;
        const lanes value = factor * LOCAL(evaluate)(window, &chunk->stencils[r]);
        const lanes kept = lanes_keep(lanes_load(chunk->mass + slot) > 0, value);
        lanes_store(values + slot, adds ? lanes_load(values + slot) + kept : kept);
    }
}

/* slope_b += sum dN/dx_b u, or = factor ratio_b times it; and value = factor sum N u unless NULL.
 */
static void LOCAL(gather_slopes)(const struct LOCAL(chunk) * chunk, const real *window, bool adds,
                                 real factor, const real ratio[3], real *values,
                                 real *const slopes[DIMENSION])
{
    for (size_t r = 0; r < chunk->rows; r++) {
        const size_t slot = (chunk->begin + r) * LANE_COUNT;
        const lane_mask filled = lanes_load(chunk->mass + slot) > 0;
        lanes slope[DIMENSION];
        const lanes value =
            factor * LOCAL(evaluate_with_slopes)(window, &chunk->stencils[r], slope);
        if (values != NULL)
            lanes_store(values + slot, lanes_keep(filled, value));
        UNROLL for (int along = 0; along < DIMENSION; along++)
        {
            const lanes kept = lanes_keep(filled, factor * ratio[along] * slope[along]);
            lanes_store(slopes[along] + slot,
                        adds ? lanes_load(slopes[along] + slot) + kept : kept);
        }
    }
}

/* PARTICLE_VELOCITY += what the windows hold. */
static void LOCAL(add_velocity)(const struct LOCAL(chunk) * chunk,
                                const struct LOCAL(window) windows[DIMENSION])
{
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        real *velocity = LOCAL(values)(chunk, PARTICLE_VELOCITY, axis);
        LOCAL(gather_value)(chunk, windows[axis].values, true, 1, velocity);
    }
}

/* PARTICLE_AFFINE = or += what the windows hold; overwrites the slopes of the chunk. */
static void LOCAL(gather_affine)(struct LOCAL(chunk) * chunk,
                                 const struct LOCAL(window) windows[DIMENSION], bool adds)
{
    static const real equal[3] = {1, 1, 1};
    LOCAL(chunk_affine)(chunk, true);
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        real *slopes[DIMENSION];
        for (uint32_t along = 0; along < DIMENSION; along++)
            slopes[along] = LOCAL(values)(chunk, PARTICLE_AFFINE, DIMENSION * axis + along);
        LOCAL(gather_slopes)(chunk, windows[axis].values, adds, 1, equal, NULL, slopes);
    }
}

static void LOCAL(kick)(const struct shape_context *context, struct particle_block *block)
{
    const bool affine = context->particles->component_count[PARTICLE_AFFINE] > 0;
    const struct node_layout *layout = &context->nodes->layout;
    struct LOCAL(window) windows[DIMENSION];
    struct LOCAL(sums) sums[DIMENSION] = {0};
    struct LOCAL(chunk) chunk;
    LOCAL(chunk_init)(context, block, &chunk);
    LOCAL(load_windows)(&chunk, layout->kick, windows, DIMENSION);
    while (LOCAL(chunk_next)(&chunk)) {
        LOCAL(add_velocity)(&chunk, windows);
        if (affine)
            LOCAL(gather_affine)(&chunk, windows, true);
        LOCAL(spread_momentum)(&chunk, chunk.mass, sums);
    }
    LOCAL(merge)(&chunk, layout->momentum, sums, DIMENSION);
}

/* Displacements and gradients of a chunk; `motion` may be `velocity`. */
static void LOCAL(gather_motion)(const struct LOCAL(chunk) * chunk,
                                 const struct LOCAL(window) velocity[DIMENSION],
                                 const struct LOCAL(window) motion[DIMENSION], unsigned what,
                                 struct block_scratch *scratch)
{
    enum { BOTH = GATHER_DISPLACEMENT | GATHER_GRADIENT };
    const bool together = (what & BOTH) == BOTH && motion == velocity;
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        const real factor = chunk->context->displacement[axis];
        const real *ratio = chunk->context->cell_ratio[axis];
        const real *moves = motion[axis].values, *strains = velocity[axis].values;
        real *moved = scratch->displacement[axis], *const *slopes = &scratch->gradient[3 * axis];
        if (what & GATHER_DISPLACEMENT && !together)
            LOCAL(gather_value)(chunk, moves, false, factor, moved);
        if (what & GATHER_GRADIENT) {
            real *values = together ? moved : NULL;
            LOCAL(gather_slopes)(chunk, strains, false, factor, ratio, values, slopes);
        }
    }
}

static void LOCAL(gather)(const struct shape_context *context, const struct particle_block *block,
                          unsigned what, struct block_scratch *scratch)
{
    const struct node_layout *layout = &context->nodes->layout;
    const bool apart = what & GATHER_DISPLACEMENT && layout->motion != layout->velocity;
    struct LOCAL(window) correction[DIMENSION], velocity[DIMENSION], motion[DIMENSION];
    struct LOCAL(chunk) chunk;
    LOCAL(chunk_init)(context, block, &chunk);
    if (what & GATHER_CORRECTION)
        LOCAL(load_windows)(&chunk, layout->correction, correction, DIMENSION);
    LOCAL(load_windows)(&chunk, layout->velocity, velocity, DIMENSION);
    if (apart)
        LOCAL(load_windows)(&chunk, layout->motion, motion, DIMENSION);
    while (LOCAL(chunk_next)(&chunk)) {
        if (what & GATHER_CORRECTION)
            LOCAL(add_velocity)(&chunk, correction);
        LOCAL(gather_motion)(&chunk, velocity, apart ? motion : velocity, what, scratch);
        if (what & GATHER_AFFINE)
            LOCAL(gather_affine)(&chunk, velocity, false);
    }
}

static void LOCAL(gather_values)(const struct shape_context *context,
                                 const struct particle_block *block, size_t count,
                                 real *const *values, uint32_t first)
{
    struct LOCAL(window) window;
    struct LOCAL(chunk) chunk;
    LOCAL(chunk_init)(context, block, &chunk);
    while (LOCAL(chunk_next)(&chunk)) {
        for (size_t index = 0; index < count; index++) {
            LOCAL(load_windows)(&chunk, first + (uint32_t)index, &window, 1);
            LOCAL(gather_value)(&chunk, window.values, false, 1, values[index]);
        }
    }
}

extern const struct shape_kernels WIDE_CONCAT(WIDE_KERNELS, DIMENSION);
const struct shape_kernels WIDE_CONCAT(WIDE_KERNELS, DIMENSION) = {
    .kick = LOCAL(kick),
    .gather = LOCAL(gather),
    .scatter = LOCAL(scatter),
    .scatter_one = LOCAL(scatter_one),
    .scatter_values = LOCAL(scatter_values),
    .gather_values = LOCAL(gather_values),
};

#undef UNROLL
#undef WIDE_ROWS
#undef WIDE_LAYERS
#undef WIDE_COLUMNS
#undef Z_AXIS
#undef Y_AXIS
#undef LOCAL
#undef WIDE_CONCAT
#undef WIDE_CONCAT_
