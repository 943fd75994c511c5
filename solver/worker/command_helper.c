/* SPDX-License-Identifier: Apache-2.0 */
/* Answers questions of the daemon: one JSON object a line in, one a line out, until the end of the
 * input. Whatever is asked is answered; a bad question never ends the process. */
#include "base/protocol.h"
#include "output/frame_slice.h"
#include "output/render.h"
#include "scene/scene_json.h"
#include "worker/check_answer.h"
#include "worker/command.h"
#include "worker/helper_chart.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *answer_check(const json_t *question)
{
    const json_t *scene = json_object_get(question, "scene");
    json_int_t threads = json_integer_value(json_object_get(question, "threads"));
    if (scene == NULL)
        return check_answer_error("", "required", "'scene' is required");
    return check_answer(scene, threads < 1 || threads > 4096 ? 1 : (int)threads,
                        json_object_get(question, "calibration"));
}

/* Many scenes in one question, for studies: of what a scene is found to be only what a row of a
 * study needs. With `stop_after` mistaken scenes the rest is not looked at. */
static json_t *answer_check_many(const json_t *question)
{
    const json_t *scenes = json_object_get(question, "scenes");
    json_int_t threads = json_integer_value(json_object_get(question, "threads"));
    json_int_t stop_after = json_integer_value(json_object_get(question, "stop_after"));
    json_t *answers = json_array();
    json_int_t mistaken = 0;
    size_t index;
    const json_t *scene;
    if (!json_is_array(scenes)) {
        json_decref(answers);
        return check_answer_error("", "required", "'scenes' is required: an array");
    }
    json_array_foreach(scenes, index, scene)
    {
        json_t *answer = check_answer(scene, threads < 1 || threads > 4096 ? 1 : (int)threads,
                                      json_object_get(question, "calibration"));
        (void)json_object_del(answer, "effective");
        (void)json_object_del(answer, "advice");
        (void)json_object_del(answer, "warnings");
        mistaken += !json_is_true(json_object_get(answer, "ok"));
        if (json_array_append_new(answers, answer) != 0) {
            json_decref(answers);
            return NULL;
        }
        if (stop_after > 0 && mistaken >= stop_after)
            break;
    }
    return json_pack("{s:b, s:o}", "ok", 1, "answers", answers);
}

static json_t *answer_describe(const json_t *question)
{
    (void)question;
    return json_pack("{s:b, s:o}", "ok", 1, "describe", scene_describe());
}

static json_t *answer_schema(const json_t *question)
{
    (void)question;
    return json_pack("{s:b, s:o}", "ok", 1, "schema", scene_schema());
}

/* The number at a key, `preset` where it is missing; -1 if it is not a whole number >= 0. */
static json_int_t whole_number(const json_t *question, const char *key, json_int_t preset)
{
    const json_t *value = json_object_get(question, key);
    if (value == NULL)
        return preset;
    return json_is_integer(value) && json_integer_value(value) >= 0 ? json_integer_value(value)
                                                                    : -1;
}

static json_t *answer_render(const json_t *question)
{
    struct talus_error error = {.status = TALUS_OK};
    const char *style = json_string_value(json_object_get(question, "style"));
    json_int_t frame = whole_number(question, "frame", 0);
    json_int_t width = whole_number(question, "width", 1000);
    struct render_request request = {
        .folder = json_string_value(json_object_get(question, "folder")),
        .frame = (uint64_t)frame,
        .field = json_string_value(json_object_get(question, "field")),
        .width = width > RENDER_WIDTH_MAX ? RENDER_WIDTH_MAX + 1 : (int)width,
        .output = json_string_value(json_object_get(question, "output")),
    };
    if (request.folder == NULL || request.output == NULL)
        return check_answer_error("/folder", "required", "'folder' and 'output' are required");
    if (frame < 0 || width < 0)
        return check_answer_error(frame < 0 ? "/frame" : "/width", "type",
                                  "expected a whole number");
    enum talus_status status = TALUS_OK;
    if (style != NULL)
        status = render_find_style(style, &request.style, &error);
    if (status == TALUS_OK)
        status = render_frame(&request, &error);
    if (status != TALUS_OK)
        return check_answer_error(error.pointer, error.code, error.text);
    return json_pack("{s:b}", "ok", 1);
}

enum { SLICE_FIELD_MAX = 64 };

static json_t *answer_slice(const json_t *question)
{
    struct talus_error error = {.status = TALUS_OK};
    const char *names[SLICE_FIELD_MAX];
    const json_t *fields = json_object_get(question, "fields");
    json_int_t frame = whole_number(question, "frame", 0);
    json_int_t stride = whole_number(question, "stride", 1);
    struct frame_slice_request request = {
        .folder = json_string_value(json_object_get(question, "folder")),
        .frame = (uint64_t)frame,
        .fields = names,
        .field_count = json_array_size(fields),
        .stride = (uint64_t)stride,
        .output = json_string_value(json_object_get(question, "output")),
    };
    if (request.folder == NULL || request.output == NULL)
        return check_answer_error("/folder", "required", "'folder' and 'output' are required");
    if (frame < 0 || stride < 1)
        return check_answer_error(frame < 0 ? "/frame" : "/stride", "type",
                                  "expected a whole number");
    if (request.field_count > SLICE_FIELD_MAX)
        return check_answer_error("/fields", "range", "too many fields");
    for (size_t index = 0; index < request.field_count; index++) {
        names[index] = json_string_value(json_array_get(fields, index));
        if (names[index] == NULL)
            return check_answer_error("/fields", "type", "expected names");
    }
    if (frame_slice_write(&request, &error) != TALUS_OK)
        return check_answer_error(error.pointer, error.code, error.text);
    return json_pack("{s:b}", "ok", 1);
}

static const struct operation {
    const char *name;
    json_t *(*answer)(const json_t *question);
} operations[] = {
    {"check", answer_check},   {"check_many", answer_check_many}, {"describe", answer_describe},
    {"schema", answer_schema}, {"render", answer_render},         {"slice", answer_slice},
    {"chart", helper_chart},
};
enum { OPERATION_COUNT = sizeof operations / sizeof operations[0] };

static json_t *answer_question(const char *line, size_t length)
{
    json_error_t error;
    json_t *question = json_loadb(line, length, JSON_REJECT_DUPLICATES, &error);
    if (question == NULL && json_error_code(&error) == json_error_numeric_overflow)
        question =
            json_loadb(line, length, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error);
    const char *name = json_string_value(json_object_get(question, "op"));
    json_t *answer = NULL;
    if (question == NULL)
        return check_answer_error("", "json", error.text);
    for (size_t index = 0; index < OPERATION_COUNT && name != NULL; index++) {
        if (strcmp(operations[index].name, name) == 0)
            answer = operations[index].answer(question);
    }
    if (answer == NULL)
        answer = check_answer_error("/op", "unknown_value",
                                    "'op' is check, check_many, describe, schema, render, slice "
                                    "or chart");
    json_decref(question);
    return answer;
}

/* Writes one answer line; false if the reader is gone. */
static bool write_answer(json_t *answer)
{
    char *text = answer != NULL ? json_dumps(answer, JSON_COMPACT) : NULL;
    int written = printf("%s\n", text != NULL ? text
                                              : "{\"ok\":false,\"errors\":[{\"pointer\":\"\","
                                                "\"code\":\"memory\",\"detail\":\"out of "
                                                "memory\"}]}");
    free(text);
    json_decref(answer);
    return written > 0 && fflush(stdout) == 0;
}

int command_helper(int argument_count, char **arguments)
{
    char *line = NULL;
    size_t capacity = 0;
    ssize_t length;
    bool connected = true;
    if (argument_count > 1) {
        (void)fprintf(stderr, "talus-worker helper: unexpected argument '%s'\n", arguments[1]);
        return PROTOCOL_EXIT_OTHER;
    }
    while (connected && (length = getline(&line, &capacity, stdin)) > 0)
        connected = write_answer(answer_question(line, (size_t)length));
    free(line);
    return connected ? PROTOCOL_EXIT_SUCCEEDED : PROTOCOL_EXIT_OTHER;
}
