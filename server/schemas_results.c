/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of results, and what the daemon says of itself. */
#include "schemas.h"

const struct json_field schema_any_object = {.kind = FIELD_MAP,
                                             .item = &(const struct json_field){.kind = FIELD_ANY}};

static const struct json_field text_item = {.kind = FIELD_TEXT};
static const struct json_field number_item = {.kind = FIELD_NUMBER, .nullable = true};

static const struct json_field file_members[] = {
    MEMBER(TEXT, "name", "with slashes"),
    MEMBER(INTEGER, "bytes", "size"),
    MEMBER(TEXT, "sha256", "of its contents"),
    MEMBER_END,
};
static const struct json_field file_item = {
    .kind = FIELD_OBJECT, .schema = "File", .fields = file_members};
const struct json_field schema_file_list = {.kind = FIELD_LIST, .item = &file_item};

static const struct json_field frame_members[] = {
    MEMBER(INTEGER, "n", "number"),
    MEMBER(NUMBER, "time", "[s]"),
    MEMBER(INTEGER, "step", "number of the step"),
    MEMBER(INTEGER, "particles", "in the frame"),
    {.key = "fields", .kind = FIELD_LIST, .item = &text_item},
    MEMBER(INTEGER, "bytes", "size"),
    MEMBER(TEXT, "sha256", "of the file"),
    MEMBER_END,
};
static const struct json_field frame_item = {
    .kind = FIELD_OBJECT, .schema = "Frame", .fields = frame_members};
const struct json_field schema_frame_list = {.kind = FIELD_LIST, .item = &frame_item};

static const struct json_field series_name_members[] = {
    MEMBER(TEXT, "name", NULL),
    MEMBER(TEXT, "unit", NULL),
    MEMBER(INTEGER, "rows", "so far"),
    MEMBER_END,
};
static const struct json_field series_name = {
    .kind = FIELD_OBJECT, .schema = "SeriesName", .fields = series_name_members};
const struct json_field schema_series_list = {.kind = FIELD_LIST, .item = &series_name};

static const struct json_field series_members[] = {
    MEMBER(TEXT, "name", NULL),
    MEMBER(TEXT, "unit", NULL),
    {.key = "time", .kind = FIELD_LIST, .item = &number_item, .meaning = "[s]"},
    {.key = "value", .kind = FIELD_LIST, .item = &number_item, .meaning = "null: none"},
    MEMBER(BOOLEAN, "decimated", "points were left out"),
    MEMBER_END,
};
const struct json_field schema_series = {
    .kind = FIELD_OBJECT, .schema = "Series", .fields = series_members};

static const struct json_field quality_members[] = {
    MEMBER(INTEGER, "judged", "jobs that succeeded at once, as they were forecast"),
    MEMBER(INTEGER, "inside", "of these, whose wall time was in its interval"),
    MEMBER_SOMETIMES(NUMBER, "inside_ratio", "share of the last hundred or so"),
    MEMBER(INTEGER, "learned", "methods and classes with statistics of their own"),
    MEMBER_END,
};
static const struct json_field version_members[] = {
    MEMBER(TEXT, "name", "talus"),
    MEMBER(TEXT, "version", NULL),
    MEMBER(TEXT, "build", "version, commit and compiler"),
    MEMBER(TEXT, "api", "v1"),
    {.key = "forecasts",
     .kind = FIELD_OBJECT,
     .fields = quality_members,
     .meaning = "how good they were, and what they go by"},
    MEMBER_END,
};
const struct json_field schema_version = {
    .kind = FIELD_OBJECT, .schema = "Version", .fields = version_members};

static const struct json_field status_members[] = {MEMBER(TEXT, "status", "in a word"), MEMBER_END};
const struct json_field schema_status = {
    .kind = FIELD_OBJECT, .schema = "Status", .fields = status_members};

static const struct json_field warning_item = {.kind = FIELD_TEXT};
static const struct json_field readiness_members[] = {
    MEMBER(TEXT, "status", "in a word"),
    {.key = "warnings", .kind = FIELD_LIST, .item = &warning_item, .meaning = "to look at soon"},
    MEMBER_END,
};
const struct json_field schema_readiness = {
    .kind = FIELD_OBJECT, .schema = "Readiness", .fields = readiness_members};

static const struct json_field problem_members[] = {
    MEMBER(TEXT, "type", "urn:talus:problem:CODE"),
    MEMBER(TEXT, "title", "what kind of problem"),
    MEMBER(INTEGER, "status", "of the answer"),
    MEMBER(TEXT, "detail", "for people"),
    MEMBER(TEXT, "instance", "the target of the request"),
    {.key = "errors",
     .kind = FIELD_LIST,
     .optional = true,
     .most = 50,
     .item = &schema_issue,
     .meaning = "every mistake"},
    MEMBER_SOMETIMES(INTEGER, "needed_bytes", "of a 507: what the results take by their forecast"),
    MEMBER_SOMETIMES(INTEGER, "free_bytes",
                     "of a 507: what the disk has for results, without the reserve of the daemon"),
    MEMBER_END,
};
const struct json_field schema_problem = {
    .kind = FIELD_OBJECT, .schema = "Problem", .fields = problem_members};
