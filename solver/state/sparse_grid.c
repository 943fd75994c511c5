/* SPDX-License-Identifier: Apache-2.0 */
#include "state/sparse_grid.h"
#include "state/wide_window.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static void drop_block(struct particle_block *block)
{
    particle_block_release(block);
    free(block->wide_nodes);
    block->wide_nodes = NULL;
}

void sparse_grid_release(struct sparse_grid *grid)
{
    for (size_t index = 0; index < grid->block_count; index++)
        drop_block(&grid->blocks[index]);
    free(grid->blocks);
    free(grid->slab);
    free(grid->tiles);
    free(grid->tile_blocks);
    block_map_release(&grid->map);
    node_blocks_release(&grid->nodes);
    memset(grid, 0, sizeof *grid);
}

static size_t wide_node_count(const struct sparse_grid *grid)
{
    return (size_t)3 * window_row_count(grid->domain.axis_count, grid->reach);
}

static int connect_wide_nodes(struct sparse_grid *grid, struct particle_block *block)
{
    const size_t count = wide_node_count(grid);
    const int32_t reach = (int32_t)grid->reach, rows = 2 * reach + 2;
    const size_t axes = grid->domain.axis_count;
    if (block->wide_nodes == NULL)
        block->wide_nodes = malloc(count * sizeof *block->wide_nodes);
    if (block->wide_nodes == NULL)
        return -1;
    for (size_t index = 0; index < count; index++) {
        const int32_t row = (int32_t)(index / 3);
        const uint32_t nodes = node_blocks_require(
            &grid->nodes, block->cell[0] + ((int32_t)(index % 3) - 1) * LANE_COUNT,
            block->cell[1] + (axes > 1 ? row % rows - reach : 0),
            block->cell[2] + (axes > 2 ? row / rows - reach : 0));
        if (nodes == BLOCK_NONE)
            return -1;
        block->wide_nodes[index] = nodes;
    }
    return 0;
}

static int connect_nodes(struct sparse_grid *grid, struct particle_block *block)
{
    for (int corner = 0; corner < 1 << grid->domain.axis_count; corner++) {
        const uint32_t nodes =
            node_blocks_require(&grid->nodes, block->cell[0] + (corner & 1 ? LANE_COUNT : 0),
                                block->cell[1] + (corner >> 1 & 1), block->cell[2] + (corner >> 2));
        if (nodes == BLOCK_NONE)
            return -1;
        block->nodes[corner] = nodes;
    }
    return grid->reach == 0 ? 0 : connect_wide_nodes(grid, block);
}

uint32_t sparse_grid_find_block(const struct sparse_grid *grid, const int32_t cell[3])
{
    return block_map_find(&grid->map, block_key(cell[0] / LANE_COUNT, cell[1], cell[2]));
}

uint32_t sparse_grid_require_block(struct sparse_grid *grid, const int32_t cell[3])
{
    const uint64_t key = block_key(cell[0] / LANE_COUNT, cell[1], cell[2]);
    const uint32_t found = block_map_find(&grid->map, key);
    if (found != BLOCK_NONE)
        return found;
    if (grid->block_count == grid->block_capacity) {
        const size_t capacity = grid->block_capacity == 0 ? 64 : 2 * grid->block_capacity;
        struct particle_block *blocks = realloc(grid->blocks, capacity * sizeof *blocks);
        if (blocks == NULL)
            return BLOCK_NONE;
        grid->blocks = blocks;
        grid->block_capacity = capacity;
    }
    struct particle_block *block = &grid->blocks[grid->block_count];
    memset(block, 0, sizeof *block);
    block->cell[0] = cell[0] / LANE_COUNT * LANE_COUNT;
    block->cell[1] = cell[1];
    block->cell[2] = cell[2];
    if (connect_nodes(grid, block) != 0 ||
        block_map_insert(&grid->map, key, (uint32_t)grid->block_count) != 0) {
        drop_block(block);
        return BLOCK_NONE;
    }
    grid->tiles_stale = true;
    return (uint32_t)grid->block_count++;
}

struct tile_key {
    uint32_t colour, x, y, block;
};

/* Tiles are `scale` blocks wide and scale x TILE_ROWS cells high. A block touches the node blocks
 * beside it and `reach` rows more, and two tiles of a colour have one tile between them. */
static int32_t tile_scale(const struct sparse_grid *grid)
{
    _Static_assert(2 * TILE_ROWS > 2 * REACH_MAX, "tiles of one colour would share nodes");
    return grid->reach > 0 ? 2 : 1;
}

static struct tile_key tile_key_of(const struct sparse_grid *grid, size_t index)
{
    const uint32_t scale = (uint32_t)tile_scale(grid);
    const uint32_t x = (uint32_t)grid->blocks[index].cell[0] / (LANE_COUNT * scale);
    const uint32_t y = (uint32_t)grid->blocks[index].cell[1] / (TILE_ROWS * scale);
    return (struct tile_key){(x & 1) | (y & 1) << 1, x, y, (uint32_t)index};
}

static int compare_tile_keys(const void *left, const void *right)
{
    const struct tile_key *a = left, *b = right;
    if (a->colour != b->colour)
        return a->colour < b->colour ? -1 : 1;
    if (a->y != b->y)
        return a->y < b->y ? -1 : 1;
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    return a->block < b->block ? -1 : 1;
}

/* By tile, and inside of a tile layer by layer. */
static int compare_blocks(const struct particle_block *a, const struct particle_block *b,
                          int32_t scale)
{
    const int32_t a_tile[2] = {a->cell[0] / (LANE_COUNT * scale), a->cell[1] / (TILE_ROWS * scale)};
    const int32_t b_tile[2] = {b->cell[0] / (LANE_COUNT * scale), b->cell[1] / (TILE_ROWS * scale)};
    const int32_t a_key[] = {(a_tile[0] & 1) | (a_tile[1] & 1) << 1,
                             a_tile[1],
                             a_tile[0],
                             a->cell[2],
                             a->cell[1],
                             a->cell[0]};
    const int32_t b_key[] = {(b_tile[0] & 1) | (b_tile[1] & 1) << 1,
                             b_tile[1],
                             b_tile[0],
                             b->cell[2],
                             b->cell[1],
                             b->cell[0]};
    for (size_t index = 0; index < sizeof a_key / sizeof a_key[0]; index++) {
        if (a_key[index] != b_key[index])
            return a_key[index] < b_key[index] ? -1 : 1;
    }
    return 0;
}

static int compare_narrow(const void *left, const void *right)
{
    return compare_blocks(left, right, 1);
}

static int compare_wide(const void *left, const void *right)
{
    return compare_blocks(left, right, 2);
}

static int reserve_tiles(struct sparse_grid *grid)
{
    if (grid->block_count <= grid->tile_block_capacity)
        return 0;
    const size_t capacity = grid->block_capacity;
    uint32_t *tile_blocks = realloc(grid->tile_blocks, capacity * sizeof *tile_blocks);
    if (tile_blocks == NULL)
        return -1;
    grid->tile_blocks = tile_blocks;
    struct tile *tiles = realloc(grid->tiles, capacity * sizeof *tiles);
    if (tiles == NULL)
        return -1;
    grid->tiles = tiles;
    grid->tile_block_capacity = capacity;
    return 0;
}

static void cut_tiles(struct sparse_grid *grid, const struct tile_key *keys)
{
    grid->tile_count = 0;
    size_t colour = 0;
    for (size_t index = 0; index < grid->block_count; index++) {
        const struct tile_key *key = &keys[index];
        grid->tile_blocks[index] = key->block;
        while (colour <= key->colour)
            grid->colour_begin[colour++] = grid->tile_count;
        const bool starts = index == 0 || key->colour != keys[index - 1].colour ||
                            key->x != keys[index - 1].x || key->y != keys[index - 1].y;
        if (starts)
            grid->tiles[grid->tile_count++] = (struct tile){.begin = index};
        grid->tiles[grid->tile_count - 1].end = index + 1;
    }
    while (colour <= TILE_COLOURS)
        grid->colour_begin[colour++] = grid->tile_count;
}

/* Keys of all blocks in order: those that had tiles before are in order already, and a flow adds a
 * few in almost every step. `fresh` has room for the new ones. */
static void order_blocks(const struct sparse_grid *grid, struct tile_key *keys,
                         struct tile_key *fresh)
{
    const size_t old_count = grid->tiled_count, fresh_count = grid->block_count - old_count;
    for (size_t index = 0; index < fresh_count; index++)
        fresh[index] = tile_key_of(grid, old_count + index);
    qsort(fresh, fresh_count, sizeof *fresh, compare_tile_keys);
    size_t next = 0;
    for (size_t index = 0; index < old_count; index++) {
        const struct tile_key key = tile_key_of(grid, grid->tile_blocks[index]);
        while (next < fresh_count && compare_tile_keys(&fresh[next], &key) < 0)
            *keys++ = fresh[next++];
        *keys++ = key;
    }
    while (next < fresh_count)
        *keys++ = fresh[next++];
}

int sparse_grid_update_tiles(struct sparse_grid *grid)
{
    if (!grid->tiles_stale)
        return 0;
    struct tile_key *keys = malloc((2 * grid->block_count + 1) * sizeof *keys);
    if (keys == NULL || reserve_tiles(grid) != 0) {
        free(keys);
        return -1;
    }
    order_blocks(grid, keys, keys + grid->block_count);
    cut_tiles(grid, keys);
    free(keys);
    grid->tiles_stale = false;
    grid->tiled_count = grid->block_count;
    return 0;
}

static bool is_empty(const struct particle_block *block)
{
    return block->row_count == 0;
}

static void drop_empty_blocks(struct sparse_grid *grid)
{
    size_t kept = 0;
    for (size_t index = 0; index < grid->block_count; index++) {
        if (is_empty(&grid->blocks[index]))
            drop_block(&grid->blocks[index]);
        else
            grid->blocks[kept++] = grid->blocks[index];
    }
    grid->block_count = kept;
    grid->tiled_count = 0;
    grid->tiles_stale = true;
}

static int reconnect_blocks(struct sparse_grid *grid)
{
    for (size_t index = 0; index < grid->block_count; index++) {
        struct particle_block *block = &grid->blocks[index];
        const uint64_t key = block_key(block->cell[0] / LANE_COUNT, block->cell[1], block->cell[2]);
        if (connect_nodes(grid, block) != 0 ||
            block_map_insert(&grid->map, key, (uint32_t)index) != 0)
            return -1;
    }
    return 0;
}

int sparse_grid_purge(struct sparse_grid *grid)
{
    struct node_blocks old = grid->nodes;
    memset(&grid->nodes, 0, sizeof grid->nodes);
    grid->nodes.layout = old.layout;
    block_map_clear(&grid->map);
    drop_empty_blocks(grid);
    qsort(grid->blocks, grid->block_count, sizeof *grid->blocks,
          tile_scale(grid) == 1 ? compare_narrow : compare_wide);
    const int status = reconnect_blocks(grid);
    for (size_t index = 0; index < grid->nodes.count; index++) {
        const int32_t *place = grid->nodes.place[index];
        const uint32_t source =
            block_map_find(&old.map, block_key(place[0] / LANE_COUNT, place[1], place[2]));
        if (source != BLOCK_NONE)
            memcpy(node_values(&grid->nodes, index, 0), node_values(&old, source, 0),
                   old.layout.component_count * LANE_COUNT * sizeof(real));
    }
    node_blocks_release(&old);
    return status;
}

int sparse_grid_pack(struct sparse_grid *grid)
{
    enum { HUGE_PAGE = 2 << 20 };
    const bool first = grid->slab == NULL;
    size_t bytes = 0;
    for (size_t index = 0; index < grid->block_count; index++)
        bytes += particle_chunk_bytes(&grid->layout,
                                      particle_block_packed_rows(&grid->blocks[index], first));
    if (bytes == 0)
        return 0;
    assert(!grid->tiles_stale);
    bytes = (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
    char *slab = aligned_alloc(HUGE_PAGE, bytes);
    if (slab == NULL)
        return -1;
    (void)madvise(slab, bytes, MADV_HUGEPAGE); /* fewer page walks, where the system offers it */
    size_t offset = 0;
    for (size_t entry = 0; entry < grid->block_count; entry++) {
        struct particle_block *block = &grid->blocks[grid->tile_blocks[entry]];
        const uint32_t rows = particle_block_packed_rows(block, first);
        if (rows == 0) {
            particle_block_release(block);
            continue;
        }
        particle_block_pack(&grid->layout, block, rows, slab + offset);
        offset += particle_chunk_bytes(&grid->layout, rows);
    }
    free(grid->slab);
    grid->slab = slab;
    grid->slab_bytes = bytes;
    grid->loose_count = 0;
    return 0;
}

uint32_t sparse_grid_insert(struct sparse_grid *grid, const int32_t cell[3],
                            const struct particle_record *record, size_t *slot)
{
    const uint32_t index = sparse_grid_require_block(grid, cell);
    if (index == BLOCK_NONE)
        return BLOCK_NONE;
    struct particle_block *block = &grid->blocks[index];
    const uint32_t lane = (uint32_t)(cell[0] - block->cell[0]);
    grid->loose_count += block->lane_count[lane] >= block->row_capacity;
    if (particle_block_reserve(&grid->layout, block, block->lane_count[lane] + 1) != 0)
        return BLOCK_NONE;
    *slot = particle_block_insert(&grid->layout, block, lane, record);
    if (block->row_capacity > grid->row_max)
        grid->row_max = block->row_capacity;
    return index;
}

void sparse_grid_slot_position(const struct sparse_grid *grid, const struct particle_block *block,
                               size_t slot, double position[3])
{
    memset(position, 0, 3 * sizeof *position);
    for (uint32_t axis = 0; axis < grid->domain.axis_count; axis++) {
        const int32_t cell = block->cell[axis] + (axis == 0 ? (int32_t)(slot % LANE_COUNT) : 0);
        position[axis] =
            domain_position(&grid->domain, axis, cell,
                            particle_values(&grid->layout, block, PARTICLE_POSITION, axis)[slot]);
    }
}

size_t sparse_grid_memory(const struct sparse_grid *grid)
{
    size_t bytes =
        grid->block_capacity * sizeof *grid->blocks +
        grid->nodes.capacity * (grid->nodes.layout.component_count * LANE_COUNT * sizeof(real) +
                                sizeof *grid->nodes.place) +
        (grid->map.capacity + grid->nodes.map.capacity) * 12 +
        grid->tile_block_capacity * (sizeof *grid->tiles + sizeof *grid->tile_blocks) +
        (grid->reach > 0 ? grid->block_count * wide_node_count(grid) * sizeof(uint32_t) : 0);
    for (size_t index = 0; index < grid->block_count; index++) {
        if (!grid->blocks[index].packed)
            bytes += particle_chunk_bytes(&grid->layout, grid->blocks[index].row_capacity);
    }
    return bytes + grid->slab_bytes;
}

size_t sparse_grid_particle_count(const struct sparse_grid *grid)
{
    size_t count = 0;
    for (size_t index = 0; index < grid->block_count; index++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++)
            count += grid->blocks[index].lane_count[lane];
    }
    return count;
}

size_t sparse_grid_active_cells(const struct sparse_grid *grid)
{
    size_t count = 0;
    for (size_t index = 0; index < grid->block_count; index++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++)
            count += grid->blocks[index].lane_count[lane] > 0;
    }
    return count;
}
