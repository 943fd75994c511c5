/* SPDX-License-Identifier: Apache-2.0 */
/* Nothing is allocated inside a step as long as material stays in its cells; and a domain costs
 * nothing where it is empty. */
#include "simulation_fixture.h"

static size_t allocation_count;

/* The linker gives these their names.
 * NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl51-cpp,readability-identifier-naming) */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

void *__wrap_malloc(size_t size)
{
    allocation_count++;
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    allocation_count++;
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *memory, size_t size)
{
    allocation_count++;
    return __real_realloc(memory, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    allocation_count++;
    return __real_aligned_alloc(alignment, size);
}

/* NOLINTEND(bugprone-reserved-identifier,cert-dcl51-cpp,readability-identifier-naming) */

/* A column that settles between walls. */
static void build(struct simulation_fixture *fixture, const struct material *material, int64_t far)
{
    const int64_t count[3] = {16 * far, 16 * far, 16 * far};
    simulation_fixture_init(fixture, 3, 0.1, count);
    const size_t index = simulation_fixture_add_sample(fixture, material);
    simulation_fixture_add_box(fixture, index, (double[3]){0.2, 0.2, 0.2},
                               (double[3]){0.6, 0.8, 0.5}, 2);
    fixture->scene.gravity[1] = -9.81;
    fixture->scene.solver.anti_locking = TALUS_CONTROL_CELL;
    fixture->scene.solver.viscous_damping = 0.1;
    simulation_fixture_add_plane(fixture, "floor", 1, 0.2, 1, "friction", 0.3)->peak_window = 0.01;
    simulation_fixture_add_plane(fixture, "x low", 0, 0.2, 1, "slip", 0);
    simulation_fixture_add_plane(fixture, "x high", 0, 0.6, -1, "slip", 0);
    simulation_fixture_add_plane(fixture, "z low", 2, 0.2, 1, "slip", 0);
    simulation_fixture_add_plane(fixture, "z high", 2, 0.5, -1, "slip", 0);
}

static void test_steps_allocate_nothing(void **state)
{
    (void)state;
    for (size_t index = 0; index < material_count; index++) {
        struct simulation_fixture fixture;
        build(&fixture, material_table[index], 1);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        struct talus_error error = {0};
        assert_true(allocation_count > 0); /* creating does, so the counter counts */
        allocation_count = 0;
        for (size_t step = 0; step < 200; step++) {
            if (talus_simulation_step(simulation, &error) != TALUS_OK)
                fail_msg("%s", error.text);
        }
        assert_int_equal(allocation_count, 0);
        talus_simulation_destroy(simulation);
    }
}

static void test_an_empty_domain_costs_nothing(void **state)
{
    (void)state;
    size_t bytes[2], count[2];
    for (size_t index = 0; index < 2; index++) {
        struct simulation_fixture fixture;
        struct talus_simulation_state now;
        build(&fixture, material_find("linear_elastic"), index == 0 ? 1 : 10000);
        allocation_count = 0;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        simulation_run_steps(simulation, 3);
        count[index] = allocation_count;
        talus_simulation_get_state(simulation, &now);
        bytes[index] = now.memory_bytes;
        assert_true(now.memory_bytes > now.particle_count * 100);
        talus_simulation_destroy(simulation);
    }
    assert_int_equal(bytes[0], bytes[1]);
    assert_int_equal(count[0], count[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steps_allocate_nothing),
        cmocka_unit_test(test_an_empty_domain_costs_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
