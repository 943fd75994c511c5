/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_suite.h"

#include "benchmark_clock.h"
#include "benchmark_machine.h"
#include "benchmark_operations.h"
#include "benchmark_plan.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { SET_MAX = 2 * PLAN_SMALL_MAX };
/* Shares of the critical step for what is not stable at the default one. */
static const double careful[] = {0.1, 0.025, 0.005};
enum { CAREFUL_COUNT = sizeof careful / sizeof careful[0] };
/* Memory of a particle with all that belongs to it, generously [bytes]. */
#define BYTES_PER_PARTICLE 700.0

const char *benchmark_set_word(enum benchmark_set set)
{
    static const char *const words[BENCHMARK_SET_COUNT] = {
        "ordering", "size", "density", "anti_locking", "domain", "small", "flow", "single"};
    return words[set];
}

const char *benchmark_form_word(enum benchmark_form form)
{
    return benchmark_plans[form].word;
}

double benchmark_row_gigaflops(const struct benchmark_row *row)
{
    return row->operations / row->result.nanoseconds;
}

double benchmark_row_gigabytes(const struct benchmark_row *row)
{
    return row->result.bytes_moved / row->result.nanoseconds;
}

double benchmark_row_stage_sum(const struct benchmark_row *row)
{
    double sum = 0;
    for (size_t stage = 0; stage < STAGE_COUNT; stage++)
        sum += row->result.stage_nanoseconds[stage];
    return sum;
}

static struct benchmark_setup base_setup(const struct benchmark_case *subject, size_t particles)
{
    return (struct benchmark_setup){.subject = subject,
                                    .particles = particles,
                                    .per_axis = subject->per_axis,
                                    .threads = 1,
                                    .last = true,
                                    .domain_factor = 1};
}

/* Room for that many more rows. */
static bool reserve_rows(struct benchmark_suite *suite, size_t count)
{
    if (suite->row_count + count <= suite->row_capacity)
        return true;
    const size_t capacity = 2 * (suite->row_capacity + count);
    struct benchmark_row *rows = realloc(suite->rows, capacity * sizeof *rows);
    if (rows == NULL)
        return false;
    suite->rows = rows;
    suite->row_capacity = capacity;
    return true;
}

/* What is not stable at the default step gets a shorter one, alone; what is not stable then either
 * stays `failed`. */
static bool measure_carefully(struct benchmark_suite *suite, struct benchmark_setup *setups,
                              size_t count, const struct benchmark_effort *effort,
                              struct benchmark_result *results)
{
    if (!benchmark_measure(&suite->ceiling, setups, count, effort, results))
        return false;
    for (size_t index = 0; index < count; index++) {
        for (size_t try = 0; try < CAREFUL_COUNT && results[index].failed; try++) {
            setups[index].courant = careful[try];
            if (!benchmark_measure(&suite->ceiling, &setups[index], 1, effort, &results[index]))
                return false;
            results[index].relative = NAN;
        }
    }
    return true;
}

static void tell(const struct benchmark_suite *suite, enum benchmark_set set,
                 const struct benchmark_setup *setup)
{
    (void)fprintf(stderr, "%6.0f s  %s: %s, %s, %zu particles\n",
                  benchmark_wall_seconds() - suite->seconds, benchmark_set_word(set),
                  setup->subject->name, benchmark_body_word(setup), setup->particles);
}

/* Measures a set and appends its rows; with `looks`, each setup is also looked at. */
static bool run_set(struct benchmark_suite *suite, enum benchmark_set set,
                    struct benchmark_setup *setups, size_t count,
                    const struct benchmark_effort *effort, bool looks)
{
    struct benchmark_result results[SET_MAX];
    double bytes = 0;
    for (size_t index = 0; index < count; index++)
        bytes += BYTES_PER_PARTICLE * (double)setups[index].particles;
    if (suite->form != BENCHMARK_ONE)
        tell(suite, set, &setups[count - 1]);
    if (benchmark_free_memory() > 0 && bytes > benchmark_free_memory()) {
        (void)fprintf(stderr, "          left out: not enough memory\n");
        return true;
    }
    if (!reserve_rows(suite, count))
        return false;
    if (suite->form == BENCHMARK_ONE
            ? !benchmark_measure(&suite->ceiling, setups, count, effort, results)
            : !measure_carefully(suite, setups, count, effort, results))
        return false;
    const size_t first = suite->row_count;
    for (size_t index = 0; index < count; index++) {
        struct benchmark_row *row = &suite->rows[suite->row_count++];
        *row = (struct benchmark_row){.set = set,
                                      .first = first,
                                      .setup = setups[index],
                                      .effort = *effort,
                                      .result = results[index],
                                      .witness = {NAN, NAN},
                                      .operations = benchmark_operations(&setups[index])};
        if (looks && !results[index].failed && setups[index].threads == 1 &&
            !benchmark_witness_call(&setups[index], benchmark_plans[suite->form].witness_particles,
                                    effort->steps, &row->witness))
            return false;
    }
    return true;
}

/* Both orderings; `threads` 2: with one thread and with two. */
static bool run_orderings(struct benchmark_suite *suite, enum benchmark_set set,
                          struct benchmark_setup base, int threads,
                          const struct benchmark_effort *effort)
{
    struct benchmark_setup setups[SET_MAX];
    size_t count = 0;
    for (int team = 1; team <= threads; team++) {
        for (int last = 1; last >= 0; last--) {
            setups[count] = base;
            setups[count].threads = team;
            setups[count++].last = last == 1;
        }
    }
    return run_set(suite, set, setups, count, effort, true);
}

static bool is_main_case(const struct benchmark_case *subject)
{
    return strcmp(subject->name, "drucker_prager_cap_3d") == 0;
}

static bool run_ordering_sets(struct benchmark_suite *suite, const struct benchmark_plan *plan)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        const struct benchmark_case *subject = &benchmark_cases[index];
        const int threads = plan->every || is_main_case(subject) ? suite->threads : 1;
        if (!run_orderings(suite, BENCHMARK_ORDERING, base_setup(subject, plan->particles), threads,
                           &plan->effort))
            return false;
    }
    return true;
}

static bool run_size_sets(struct benchmark_suite *suite, const struct benchmark_plan *plan)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        const struct benchmark_case *subject = &benchmark_cases[index];
        for (int last = 1; last >= 0 && (plan->every || is_main_case(subject)); last--) {
            struct benchmark_setup setups[PLAN_SIZE_MAX];
            size_t count = 0;
            while (count < PLAN_SIZE_MAX && plan->sizes[count] > 0) {
                setups[count] = base_setup(subject, plan->sizes[count]);
                setups[count++].last = last == 1;
            }
            if (!run_set(suite, BENCHMARK_SIZE, setups, count, &plan->size_effort, false))
                return false;
        }
    }
    return true;
}

/* Nine and four particles per cell in two dimensions. */
static bool run_density_sets(struct benchmark_suite *suite, const struct benchmark_plan *plan)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        const struct benchmark_case *subject = &benchmark_cases[index];
        if (subject->axis_count != 2 || !(plan->every || subject->plastic))
            continue;
        struct benchmark_setup setups[2] = {base_setup(subject, plan->particles),
                                            base_setup(subject, plan->particles)};
        setups[1].per_axis = 2;
        if (!run_set(suite, BENCHMARK_DENSITY, setups, 2, &plan->effort, true))
            return false;
    }
    return true;
}

static bool run_anti_locking_sets(struct benchmark_suite *suite, const struct benchmark_plan *plan)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        const struct benchmark_case *subject = &benchmark_cases[index];
        for (int last = 1; last >= 0 && subject->locks; last--) {
            struct benchmark_setup setups[3] = {base_setup(subject, plan->particles),
                                                base_setup(subject, plan->particles),
                                                base_setup(subject, plan->particles)};
            setups[0].last = setups[1].last = setups[2].last = last == 1;
            setups[1].control = "cell";
            setups[2].control = "node";
            if (!run_set(suite, BENCHMARK_ANTI_LOCKING, setups, 3, &plan->effort, false))
                return false;
        }
    }
    return true;
}

static bool run_domain_sets(struct benchmark_suite *suite, const struct benchmark_plan *plan)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        const struct benchmark_case *subject = &benchmark_cases[index];
        struct benchmark_setup setups[PLAN_SIZE_MAX];
        if (!is_main_case(subject) && !(plan->every && subject->locks))
            continue;
        for (size_t grid = 0; grid < PLAN_SIZE_MAX; grid++) {
            setups[grid] = base_setup(subject, plan->domain_particles);
            setups[grid].domain_factor = plan->domains[grid];
        }
        if (!run_set(suite, BENCHMARK_DOMAIN, setups, PLAN_SIZE_MAX, &plan->effort, false))
            return false;
    }
    return true;
}

static bool run_small_sets(struct benchmark_suite *suite, const struct benchmark_plan *plan)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        const struct benchmark_case *subject = &benchmark_cases[index];
        struct benchmark_setup setups[2 * PLAN_SMALL_MAX];
        size_t count = 0;
        if (!is_main_case(subject) && !(plan->every && subject->locks))
            continue;
        for (size_t size = 0; size < PLAN_SMALL_MAX && plan->small[size] > 0; size++) {
            for (int threads = 1; threads <= suite->threads; threads++) {
                setups[count] = base_setup(subject, plan->small[size]);
                setups[count].last = false;
                setups[count++].threads = threads;
            }
        }
        if (!run_set(suite, BENCHMARK_SMALL, setups, count, &plan->small_effort, false))
            return false;
    }
    return true;
}

static bool run_flow_sets(struct benchmark_suite *suite, const struct benchmark_plan *plan)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        const struct benchmark_case *subject = &benchmark_cases[index];
        struct benchmark_setup base = base_setup(subject, plan->flow_particles);
        base.body = BENCHMARK_FLOW;
        const int threads = plan->every && is_main_case(subject) ? suite->threads : 1;
        if ((plan->every || is_main_case(subject)) &&
            !run_orderings(suite, BENCHMARK_DEVELOPED, base, threads, &plan->effort))
            return false;
    }
    return true;
}

static bool measure_ceilings(struct benchmark_suite *suite, int tries)
{
    if (!ceiling_create(&suite->ceiling, suite->threads))
        return false;
    for (int kind = 0; kind < CEILING_COUNT; kind++) {
        for (int threads = 1; threads <= suite->threads; threads++)
            suite->ceilings[kind][threads - 1] =
                ceiling_measure(&suite->ceiling, (enum ceiling_kind)kind, threads, tries);
    }
    return true;
}

void benchmark_suite_run_one(struct benchmark_suite *suite, const struct benchmark_setup *setup,
                             const struct benchmark_effort *effort)
{
    struct benchmark_setup only = *setup;
    *suite = (struct benchmark_suite){.form = BENCHMARK_ONE, .seconds = benchmark_wall_seconds()};
    suite->threads = setup->threads;
    suite->complete = ceiling_create(&suite->ceiling, suite->threads) &&
                      run_set(suite, BENCHMARK_SINGLE, &only, 1, effort, false) &&
                      suite->row_count == 1 && !suite->rows[0].result.failed;
    suite->seconds = benchmark_wall_seconds() - suite->seconds;
}

void benchmark_suite_run(struct benchmark_suite *suite, enum benchmark_form form)
{
    const struct benchmark_plan *plan = &benchmark_plans[form];
    *suite = (struct benchmark_suite){.form = form, .seconds = benchmark_wall_seconds()};
    suite->threads = omp_get_num_procs() > 1 ? 2 : 1;
    if (getloadavg(&suite->load, 1) != 1)
        suite->load = NAN;
    suite->complete = measure_ceilings(suite, plan->ceiling_tries) &&
                      run_ordering_sets(suite, plan) && run_anti_locking_sets(suite, plan) &&
                      run_density_sets(suite, plan) && run_domain_sets(suite, plan) &&
                      run_small_sets(suite, plan) && run_flow_sets(suite, plan) &&
                      run_size_sets(suite, plan);
    suite->seconds = benchmark_wall_seconds() - suite->seconds;
}

void benchmark_suite_release(struct benchmark_suite *suite)
{
    ceiling_release(&suite->ceiling);
    free(suite->rows);
    memset(suite, 0, sizeof *suite);
}
