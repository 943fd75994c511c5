/* SPDX-License-Identifier: Apache-2.0 */
/* What a helper says of a scene: cost, advice, warnings. */
#include "schemas.h"

/* Of a count, or of bytes. */
static const struct json_field range_members[] = {
    MEMBER(INTEGER, "low", "at least"),
    MEMBER(INTEGER, "expected", NULL),
    MEMBER(INTEGER, "high", "at most"),
    MEMBER_END,
};

static const struct json_field ranges_members[] = {
    {.key = "steps",
     .kind = FIELD_OBJECT,
     .fields = range_members,
     .meaning = "automatic ones follow the speeds that are reached"},
    {.key = "memory_bytes",
     .kind = FIELD_OBJECT,
     .fields = range_members,
     .meaning = "of the worker at its peak"},
    {.key = "disk_bytes",
     .kind = FIELD_OBJECT,
     .fields = range_members,
     .meaning = "of the finished job's folder"},
    MEMBER_END,
};

const struct json_field schema_seconds_interval[] = {
    MEMBER(NUMBER, "low", "[s]"),
    MEMBER(NUMBER, "expected", "[s]"),
    MEMBER(NUMBER, "high", "[s]"),
    MEMBER_END,
};

static const struct json_field body_members[] = {
    MEMBER(TEXT, "name", "of the body"),
    MEMBER(INTEGER, "particles", "it is made of"),
    MEMBER(NUMBER, "volume", "of the body [m^3, per metre in 2D]"),
    MEMBER(NUMBER, "volume_factor", "by which the volumes of particles were scaled to be exact"),
    MEMBER_END,
};
static const struct json_field body_item = {.kind = FIELD_OBJECT, .fields = body_members};

static const struct json_field forecast_members[] = {
    MEMBER(INTEGER, "particles", "at the start"),
    MEMBER(INTEGER, "active_cells", "cells with particles at the start"),
    MEMBER(NUMBER, "critical_time_step", "[s]"),
    MEMBER(NUMBER, "time_step", "[s] of the first step"),
    MEMBER(INTEGER, "steps", "expected"),
    MEMBER(INTEGER, "memory_bytes", "of the worker at its peak"),
    MEMBER(INTEGER, "bytes_per_particle", "of memory"),
    MEMBER(INTEGER, "disk_bytes", "what the job's folder does not exceed while it runs"),
    {.key = "bodies",
     .kind = FIELD_LIST,
     .optional = true,
     .item = &body_item,
     .meaning = "how they were filled with particles"},
    MEMBER_SOMETIMES(INTEGER, "threads", "that the time is expected for"),
    {.key = "wall_seconds",
     .kind = FIELD_OBJECT,
     .fields = schema_seconds_interval,
     .meaning = "expected, with an interval: 95 of 100 jobs should end inside"},
    MEMBER_SOMETIMES(NUMBER, "cpu_seconds", "expected processor time of all threads"),
    {.key = "intervals",
     .kind = FIELD_OBJECT,
     .optional = true,
     .fields = ranges_members,
     .meaning = "of the other figures"},
    {.key = "learn",
     .kind = FIELD_ANY,
     .optional = true,
     .meaning = "what the daemon learns from when the job has finished"},
    MEMBER_END,
};
const struct json_field schema_forecast = {
    .kind = FIELD_OBJECT, .schema = "Forecast", .fields = forecast_members};

static const struct json_field any = {.kind = FIELD_ANY};
static const struct json_field any_number = {.kind = FIELD_NUMBER};
static const struct json_field advice_members[] = {
    MEMBER(TEXT, "pointer", "JSON Pointer into the scene"),
    MEMBER(TEXT, "code", "what kind of advice"),
    MEMBER(TEXT, "detail", "what was found"),
    MEMBER(TEXT, "change", "what to write instead"),
    MEMBER(TEXT, "saves", "what that saves or avoids"),
    {.key = "set",
     .kind = FIELD_MAP,
     .optional = true,
     .item = &any,
     .meaning = "JSON Pointer into the effective scene: the value that follows the advice"},
    {.key = "saving",
     .kind = FIELD_MAP,
     .optional = true,
     .item = &any_number,
     .meaning = "quantity: the factor by which following it makes it smaller"},
    MEMBER_END,
};
const struct json_field schema_advice = {
    .kind = FIELD_OBJECT, .schema = "Advice", .fields = advice_members};

static const struct json_field issue_members[] = {
    MEMBER(TEXT, "pointer", "JSON Pointer into the request's body; the key even if it is missing"),
    MEMBER_SOMETIMES(TEXT, "parameter", "the query parameter, where it is one"),
    MEMBER_SOMETIMES(INTEGER, "row", "of a study, where only that row is wrong"),
    MEMBER_SOMETIMES(ANY, "parameters", "of that row"),
    MEMBER(TEXT, "code", "what kind of mistake"),
    MEMBER(TEXT, "detail", "for people"),
    MEMBER_SOMETIMES(ANY, "given", "what was sent, if it is short"),
    MEMBER_SOMETIMES(ANY, "allowed", "what may be sent"),
    MEMBER_SOMETIMES(INTEGER, "line", "of a body that is not JSON"),
    MEMBER_SOMETIMES(INTEGER, "column", "of a body that is not JSON"),
    MEMBER_END,
};
const struct json_field schema_issue = {
    .kind = FIELD_OBJECT, .schema = "Issue", .fields = issue_members};

static const struct json_field answer_members[] = {
    {.key = "forecast", .kind = FIELD_MAP, .item = &any, .meaning = "a Forecast or StudyForecast"},
    {.key = "advice", .kind = FIELD_LIST, .item = &schema_advice},
    {.key = "warnings", .kind = FIELD_LIST, .item = &schema_issue},
    MEMBER_SOMETIMES(SCENE, "effective_scene", "of a job"),
    MEMBER_END,
};
const struct json_field schema_forecast_answer = {
    .kind = FIELD_OBJECT, .schema = "ForecastAnswer", .fields = answer_members};
