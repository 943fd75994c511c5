/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/job_run.h"

#include <stdlib.h>

/* Seconds between history events; between progress lines where nobody watches. */
static const double history_interval = 0.25;
static const double print_interval_plain = 10.0, print_interval_terminal = 0.25;
/* Tables are replaced at checkpoints as long as that costs less than this share of the time. */
static const double tables_share = 0.02;
/* So many warnings are passed on, then one that says so. */
enum { WARNING_MAX = 200 };

enum talus_status job_pass_warnings(struct job_run *run, struct talus_error *error)
{
    struct talus_warning warning;
    while (talus_simulation_take_warning(run->simulation, &warning)) {
        enum talus_status status = TALUS_OK;
        run->warning_count++;
        if (run->warning_count == WARNING_MAX)
            status = job_warn(run, "too_many_warnings", "", "further warnings are left out", error);
        else if (run->warning_count < WARNING_MAX)
            status = job_warn(run, warning.code, warning.pointer, warning.text, error);
        if (status != TALUS_OK)
            return status;
    }
    return TALUS_OK;
}

enum talus_status job_announce_history(struct job_run *run, struct talus_error *error)
{
    if (run->announced)
        return TALUS_OK;
    enum talus_status status = history_flush(&run->history, error);
    if (status != TALUS_OK)
        return status;
    run->announced = true;
    return event_write(&run->events, PROTOCOL_HISTORY,
                       json_pack("{s:I}", "rows", (json_int_t)run->history.row_count), error);
}

/* The interval between progress events, such that a run writes under 5,000 whatever it does: its
 * expected wall clock over 4,000, and doubled with every further 100 beyond those. */
static double progress_interval(const struct job_run *run, double now)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(run->simulation, &state);
    double done = state.time - run->clock.start_time;
    double share = done / (state.duration - run->clock.start_time);
    double interval = share > 0.0 ? (now - run->clock.start) / share / 4000.0 : 1.0;
    if (!(interval > 1.0))
        interval = 1.0;
    for (uint64_t count = 4000; count < run->counters.progress_count; count += 100)
        interval *= 2.0;
    return interval;
}

static enum talus_status keep_events(struct job_run *run, double now, struct talus_error *error)
{
    enum talus_status status = job_pass_warnings(run, error);
    double interval = progress_interval(run, now);
    if (status == TALUS_OK && now - run->clock.history >= history_interval * interval) {
        run->clock.history = now;
        status = job_announce_history(run, error);
    }
    if (status == TALUS_OK && now - run->clock.progress >= interval) {
        run->clock.progress = now;
        status = job_report_progress(run, now, error);
    }
    double print_interval = run->log.terminal ? print_interval_terminal : print_interval_plain;
    if (status == TALUS_OK && now - run->clock.printed >= print_interval) {
        run->clock.printed = now;
        job_print_progress(run, now, false);
    }
    return status;
}

/* Tables of the rows so far, replaced in the background. */
struct tables_task {
    struct job_run *run;
    uint64_t row_count;
};

static enum talus_status replace_tables(void *context, struct talus_error *error)
{
    const struct tables_task *tables = context;
    double begin = job_now();
    enum talus_status status = job_write_tables(tables->run, tables->row_count, NULL, error);
    tables->run->tables_cost = job_now() - begin;
    return status;
}

static enum talus_status give_tables(struct job_run *run, struct talus_error *error)
{
    struct tables_task *tables = malloc(sizeof *tables);
    if (tables == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for tables");
    /* The checkpoint before has flushed the rows. */
    *tables = (struct tables_task){.run = run, .row_count = run->history.written};
    const struct writer_task task = {replace_tables, free, tables};
    return writer_give(run->writer, &task, error);
}

static enum talus_status keep_checkpoints(struct job_run *run, double now,
                                          struct talus_error *error)
{
    double every = run->scene.output.checkpoint_every;
    if (!(every > 0.0) || now - run->clock.checkpoint < every)
        return TALUS_OK;
    enum talus_status status = job_write_checkpoint(run, error);
    if (status != TALUS_OK || run->tables_cost > tables_share * (now - run->clock.tables))
        return status;
    run->clock.tables = now;
    return give_tables(run, error);
}

static enum talus_status stop(struct job_run *run, enum talus_status reason, const char *code,
                              const char *text, struct talus_error *error)
{
    enum talus_status status = job_write_checkpoint(run, error);
    if (status == TALUS_OK)
        status = writer_drain(run->writer, error);
    return status != TALUS_OK ? status : talus_error_set(error, reason, code, "", "%s", text);
}

enum talus_status job_attend(struct job_run *run, double now, struct talus_error *error)
{
    run->clock.attended = now;
    struct control_request request = control_poll(&run->control);
    double limit = run->options->wall_seconds;
    if (request.stop)
        return stop(run, TALUS_CANCELLED, "cancelled",
                    "stopped on request; --resume goes on from here", error);
    if (limit > 0.0 && now - run->clock.start > limit)
        return stop(run, TALUS_LIMIT, "time_limit",
                    "the wall clock limit is reached; --resume goes on from here", error);
    enum talus_status status = writer_check(run->writer, error);
    if (status == TALUS_OK && request.look)
        status = job_steer(run, false, error);
    if (status == TALUS_OK)
        status = keep_events(run, now, error);
    if (status == TALUS_OK)
        status = keep_checkpoints(run, now, error);
    return status;
}
