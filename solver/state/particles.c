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

static void chunk_release(const struct particle_block *block)
{
    if (!block->packed)
        free(block->data);
}

/* Copies what the rows of both have in common; the rest of the new chunk is empty slots. */
static void chunk_move(const struct particle_layout *layout, struct particle_block *block,
                       uint32_t row_capacity, void *chunk, bool packed)
{
    const struct particle_block old = *block;
    memset(chunk, 0, particle_chunk_bytes(layout, row_capacity));
    chunk_attach(layout, block, chunk, row_capacity);
    block->packed = packed;
    assert(block->id != NULL && block->data != NULL);
    const size_t slots = (size_t)row_capacity * LANE_COUNT;
    const size_t old_slots = (size_t)old.row_capacity * LANE_COUNT;
    const size_t kept = slots < old_slots ? slots : old_slots;
    memset(block->id, 0xFF, slots * sizeof *block->id);
    if (old.data == NULL)
        return;
    for (size_t component = 0; component < layout->double_count; component++)
        memcpy(block->data + component * slots, old.data + component * old_slots,
               kept * sizeof(real));
    memcpy(block->id, old.id, kept * sizeof *old.id);
    if (block->body != NULL && old.body != NULL)
        memcpy(block->body, old.body, kept * sizeof *old.body);
    chunk_release(&old);
}

int particle_block_reserve(const struct particle_layout *layout, struct particle_block *block,
                           uint32_t rows)
{
    if (rows <= block->row_capacity)
        return 0;
    /* Even capacities, so that every array starts on a cache line, with some slack: a flow changes
     * the count of a cell all the time. */
    const uint32_t capacity = (rows + rows / 4 + 1) / 2 * 2;
    void *chunk = aligned_alloc(CHUNK_ALIGNMENT, particle_chunk_bytes(layout, capacity));
    if (chunk == NULL)
        return -1;
    chunk_move(layout, block, capacity, chunk, false);
    return 0;
}

void particle_block_pack(const struct particle_layout *layout, struct particle_block *block,
                         uint32_t rows, void *memory)
{
    assert(rows >= block->row_count);
    chunk_move(layout, block, rows, memory, true);
}

void particle_block_release(struct particle_block *block)
{
    chunk_release(block);
    block->data = NULL;
    block->row_capacity = 0;
    block->packed = false;
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
    chunk_release(block);
    chunk_attach(layout, block, copy, row_capacity);
    block->packed = false;
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
