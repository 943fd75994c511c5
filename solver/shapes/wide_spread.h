/* SPDX-License-Identifier: Apache-2.0 */
/* The transpose of wide_stencil.h: what particles give to nodes, summed by offset in registers over
 * a chunk of rows at a time; included by wide_kernel.h (no guard). */

/* Sums of what the cells give to the nodes at one offset: [row of the window][offset along x]. */
struct LOCAL(sums) {
    lanes row[WIDE_ROWS][WIDE_NODES];
};

/* sums_c += N value_c over some rows of particles, for c < count. */
/* NOLINTNEXTLINE(readability-function-size): its branches are constants where it is inlined */
TALUS_INLINE void LOCAL(spread)(const struct LOCAL(chunk) * chunk, const lanes (*value)[WIDE_CHUNK],
                                int count, struct LOCAL(sums) * sums)
{
    for (int row = 0; row < WIDE_ROWS; row++) {
        const int y = row % WIDE_COLUMNS, z = row / WIDE_COLUMNS;
        (void)y, (void)z; /* fewer axes need less */
        lanes sum[3][WIDE_NODES];
        UNROLL for (int c = 0; c < count; c++)
        {
            memcpy(sum[c], sums[c].row[row], sizeof sum[c]);
        }
        for (size_t r = 0; r < chunk->rows; r++) {
            const struct LOCAL(stencil) *s = &chunk->stencils[r];
            UNROLL for (int c = 0; c < count; c++)
            {
                lanes part = value[c][r];
                part *= DIMENSION > 1 ? s->w[Y_AXIS][y] : lanes_splat(1);
                part *= DIMENSION > 2 ? s->w[Z_AXIS][z] : lanes_splat(1);
                UNROLL for (int k = 0; k < WIDE_NODES; k++)
                {
                    sum[c][k] += s->w[0][k] * part;
                }
            }
        }
        UNROLL for (int c = 0; c < count; c++)
        {
            memcpy(sums[c].row[row], sum[c], sizeof sum[c]);
        }
    }
}

/* sums_c += sum over the axes b of dN/dx_b q_cb over some rows of particles, for all c. */
/* NOLINTNEXTLINE(readability-function-size): its branches are constants where it is inlined */
TALUS_INLINE void LOCAL(spread_slopes)(const struct LOCAL(chunk) * chunk,
                                       const lanes (*q)[DIMENSION][WIDE_CHUNK],
                                       struct LOCAL(sums) * sums)
{
    for (int row = 0; row < WIDE_ROWS; row++) {
        const int y = row % WIDE_COLUMNS, z = row / WIDE_COLUMNS;
        (void)y, (void)z; /* fewer axes need less */
        lanes sum[DIMENSION][WIDE_NODES];
        UNROLL for (int c = 0; c < DIMENSION; c++)
        {
            memcpy(sum[c], sums[c].row[row], sizeof sum[c]);
        }
        for (size_t r = 0; r < chunk->rows; r++) {
            const struct LOCAL(stencil) *s = &chunk->stencils[r];
            const lanes one = lanes_splat(1);
            const lanes wy = DIMENSION > 1 ? s->w[Y_AXIS][y] : one;
            const lanes wz = DIMENSION > 2 ? s->w[Z_AXIS][z] : one;
            const lanes both = wy * wz;
            const lanes slope_y = s->dw[Y_AXIS][y] * wz, slope_z = wy * s->dw[Z_AXIS][z];
            (void)one, (void)slope_y, (void)slope_z;
            UNROLL for (int c = 0; c < DIMENSION; c++)
            {
                const lanes along_x = q[c][0][r] * both;
                lanes across = {0};
                if (DIMENSION > 1)
                    across += q[c][Y_AXIS][r] * slope_y;
                if (DIMENSION > 2)
                    across += q[c][Z_AXIS][r] * slope_z;
                UNROLL for (int k = 0; k < WIDE_NODES; k++)
                {
                    sum[c][k] += s->dw[0][k] * along_x;
                    if (DIMENSION > 1)
                        sum[c][k] += s->w[0][k] * across;
                }
            }
        }
        UNROLL for (int c = 0; c < DIMENSION; c++)
        {
            memcpy(sums[c].row[row], sum[c], sizeof sum[c]);
        }
    }
}

/* Adds sums_c to component first + c of the nodes, for c < count. */
static void LOCAL(merge)(const struct LOCAL(chunk) * chunk, uint32_t first,
                         const struct LOCAL(sums) * sums, int count)
{
    enum { LAST = LANE_COUNT - 1 };
    const struct node_blocks *nodes = chunk->context->nodes;
    for (int row = 0; row < WIDE_ROWS; row++) {
        const uint32_t *blocks = &chunk->block->wide_nodes[3 * row];
        for (int c = 0; c < count; c++) {
            const lanes *s = sums[c].row[row];
            real *before = node_values(nodes, blocks[0], first + (uint32_t)c);
            real *here = node_values(nodes, blocks[1], first + (uint32_t)c);
            real *after = node_values(nodes, blocks[2], first + (uint32_t)c);
            before[LAST] += s[0][0];
            lanes_store(here, lanes_load(here) + lanes_shift_down(s[0], 0) + s[1] +
                                  lanes_shift_up(s[2] + lanes_shift_up(s[3])));
            after[0] += s[2][LAST] + s[3][LAST - 1];
            after[1] += s[3][LAST];
        }
    }
}
