/* SPDX-License-Identifier: Apache-2.0 */
#include "state/block_map.h"

#include <stdlib.h>
#include <string.h>

#define KEY_EMPTY UINT64_MAX

static size_t slot_of(const struct block_map *map, uint64_t key)
{
    /* Fibonacci hashing spreads neighbouring blocks over the table. */
    size_t slot = (size_t)((key * 0x9E3779B97F4A7C15u) >> 20) & (map->capacity - 1);
    while (map->keys[slot] != KEY_EMPTY && map->keys[slot] != key)
        slot = (slot + 1) & (map->capacity - 1);
    return slot;
}

static int grow(struct block_map *map)
{
    struct block_map larger = {.capacity = map->capacity == 0 ? 256 : 2 * map->capacity};
    larger.keys = malloc(larger.capacity * sizeof *larger.keys);
    larger.values = malloc(larger.capacity * sizeof *larger.values);
    if (larger.keys == NULL || larger.values == NULL) {
        block_map_release(&larger);
        return -1;
    }
    block_map_clear(&larger);
    for (size_t index = 0; index < map->capacity; index++) {
        if (map->keys[index] == KEY_EMPTY)
            continue;
        const size_t slot = slot_of(&larger, map->keys[index]);
        larger.keys[slot] = map->keys[index];
        larger.values[slot] = map->values[index];
    }
    larger.count = map->count;
    block_map_release(map);
    *map = larger;
    return 0;
}

void block_map_release(struct block_map *map)
{
    free(map->keys);
    free(map->values);
    memset(map, 0, sizeof *map);
}

void block_map_clear(struct block_map *map)
{
    if (map->capacity > 0)
        memset(map->keys, 0xFF, map->capacity * sizeof *map->keys);
    map->count = 0;
}

uint32_t block_map_find(const struct block_map *map, uint64_t key)
{
    if (map->capacity == 0)
        return BLOCK_NONE;
    const size_t slot = slot_of(map, key);
    return map->keys[slot] == key ? map->values[slot] : BLOCK_NONE;
}

int block_map_insert(struct block_map *map, uint64_t key, uint32_t value)
{
    if (2 * (map->count + 1) > map->capacity && grow(map) != 0)
        return -1;
    const size_t slot = slot_of(map, key);
    map->keys[slot] = key;
    map->values[slot] = value;
    map->count++;
    return 0;
}
