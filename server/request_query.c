/* SPDX-License-Identifier: Apache-2.0 */
/* Query parameters, by the table of the operation. */
#include "request.h"

#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PARAMETER_MAX = 32 };

static bool refuse(struct request *request, const struct target_parameter *parameter,
                   const char *code, const char *detail)
{
    json_t *errors =
        json_pack("[{s:s, s:s, s:s, s:s, s:s}]", "pointer", "", "parameter", parameter->name,
                  "code", code, "detail", detail, "given", parameter->value);
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "query", request->raw, errors,
                  "query parameter %s: %s", parameter->name, detail);
    return false;
}

static bool refuse_unknown(struct request *request, const struct target_parameter *parameter)
{
    const struct json_field *query = request->route->operation->query;
    const char *names[PARAMETER_MAX + 1] = {NULL};
    char detail[256];
    for (size_t index = 0; query != NULL && query[index].key != NULL && index < PARAMETER_MAX;
         index++)
        names[index] = query[index].key;
    const char *near = suggest(parameter->name, names);
    (void)snprintf(detail, sizeof detail, "is not known here%s%s%s",
                   near == NULL ? "" : "; did you mean ", near == NULL ? "" : near,
                   near == NULL ? "" : "?");
    return refuse(request, parameter, "unknown_key", detail);
}

static const struct json_field *parameter_find(const struct request *request, const char *name)
{
    const struct json_field *field = request->route->operation->query;
    for (; field != NULL && field->key != NULL; field++) {
        if (strcmp(field->key, name) == 0)
            return field;
    }
    return NULL;
}

/* The number that a text is, as JSON has numbers; NAN if it is none. */
static double number_read(const char *text)
{
    json_t *value = json_loads(text, JSON_DECODE_ANY, NULL);
    double number = json_is_number(value) ? json_number_value(value) : NAN;
    json_decref(value);
    return number;
}

static bool number_check(struct request *request, const struct json_field *field,
                         const struct target_parameter *parameter)
{
    const double value = number_read(parameter->value);
    const bool bounded = json_field_bounded(field);
    const bool whole = field->kind == FIELD_INTEGER;
    char detail[128];
    if (!isnan(value) && (!whole || floor(value) >= value) &&
        (!bounded || (value >= field->minimum && value <= field->maximum)))
        return true;
    if (bounded)
        (void)snprintf(detail, sizeof detail, "a %snumber from %.15g to %.15g is wanted",
                       whole ? "whole " : "", field->minimum, field->maximum);
    else
        (void)snprintf(detail, sizeof detail, "a %snumber is wanted", whole ? "whole " : "");
    return refuse(request, parameter, isnan(value) ? "type" : "range", detail);
}

static bool word_check(struct request *request, const struct json_field *field,
                       const struct target_parameter *parameter)
{
    char detail[512] = "one of these is wanted:";
    for (size_t index = 0; field->words[index] != NULL; index++) {
        if (strcmp(field->words[index], parameter->value) == 0)
            return true;
        size_t length = strlen(detail);
        (void)snprintf(detail + length, sizeof detail - length, " %s", field->words[index]);
    }
    return refuse(request, parameter, "unknown_value", detail);
}

bool request_query_check(struct request *request)
{
    for (size_t index = 0; index < request->target.query_count; index++) {
        const struct target_parameter *parameter = &request->target.query[index];
        const struct json_field *field = parameter_find(request, parameter->name);
        if (field == NULL)
            return refuse_unknown(request, parameter);
        for (size_t other = 0; other < index; other++) {
            if (field->kind != FIELD_LIST &&
                strcmp(request->target.query[other].name, parameter->name) == 0)
                return refuse(request, parameter, "repeated", "is given twice");
        }
        if ((field->kind == FIELD_NUMBER || field->kind == FIELD_INTEGER) &&
            !number_check(request, field, parameter))
            return false;
        if (field->words != NULL && !word_check(request, field, parameter))
            return false;
    }
    return true;
}

double request_query_number(const struct request *request, const char *name)
{
    const char *value = target_query(&request->target, name);
    const struct json_field *field = parameter_find(request, name);
    if (value != NULL)
        return number_read(value);
    return field == NULL ? NAN : field->preset;
}

void request_query_refuse(struct request *request, const char *parameter, const char *detail)
{
    json_t *errors = json_pack("[{s:s, s:s, s:s, s:s}]", "pointer", "", "parameter", parameter,
                               "code", "unknown_value", "detail", detail);
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "query", request->raw, errors,
                  "query parameter %s: %s", parameter, detail);
}
