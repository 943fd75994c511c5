/* SPDX-License-Identifier: Apache-2.0 */
/* Linear fits over cells: what they preserve, that they project, and where they fall back. */
#include "antilocking/anti_locking.h"
#include "antilocking/cell_fit.h"
#include "simulation_fixture.h"

enum { ROWS = 9, COUNT = ROWS * LANE_COUNT, COMPONENTS = 6 };
/* Some dozen sums of ROWS numbers around 1, over a spread of about 1/12. */
#define ROUNDING (500 * (double)REAL_EPSILON)

struct bench {
    size_t axes;
    _Alignas(64) real weight[COUNT], position[3][COUNT], tensor[COMPONENTS][COUNT];
    real *arrays[COMPONENTS];
    struct cell_fit fit;
};

/* Random particles of unequal mass; in lane 1 some slots are empty. */
static void bench_init(struct bench *bench, size_t axes)
{
    uint64_t random = 29 + axes;
    memset(bench, 0, sizeof *bench);
    bench->axes = axes;
    for (size_t slot = 0; slot < COUNT; slot++) {
        const bool empty = slot % LANE_COUNT == 1 && slot > 5 * LANE_COUNT;
        bench->weight[slot] = empty ? 0 : (real)(1.5 + random_value(&random));
        for (size_t axis = 0; axis < axes; axis++)
            bench->position[axis][slot] = (real)(0.5 * random_value(&random));
        for (size_t component = 0; component < COMPONENTS; component++)
            bench->tensor[component][slot] = (real)random_value(&random);
    }
    for (size_t component = 0; component < COMPONENTS; component++)
        bench->arrays[component] = bench->tensor[component];
}

static void prepare(struct bench *bench)
{
    const real *position[3] = {bench->position[0], bench->position[1], bench->position[2]};
    cell_fit_init(&bench->fit, COUNT, bench->axes, bench->weight, position);
}

static size_t components_of(size_t axes)
{
    return axes == 1 ? 3 : axes == 2 ? 4 : 6;
}

static void fit_tensor(struct bench *bench, bool constant_trace)
{
    cell_fit_tensor(&bench->fit, components_of(bench->axes), 3, constant_trace, NULL,
                    bench->arrays);
}

static real trace_at(const struct bench *bench, size_t slot)
{
    return bench->tensor[0][slot] + bench->tensor[1][slot] + bench->tensor[2][slot];
}

/* A linear field in the normal components and a constant one in the shears; what `full` has to
 * leave as it is, and without the slopes (or without that of the trace) every fit. */
static void set_field(struct bench *bench, double slope, bool constant_trace)
{
    for (size_t slot = 0; slot < COUNT; slot++) {
        double sum = 0;
        for (size_t component = 0; component < COMPONENTS; component++) {
            double value = 0.3 + 0.1 * (double)component;
            for (size_t axis = 0; axis < bench->axes && component < 3; axis++)
                value += slope * (1.0 + (double)(component * 3 + axis)) *
                         (double)bench->position[axis][slot];
            if (component == 2 && constant_trace)
                value = 2.0 - sum;
            sum += value;
            bench->tensor[component][slot] = (real)value;
        }
    }
}

static void assert_unchanged(const struct bench *bench, const struct bench *before)
{
    for (size_t component = 0; component < COMPONENTS; component++) {
        for (size_t slot = 0; slot < COUNT; slot++)
            assert_close((double)bench->tensor[component][slot],
                         (double)before->tensor[component][slot], ROUNDING, 1.0);
    }
}

static void test_fields_preserved(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        for (int kind = 0; kind < 4; kind++) {
            struct bench bench, before;
            bench_init(&bench, axes);
            prepare(&bench);
            /* Constants by both; lines by full; lines of constant trace by full_constant_volume. */
            set_field(&bench, kind < 2 ? 0.0 : 0.2, kind == 3);
            memcpy(before.tensor, bench.tensor, sizeof before.tensor);
            fit_tensor(&bench, kind % 2 == 1);
            assert_unchanged(&bench, &before);
        }
    }
}

static void test_projection(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        for (int constant = 0; constant < 2; constant++) {
            struct bench bench, before;
            bench_init(&bench, axes);
            prepare(&bench);
            memcpy(before.tensor, bench.tensor, sizeof before.tensor);
            fit_tensor(&bench, constant != 0);
            double change = 0;
            for (size_t slot = 0; slot < COUNT; slot++) {
                if (bench.weight[slot] > 0)
                    change += fabs((double)(bench.tensor[0][slot] - before.tensor[0][slot]));
                else
                    assert_true(bench.tensor[0][slot] == before.tensor[0][slot]);
            }
            assert_true(change > 0.1);
            memcpy(before.tensor, bench.tensor, sizeof before.tensor);
            fit_tensor(&bench, constant != 0);
            assert_unchanged(&bench, &before);
        }
    }
}

/* The fit in the mass-weighted scalar product: the rest is orthogonal to 1 and x. */
static void test_orthogonality(void **state)
{
    (void)state;
    struct bench bench, before;
    bench_init(&bench, 3);
    prepare(&bench);
    memcpy(before.tensor, bench.tensor, sizeof before.tensor);
    fit_tensor(&bench, false);
    for (size_t lane = 0; lane < LANE_COUNT; lane++) {
        for (size_t component = 0; component < COMPONENTS; component++) {
            double moments[4] = {0};
            for (size_t slot = lane; slot < COUNT; slot += LANE_COUNT) {
                const double rest =
                    (double)bench.weight[slot] *
                    (double)(bench.tensor[component][slot] - before.tensor[component][slot]);
                moments[3] += rest;
                for (size_t axis = 0; axis < 3; axis++)
                    moments[axis] += rest * (double)bench.position[axis][slot];
            }
            /* Shears are fitted by constants only. */
            for (size_t index = component < 3 ? 0 : 3; index < 4; index++)
                assert_close(moments[index], 0, ROUNDING, 10.0);
        }
    }
}

/* Of the trace only the mean is left, and the deviator is that of the linear fit. */
static void test_constant_trace(void **state)
{
    (void)state;
    struct bench bench, full;
    bench_init(&bench, 2);
    bench_init(&full, 2);
    prepare(&bench);
    prepare(&full);
    fit_tensor(&bench, true);
    fit_tensor(&full, false);
    for (size_t slot = 0; slot < COUNT; slot++) {
        if (bench.weight[slot] == 0)
            continue;
        assert_close((double)trace_at(&bench, slot), (double)trace_at(&bench, slot % LANE_COUNT),
                     ROUNDING, 1.0);
        assert_close((double)(bench.tensor[0][slot] - bench.tensor[1][slot]),
                     (double)(full.tensor[0][slot] - full.tensor[1][slot]), ROUNDING, 1.0);
    }
}

/* Turning the cell turns the fit of the normal components by quarters: axes are exchanged. */
static void test_exchanged_axes(void **state)
{
    (void)state;
    struct bench bench, turned;
    bench_init(&bench, 2);
    bench_init(&turned, 2);
    memcpy(turned.position[0], bench.position[1], sizeof turned.position[0]);
    memcpy(turned.position[1], bench.position[0], sizeof turned.position[1]);
    memcpy(turned.tensor[0], bench.tensor[1], sizeof turned.tensor[0]);
    memcpy(turned.tensor[1], bench.tensor[0], sizeof turned.tensor[1]);
    prepare(&bench);
    prepare(&turned);
    fit_tensor(&bench, false);
    fit_tensor(&turned, false);
    for (size_t slot = 0; slot < COUNT; slot++) {
        assert_close((double)turned.tensor[0][slot], (double)bench.tensor[1][slot], ROUNDING, 1.0);
        assert_close((double)turned.tensor[3][slot], (double)bench.tensor[3][slot], ROUNDING, 1.0);
    }
}

/* Three particles on a line in 2D, four in a plane in 3D: only the volumetric part is fitted. */
static void test_singular(void **state)
{
    (void)state;
    for (size_t axes = 2; axes <= 3; axes++) {
        struct bench bench, before;
        bench_init(&bench, axes);
        for (size_t slot = 0; slot < COUNT; slot++) {
            if (slot % LANE_COUNT != 2)
                continue;
            if (slot / LANE_COUNT > axes)
                bench.weight[slot] = 0;
            double sum = 0.1;
            for (size_t axis = 0; axis + 1 < axes; axis++)
                sum -= (double)bench.position[axis][slot];
            bench.position[axes - 1][slot] = (real)sum;
        }
        memcpy(before.tensor, bench.tensor, sizeof before.tensor);
        prepare(&bench);
        assert_int_equal(bench.fit.fall_backs, 1);
        fit_tensor(&bench, false);
        double mean = 0, mass = 0;
        for (size_t slot = 2; slot < COUNT; slot += LANE_COUNT) {
            mean += (double)(bench.weight[slot] * trace_at(&before, slot));
            mass += (double)bench.weight[slot];
        }
        for (size_t slot = 2; slot < (axes + 1) * LANE_COUNT; slot += LANE_COUNT) {
            assert_close((double)trace_at(&bench, slot), mean / mass, ROUNDING, 1.0);
            assert_close((double)(bench.tensor[0][slot] - bench.tensor[1][slot]),
                         (double)(before.tensor[0][slot] - before.tensor[1][slot]), ROUNDING, 1.0);
            assert_true(bench.tensor[3][slot] == before.tensor[3][slot]);
        }
    }
}

/* In plane stress the trace is of two components, and zz stays. M M* = 1: a fit that changes
 * nothing gives back each component. */
static void test_plane_stress(void **state)
{
    (void)state;
    struct bench bench, before;
    bench_init(&bench, 2);
    prepare(&bench);
    memcpy(before.tensor, bench.tensor, sizeof before.tensor);
    cell_fit_tensor(&bench.fit, 4, 2, true, NULL, bench.arrays);
    double first = 0, second = 0;
    for (size_t slot = 0; slot < COUNT; slot++) {
        assert_true(bench.tensor[2][slot] == before.tensor[2][slot]);
        if (slot % LANE_COUNT != 0)
            continue;
        first += (double)(bench.weight[slot] * bench.tensor[0][slot]);
        second += (double)(bench.weight[slot] * before.tensor[0][slot]);
        assert_close((double)(bench.tensor[0][slot] + bench.tensor[1][slot]),
                     (double)(bench.tensor[0][0] + bench.tensor[1][0]), ROUNDING, 1.0);
    }
    assert_close(first, second, ROUNDING, 10.0);
    set_field(&bench, 0.2, false);
    memcpy(before.tensor, bench.tensor, sizeof before.tensor);
    cell_fit_tensor(&bench.fit, 4, 2, false, NULL, bench.arrays);
    assert_unchanged(&bench, &before);
}

/* A scalar is fitted as a component is, and a given trace is taken over. */
static void test_scalar_and_trace(void **state)
{
    (void)state;
    struct bench bench, scalar;
    _Alignas(64) real trace[COUNT];
    bench_init(&bench, 3);
    bench_init(&scalar, 3);
    prepare(&bench);
    prepare(&scalar);
    fit_tensor(&bench, false);
    cell_fit_scalar(&scalar.fit, scalar.tensor[0]);
    for (size_t slot = 0; slot < COUNT; slot++) {
        assert_close((double)scalar.tensor[0][slot], (double)bench.tensor[0][slot], ROUNDING, 1.0);
        trace[slot] = (real)((double)slot / COUNT);
    }
    cell_fit_tensor(&bench.fit, 6, 3, false, trace, bench.arrays);
    for (size_t slot = 0; slot < COUNT; slot++) {
        if (bench.weight[slot] > 0)
            assert_close((double)trace_at(&bench, slot), (double)trace[slot], ROUNDING, 1.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields_preserved), cmocka_unit_test(test_projection),
        cmocka_unit_test(test_orthogonality),    cmocka_unit_test(test_constant_trace),
        cmocka_unit_test(test_exchanged_axes),   cmocka_unit_test(test_singular),
        cmocka_unit_test(test_plane_stress),     cmocka_unit_test(test_scalar_and_trace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
