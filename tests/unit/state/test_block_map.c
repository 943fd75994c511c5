/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation_fixture.h"
#include "state/block_map.h"

static void test_empty_map_finds_nothing(void **state)
{
    (void)state;
    const struct block_map map = {0};
    assert_int_equal(block_map_find(&map, block_key(0, 0, 0)), BLOCK_NONE);
}

static void test_keys_are_distinct_up_to_the_largest_grid(void **state)
{
    (void)state;
    enum { LARGEST = (1 << 21) - 1 };
    static const int32_t places[4] = {0, 1, LARGEST - 1, LARGEST};
    uint64_t keys[64];
    size_t count = 0;
    for (size_t x = 0; x < 4; x++) {
        for (size_t y = 0; y < 4; y++) {
            for (size_t z = 0; z < 4; z++)
                keys[count++] = block_key(places[x], places[y], places[z]);
        }
    }
    for (size_t a = 0; a < count; a++) {
        for (size_t b = 0; b < a; b++)
            assert_true(keys[a] != keys[b]);
        assert_true(keys[a] != UINT64_MAX);
    }
}

/* Against a plain three-dimensional array, through several doublings. */
static void test_finds_what_was_inserted(void **state)
{
    (void)state;
    enum { X = 23, Y = 19, Z = 7 };
    static uint32_t values[X][Y][Z];
    struct block_map map = {0};
    uint64_t random = 3;
    size_t inserted = 0;
    memset(values, 0xFF, sizeof values);
    for (size_t turn = 0; turn < 2000; turn++) {
        const int32_t x = (int32_t)((random_value(&random) + 1) / 2 * X);
        const int32_t y = (int32_t)((random_value(&random) + 1) / 2 * Y);
        const int32_t z = (int32_t)((random_value(&random) + 1) / 2 * Z);
        if (values[x][y][z] != BLOCK_NONE)
            continue;
        values[x][y][z] = (uint32_t)inserted++;
        assert_int_equal(block_map_insert(&map, block_key(x, y, z), values[x][y][z]), 0);
    }
    assert_true(inserted > 1000);
    assert_int_equal(map.count, inserted);
    for (int32_t x = 0; x < X; x++) {
        for (int32_t y = 0; y < Y; y++) {
            for (int32_t z = 0; z < Z; z++)
                assert_int_equal(block_map_find(&map, block_key(x, y, z)), values[x][y][z]);
        }
    }
    const size_t capacity = map.capacity;
    block_map_clear(&map);
    assert_int_equal(map.count, 0);
    assert_int_equal(map.capacity, capacity);
    assert_int_equal(block_map_find(&map, block_key(1, 1, 1)), BLOCK_NONE);
    block_map_release(&map);
    assert_null(map.keys);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty_map_finds_nothing),
        cmocka_unit_test(test_keys_are_distinct_up_to_the_largest_grid),
        cmocka_unit_test(test_finds_what_was_inserted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
