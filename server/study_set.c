/* SPDX-License-Identifier: Apache-2.0 */
#include "study_set.h"

#include "expression.h"
#include "reply.h"
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ENTRY_MAX = STUDY_SET_MAX + STUDY_NAME_MAX };

struct study_set {
    const char *names[STUDY_NAME_MAX + 1]; /* NULL-terminated */
    bool used[STUDY_NAME_MAX];
    size_t name_count, entry_count;
    bool nest;                                                    /* some place is within another */
    char place[JSON_POINTER_SIZE], parameters[JSON_POINTER_SIZE]; /* in the request */
    struct set_entry {
        const char *pointer;           /* into the scene */
        bool itself;                   /* a name that sets itself */
        int name;                      /* the parameter that is put there, or -1 */
        json_t *number;                /* a plain number, borrowed, or NULL */
        struct expression *expression; /* or NULL */
        bool failed;                   /* a mistake in a row was told */
    } entries[ENTRY_MAX];
};

static int name_find(void *context, const char *name, size_t length)
{
    const struct study_set *set = context;
    for (size_t index = 0; index < set->name_count; index++) {
        if (strlen(set->names[index]) == length && strncmp(set->names[index], name, length) == 0)
            return (int)index;
    }
    return -1;
}

static void name_use(void *context, int index)
{
    struct study_set *set = context;
    set->used[index] = true;
}

static void name_read(struct study_set *set, struct study_reader *reader, const char *name)
{
    char place[JSON_POINTER_SIZE];
    json_pointer_join(place, set->parameters, name);
    (void)json_array_append_new(reader->plan->names, json_string(name));
    set->names[set->name_count] = name;
    if (name[0] == '/') {
        set->used[set->name_count] = true;
        set->entries[set->entry_count++] =
            (struct set_entry){.pointer = name, .itself = true, .name = (int)set->name_count};
    } else if (strlen(name) > STUDY_TEXT_MAX || !expression_name_is_valid(name)) {
        issue_add(reader->errors, place, "name", NULL, NULL,
                  "a name is letters, digits and _ (no function, nor pi), or a JSON Pointer");
    }
    set->name_count++;
}

static void expression_read(struct study_set *set, struct study_reader *reader,
                            struct set_entry *entry, const json_t *given, const char *place)
{
    struct expression_mistake mistake;
    const char *text = json_string_value(given);
    entry->name = name_find(set, text, strlen(text));
    if (entry->name >= 0) {
        set->used[entry->name] = true;
        return;
    }
    entry->expression = expression_create(text, name_find, set, &mistake);
    if (entry->expression != NULL) {
        expression_visit(entry->expression, name_use, set);
        return;
    }
    const char *near = mistake.name[0] == '\0' ? NULL : suggest(mistake.name, set->names);
    issue_add(reader->errors, place, mistake.name[0] == '\0' ? "syntax" : "unknown_name", given,
              NULL, "at character %zu: %s%s%s%s%s%s", mistake.position + 1, mistake.text,
              mistake.name[0] == '\0' ? "" : " ", mistake.name,
              near == NULL ? "" : "; did you mean '", near == NULL ? "" : near,
              near == NULL ? "" : "'?");
}

static void set_read(struct study_set *set, struct study_reader *reader, const json_t *object)
{
    const char *pointer;
    json_t *given;
    json_object_foreach((json_t *)(uintptr_t)object, pointer, given)
    {
        char place[JSON_POINTER_SIZE];
        struct set_entry *entry = &set->entries[set->entry_count++];
        *entry = (struct set_entry){.pointer = pointer, .name = -1};
        json_pointer_join(place, set->place, pointer);
        if (json_is_number(given))
            entry->number = given;
        else if (json_is_string(given))
            expression_read(set, reader, entry, given, place);
        else
            issue_add(reader->errors, place, "type", given, NULL,
                      "the name of a parameter or an expression is wanted, as a text");
    }
}

static void entry_place(const struct study_set *set, const struct set_entry *entry,
                        char place[JSON_POINTER_SIZE])
{
    json_pointer_join(place, entry->itself ? set->parameters : set->place, entry->pointer);
}

/* Brings the entries into the order in which they are put, and checks where. */
static void places_check(struct study_set *set, struct study_reader *reader)
{
    struct study_item items[ENTRY_MAX];
    struct set_entry *sorted = malloc(sizeof set->entries);
    char place[JSON_POINTER_SIZE];
    for (size_t index = 0; index < set->entry_count; index++)
        items[index] = (struct study_item){.pointer = set->entries[index].pointer, .order = index};
    study_items_sort(items, set->entry_count);
    for (size_t index = 0; sorted != NULL && index < set->entry_count; index++)
        sorted[index] = set->entries[items[index].order];
    if (sorted == NULL)
        issue_add(reader->errors, set->place, "memory", NULL, NULL, "out of memory");
    else
        memcpy(set->entries, sorted, set->entry_count * sizeof *sorted);
    free(sorted);
    const struct study_item *repeated = study_items_repeated(items, set->entry_count);
    if (repeated != NULL) {
        json_pointer_join(place, set->place, repeated->pointer);
        issue_add(reader->errors, place, "contradiction", NULL, NULL,
                  "a parameter of this name sets the same place");
    }
    set->nest = study_items_nest(items, set->entry_count);
    const char *outer = NULL;
    for (size_t index = 0; index < set->entry_count; index++) {
        /* What lies within another place depends on the row. */
        if (outer != NULL && json_pointer_is_within(items[index].pointer, outer))
            continue;
        outer = items[index].pointer;
        entry_place(set, &set->entries[index], place);
        (void)study_place_check(reader, outer, place);
    }
}

static void used_check(const struct study_set *set, struct study_reader *reader)
{
    char place[JSON_POINTER_SIZE];
    for (size_t index = 0; index < set->name_count; index++) {
        json_pointer_join(place, set->parameters, set->names[index]);
        if (!set->used[index])
            issue_add(reader->errors, place, "unused", NULL, NULL,
                      "no entry of 'set' uses '%s'; a name that begins with / sets itself",
                      set->names[index]);
    }
}

static bool sizes_check(struct study_reader *reader, size_t count, size_t maximum,
                        const char *place, const char *what)
{
    json_t *allowed = json_pack("{s:I}", "maximum", (json_int_t)maximum);
    if (count > maximum)
        issue_add(reader->errors, place, "range", NULL, allowed, "at most %zu %s are allowed",
                  maximum, what);
    json_decref(allowed);
    return count <= maximum;
}

struct study_set *study_set_create(struct study_reader *reader, const json_t *design,
                                   const char *parent, const json_t *parameters,
                                   const char *pointer)
{
    struct study_set *set = calloc(1, sizeof *set);
    const json_t *object = json_object_get(design, "set");
    size_t before = json_array_size(reader->errors);
    const char *name;
    json_t *value;
    if (set == NULL) {
        issue_add(reader->errors, pointer, "memory", NULL, NULL, "out of memory");
        return NULL;
    }
    json_pointer_join(set->place, parent, "set");
    memcpy(set->parameters, pointer, strlen(pointer) + 1);
    if (object != NULL && !json_is_object(object))
        issue_add(reader->errors, set->place, "type", object, NULL, "an object is wanted");
    bool fits =
        sizes_check(reader, json_object_size(parameters), STUDY_NAME_MAX, pointer, "parameters");
    fits =
        sizes_check(reader, json_object_size(object), STUDY_SET_MAX, set->place, "places") && fits;
    if (fits) {
        json_object_foreach((json_t *)(uintptr_t)parameters, name, value)
            name_read(set, reader, name);
        set_read(set, reader, object);
        places_check(set, reader);
    }
    if (study_good(reader, before))
        used_check(set, reader);
    if (study_good(reader, before))
        return set;
    study_set_destroy(set);
    return NULL;
}

void study_set_destroy(struct study_set *set)
{
    for (size_t index = 0; set != NULL && index < set->entry_count; index++)
        expression_destroy(set->entries[index].expression);
    free(set);
}

size_t study_set_size(const struct study_set *set)
{
    return set->name_count + set->entry_count;
}

/* The number that a name stands for in an expression, or an issue. */
struct number_search {
    json_t *const *given;
    double values[STUDY_NAME_MAX];
    int not_a_number; /* the first name that is none, or -1 */
};

static void number_take(void *context, int index)
{
    struct number_search *search = context;
    const json_t *value = study_value_set(search->given[index]);
    search->values[index] = json_number_value(value);
    if (!json_is_number(value) && search->not_a_number < 0)
        search->not_a_number = index;
}

/* A result with 15 digits, so that 3 * 0.1 is 0.3 and machines agree; whole ones as integers. */
static json_t *number_make(double value)
{
    char text[32];
    (void)snprintf(text, sizeof text, "%.15g", value);
    double rounded = strtod(text, NULL);
    return fabs(rounded) < 1e15 && floor(rounded) == rounded ? json_integer((json_int_t)rounded)
                                                             : json_real(rounded);
}

/* "row 4 {...}": which row a mistake is in, for people. */
static void row_describe(const struct study_reader *reader, const json_t *parameters,
                         char text[200])
{
    char *shown = json_dumps(parameters, JSON_COMPACT);
    (void)snprintf(text, 200, "row %zu %.150s", json_array_size(reader->plan->rows),
                   shown == NULL ? "" : shown);
    free(shown);
}

/* The value of an entry in a row: a new reference, NULL with an issue. */
static json_t *entry_value(struct study_set *set, struct study_reader *reader,
                           struct set_entry *entry, json_t *const *given, const json_t *parameters)
{
    struct number_search search = {.given = given, .not_a_number = -1};
    struct expression_mistake mistake;
    char place[JSON_POINTER_SIZE], row[200];
    double result;
    if (entry->number != NULL)
        return json_incref(entry->number);
    if (entry->name >= 0)
        return json_incref(study_value_set(given[entry->name]));
    expression_visit(entry->expression, number_take, &search);
    if (search.not_a_number < 0 &&
        expression_evaluate(entry->expression, search.values, &result, &mistake))
        return number_make(result);
    if (entry->failed)
        return NULL;
    entry->failed = true;
    row_describe(reader, parameters, row);
    entry_place(set, entry, place);
    if (search.not_a_number >= 0)
        issue_add(reader->errors, place, "type", study_value_shown(given[search.not_a_number]),
                  NULL, "%s: '%s' is not a number", row, set->names[search.not_a_number]);
    else
        issue_add(reader->errors, place, "not_finite", NULL, NULL, "%s: %s, at character %zu", row,
                  mistake.text, mistake.position + 1);
    return NULL;
}

static json_t *parameters_make(const struct study_set *set, json_t *const *given)
{
    json_t *parameters = json_object();
    for (size_t index = 0; index < set->name_count; index++) {
        if (json_object_set(parameters, set->names[index], study_value_shown(given[index])) != 0) {
            json_decref(parameters);
            return NULL;
        }
    }
    return parameters;
}

void study_set_row(struct study_set *set, struct study_reader *reader, json_t *const *given)
{
    struct study_item items[ENTRY_MAX];
    size_t count = 0;
    json_t *parameters = parameters_make(set, given);
    for (; count < set->entry_count; count++) {
        items[count].pointer = set->entries[count].pointer;
        items[count].place = set->entries[count].itself ? set->parameters : set->place;
        items[count].value = entry_value(set, reader, &set->entries[count], given, parameters);
        if (items[count].value == NULL)
            break;
    }
    if (count == set->entry_count)
        study_row_add(reader, parameters, items, count, set->nest);
    else
        json_decref(parameters);
    while (count-- > 0)
        json_decref(items[count].value);
}
