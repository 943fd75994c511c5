/* SPDX-License-Identifier: Apache-2.0 */
/* The nodes around a block, for shape functions that reach beyond their cell.
 *
 * A window holds one component of all nodes that the particles of a block can touch as dense rows
 * along x: [rows along y and z][WINDOW_WIDTH]. The node at (x, y, z) from the first node of the
 * block lies in row y + reach + (2 reach + 2) (z + reach), column WINDOW_ORIGIN + x, so the nodes
 * at one offset from all cells of the block are one contiguous vector. Block wide_nodes[3 row +
 * part] holds LANE_COUNT columns of a row. */
#ifndef TALUS_WIDE_WINDOW_H
#define TALUS_WIDE_WINDOW_H

#include "state/nodes.h"
#include "state/particles.h"

enum { WINDOW_WIDTH = 3 * LANE_COUNT, WINDOW_ORIGIN = LANE_COUNT };

/* Rows of a window. */
static inline uint32_t window_row_count(size_t axis_count, uint32_t reach)
{
    const uint32_t rows = 2 * reach + 2;
    return axis_count == 1 ? 1 : axis_count == 2 ? rows : rows * rows;
}

/* Node values of a component -> window [rows][WINDOW_WIDTH]. */
static inline void window_load(const struct node_blocks *nodes, const struct particle_block *block,
                               uint32_t rows, uint32_t component, real *window)
{
    for (uint32_t part = 0; part < 3 * rows; part++)
        lanes_store(window + (size_t)part * LANE_COUNT,
                    lanes_load(node_values(nodes, block->wide_nodes[part], component)));
}

/* The transpose: adds the window to the nodes. */
static inline void window_add(const struct node_blocks *nodes, const struct particle_block *block,
                              uint32_t rows, uint32_t component, const real *window)
{
    for (uint32_t part = 0; part < 3 * rows; part++) {
        real *values = node_values(nodes, block->wide_nodes[part], component);
        lanes_store(values, lanes_load(values) + lanes_load(window + (size_t)part * LANE_COUNT));
    }
}

/* Place in a window of the node at (x, y, z) from the first node of the block; axes beyond the
 * dimension are ignored. */
static inline size_t window_index(size_t axis_count, uint32_t reach, int32_t x, int32_t y,
                                  int32_t z)
{
    const int32_t rows = 2 * (int32_t)reach + 2;
    const int32_t row = (axis_count > 1 ? y + (int32_t)reach : 0) +
                        (axis_count > 2 ? rows * (z + (int32_t)reach) : 0);
    return (size_t)(row * WINDOW_WIDTH + WINDOW_ORIGIN + x);
}

#endif
