/* SPDX-License-Identifier: Apache-2.0 */
#include "state/particles.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK_ALIGNMENT = 64 };

void particle_layout_finish(struct particle_layout *layout)
{
    uint32_t count = 0;
    for (size_t field = 0; field < PARTICLE_FIELD_COUNT; field++) {
        layout->first_component[field] = count;
        count += layout->component_count[field];
    }
    layout->double_count = count;
}

size_t particle_chunk_bytes(const struct particle_layout *layout, uint32_t row_capacity)
{
    const size_t slots = (size_t)row_capacity * LANE_COUNT;
    const size_t bytes = slots * (layout->double_count * sizeof(real) + sizeof(uint32_t) +
                                  (layout->has_body ? sizeof(uint16_t) : 0));
    return (bytes + CHUNK_ALIGNMENT - 1) / CHUNK_ALIGNMENT * CHUNK_ALIGNMENT;
}

static void chunk_attach(const struct particle_layout *layout, struct particle_block *block,
                         void *chunk, uint32_t row_capacity)
{
    const size_t slots = (size_t)row_capacity * LANE_COUNT;
    block->row_capacity = row_capacity;
    block->data = chunk;
    block->id = (uint32_t *)(void *)(block->data + layout->double_count * slots);
    block->body = layout->has_body ? (uint16_t *)(void *)(block->id + slots) : NULL;
}

int particle_block_reserve(const struct particle_layout *layout, struct particle_block *block,
                           uint32_t rows)
{
    if (rows <= block->row_capacity)
        return 0;
    /* Even capacities with some slack: a flow changes the count of a cell all the time. */
    const uint32_t capacity = (rows + rows / 4 + 1) / 2 * 2;
    const size_t bytes = particle_chunk_bytes(layout, capacity);
    void *chunk = aligned_alloc(CHUNK_ALIGNMENT, bytes);
    if (chunk == NULL)
        return -1;
    memset(chunk, 0, bytes);
    const struct particle_block old = *block;
    chunk_attach(layout, block, chunk, capacity);
    assert(block->id != NULL);
    memset(block->id, 0xFF, (size_t)capacity * LANE_COUNT * sizeof *block->id);
    const size_t old_slots = (size_t)old.row_capacity * LANE_COUNT;
    const size_t slots = (size_t)capacity * LANE_COUNT;
    if (old.data != NULL) {
        assert(block->data != NULL && old.id != NULL);
        for (size_t component = 0; component < layout->double_count; component++)
            memcpy(block->data + component * slots, old.data + component * old_slots,
                   old_slots * sizeof(real));
        memcpy(block->id, old.id, old_slots * sizeof *old.id);
        if (block->body != NULL && old.body != NULL)
            memcpy(block->body, old.body, old_slots * sizeof *old.body);
        free(old.data);
    }
    return 0;
}

void particle_block_release(struct particle_block *block)
{
    free(block->data);
    block->data = NULL;
    block->row_capacity = 0;
}

int particle_block_attach(const struct particle_layout *layout, struct particle_block *block,
                          uint32_t row_capacity, const void *chunk)
{
    const size_t bytes = particle_chunk_bytes(layout, row_capacity);
    if (bytes == 0)
        return 0;
    void *copy = aligned_alloc(CHUNK_ALIGNMENT, bytes);
    if (copy == NULL)
        return -1;
    memcpy(copy, chunk, bytes);
    free(block->data);
    chunk_attach(layout, block, copy, row_capacity);
    return 0;
}

static void row_count_update(struct particle_block *block)
{
    uint32_t rows = 0;
    for (size_t lane = 0; lane < LANE_COUNT; lane++)
        rows = block->lane_count[lane] > rows ? block->lane_count[lane] : rows;
    block->row_count = rows;
}

size_t particle_block_insert(const struct particle_layout *layout, struct particle_block *block,
                             uint32_t lane, const struct particle_record *record)
{
    const size_t slot = (size_t)block->lane_count[lane] * LANE_COUNT + lane;
    const size_t slots = (size_t)block->row_capacity * LANE_COUNT;
    for (size_t component = 0; component < layout->double_count; component++)
        block->data[component * slots + slot] = record->values[component];
    block->id[slot] = record->id;
    if (block->body != NULL)
        block->body[slot] = record->body;
    block->lane_count[lane]++;
    row_count_update(block);
    return slot;
}

void particle_block_remove(const struct particle_layout *layout, struct particle_block *block,
                           size_t slot, struct particle_record *record)
{
    const size_t lane = slot % LANE_COUNT;
    const size_t last = (size_t)(block->lane_count[lane] - 1) * LANE_COUNT + lane;
    const size_t slots = (size_t)block->row_capacity * LANE_COUNT;
    for (size_t component = 0; component < layout->double_count; component++) {
        real *values = block->data + component * slots;
        record->values[component] = values[slot];
        values[slot] = values[last];
        values[last] = 0;
    }
    record->id = block->id[slot];
    block->id[slot] = block->id[last];
    block->id[last] = PARTICLE_NONE;
    record->body = 0;
    if (block->body != NULL) {
        record->body = block->body[slot];
        block->body[slot] = block->body[last];
        block->body[last] = 0;
    }
    block->lane_count[lane]--;
    row_count_update(block);
}
