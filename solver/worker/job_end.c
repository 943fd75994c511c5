/* SPDX-License-Identifier: Apache-2.0 */
#include "output/file.h"
#include "output/lenient_text.h"
#include "worker/job_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct ending {
    const char *reason; /* of the failed event; NULL: finished */
    int exit_code;
};

static struct ending find_ending(enum talus_status outcome, const struct talus_error *error)
{
    switch (outcome) {
    case TALUS_OK:
        return (struct ending){NULL, PROTOCOL_EXIT_SUCCEEDED};
    case TALUS_INVALID:
    case TALUS_UNSUPPORTED:
        return (struct ending){"invalid", PROTOCOL_EXIT_INVALID};
    case TALUS_UNSTABLE:
        return (struct ending){"unstable", PROTOCOL_EXIT_UNSTABLE};
    case TALUS_CANCELLED:
        return (struct ending){"cancelled", PROTOCOL_EXIT_CANCELLED};
    case TALUS_MEMORY:
        return (struct ending){"memory_limit", PROTOCOL_EXIT_MEMORY};
    case TALUS_LIMIT:
        if (strcmp(error->code, "disk_limit") == 0)
            return (struct ending){"disk_limit", PROTOCOL_EXIT_LIMIT};
        if (strcmp(error->code, "time_limit") == 0)
            return (struct ending){"time_limit", PROTOCOL_EXIT_LIMIT};
        /* A limit inside the solver (mass that may leave the grid) is a state gone bad. */
        return (struct ending){"unstable", PROTOCOL_EXIT_UNSTABLE};
    case TALUS_AUDIT:
        return (struct ending){"audit", PROTOCOL_EXIT_AUDIT};
    case TALUS_IO:
    case TALUS_INTERNAL:
        break;
    }
    return (struct ending){"crashed", PROTOCOL_EXIT_OTHER};
}

static enum talus_status write_csv(const struct job_run *run, const struct history_table *table,
                                   const char *name, const char *prefix, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = file_path(path, run->options->folder, name, error);
    if (status == TALUS_OK)
        status = history_write_csv(table, path, prefix, error);
    return status;
}

enum talus_status job_write_tables(const struct job_run *run, uint64_t row_count,
                                   const char *receipt, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    struct history_table table;
    enum talus_status status = history_table_open(&table, run->options->folder, error);
    if (status != TALUS_OK)
        return status;
    /* Rows that are being appended now may be cut again. */
    if (table.row_count > row_count)
        table.row_count = row_count;
    status = write_csv(run, &table, "history.csv", "", error);
    if (status == TALUS_OK)
        status = write_csv(run, &table, "reactions.csv", "reaction.", error);
    if (status == TALUS_OK)
        status = file_path(path, run->options->folder, "results.h5", error);
    if (status == TALUS_OK)
        status = results_write(&table, path, run->scene_text, receipt, error);
    history_table_close(&table);
    return status;
}

/* All metrics; NULL with *error set if they cannot be had. */
static json_t *collect_metrics(struct job_run *run, struct talus_error *error)
{
    struct history_table table;
    if (history_table_open(&table, run->options->folder, error) != TALUS_OK)
        return NULL;
    json_t *metrics = job_metrics(run, &table);
    if (metrics == NULL) {
        (void)talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for metrics");
    } else if (job_add_reference_errors(run, &table, metrics, error) != TALUS_OK) {
        json_decref(metrics);
        metrics = NULL;
    }
    history_table_close(&table);
    return metrics;
}

/* Files of the end: what the rows and frames so far say. *metrics is a new reference or NULL. */
static enum talus_status close_books(struct job_run *run, enum talus_status outcome,
                                     const char *outcome_name, json_t **metrics,
                                     struct talus_error *error)
{
    enum talus_status status = job_pass_warnings(run, error);
    /* The state that went bad is worth a look. */
    if (status == TALUS_OK && outcome == TALUS_UNSTABLE)
        status = job_take_frame(run, error);
    if (status == TALUS_OK)
        status = job_report_progress(run, job_now(), error);
    if (status == TALUS_OK)
        status = job_announce_history(run, error);
    if (status == TALUS_OK)
        status = history_sync(&run->history, error);
    if (status != TALUS_OK)
        return status;
    *metrics = collect_metrics(run, error);
    if (*metrics == NULL)
        return error->status;
    return job_write_receipt(run, outcome_name, *metrics, error);
}

static enum talus_status write_last_event(struct job_run *run, const struct ending *ending,
                                          const char *detail, json_t *metrics,
                                          struct talus_error *error)
{
    json_t *event = NULL;
    if (ending->reason == NULL)
        event = json_pack("{s:O}", "metrics", metrics);
    else
        event = json_pack("{s:s, s:o, s:O}", "reason", ending->reason, "detail",
                          lenient_text_json(detail), "metrics", metrics);
    enum protocol_message message = ending->reason == NULL ? PROTOCOL_FINISHED : PROTOCOL_FAILED;
    enum talus_status status = event_write(&run->events, message, event, error);
    if (status == TALUS_OK)
        status = event_sync(&run->events, error);
    return status;
}

/* The folder is ours: its events must end with a last one, whatever else fails. */
static int end_in_folder(struct job_run *run, enum talus_status outcome, struct talus_error *error)
{
    struct talus_error failure = {.status = TALUS_OK};
    json_t *metrics = NULL;
    /* What is still to be written, and from here on everything is done by this thread. An error
     * there came before the one that ended the loop. */
    enum talus_status written =
        run->writer == NULL ? TALUS_OK : writer_finish(run->writer, &failure);
    if (written != TALUS_OK) {
        outcome = written;
        *error = failure;
        failure = (struct talus_error){.status = TALUS_OK};
    }
    bool can_write = outcome != TALUS_MEMORY &&
                     !(outcome == TALUS_LIMIT && strcmp(error->code, "disk_limit") == 0);
    if (outcome == TALUS_OK)
        outcome = talus_simulation_audit(run->simulation, error);
    struct ending ending = find_ending(outcome, error);
    if (run->history.descriptor >= 0 && can_write) {
        const char *name = ending.reason == NULL ? "succeeded" : ending.reason;
        enum talus_status status = close_books(run, outcome, name, &metrics, &failure);
        if (status != TALUS_OK && outcome == TALUS_OK) {
            outcome = status;
            *error = failure;
            ending = find_ending(outcome, error);
        } else if (status != TALUS_OK) {
            job_log_write(&run->log, "error", failure.text);
        }
    }
    if (metrics == NULL)
        metrics = json_object();
    if (run->simulation != NULL && run->log.terminal)
        job_print_progress(run, job_now(), true);
    job_log_write(&run->log, ending.reason == NULL ? "info" : "error",
                  ending.reason == NULL ? "finished" : error->text);
    failure = (struct talus_error){.status = TALUS_OK};
    enum talus_status status = write_last_event(run, &ending, error->text, metrics, &failure);
    json_decref(metrics);
    if (status != TALUS_OK)
        job_log_write(&run->log, "error", failure.text);
    if (status != TALUS_OK && ending.reason == NULL)
        return find_ending(status, &failure).exit_code;
    return ending.exit_code;
}

int job_end(struct job_run *run, enum talus_status outcome, struct talus_error *error)
{
    if (run->events.descriptor >= 0 && run->events.attempt > 0)
        return end_in_folder(run, outcome, error);
    (void)fprintf(stderr, "talus-worker: %s\n", error->text);
    return find_ending(outcome, error).exit_code;
}

void job_release(struct job_run *run)
{
    writer_destroy(run->writer);
    history_close(&run->history);
    frame_list_release(&run->frames);
    talus_simulation_destroy(run->simulation);
    talus_scene_release(&run->scene);
    json_decref(run->effective);
    json_decref(run->steering);
    free(run->scene_text);
    free(run->last_row);
    job_log_close(&run->log);
    event_close(&run->events);
    control_close(&run->control);
    job_lock_release(&run->lock);
}
