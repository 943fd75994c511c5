/* SPDX-License-Identifier: Apache-2.0 */
#include "state/nodes.h"

#include <stdlib.h>
#include <string.h>

void node_layout_init(struct node_layout *layout, size_t axis_count,
                      bool momentum_outlives_velocity)
{
    const uint32_t axes = (uint32_t)axis_count;
    layout->mass = 0;
    layout->force = 1;
    layout->momentum = 1 + axes;
    layout->kick = 1 + 2 * axes;
    layout->correction = 1 + 3 * axes;
    layout->velocity = momentum_outlives_velocity ? layout->kick : layout->momentum;
    layout->motion = layout->velocity;
    layout->external = 0;
    layout->start = 0;
    layout->passed = 0;
    layout->volume = 0;
    layout->component_count = 1 + 4 * axes;
}

void node_blocks_release(struct node_blocks *nodes)
{
    free(nodes->place);
    free(nodes->values);
    block_map_release(&nodes->map);
    memset(nodes, 0, sizeof *nodes);
}

static int grow(struct node_blocks *nodes)
{
    const size_t capacity = nodes->capacity == 0 ? 256 : 2 * nodes->capacity;
    const size_t block_bytes = nodes->layout.component_count * LANE_COUNT * sizeof(real);
    const size_t bytes = (capacity * block_bytes + 63) / 64 * 64;
    real *values = aligned_alloc(64, bytes);
    if (values == NULL)
        return -1;
    int32_t(*place)[3] = realloc(nodes->place, capacity * sizeof *place);
    if (place == NULL) {
        free(values);
        return -1;
    }
    if (nodes->count > 0)
        memcpy(values, nodes->values, nodes->count * block_bytes);
    free(nodes->values);
    nodes->values = values;
    nodes->place = place;
    nodes->capacity = capacity;
    return 0;
}

uint32_t node_blocks_require(struct node_blocks *nodes, int32_t x, int32_t y, int32_t z)
{
    const uint64_t key = block_key(x / LANE_COUNT, y, z);
    const uint32_t found = block_map_find(&nodes->map, key);
    if (found != BLOCK_NONE)
        return found;
    if (nodes->count == nodes->capacity && grow(nodes) != 0)
        return BLOCK_NONE;
    const uint32_t index = (uint32_t)nodes->count;
    if (block_map_insert(&nodes->map, key, index) != 0)
        return BLOCK_NONE;
    nodes->place[index][0] = x;
    nodes->place[index][1] = y;
    nodes->place[index][2] = z;
    memset(node_values(nodes, index, 0), 0,
           nodes->layout.component_count * LANE_COUNT * sizeof(real));
    nodes->count++;
    return index;
}
