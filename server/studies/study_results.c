/* SPDX-License-Identifier: Apache-2.0 */
/* The table of a study's rows. */
#include "json_text.h"
#include "studies/study_store.h"
#include "studies/study_view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct table {
    struct text *text;
    json_t *names, *metrics; /* of the columns */
    size_t count;
};

static void table_release(struct table *table)
{
    json_decref(table->names);
    json_decref(table->metrics);
}

static struct table table_begin(const struct study *study, enum study_results_metrics which,
                                struct text *text)
{
    const char *metrics = which == STUDY_RESULTS_WANTED ? study->wanted : study->metrics;
    return (struct table){.text = text,
                          .names = json_loads(study->names == NULL ? "[]" : study->names, 0, NULL),
                          .metrics = json_loads(metrics == NULL ? "[]" : metrics, 0, NULL)};
}

static void quoted_add(struct text *text, const char *value)
{
    json_t *string = value == NULL ? json_null() : json_string(value);
    json_text_add(text, string, 0);
    json_decref(string);
}

static bool row_json(const struct study_row *row, void *context)
{
    struct table *table = context;
    struct text *text = table->text;
    json_t *metrics = row->metrics == NULL ? NULL : json_loads(row->metrics, 0, NULL);
    size_t index;
    const json_t *name;
    text_print(text, "%s{\"row\":%lld,\"state\":\"%s\",\"job\":", table->count++ > 0 ? "," : "",
               (long long)row->number, row_state_name(row->state));
    quoted_add(text, row->job);
    text_add_string(text, ",\"reason\":");
    quoted_add(text, row->reason);
    text_add_string(text, ",\"detail\":");
    quoted_add(text, row->detail);
    text_print(text, ",\"reused\":%s,\"parameters\":%s,\"metrics\":{",
               row->reused ? "true" : "false", row->parameters);
    json_array_foreach(table->metrics, index, name)
    {
        const json_t *value = json_object_get(metrics, json_string_value(name));
        text_add_string(text, index == 0 ? "" : ",");
        quoted_add(text, json_string_value(name));
        text_add_string(text, ":");
        if (json_is_number(value))
            text_add_number(text, json_number_value(value));
        else
            text_add_string(text, "null");
    }
    text_add_string(text, "}}");
    json_decref(metrics);
    return !text->failed;
}

enum talus_status study_results_json(struct service *service, const struct study *study,
                                     enum study_results_metrics which, struct text *text,
                                     struct talus_error *error)
{
    const struct row_filter filter = {.state = ROW_STATE_COUNT};
    struct table table = table_begin(study, which, text);
    text_print(
        text, "{\"study\":\"%s\",\"state\":\"%s\",\"parameters\":%s,\"metrics\":%s,\"rows\":[",
        study->id, study_state_name((enum study_state)study->state),
        study->names == NULL ? "[]" : study->names, study->metrics == NULL ? "[]" : study->metrics);
    enum talus_status status =
        study_store_rows(service->store, study->id, &filter, row_json, &table, error);
    text_add_string(text, "]}\n");
    table_release(&table);
    return status;
}

/* One field: quoted where it must be. */
static void field_add(struct text *text, const char *value)
{
    if (strpbrk(value, ",\"\r\n") == NULL) {
        text_add_string(text, value);
        return;
    }
    text_add_string(text, "\"");
    for (const char *in = value; *in != '\0'; in++) {
        if (*in == '"')
            text_add_string(text, "\"");
        text_add(text, in, 1);
    }
    text_add_string(text, "\"");
}

/* A number or a text as a field; nothing for null. */
static void value_add(struct text *text, const json_t *value)
{
    text_add_string(text, ",");
    if (json_is_number(value)) {
        text_add_number(text, json_number_value(value));
    } else if (json_is_string(value)) {
        field_add(text, json_string_value(value));
    } else if (value != NULL && !json_is_null(value)) {
        char *dump = json_text(value, 0);
        field_add(text, dump == NULL ? "" : dump);
        free(dump);
    }
}

static void columns_add(struct text *text, const json_t *names, const json_t *values)
{
    size_t index;
    const json_t *name;
    json_array_foreach(names, index, name)
    {
        value_add(text, values == NULL ? name : json_object_get(values, json_string_value(name)));
    }
}

static bool row_csv(const struct study_row *row, void *context)
{
    struct table *table = context;
    struct text *text = table->text;
    json_t *parameters = json_loads(row->parameters, 0, NULL);
    json_t *metrics = json_loads(row->metrics == NULL ? "{}" : row->metrics, 0, NULL);
    text_print(text, "%lld,%s,%s,%s,%s", (long long)row->number, row_state_name(row->state),
               row->job == NULL ? "" : row->job, row->reason == NULL ? "" : row->reason,
               row->reused ? "true" : "false");
    columns_add(text, table->names, parameters);
    columns_add(text, table->metrics, metrics);
    text_add_string(text, "\r\n");
    json_decref(parameters);
    json_decref(metrics);
    return !text->failed;
}

enum talus_status study_results_csv(struct service *service, const struct study *study,
                                    struct text *text, struct talus_error *error)
{
    const struct row_filter filter = {.state = ROW_STATE_COUNT};
    struct table table = table_begin(study, STUDY_RESULTS_ASKED, text);
    text_add_string(text, "row,state,job,reason,reused");
    columns_add(text, table.names, NULL);
    columns_add(text, table.metrics, NULL);
    text_add_string(text, "\r\n");
    enum talus_status status =
        study_store_rows(service->store, study->id, &filter, row_csv, &table, error);
    table_release(&table);
    return status;
}
