/* SPDX-License-Identifier: Apache-2.0 */
/* The chunk of a block: its layout, and lanes that stay compact. */
#include "simulation_fixture.h"
#include "state/particles.h"

static struct particle_layout make_layout(bool has_body)
{
    struct particle_layout layout = {.has_body = has_body};
    layout.component_count[PARTICLE_POSITION] = 2;
    layout.component_count[PARTICLE_VELOCITY] = 2;
    layout.component_count[PARTICLE_MASS] = 1;
    layout.component_count[PARTICLE_VOLUME] = 1;
    layout.component_count[PARTICLE_STRAIN] = 4;
    particle_layout_finish(&layout);
    return layout;
}

/* Every value tells its particle and its component. */
static struct particle_record make_record(const struct particle_layout *layout, uint32_t id)
{
    struct particle_record record = {.id = id, .body = (uint16_t)(id % 7)};
    for (size_t component = 0; component < layout->double_count; component++)
        record.values[component] = 1.0 + id + 1000.0 * (double)component;
    return record;
}

static void test_fields_follow_each_other(void **state)
{
    (void)state;
    const struct particle_layout layout = make_layout(false);
    uint32_t next = 0;
    for (size_t field = 0; field < PARTICLE_FIELD_COUNT; field++) {
        assert_int_equal(layout.first_component[field], next);
        next += layout.component_count[field];
    }
    assert_int_equal(layout.double_count, next);
}

static void test_chunk_holds_all_arrays_without_overlap(void **state)
{
    (void)state;
    for (int has_body = 0; has_body < 2; has_body++) {
        const struct particle_layout layout = make_layout(has_body != 0);
        struct particle_block block = {0};
        assert_int_equal(particle_block_reserve(&layout, &block, 3), 0);
        assert_true(block.row_capacity >= 3);
        const size_t slots = (size_t)block.row_capacity * LANE_COUNT;
        const char *begin = (const char *)block.data;
        const char *end = begin + particle_chunk_bytes(&layout, block.row_capacity);
        assert_int_equal((uintptr_t)begin % 64, 0);
        for (uint32_t component = 0; component < layout.double_count; component++)
            assert_ptr_equal(particle_values(&layout, &block, PARTICLE_POSITION, component),
                             block.data + component * slots);
        assert_true((const char *)block.id >= begin + layout.double_count * slots * sizeof(real));
        assert_true((const char *)(block.id + slots) <= end);
        if (has_body) {
            assert_true(block.body >= (uint16_t *)(void *)(block.id + slots));
            assert_true((const char *)(block.body + slots) <= end);
        } else {
            assert_null(block.body);
        }
        for (size_t slot = 0; slot < slots; slot++)
            assert_int_equal(block.id[slot], PARTICLE_NONE);
        particle_block_release(&block);
    }
}

/* What the lanes should hold, as plain lists. */
struct expected {
    uint32_t id[LANE_COUNT][64];
    uint32_t count[LANE_COUNT];
};

static void check_block(const struct particle_layout *layout, const struct particle_block *block,
                        const struct expected *expected)
{
    uint32_t rows = 0;
    for (size_t lane = 0; lane < LANE_COUNT; lane++) {
        assert_int_equal(block->lane_count[lane], expected->count[lane]);
        rows = expected->count[lane] > rows ? expected->count[lane] : rows;
        for (size_t row = 0; row < block->row_capacity; row++) {
            const size_t slot = row * LANE_COUNT + lane;
            const bool filled = row < expected->count[lane];
            const uint32_t id = filled ? expected->id[lane][row] : PARTICLE_NONE;
            assert_int_equal(block->id[slot], id);
            if (block->body != NULL)
                assert_int_equal(block->body[slot], filled ? id % 7 : 0);
            for (uint32_t component = 0; component < layout->double_count; component++)
                assert_true(particle_values(layout, block, PARTICLE_POSITION, component)[slot] ==
                            (filled ? 1.0 + id + 1000.0 * component : 0.0));
        }
    }
    assert_int_equal(block->row_count, rows);
}

static void insert(const struct particle_layout *layout, struct particle_block *block,
                   struct expected *expected, uint32_t lane, uint32_t id)
{
    const struct particle_record record = make_record(layout, id);
    assert_int_equal(particle_block_reserve(layout, block, block->lane_count[lane] + 1), 0);
    const size_t slot = particle_block_insert(layout, block, lane, &record);
    assert_int_equal(slot, expected->count[lane] * LANE_COUNT + lane);
    expected->id[lane][expected->count[lane]++] = id;
}

static void take(const struct particle_layout *layout, struct particle_block *block,
                 struct expected *expected, uint32_t lane, uint32_t row)
{
    struct particle_record record;
    particle_block_remove(layout, block, (size_t)row * LANE_COUNT + lane, &record);
    const struct particle_record original = make_record(layout, expected->id[lane][row]);
    assert_int_equal(record.id, original.id);
    assert_int_equal(record.body, block->body != NULL ? original.body : 0);
    assert_memory_equal(record.values, original.values, layout->double_count * sizeof(real));
    expected->id[lane][row] = expected->id[lane][--expected->count[lane]];
}

static void test_lanes_stay_compact(void **state)
{
    (void)state;
    for (int has_body = 0; has_body < 2; has_body++) {
        const struct particle_layout layout = make_layout(has_body != 0);
        struct particle_block block = {0};
        struct expected expected = {.count = {0}};
        uint64_t random = 11;
        for (uint32_t turn = 0; turn < 500; turn++) {
            const uint32_t lane = (uint32_t)((random_value(&random) + 1) / 2 * LANE_COUNT);
            const uint32_t count = expected.count[lane];
            if (count > 0 && (count == 20 || random_value(&random) < -0.2))
                take(&layout, &block, &expected, lane,
                     (uint32_t)((random_value(&random) + 1) / 2 * count));
            else
                insert(&layout, &block, &expected, lane, turn);
            check_block(&layout, &block, &expected);
        }
        particle_block_release(&block);
    }
}

static void test_attach_copies_a_chunk(void **state)
{
    (void)state;
    const struct particle_layout layout = make_layout(true);
    struct particle_block block = {0}, copy = {0};
    struct expected expected = {.count = {0}};
    for (uint32_t id = 0; id < 9; id++)
        insert(&layout, &block, &expected, id % 3, id);
    assert_int_equal(particle_block_attach(&layout, &copy, block.row_capacity, block.data), 0);
    copy.row_count = block.row_count;
    memcpy(copy.lane_count, block.lane_count, sizeof copy.lane_count);
    assert_ptr_not_equal(copy.data, block.data);
    check_block(&layout, &copy, &expected);
    particle_block_release(&block);
    particle_block_release(&copy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields_follow_each_other),
        cmocka_unit_test(test_chunk_holds_all_arrays_without_overlap),
        cmocka_unit_test(test_lanes_stay_compact),
        cmocka_unit_test(test_attach_copies_a_chunk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
