/* SPDX-License-Identifier: Apache-2.0 */
/* Node values, in blocks of LANE_COUNT nodes side by side along x: node l of a block is the lower
 * corner of cell l of the particle block at the same place. All quantities of a block lie together.
 */
#ifndef TALUS_NODES_H
#define TALUS_NODES_H

#include "state/block_map.h"
#include "state/lanes.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Components of a node; each array of a quantity has `axis_count` components but for the mass. */
struct node_layout {
    uint32_t mass;       /* [kg] of the present particle positions */
    uint32_t force;      /* [N] internal force of the present particle positions */
    uint32_t momentum;   /* [kg m/s] scattered */
    uint32_t velocity;   /* [m/s] that strains and moves the material; shares its place with what is
                            free by then, see node_layout_init */
    uint32_t motion;     /* [m/s] velocity that moves it: the same place, unless a scene asks */
    uint32_t kick;       /* [m/s] velocity increment that the particles get in the first pass */
    uint32_t external;   /* [N] of the present particle positions, other than stress and constant
                            gravity; 0: the scene has none */
    uint32_t start;      /* [m/s] velocity at the start of the step; 0: the scene needs none */
    uint32_t passed;     /* [m/s] what the walls let pass of the forces, where the kick is the brake
                            of local damping in the end; 0: the scene has none */
    uint32_t volume;     /* [m^3] of the present particle positions, and after it a mark: 1 at nodes
                            of whose support hardly anything is full; 0: the scene needs none */
    uint32_t correction; /* [m/s] velocity increment that they get in the second pass */
    uint32_t component_count;
};

struct node_blocks {
    struct node_layout layout;
    size_t count, capacity;
    int32_t (*place)[3]; /* [count] first node: x (multiple of LANE_COUNT), y, z */
    real *values;        /* [count][component_count][LANE_COUNT], aligned to 64 bytes */
    struct block_map map;
};

/* With `momentum_outlives_velocity` the second pass scatters momentum while it reads velocity, and
 * no kick is needed: velocity takes the place of the kick. Otherwise the node update turns momentum
 * into velocity in place, unless the scene gives the velocity a place of its own. */
void node_layout_init(struct node_layout *layout, size_t axis_count,
                      bool momentum_outlives_velocity);
/* Adds components to the layout, before there are nodes; returns the first of them. */
static inline uint32_t node_layout_extend(struct node_layout *layout, size_t count)
{
    const uint32_t first = layout->component_count;
    layout->component_count += (uint32_t)count;
    return first;
}
void node_blocks_release(struct node_blocks *nodes);
/* Index of the node block at a place, made (zeroed) if missing; BLOCK_NONE when memory ran out. */
uint32_t node_blocks_require(struct node_blocks *nodes, int32_t x, int32_t y, int32_t z);

static inline real *node_values(const struct node_blocks *nodes, size_t block, uint32_t component)
{
    return nodes->values + (block * nodes->layout.component_count + component) * LANE_COUNT;
}

/* Bytes of all values of a block. */
static inline size_t node_block_bytes(const struct node_blocks *nodes)
{
    return nodes->layout.component_count * LANE_COUNT * sizeof(real);
}

#endif
