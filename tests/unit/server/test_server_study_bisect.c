/* SPDX-License-Identifier: Apache-2.0 */
/* Conditions, and the search for their edge. */
#include "server_fixture.h"
#include "study_bisect.h"

#include <stdlib.h>

#include <math.h>
#include <string.h>

static enum condition_answer ask(const char *text, const char *metrics_text)
{
    struct condition condition;
    struct expression_mistake mistake;
    const char *missing = NULL;
    json_t *metrics = json_loads(metrics_text, 0, NULL);
    if (!condition_read(text, &condition, &mistake))
        fail_msg("%s: %zu %s", text, mistake.position, mistake.text);
    enum condition_answer answer = condition_evaluate(&condition, metrics, &missing);
    assert_int_equal(answer == CONDITION_NO_METRIC, missing != NULL);
    json_decref(metrics);
    return answer;
}

static void test_condition(void **state)
{
    static const char metrics[] = "{\"energy_error\":0.01,\"probe.run out.final\":-2,\"n\":null}";
    (void)state;
    assert_int_equal(ask("energy_error < 0.02", metrics), CONDITION_MET);
    assert_int_equal(ask("energy_error<0.01", metrics), CONDITION_NOT_MET);
    assert_int_equal(ask("energy_error <= 1e-2", metrics), CONDITION_MET);
    assert_int_equal(ask("energy_error > 0.01", metrics), CONDITION_NOT_MET);
    assert_int_equal(ask(" energy_error >= .01 ", metrics), CONDITION_MET);
    assert_int_equal(ask("probe.run out.final < -1.5", metrics), CONDITION_MET);
    assert_int_equal(ask("energy_error < 1&&probe.run out.final >= -2", metrics), CONDITION_MET);
    assert_int_equal(ask("energy_error < 1 && probe.run out.final > -2", metrics),
                     CONDITION_NOT_MET);
    assert_int_equal(ask("n < 1", metrics), CONDITION_NOT_MET);
    assert_int_equal(ask("n > 1", metrics), CONDITION_NOT_MET);
    assert_int_equal(ask("energy_eror < 1", metrics), CONDITION_NO_METRIC);
    assert_int_equal(ask("energy_error < 0 && other < 1", metrics), CONDITION_NO_METRIC);
}

static void test_condition_mistakes(void **state)
{
    static const struct {
        const char *text;
        size_t position;
    } cases[] = {
        {"", 0},
        {"a", 1},
        {"a <", 3},
        {"a < b", 4},
        {"< 1", 0},
        {"a == 1", 2},
        {"a = 1", 2},
        {"a < 1 &&", 8},
        {"a < 1 & b<1", 6},
        {"a < 1 || b < 1", 6},
        {"a < 1 b < 1", 6},
        {"a && b", 2},
        {"a < 1e999", 4},
        {"a < 1-2", 4},
        {"a < 0x1", 5},
        {"a < nan", 4},
        {"a =< 1", 2},
        {"a << 1", 3},
        {"a < 1 && && b < 1", 9},
    };
    char many[20 * (CONDITION_TERM_MAX + 1)] = "a < 1", longest[2 * CONDITION_METRIC_SIZE];
    struct condition condition;
    struct expression_mistake mistake;
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        if (condition_read(cases[index].text, &condition, &mistake) ||
            mistake.position != cases[index].position)
            fail_msg("'%s': %zu %s", cases[index].text, mistake.position, mistake.text);
    }
    for (int term = 1; term < CONDITION_TERM_MAX; term++)
        (void)strcat(many, " && a < 1");
    assert_true(condition_read(many, &condition, &mistake));
    (void)strcat(many, " && a < 1");
    assert_false(condition_read(many, &condition, &mistake));
    memset(longest, 'a', sizeof longest);
    (void)strcpy(longest + CONDITION_METRIC_SIZE, " < 1");
    assert_false(condition_read(longest, &condition, &mistake));
    (void)strcpy(longest + CONDITION_METRIC_SIZE - 1, " < 1");
    assert_true(condition_read(longest, &condition, &mistake));
}

enum { TRIAL_MAX = 100 };

/* Runs a whole search; the condition holds on one side of the edge. */
static struct bisect_step search(const struct study_bisect *bisect, double edge, bool met_below,
                                 size_t *runs)
{
    struct bisect_trial trials[TRIAL_MAX];
    size_t count = 0;
    for (;;) {
        struct bisect_step step = study_bisect_next(bisect, trials, count);
        *runs = count;
        if (step.state != BISECT_RUN)
            return step;
        assert_true(step.run_count >= 1 && count + step.run_count <= TRIAL_MAX);
        for (size_t index = 0; index < step.run_count; index++) {
            for (size_t other = 0; other < count; other++)
                assert_true(trials[other].value != step.run[index]);
            trials[count++] = (struct bisect_trial){.value = step.run[index],
                                                    .met = (step.run[index] < edge) == met_below};
        }
    }
}

static void test_search(void **state)
{
    static const struct {
        double low, high, tolerance, edge;
    } cases[] = {
        {0.1, 2.0, 0.01, 0.7531},
        {-1.0, 1.0, 1e-3, 0.0},
        {-3e9, -1e9, 1.0, -1.23456789e9},
        {1e-12, 1e-6, 1e-10, 3.3e-9},
        {0.0, 1.0, 2.0, 0.3},
        {0.0, 1.0, 1e-12, 0.999},
        {5.0, 5.0000001, 1e-10, 5.00000002},
    };
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        for (int met_below = 0; met_below <= 1; met_below++) {
            const double edge = cases[index].edge;
            struct study_bisect bisect = {.low = cases[index].low,
                                          .high = cases[index].high,
                                          .tolerance = cases[index].tolerance};
            size_t runs;
            struct bisect_step step = search(&bisect, edge, met_below != 0, &runs);
            assert_int_equal(step.state, BISECT_DONE);
            assert_true(step.low < edge && edge <= step.high);
            assert_true(step.high - step.low <= bisect.tolerance ||
                        bisect.tolerance >= bisect.high - bisect.low);
            assert_true(step.value == (met_below != 0 ? step.low : step.high));
            assert_true(runs <= study_bisect_runs_max(&bisect));
            assert_true(runs + 2 >= study_bisect_runs_max(&bisect));
        }
    }
}

static void test_ends(void **state)
{
    const struct study_bisect bisect = {.low = 1.0, .high = 2.0, .tolerance = 0.1};
    struct bisect_trial trials[] = {{2.0, true}, {1.0, true}, {7.0, false}};
    (void)state;
    struct bisect_step step = study_bisect_next(&bisect, trials, 0);
    assert_int_equal(step.state, BISECT_RUN);
    assert_int_equal(step.run_count, 2); /* both ends at once */
    assert_true(step.run[0] == 1.0 && step.run[1] == 2.0);
    step = study_bisect_next(&bisect, trials, 1);
    assert_int_equal(step.run_count, 1);
    assert_true(step.run[0] == 1.0);
    step = study_bisect_next(&bisect, trials, 3);
    assert_int_equal(step.state, BISECT_FAILED);
    assert_non_null(strstr(step.detail, "both ends meet"));
    trials[0].met = trials[1].met = false;
    step = study_bisect_next(&bisect, trials, 2);
    assert_int_equal(step.state, BISECT_FAILED);
    assert_non_null(strstr(step.detail, "neither end"));
    trials[0].met = true; /* what lies outside does not matter */
    step = study_bisect_next(&bisect, trials, 3);
    assert_int_equal(step.state, BISECT_RUN);
    assert_true(step.run_count == 1 && step.run[0] == 1.5);
}

/* Trials that come back from a table in any order, and with the digits of a table, lead on alike.
 */
static void test_recovery(void **state)
{
    const struct study_bisect bisect = {.low = 0.1, .high = 0.9, .tolerance = 1e-6};
    struct bisect_trial trials[TRIAL_MAX];
    size_t count = 0;
    (void)state;
    for (;;) {
        struct bisect_step step = study_bisect_next(&bisect, trials, count);
        if (step.state == BISECT_DONE)
            break;
        for (size_t index = 0; index < step.run_count; index++) {
            char text[32];
            (void)snprintf(text, sizeof text, "%.15g", step.run[index]);
            double value = strtod(text, NULL);
            memmove(trials + 1, trials, count * sizeof *trials);
            trials[0] = (struct bisect_trial){value, value < 0.4321};
            count++;
        }
        assert_true(count < 40);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_condition), cmocka_unit_test(test_condition_mistakes),
        cmocka_unit_test(test_search),    cmocka_unit_test(test_ends),
        cmocka_unit_test(test_recovery),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
