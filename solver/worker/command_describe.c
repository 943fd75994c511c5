/* SPDX-License-Identifier: Apache-2.0 */
/* Prints every part of a scene with its keys, units, bounds and defaults. */
#include "base/protocol.h"
#include "scene/scene_json.h"
#include "worker/command.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text != NULL ? text : "";
}

static void print_bounds(const json_t *field)
{
    static const struct {
        const char *key, *sign;
    } bounds[] = {
        {"minimum", ">="},
        {"exclusiveMinimum", ">"},
        {"maximum", "<="},
        {"exclusiveMaximum", "<"},
    };
    for (size_t index = 0; index < sizeof bounds / sizeof bounds[0]; index++) {
        const json_t *bound = json_object_get(field, bounds[index].key);
        if (bound != NULL)
            (void)printf(" %s %g", bounds[index].sign, json_number_value(bound));
    }
    const json_t *preset = json_object_get(field, "default");
    char *text =
        preset != NULL ? json_dumps(preset, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6)) : NULL;
    if (text != NULL)
        (void)printf(", default %s", text);
    free(text);
    if (json_is_true(json_object_get(field, "required")))
        (void)printf(", required%s", *text_of(field, "alternative") != '\0' ? " (or another)" : "");
}

static void print_fields(const json_t *fields, int indent)
{
    size_t index, word;
    const json_t *field, *choice;
    json_array_foreach(fields, index, field)
    {
        (void)printf("%*s%s: %s", indent, "", text_of(field, "key"), text_of(field, "type"));
        if (strcmp(text_of(field, "unit"), "1") != 0)
            (void)printf(" [%s]", text_of(field, "unit"));
        print_bounds(field);
        json_array_foreach(json_object_get(field, "choices"), word, choice)
        {
            (void)printf("%s%s", word == 0 ? "; one of " : ", ", json_string_value(choice));
        }
        (void)printf("\n%*s    %s\n", indent, "", text_of(field, "meaning"));
        print_fields(json_object_get(field, "fields"), indent + 4);
    }
}

/* Entries of a list that is not made of fields: "name (reference): summary" and parameters. */
static void print_entries(const json_t *list, const char *name_key)
{
    size_t index;
    const json_t *entry;
    json_array_foreach(list, index, entry)
    {
        (void)printf("  %s: %s%s\n", text_of(entry, name_key), text_of(entry, "summary"),
                     text_of(entry, "meaning"));
        if (*text_of(entry, "reference") != '\0')
            (void)printf("      %s\n", text_of(entry, "reference"));
        print_fields(json_object_get(entry, "parameters"), 6);
    }
}

static void print_description(const json_t *description)
{
    static const char *const parts[] = {"scene",      "grid",   "solver",     "bodies",
                                        "boundaries", "probes", "references", "output"};
    (void)printf("%s\n%s\n", text_of(description, "build"), text_of(description, "units"));
    for (size_t index = 0; index < sizeof parts / sizeof parts[0]; index++) {
        (void)printf("\n%s\n", parts[index]);
        print_fields(json_object_get(description, parts[index]), 2);
    }
    (void)printf("\nmaterials\n");
    print_entries(json_object_get(description, "materials"), "model");
    (void)printf("\nshapes\n");
    print_entries(json_object_get(description, "shapes"), "shape");
    (void)printf("\ntransfers\n");
    print_entries(json_object_get(description, "transfers"), "transfer");
    (void)printf("\nconditions\n");
    print_entries(json_object_get(description, "conditions"), "condition");
    (void)printf("\nfields\n");
    print_entries(json_object_get(description, "fields"), "field");
}

int command_describe(int argument_count, char **arguments)
{
    bool json = argument_count == 2 && strcmp(arguments[1], "--json") == 0;
    if (argument_count > 1 && !json) {
        (void)fprintf(stderr, "usage: talus-worker describe [--json]\n");
        return PROTOCOL_EXIT_OTHER;
    }
    json_t *description = scene_describe();
    if (description == NULL) {
        (void)fprintf(stderr, "talus-worker describe: out of memory\n");
        return PROTOCOL_EXIT_MEMORY;
    }
    if (json)
        (void)json_dumpf(description, stdout, JSON_INDENT(2));
    else
        print_description(description);
    (void)printf("\n");
    json_decref(description);
    return fflush(stdout) == 0 ? PROTOCOL_EXIT_SUCCEEDED : PROTOCOL_EXIT_OTHER;
}
