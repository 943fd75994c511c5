/* SPDX-License-Identifier: Apache-2.0 */
/* Blocks appear where material is, tiles of a colour are apart, purging keeps what lives. */
#include "simulation_fixture.h"
#include "state/sparse_grid.h"
#include "state/wide_window.h"

static void grid_init(struct sparse_grid *grid, size_t axis_count, uint32_t reach)
{
    memset(grid, 0, sizeof *grid);
    grid->domain.axis_count = axis_count;
    grid->reach = reach;
    grid->layout.component_count[PARTICLE_POSITION] = (uint32_t)axis_count;
    grid->layout.component_count[PARTICLE_VELOCITY] = (uint32_t)axis_count;
    grid->layout.component_count[PARTICLE_MASS] = 1;
    particle_layout_finish(&grid->layout);
    node_layout_init(&grid->nodes.layout, axis_count, false);
}

static uint32_t place(struct sparse_grid *grid, int32_t x, int32_t y, int32_t z, uint32_t id)
{
    const int32_t cell[3] = {x, y, z};
    const struct particle_record record = {.id = id};
    size_t slot = 0;
    const uint32_t block = sparse_grid_insert(grid, cell, &record, &slot);
    assert_int_not_equal(block, BLOCK_NONE);
    assert_int_equal(grid->blocks[block].id[slot], id);
    assert_int_equal(slot % LANE_COUNT, x % LANE_COUNT);
    return block;
}

static void test_blocks_know_their_nodes(void **state)
{
    (void)state;
    struct sparse_grid grid;
    grid_init(&grid, 3, 0);
    const int32_t first = LANE_COUNT;
    const uint32_t a = place(&grid, first + 2, 2, 3, 0);
    const uint32_t b = place(&grid, 2 * first + 1, 2, 3, 1);
    const struct particle_block *blocks = grid.blocks;
    assert_int_equal(blocks[a].cell[0], first);
    for (int corner = 0; corner < 8; corner++) {
        const int32_t *node = grid.nodes.place[blocks[a].nodes[corner]];
        assert_int_equal(node[0], first + LANE_COUNT * (corner & 1));
        assert_int_equal(node[1], 2 + (corner >> 1 & 1));
        assert_int_equal(node[2], 3 + (corner >> 2));
    }
    /* The upper nodes of a are the lower ones of its neighbour. */
    for (int corner = 1; corner < 8; corner += 2)
        assert_int_equal(blocks[a].nodes[corner], blocks[b].nodes[corner - 1]);
    assert_int_equal(grid.nodes.count, 12);
    assert_int_equal(sparse_grid_particle_count(&grid), 2);
    assert_int_equal(sparse_grid_active_cells(&grid), 2);
    sparse_grid_release(&grid);
}

/* Blocks strewn over a box, in random order. */
static void strew(struct sparse_grid *grid, size_t count, uint64_t seed)
{
    for (uint32_t id = 0; id < count; id++) {
        const int32_t x = (int32_t)((random_value(&seed) + 1) * 30);
        const int32_t y =
            grid->domain.axis_count > 1 ? (int32_t)((random_value(&seed) + 1) * 10) : 0;
        const int32_t z =
            grid->domain.axis_count > 2 ? (int32_t)((random_value(&seed) + 1) * 3) : 0;
        (void)place(grid, x, y, z, id);
    }
}

/* Node blocks that a block touches. */
static size_t touched_nodes(const struct sparse_grid *grid, const struct particle_block *block,
                            const uint32_t **nodes)
{
    *nodes = grid->reach > 0 ? block->wide_nodes : block->nodes;
    return grid->reach > 0 ? (size_t)3 * window_row_count(grid->domain.axis_count, grid->reach)
                           : (size_t)1 << grid->domain.axis_count;
}

static bool share_nodes(const struct sparse_grid *grid, const struct tile *a, const struct tile *b)
{
    const uint32_t *left = NULL, *right = NULL;
    for (size_t i = a->begin; i < a->end; i++) {
        const size_t left_count = touched_nodes(grid, &grid->blocks[grid->tile_blocks[i]], &left);
        for (size_t j = b->begin; j < b->end; j++) {
            const size_t right_count =
                touched_nodes(grid, &grid->blocks[grid->tile_blocks[j]], &right);
            for (size_t m = 0; m < left_count; m++) {
                for (size_t n = 0; n < right_count; n++) {
                    if (left[m] == right[n])
                        return true;
                }
            }
        }
    }
    return false;
}

static void tiles_of_one_colour_share_no_node_block(uint32_t reach)
{
    for (size_t axis_count = 1; axis_count <= 3; axis_count++) {
        struct sparse_grid grid;
        grid_init(&grid, axis_count, reach);
        strew(&grid, 400, axis_count);
        assert_int_equal(sparse_grid_update_tiles(&grid), 0);
        assert_false(grid.tiles_stale);
        assert_int_equal(grid.colour_begin[0], 0);
        assert_int_equal(grid.colour_begin[TILE_COLOURS], grid.tile_count);
        size_t sharing = 0;
        for (size_t colour = 0; colour < TILE_COLOURS; colour++) {
            for (size_t a = grid.colour_begin[colour]; a < grid.colour_begin[colour + 1]; a++) {
                for (size_t b = grid.colour_begin[colour]; b < a; b++)
                    assert_false(share_nodes(&grid, &grid.tiles[a], &grid.tiles[b]));
                for (size_t b = grid.colour_begin[colour + 1]; b < grid.tile_count; b++)
                    sharing += share_nodes(&grid, &grid.tiles[a], &grid.tiles[b]);
            }
        }
        assert_true(sharing > 0); /* between colours they do */
        bool *seen = calloc(grid.block_count, sizeof *seen);
        assert_non_null(seen);
        size_t next = 0;
        for (size_t tile = 0; tile < grid.tile_count; tile++) {
            assert_int_equal(grid.tiles[tile].begin, next);
            for (next = grid.tiles[tile].begin; next < grid.tiles[tile].end; next++) {
                assert_false(seen[grid.tile_blocks[next]]);
                seen[grid.tile_blocks[next]] = true;
            }
        }
        assert_int_equal(next, grid.block_count);
        free(seen);
        sparse_grid_release(&grid);
    }
}

static void test_tiles_of_one_colour_share_no_node_block(void **state)
{
    (void)state;
    for (uint32_t reach = 0; reach <= REACH_MAX; reach++)
        tiles_of_one_colour_share_no_node_block(reach);
}

/* In the corner of the domain too, where nodes lie outside; before and after blocks were sorted. */
static void check_neighbourhood(const struct sparse_grid *grid)
{
    const size_t axes = grid->domain.axis_count;
    const int32_t reach = (int32_t)grid->reach;
    for (size_t index = 0; index < grid->block_count; index++) {
        const struct particle_block *block = &grid->blocks[index];
        for (int32_t z = axes > 2 ? -reach : 0; z <= (axes > 2 ? reach + 1 : 0); z++) {
            for (int32_t y = axes > 1 ? -reach : 0; y <= (axes > 1 ? reach + 1 : 0); y++) {
                for (int32_t x = -reach; x <= LANE_COUNT + reach; x++) {
                    const size_t place = window_index(axes, grid->reach, x, y, z);
                    const uint32_t nodes = block->wide_nodes[place / LANE_COUNT];
                    assert_int_equal(grid->nodes.place[nodes][0] + (int32_t)(place % LANE_COUNT),
                                     block->cell[0] + x);
                    assert_int_equal(grid->nodes.place[nodes][1], block->cell[1] + y);
                    assert_int_equal(grid->nodes.place[nodes][2], block->cell[2] + z);
                }
            }
        }
    }
}

static void test_wide_blocks_know_their_neighbourhood(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        for (uint32_t reach = 1; reach <= REACH_MAX; reach++) {
            struct sparse_grid grid;
            grid_init(&grid, axes, reach);
            (void)place(&grid, 0, 0, 0, 0);
            strew(&grid, 50, axes);
            check_neighbourhood(&grid);
            assert_int_equal(sparse_grid_purge(&grid), 0);
            check_neighbourhood(&grid);
            sparse_grid_release(&grid);
        }
    }
}

/* What a window holds is what the nodes hold, and what is added to it arrives there. */
static void test_windows_show_the_nodes(void **state)
{
    (void)state;
    enum { REACH = 2, AXES = 2 };
    _Alignas(64) real window[(2 * REACH + 2) * WINDOW_WIDTH];
    struct sparse_grid grid;
    grid_init(&grid, AXES, REACH);
    const uint32_t index = place(&grid, 1, 0, 0, 0);
    const struct particle_block *block = &grid.blocks[index];
    const uint32_t rows = window_row_count(AXES, REACH), component = grid.nodes.layout.mass;
    for (size_t nodes = 0; nodes < grid.nodes.count; nodes++) {
        for (int32_t lane = 0; lane < LANE_COUNT; lane++)
            node_values(&grid.nodes, nodes, component)[lane] =
                (real)(grid.nodes.place[nodes][0] + lane + 100 * grid.nodes.place[nodes][1]);
    }
    window_load(&grid.nodes, block, rows, component, window);
    for (int32_t y = -REACH; y <= REACH + 1; y++) {
        for (int32_t x = -REACH; x <= LANE_COUNT + REACH; x++)
            assert_true(window[window_index(AXES, REACH, x, y, 0)] == (real)(x + 100 * y));
    }
    window_add(&grid.nodes, block, rows, component, window);
    for (size_t nodes = 0; nodes < grid.nodes.count; nodes++) {
        const real expected =
            (real)(2 * (grid.nodes.place[nodes][0] + 100 * grid.nodes.place[nodes][1]));
        assert_true(node_values(&grid.nodes, nodes, component)[0] == expected);
    }
    sparse_grid_release(&grid);
}

static uint32_t find_block(const struct sparse_grid *grid, const int32_t cell[3])
{
    return block_map_find(&grid->map, block_key(cell[0] / LANE_COUNT, cell[1], cell[2]));
}

static void test_purge_keeps_what_lives(void **state)
{
    (void)state;
    struct sparse_grid grid;
    grid_init(&grid, 2, 0);
    strew(&grid, 200, 5);
    const uint32_t component = grid.nodes.layout.mass;
    for (size_t block = 0; block < grid.nodes.count; block++)
        node_values(&grid.nodes, block, component)[1] =
            grid.nodes.place[block][0] + 100.0 * grid.nodes.place[block][1];
    size_t living = 0;
    for (size_t index = 0; index < grid.block_count; index++) {
        struct particle_block *block = &grid.blocks[index];
        for (uint32_t lane = 0; lane < LANE_COUNT && index % 3 != 0; lane++) {
            struct particle_record record;
            while (block->lane_count[lane] > 0)
                particle_block_remove(&grid.layout, block, lane, &record);
        }
        living += block->row_count > 0;
    }
    const size_t before = grid.block_count, particles = sparse_grid_particle_count(&grid);
    assert_true(living < before && living > 10);
    assert_int_equal(sparse_grid_purge(&grid), 0);
    assert_int_equal(grid.block_count, living);
    assert_true(grid.tiles_stale);
    assert_int_equal(sparse_grid_particle_count(&grid), particles);
    for (size_t index = 0; index < grid.block_count; index++) {
        const struct particle_block *block = &grid.blocks[index];
        assert_true(block->row_count > 0);
        assert_int_equal(find_block(&grid, block->cell), index);
        for (int corner = 0; corner < 4; corner++) {
            const int32_t *node = grid.nodes.place[block->nodes[corner]];
            assert_int_equal(node[0], block->cell[0] + LANE_COUNT * (corner & 1));
            assert_int_equal(node[1], block->cell[1] + (corner >> 1));
        }
    }
    bool *touched = calloc(grid.nodes.count, sizeof *touched);
    assert_non_null(touched);
    for (size_t index = 0; index < grid.block_count; index++) {
        for (int corner = 0; corner < 4; corner++)
            touched[grid.blocks[index].nodes[corner]] = true;
    }
    for (size_t block = 0; block < grid.nodes.count; block++) {
        assert_true(touched[block]);
        assert_true(node_values(&grid.nodes, block, component)[1] ==
                    grid.nodes.place[block][0] + 100.0 * grid.nodes.place[block][1]);
    }
    free(touched);
    sparse_grid_release(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blocks_know_their_nodes),
        cmocka_unit_test(test_tiles_of_one_colour_share_no_node_block),
        cmocka_unit_test(test_wide_blocks_know_their_neighbourhood),
        cmocka_unit_test(test_windows_show_the_nodes),
        cmocka_unit_test(test_purge_keeps_what_lives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
