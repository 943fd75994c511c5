/* SPDX-License-Identifier: Apache-2.0 */
/* Weights of the four nodes an axis that a wide shape function reaches, and sums over them;
 * included once per dimension and shape by wide_kernel.h (no guard). WIDE_WEIGHTS and the other
 * WIDE_ macros are the shape's own, see wide_kernel.h.
 *
 * Lane l works for cell l: the nodes at offset k from all cells are the vector at column
 * WINDOW_ORIGIN + k - 1 of a row of the window. Sums over the axes are nested (sum factorisation).
 */

/* Weights and their derivatives per cell width of the nodes at offsets -1, 0, 1, 2 from the lower
 * node of the cell, for the particles of one row. */
struct LOCAL(stencil) {
    lanes w[DIMENSION][WIDE_NODES], dw[DIMENSION][WIDE_NODES];
};

/* What the stencils of a block are made from. */
struct LOCAL(support) {
    const real *position[DIMENSION], *half[DIMENSION];
    lane_mask fold[DIMENSION][2]; /* cells with a wall at their lower, upper side */
    lane_mask odd[DIMENSION];     /* cells in the upper half of their element */
    bool folded;
};

static void LOCAL(support_init)(const struct shape_context *context,
                                const struct particle_block *block, struct LOCAL(support) * support)
{
    unsigned folds = 0;
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        support->position[axis] =
            particle_values(context->particles, block, PARTICLE_POSITION, axis);
        support->half[axis] =
            WIDE_USES_DOMAIN ? particle_values(context->particles, block, PARTICLE_DOMAIN, axis)
                             : NULL;
        for (int lane = 0; lane < LANE_COUNT; lane++) {
            for (size_t side = 0; side < 2; side++)
                support->fold[axis][side][lane] = -(block->folds[2 * axis + side] >> lane & 1);
            support->odd[axis][lane] = -((block->cell[axis] + (axis == 0 ? lane : 0)) & 1);
        }
        folds |= (unsigned)block->folds[2 * axis] | block->folds[2 * axis + 1];
    }
    support->folded = WIDE_FOLDS && folds != 0;
}

/* Gives what belongs to a node behind a wall to the two before it as if the field went on linearly:
 * partition of unity and linear fields stay, and on the wall only its own node counts. */
TALUS_INLINE void LOCAL(fold)(const lane_mask masks[2], lanes w[WIDE_NODES])
{
    const lanes below = lanes_keep(masks[0], w[0]), above = lanes_keep(masks[1], w[3]);
    w[0] -= below;
    w[1] += 2 * below - above;
    w[2] += 2 * above - below;
    w[3] -= above;
}

TALUS_INLINE void LOCAL(stencil_at)(const struct LOCAL(support) * support, size_t slot,
                                    struct LOCAL(stencil) * stencil)
{
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        const lanes x = lanes_load(support->position[axis] + slot);
        const lanes half = WIDE_USES_DOMAIN ? lanes_load(support->half[axis] + slot) : x;
        WIDE_WEIGHTS(x, half, support->odd[axis], stencil->w[axis], stencil->dw[axis]);
        if (support->folded) {
            LOCAL(fold)(support->fold[axis], stencil->w[axis]);
            LOCAL(fold)(support->fold[axis], stencil->dw[axis]);
        }
    }
}

/* Turns slopes into what an affine velocity field takes in their place (Jiang et al. 2015): the
 * weights w (x_i - x_p) that scatter it, and these over D = sum w (x_i - x_p)^2, which gather it.
 * For hat functions the latter are the slopes, as they are where D vanishes: on the node of a wall.
 */
TALUS_INLINE void LOCAL(affine_stencil)(const struct LOCAL(support) * support, size_t slot,
                                        bool gathers, struct LOCAL(stencil) * stencil)
{
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        const lanes x = lanes_load(support->position[axis] + slot);
        lanes first[WIDE_NODES], second = {0};
        UNROLL for (int k = 0; k < WIDE_NODES; k++)
        {
            const lanes arm = (real)k - (real)1.5 - x;
            first[k] = stencil->w[axis][k] * arm;
            second += first[k] * arm;
        }
        const lane_mask regular = second > 16 * REAL_EPSILON;
        const lanes inverse = 1 / lanes_select(regular, second, lanes_splat(1));
        UNROLL for (int k = 0; k < WIDE_NODES; k++)
        {
            stencil->dw[axis][k] =
                gathers ? lanes_select(regular, first[k] * inverse, stencil->dw[axis][k])
                        : first[k];
        }
    }
}

TALUS_INLINE lanes LOCAL(load_nodes)(const real *row, int k)
{
    lanes value;
    memcpy(&value, row + WINDOW_ORIGIN - 1 + k, sizeof value);
    return value;
}

/* sum N u over one window. */
TALUS_INLINE lanes LOCAL(evaluate)(const real *window, const struct LOCAL(stencil) * stencil)
{
    lanes value = {0};
    UNROLL for (int z = 0; z < WIDE_LAYERS; z++)
    {
        lanes layer = {0};
        UNROLL for (int y = 0; y < WIDE_COLUMNS; y++)
        {
            const real *row = window + (WIDE_COLUMNS * z + y) * WINDOW_WIDTH;
            lanes sum = {0};
            UNROLL for (int k = 0; k < WIDE_NODES; k++)
            {
                sum += stencil->w[0][k] * LOCAL(load_nodes)(row, k);
            }
            layer += DIMENSION > 1 ? stencil->w[Y_AXIS][y] * sum : sum;
        }
        value += DIMENSION > 2 ? stencil->w[Z_AXIS][z] * layer : layer;
    }
    return value;
}

/* The same with the derivative along every axis, per cell width. */
TALUS_INLINE lanes LOCAL(evaluate_with_slopes)(const real *window,
                                               const struct LOCAL(stencil) * stencil,
                                               lanes slope[DIMENSION])
{
    lanes value = {0}, along_x = {0}, along_y = {0}, along_z = {0};
    UNROLL for (int z = 0; z < WIDE_LAYERS; z++)
    {
        lanes layer = {0}, layer_x = {0}, layer_y = {0};
        UNROLL for (int y = 0; y < WIDE_COLUMNS; y++)
        {
            const real *row = window + (WIDE_COLUMNS * z + y) * WINDOW_WIDTH;
            lanes sum = {0}, sum_x = {0};
            UNROLL for (int k = 0; k < WIDE_NODES; k++)
            {
                const lanes u = LOCAL(load_nodes)(row, k);
                sum += stencil->w[0][k] * u;
                sum_x += stencil->dw[0][k] * u;
            }
            layer += DIMENSION > 1 ? stencil->w[Y_AXIS][y] * sum : sum;
            layer_x += DIMENSION > 1 ? stencil->w[Y_AXIS][y] * sum_x : sum_x;
            layer_y += stencil->dw[Y_AXIS][y] * sum;
        }
        value += DIMENSION > 2 ? stencil->w[Z_AXIS][z] * layer : layer;
        along_x += DIMENSION > 2 ? stencil->w[Z_AXIS][z] * layer_x : layer_x;
        along_y += DIMENSION > 2 ? stencil->w[Z_AXIS][z] * layer_y : layer_y;
        along_z += stencil->dw[Z_AXIS][z] * layer;
    }
    const lanes slopes[3] = {along_x, along_y, along_z};
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        slope[axis] = slopes[axis];
    }
    return value;
}
