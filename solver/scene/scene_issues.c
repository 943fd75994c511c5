/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_reader.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void scene_issues_release(struct scene_issues *issues)
{
    for (size_t index = 0; index < issues->count; index++) {
        json_decref(issues->items[index].given);
        json_decref(issues->items[index].allowed);
    }
    free(issues->items);
    memset(issues, 0, sizeof *issues);
}

json_t *scene_issues_json(const struct scene_issues *issues)
{
    json_t *list = json_array();
    for (size_t index = 0; index < issues->count; index++) {
        const struct scene_issue *issue = &issues->items[index];
        json_t *entry =
            json_pack("{s:s, s:s, s:s, s:O?, s:O?}", "pointer", issue->pointer, "code", issue->code,
                      "detail", issue->detail, "given", issue->given, "allowed", issue->allowed);
        if (entry == NULL || json_array_append_new(list, entry) != 0) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

void scene_path_print(const struct scene_path *path, char pointer[256])
{
    const struct scene_path *chain[64];
    size_t depth = 0, length = 0;
    pointer[0] = '\0';
    for (; path != NULL && depth < 64; path = path->parent)
        chain[depth++] = path;
    while (depth-- > 0 && length < 240) {
        pointer[length++] = '/';
        if (chain[depth]->key == NULL)
            length += (size_t)snprintf(pointer + length, 12, "%zu", chain[depth]->index % 1000000);
        for (const char *c = chain[depth]->key; c != NULL && *c != '\0' && length < 252; c++) {
            if (*c == '~' || *c == '/') { /* RFC 6901 */
                pointer[length++] = '~';
                pointer[length++] = *c == '~' ? '0' : '1';
            } else {
                pointer[length++] = *c;
            }
        }
        pointer[length] = '\0';
    }
}

static struct scene_issue *add_issue(struct scene_reader *reader, struct scene_issues *issues)
{
    if (issues->count == SCENE_ISSUE_MAX)
        return NULL;
    if (issues->count == issues->capacity) {
        size_t capacity = issues->capacity == 0 ? 8 : 2 * issues->capacity;
        struct scene_issue *items = realloc(issues->items, capacity * sizeof *items);
        if (items == NULL) {
            reader->out_of_memory = true;
            return NULL;
        }
        issues->items = items;
        issues->capacity = capacity;
    }
    struct scene_issue *issue = &issues->items[issues->count++];
    memset(issue, 0, sizeof *issue);
    return issue;
}

/* A copy of what was given if it is small enough to be shown; a new reference or NULL. */
static json_t *copy_small(const json_t *given)
{
    enum { TEXT_MAX = 200, ARRAY_MAX = 9 };
    if (json_is_string(given) && json_string_length(given) > TEXT_MAX)
        return NULL;
    if (json_is_object(given) || json_array_size(given) > ARRAY_MAX)
        return NULL;
    for (size_t index = 0; index < json_array_size(given); index++) {
        const json_t *entry = json_array_get(given, index);
        if (json_is_array(entry) || json_is_object(entry))
            return NULL;
    }
    return json_deep_copy(given);
}

/* Every code is in the list, so that what it means for the schema is decided in one place. */
static void set_code(struct scene_issue *issue, const char *code)
{
    static const char *const codes[] = {
#define SCENE_CODE(code, CLASS, text) #code,
#include "scene/scene_codes.def"
#undef SCENE_CODE
    };
    bool known = false;
    for (size_t index = 0; index < sizeof codes / sizeof codes[0]; index++)
        known = known || strcmp(codes[index], code) == 0;
    assert(known);
    (void)known;
    (void)snprintf(issue->code, sizeof issue->code, "%s", code);
}

void scene_mistake(struct scene_reader *reader, const struct scene_path *path, const char *code,
                   const json_t *given, json_t *allowed, const char *format, ...)
{
    struct scene_issue *issue = add_issue(reader, reader->issues);
    if (issue == NULL) {
        json_decref(allowed);
        return;
    }
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(issue->detail, sizeof issue->detail, format, arguments);
    va_end(arguments);
    set_code(issue, code);
    scene_path_print(path, issue->pointer);
    issue->given = copy_small(given);
    issue->allowed = allowed;
}

void scene_mistake_at(struct scene_reader *reader, const char *pointer, const char *code,
                      const char *detail)
{
    struct scene_issue *issue = add_issue(reader, reader->issues);
    if (issue == NULL)
        return;
    (void)snprintf(issue->detail, sizeof issue->detail, "%s", detail);
    set_code(issue, code);
    (void)snprintf(issue->pointer, sizeof issue->pointer, "%s", pointer);
}

void scene_file_mistake(struct scene_reader *reader, const json_error_t *error)
{
    if (error->line < 0)
        scene_mistake(reader, NULL, "file", NULL, NULL, "%s", error->text);
    else
        scene_mistake(reader, NULL, "json", NULL, NULL, "line %d, column %d: %s", error->line,
                      error->column, error->text);
}

void scene_warn(struct scene_reader *reader, const struct scene_path *path, const char *code,
                const char *format, ...)
{
    struct scene_issue *issue = add_issue(reader, reader->warnings);
    if (issue == NULL)
        return;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(issue->detail, sizeof issue->detail, format, arguments);
    va_end(arguments);
    (void)snprintf(issue->code, sizeof issue->code, "%s", code);
    scene_path_print(path, issue->pointer);
}
