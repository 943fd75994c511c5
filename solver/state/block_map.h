/* SPDX-License-Identifier: Apache-2.0 */
/* Finds a block of the sparse grid by its place: open addressing, linear probing. */
#ifndef TALUS_BLOCK_MAP_H
#define TALUS_BLOCK_MAP_H

#include <stddef.h>
#include <stdint.h>

#define BLOCK_NONE UINT32_MAX

struct block_map {
    uint64_t *keys; /* [capacity] owned; UINT64_MAX: empty */
    uint32_t *values;
    size_t capacity; /* power of two, or 0 */
    size_t count;
};

/* Key of the block at (block x, cell y, cell z); any 2^21 places in a row on each axis have
 * different keys, negative ones too. */
static inline uint64_t block_key(int32_t x, int32_t y, int32_t z)
{
    const uint32_t mask = (1u << 21) - 1;
    return (uint64_t)((uint32_t)x & mask) | (uint64_t)((uint32_t)y & mask) << 21 |
           (uint64_t)((uint32_t)z & mask) << 42;
}

void block_map_release(struct block_map *map);
void block_map_clear(struct block_map *map);
/* Value of a key, or BLOCK_NONE. */
uint32_t block_map_find(const struct block_map *map, uint64_t key);
/* Adds a key that is not there yet. Returns 0, or -1 when memory ran out. */
int block_map_insert(struct block_map *map, uint64_t key, uint32_t value);

#endif
