/* SPDX-License-Identifier: Apache-2.0 */
/* A job as it is answered (job_view.c). */
#include "job.h"
#include "schemas.h"

static const struct json_field any_text = {.kind = FIELD_TEXT};
static const struct json_field any_number = {.kind = FIELD_NUMBER, .nullable = true};

static const struct json_field limit_members[] = {
    MEMBER_SOMETIMES(NUMBER, "wall_seconds", "over all attempts"),
    MEMBER_SOMETIMES(INTEGER, "memory_bytes", "of the worker"),
    MEMBER_SOMETIMES(INTEGER, "disk_bytes", "of the results"),
    MEMBER_END,
};

static const struct json_field attempt_members[] = {
    MEMBER(INTEGER, "number", "from 1"),
    MEMBER(TEXT, "started_at", "RFC 3339"),
    MEMBER(INTEGER, "threads", "it ran with"),
    MEMBER_SOMETIMES(TEXT, "finished_at", "RFC 3339"),
    MEMBER_SOMETIMES(TEXT, "outcome", "how it ended"),
    MEMBER_SOMETIMES(TEXT, "reason", "of a failure"),
    MEMBER_SOMETIMES(TEXT, "detail", "of a failure"),
    MEMBER_SOMETIMES(INTEGER, "exit_code", "of the worker"),
    MEMBER_SOMETIMES(INTEGER, "signal", "that ended the worker"),
    MEMBER_END,
};
static const struct json_field attempt_item = {.kind = FIELD_OBJECT, .fields = attempt_members};

static const struct json_field progress_members[] = {
    MEMBER(NUMBER, "fraction", "of the duration"),
    MEMBER(NUMBER, "time", "[s] simulated"),
    MEMBER(INTEGER, "step", "number of the last step"),
    MEMBER_SOMETIMES(NUMBER, "time_step", "[s] of the last step"),
    MEMBER_SOMETIMES(INTEGER, "particles", "now"),
    MEMBER_SOMETIMES(NUMBER, "particle_steps_per_second", "now"),
    {.key = "eta_seconds",
     .kind = FIELD_NUMBER,
     .optional = true,
     .nullable = true,
     .meaning = "expected until the end"},
    MEMBER_END,
};

static const struct json_field steering_members[] = {
    MEMBER_SOMETIMES(NUMBER, "end_time", "[s] at which the run ends instead"),
    MEMBER_SOMETIMES(INTEGER, "checkpoint_now", "so many times"),
    MEMBER_SOMETIMES(INTEGER, "frame_now", "so many times"),
    MEMBER_END,
};

static const struct json_field result_members[] = {
    MEMBER(TEXT, "file", "name"),
    MEMBER(INTEGER, "bytes", "size"),
    MEMBER(TEXT, "sha256", "of its contents"),
    MEMBER_SOMETIMES(BOOLEAN, "varies",
                     "it holds times or names of this run, which a repeat has not"),
    MEMBER_END,
};
static const struct json_field result_item = {.kind = FIELD_OBJECT, .fields = result_members};

static const struct json_field receipt_members[] = {
    MEMBER_SOMETIMES(TEXT, "outcome", "how the attempt ended"),
    MEMBER_SOMETIMES(TEXT, "scene_hash", "SHA-256 of the effective scene without its title"),
    MEMBER_SOMETIMES(TEXT, "build", "of the worker"),
    MEMBER_SOMETIMES(TEXT, "compiler", "of the worker"),
    MEMBER_SOMETIMES(TEXT, "isa", "instruction set"),
    MEMBER_SOMETIMES(TEXT, "precision", "double or single"),
    MEMBER_SOMETIMES(INTEGER, "threads", "it ran with"),
    MEMBER_SOMETIMES(INTEGER, "attempt", "number"),
    MEMBER_SOMETIMES(BOOLEAN, "steered", "the run was told to do otherwise than its scene"),
    MEMBER_SOMETIMES(TEXT, "command", "that repeats the result"),
    MEMBER_SOMETIMES(TEXT, "state_hash", "of the state at the end"),
    MEMBER_SOMETIMES(TEXT, "finished_at", "RFC 3339"),
    {.key = "metrics", .kind = FIELD_MAP, .optional = true, .item = &any_number},
    {.key = "results", .kind = FIELD_LIST, .optional = true, .item = &result_item},
    MEMBER_END,
};

static const struct json_field link_members[] = {
    MEMBER(TEXT, "self", NULL),   MEMBER(TEXT, "events", NULL), MEMBER(TEXT, "series", NULL),
    MEMBER(TEXT, "frames", NULL), MEMBER(TEXT, "files", NULL),  MEMBER(TEXT, "log", NULL),
    MEMBER(TEXT, "cancel", NULL), MEMBER(TEXT, "resume", NULL), MEMBER_END,
};

static const char *const reasons[] = {"unstable",   "audit",   "time_limit", "memory_limit",
                                      "disk_limit", "crashed", "lost",       NULL};

static const struct json_field job_members[] = {
    MEMBER(TEXT, "id", "sortable, URL-safe"),
    MEMBER_OR_NULL(TEXT, "name", "for people"),
    {.key = "labels", .kind = FIELD_MAP, .item = &any_text, .meaning = "for filters"},
    {.key = "state",
     .kind = FIELD_TEXT,
     .words = job_state_words,
     .meaning = "where it is between submission and end"},
    {.key = "reason",
     .kind = FIELD_TEXT,
     .nullable = true,
     .words = reasons,
     .meaning = "of a failure"},
    MEMBER_OR_NULL(TEXT, "detail", "when, where, and what to try"),
    MEMBER_OR_NULL(TEXT, "study", "the study whose row it is"),
    MEMBER_OR_NULL(INTEGER, "study_row", "number of that row, from 0"),
    MEMBER_OR_NULL(TEXT, "owner", "name of the token that submitted it"),
    MEMBER_OR_NULL(TEXT, "reused_from", "the finished job whose result this one shows"),
    MEMBER(BOOLEAN, "steered", "it was told to do otherwise than its scene"),
    {.key = "steering",
     .kind = FIELD_OBJECT,
     .nullable = true,
     .fields = steering_members,
     .meaning = "what it was told"},
    MEMBER(BOOLEAN, "cancel_requested", "it runs until its processes are gone"),
    MEMBER(INTEGER, "revision", "changes with everything but progress"),
    MEMBER(INTEGER, "priority", "larger ones start first"),
    MEMBER(INTEGER, "threads", "it takes"),
    {.key = "limits",
     .kind = FIELD_OBJECT,
     .fields = limit_members,
     .meaning = "beyond which it is ended"},
    MEMBER(INTEGER, "retries", "after crashes"),
    MEMBER(TEXT, "created_at", "RFC 3339"),
    MEMBER_OR_NULL(TEXT, "started_at", "RFC 3339"),
    MEMBER_OR_NULL(TEXT, "finished_at", "RFC 3339"),
    {.key = "attempts",
     .kind = FIELD_LIST,
     .item = &attempt_item,
     .meaning = "every start of a worker for it"},
    {.key = "progress",
     .kind = FIELD_OBJECT,
     .fields = progress_members,
     .meaning = "how far the run is"},
    {.key = "forecast",
     .kind = FIELD_SAME,
     .nullable = true,
     .item = &schema_forecast,
     .meaning = "as it was at submission"},
    {.key = "advice",
     .kind = FIELD_LIST,
     .item = &schema_advice,
     .meaning = "where the scene models more or less than it needs"},
    {.key = "warnings",
     .kind = FIELD_LIST,
     .item = &schema_issue,
     .meaning = "what was taken as it is, and may not be meant"},
    {.key = "metrics",
     .kind = FIELD_MAP,
     .nullable = true,
     .item = &any_number,
     .meaning = "final values"},
    {.key = "receipt",
     .kind = FIELD_OBJECT,
     .nullable = true,
     .fields = receipt_members,
     .meaning = "what makes the result reproducible"},
    MEMBER_OR_NULL(TEXT, "scene_hash", "SHA-256 of the effective scene without its title"),
    {.key = "links",
     .kind = FIELD_OBJECT,
     .fields = link_members,
     .meaning = "where its parts are"},
    MEMBER_END,
};
const struct json_field schema_job = {.kind = FIELD_OBJECT, .schema = "Job", .fields = job_members};

/* A job of a list has the members that were asked for. */
static const struct json_field thin_job = {.kind = FIELD_OBJECT,
                                           .schema = "JobInList",
                                           .fields = job_members,
                                           .partial = true,
                                           .meaning = "the members asked for with `fields`"};

static const struct json_field job_list_members[] = {
    {.key = "jobs", .kind = FIELD_LIST, .item = &thin_job},
    MEMBER_OR_NULL(TEXT, "cursor", "of the next page; null at the end"),
    MEMBER_END,
};
const struct json_field schema_job_list = {
    .kind = FIELD_OBJECT, .schema = "JobList", .fields = job_list_members};
