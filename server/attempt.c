/* SPDX-License-Identifier: Apache-2.0 */
#include "attempt.h"

#include "base/protocol.h"
#include "json_file.h"
#include "moment.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

struct attempt *attempt_create(const struct job *job, const char *folder, const char *boot)
{
    struct attempt *attempt = calloc(1, sizeof *attempt);
    if (attempt == NULL)
        return NULL;
    attempt->id = strdup(job->id);
    attempt->folder = strdup(folder);
    attempt->owner = strdup(job->owner == NULL ? "" : job->owner);
    attempt->number = job->attempt;
    attempt->threads = job->threads;
    /* Read once: a step of the machine's clock during the run must not end it. */
    double elapsed = moment_now() - job->attempt_started;
    attempt->wall_begin = moment_monotonic() - job->wall_used - (elapsed > 0 ? elapsed : 0);
    attempt->other_boot = job->boot == NULL || strcmp(job->boot, boot) != 0;
    attempt->tail.descriptor = -1;
    attempt->end = -1;
    (void)attempt_update(attempt, job);
    if (attempt->id != NULL && attempt->folder != NULL && attempt->owner != NULL)
        return attempt;
    attempt_destroy(attempt);
    return NULL;
}

void attempt_destroy(struct attempt *attempt)
{
    event_tail_close(&attempt->tail);
    if (attempt->end >= 0)
        (void)close(attempt->end);
    json_decref(attempt->progress);
    json_decref(attempt->last);
    free(attempt->orders);
    free(attempt->owner);
    free(attempt->id);
    free(attempt->folder);
    free(attempt);
}

bool attempt_update(struct attempt *attempt, const struct job *job)
{
    bool limits =
        attempt->memory_limit != job->memory_limit || attempt->disk_limit != job->disk_limit;
    const char *known = attempt->orders == NULL ? "" : attempt->orders;
    if (job->steering != NULL && strcmp(job->steering, known) != 0) {
        char *copy = strdup(job->steering);
        attempt->orders_pending = true;
        if (copy != NULL) {
            free(attempt->orders);
            attempt->orders = copy;
        }
    }
    attempt->revision = job->revision;
    attempt->memory_limit = job->memory_limit;
    attempt->disk_limit = job->disk_limit;
    attempt->wall_deadline = job->wall_limit > 0 ? attempt->wall_begin + job->wall_limit : 0;
    attempt->cancel_requested = job->cancel_requested != 0;
    return limits;
}

/* Keeps what describes the progress and drops the envelope. */
static json_t *progress_members(json_t *line)
{
    (void)json_object_del(line, "event");
    (void)json_object_del(line, "at");
    (void)json_object_del(line, "attempt");
    return json_incref(line);
}

static bool attempt_line(char *line, size_t length, int64_t end, void *context)
{
    struct attempt *attempt = context;
    (void)end;
    json_t *root = json_loadb(line, length, 0, NULL);
    const char *name = json_string_value(json_object_get(root, "event"));
    bool own = json_integer_value(json_object_get(root, "attempt")) == attempt->number;
    switch (name == NULL || !own ? PROTOCOL_MESSAGE_COUNT : protocol_message_find(name)) {
    case PROTOCOL_STARTED:
        attempt->worker_started = true;
        break;
    case PROTOCOL_PROGRESS:
        json_decref(attempt->progress);
        attempt->progress = progress_members(root);
        attempt->progress_count++;
        break;
    case PROTOCOL_FINISHED:
    case PROTOCOL_FAILED:
        json_decref(attempt->last);
        attempt->last = json_incref(root);
        break;
    default:
        break;
    }
    json_decref(root);
    return true;
}

void attempt_read(struct attempt *attempt)
{
    struct talus_error error = {0};
    if (event_tail_read(&attempt->tail, attempt->folder, attempt_line, attempt, &error) != TALUS_OK)
        (void)fprintf(stderr, "talusd: job %s: %s\n", attempt->id, error.text);
}

/* The outcome of an attempt whose worker did not say how it ended. */
static void outcome_silent(const struct attempt *attempt, struct job_outcome *outcome,
                           char detail[512])
{
    outcome->detail = detail;
    if (attempt->stop_reason != NULL) {
        outcome->end = JOB_END_FAILED;
        outcome->reason = attempt->stop_reason;
        (void)snprintf(detail, 512, "the worker was ended because the job's %s was reached",
                       strcmp(attempt->stop_reason, "time_limit") == 0 ? "limits.wall_seconds"
                                                                       : "limits.disk_bytes");
    } else if (attempt->cancel_requested) {
        outcome->end = JOB_END_CANCELLED;
        outcome->detail = NULL;
    } else if (outcome->signal_number == SIGXFSZ) {
        outcome->end = JOB_END_FAILED;
        outcome->reason = "disk_limit";
        (void)snprintf(detail, 512, "a file grew beyond limits.disk_bytes");
    } else if (attempt->pid == 0 && (attempt->other_boot || !attempt->worker_started)) {
        outcome->end = JOB_END_LOST;
        outcome->reason = "lost";
        (void)snprintf(detail, 512, "%s",
                       attempt->other_boot ? "the machine was restarted during the attempt"
                                           : "the daemon died before the worker had started");
    } else {
        outcome->end = JOB_END_CRASHED;
        outcome->reason = "crashed";
        if (outcome->signal_number >= 0)
            (void)snprintf(detail, 512, "the worker was ended by signal %d (%s); see log.txt",
                           outcome->signal_number, strsignal(outcome->signal_number));
        else if (outcome->exit_code >= 0)
            (void)snprintf(detail, 512,
                           "the worker exited with code %d without a result; see "
                           "log.txt",
                           outcome->exit_code);
        else
            (void)snprintf(detail, 512, "the worker ended without a result; see log.txt");
    }
    if (outcome->exit_code == PROTOCOL_EXIT_MEMORY && outcome->end == JOB_END_CRASHED) {
        outcome->end = JOB_END_FAILED;
        outcome->reason = "memory_limit";
        (void)snprintf(detail, 512, "the worker ran out of memory");
    }
}

/* The outcome that the worker's last line tells. */
static void outcome_told(const struct attempt *attempt, struct job_outcome *outcome,
                         char detail[512])
{
    const char *event = json_string_value(json_object_get(attempt->last, "event"));
    const char *reason = json_string_value(json_object_get(attempt->last, "reason"));
    const char *text = json_string_value(json_object_get(attempt->last, "detail"));
    outcome->metrics = json_object_get(attempt->last, "metrics");
    if (protocol_message_find(event) == PROTOCOL_FINISHED) {
        outcome->end = JOB_END_SUCCEEDED;
        return;
    }
    outcome->end = JOB_END_FAILED;
    outcome->reason = reason == NULL ? "crashed" : reason;
    (void)snprintf(detail, 512, "%s", text == NULL ? "" : text);
    outcome->detail = detail;
    if (reason != NULL && strcmp(reason, "cancelled") == 0) {
        outcome->reason = NULL;
        outcome->end = JOB_END_CANCELLED;
        if (attempt->stop_reason != NULL) {
            outcome->end = JOB_END_FAILED;
            outcome->reason = attempt->stop_reason;
            (void)snprintf(detail, 512,
                           "stopped with a checkpoint because the job's limit (%s) "
                           "was reached",
                           attempt->stop_reason);
        } else if (!attempt->cancel_requested && attempt->other_boot) {
            outcome->end = JOB_END_LOST;
            outcome->reason = "lost";
        }
    } else if (reason != NULL && strcmp(reason, "invalid") == 0) {
        outcome->reason = "crashed";
        (void)snprintf(detail, 512, "the worker refused the scene: %s", text == NULL ? "" : text);
    }
}

void attempt_outcome(const struct attempt *attempt, struct job_outcome *outcome, json_t **receipt,
                     char detail[512])
{
    memset(outcome, 0, sizeof *outcome);
    detail[0] = '\0';
    outcome->exit_code = outcome->signal_number = -1;
    if (attempt->ended && WIFEXITED(attempt->wait_status))
        outcome->exit_code = WEXITSTATUS(attempt->wait_status);
    if (attempt->ended && WIFSIGNALED(attempt->wait_status))
        outcome->signal_number = WTERMSIG(attempt->wait_status);
    outcome->progress = attempt->progress;
    *receipt = NULL;
    if (attempt->last == NULL) {
        outcome_silent(attempt, outcome, detail);
        return;
    }
    outcome_told(attempt, outcome, detail);
    *receipt = json_file_load(attempt->folder, PROTOCOL_RECEIPT_FILE);
    outcome->receipt = *receipt;
}
