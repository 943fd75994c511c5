/* SPDX-License-Identifier: Apache-2.0 */
#include "problem_text.h"

#include <jansson.h>
#include <stdlib.h>

static const char *string_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text == NULL ? "" : text;
}

static void print_value(FILE *stream, const char *label, const json_t *value)
{
    if (value == NULL || json_is_null(value))
        return;
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(10));
    if (text != NULL)
        (void)fprintf(stream, "      %s: %.200s\n", label, text);
    free(text);
}

static void print_error(FILE *stream, const json_t *error)
{
    const char *place = string_of(error, "pointer");
    if (place[0] == '\0')
        place = string_of(error, "parameter");
    (void)fprintf(stream, "  %s: %s", place[0] == '\0' ? "(the whole)" : place,
                  string_of(error, "detail"));
    (void)fprintf(stream, " [%s]\n", string_of(error, "code"));
    print_value(stream, "given", json_object_get(error, "given"));
    print_value(stream, "allowed", json_object_get(error, "allowed"));
}

void problem_print(FILE *stream, long status, const char *body, size_t length)
{
    size_t index;
    json_t *error;
    json_t *problem = body == NULL ? NULL : json_loadb(body, length, 0, NULL);
    if (!json_is_object(problem)) {
        (void)fprintf(stream, "talus: the server refused with status %ld%s%.*s\n", status,
                      length > 0 ? ": " : "", (int)(length < 500 ? length : 500),
                      body == NULL ? "" : body);
        json_decref(problem);
        return;
    }
    const char *title = string_of(problem, "title"), *detail = string_of(problem, "detail");
    (void)fprintf(stream, "talus: %s%s%s (%ld)\n", title, title[0] && detail[0] ? ": " : "", detail,
                  status);
    json_array_foreach(json_object_get(problem, "errors"), index, error) print_error(stream, error);
    json_decref(problem);
}
