/* SPDX-License-Identifier: Apache-2.0 */
/* The root of a scene: reads the sections in the order in which they need each other. */
#include "scene/scene_sections.h"
#include "scene/scene_words.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* In the order of enum talus_dimension. */
const char *const scene_dimension_words[] = {"line",         "plane_strain", "plane_stress",
                                             "axisymmetric", "solid",        NULL};
static const size_t dimension_axes[] = {1, 2, 2, 2, 3};

static void read_dimension(struct scene_reader *reader, const struct scene_path *path,
                           const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    int index = scene_choice_read(reader, path, given, scene_dimension_words, NULL);
    if (index < 0)
        return;
    scene->dimension = (enum talus_dimension)index;
    scene->axis_count = reader->axis_count = dimension_axes[index];
    scene_put(reader, effective, path->key, json_string(scene_dimension_words[index]));
}

json_t *scene_dimensions_of(size_t axis_count)
{
    json_t *list = json_array();
    for (size_t index = 0; scene_dimension_words[index] != NULL; index++) {
        if (dimension_axes[index] == axis_count)
            (void)json_array_append_new(list, json_string(scene_dimension_words[index]));
    }
    return list;
}

static json_t *dimension_schema(void)
{
    return json_pack("{s:o}", "enum", scene_word_list(scene_dimension_words));
}

static void read_title(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct title {
        const char *text;
    } title = {.text = ""};
    static const struct scene_field fields[] = {
        {.key = "title", .kind = SCENE_TEXT, .unit = "1", .offset = offsetof(struct title, text)},
        {.key = NULL},
    };
    (void)path;
    if (given != NULL) {
        json_t *object = json_pack("{s:O}", "title", given);
        scene_fields_read(reader, NULL, fields, object, &title, NULL);
        json_decref(object); /* `given` lives on in the document */
    }
    ((struct talus_scene *)target)->title = scene_copy_text(reader, title.text);
    scene_put(reader, effective, "title", json_string(title.text));
}

static json_t *title_schema(void)
{
    return json_pack("{s:s, s:i}", "type", "string", "maxLength", 1000);
}

static const struct scene_field audit_fields[] = {
    {.key = "energy_growth",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .maximum = INFINITY,
     .default_value = 0.01,
     .offset = offsetof(struct talus_scene, energy_growth_limit),
     .meaning = "share of the energy turned over by which the energy may grow"},
    {.key = NULL},
};

#define SECTION(NAME, REQUIRED, MEANING)                                                           \
    {                                                                                              \
        .key = #NAME, .kind = SCENE_CUSTOM, .unit = "1", .required = REQUIRED,                     \
        .read = scene_##NAME##_read, .schema = scene_##NAME##_schema, .meaning = MEANING           \
    }

const struct scene_field scene_root_fields[] = {
    {.key = "title",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_title,
     .schema = title_schema,
     .meaning = "for people"},
    {.key = "dimension",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_dimension,
     .schema = dimension_schema,
     .meaning = "line (1D), plane_strain, plane_stress (linear elastic only), axisymmetric (x is "
                "the distance from the axis, y runs along it), solid (3D); vectors have 1, 2 or 3 "
                "components to match"},
    {.key = "duration",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .above_minimum = true,
     .required = true,
     .default_value = NAN,
     .offset = offsetof(struct talus_scene, duration),
     .meaning = "end of the run"},
    SECTION(grid, true, "cells, and the box that bounds the problem"),
    {.key = "solver",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = scene_solver_fields,
     .meaning = "how the equations are solved"},
    SECTION(materials, true, "name to model and parameters"),
    SECTION(gravity, false, "acceleration; default none"),
    SECTION(bodies, true, "what the problem is made of"),
    SECTION(boundaries, false, "walls, obstacles, outlets"),
    SECTION(probes, false, "what is read at every sample"),
    SECTION(references, false, "what probes should read"),
    SECTION(output, false, "what is written, and how often"),
    {.key = "audits",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = audit_fields,
     .meaning = "limits of the checks at the end of a run"},
    {.key = "phases", .unsupported = true},
    {.key = NULL},
};

/* Containers within containers; the document has no reason to go deeper than this. */
enum { DEPTH_MAX = 24 };

static bool too_deep(const json_t *value, int depth)
{
    const char *key;
    json_t *member;
    size_t index;
    if (depth == 0)
        return json_is_object(value) || json_is_array(value);
    json_object_foreach((json_t *)value, key, member)
    { /* the iterator does not write */
        if (too_deep(member, depth - 1))
            return true;
    }
    json_array_foreach(value, index, member)
    {
        if (too_deep(member, depth - 1))
            return true;
    }
    return false;
}

bool scene_issues_under(const struct scene_issues *issues, const char *pointer)
{
    size_t length = strlen(pointer);
    for (size_t index = 0; index < issues->count; index++) {
        const char *place = issues->items[index].pointer;
        if (strncmp(place, pointer, length) == 0 && (place[length] == '\0' || place[length] == '/'))
            return true;
    }
    return false;
}

enum talus_status scene_read(const json_t *root, struct talus_scene *scene, json_t **effective,
                             struct scene_issues *issues, struct scene_issues *warnings)
{
    struct scene_reader reader = {.scene = scene, .issues = issues, .warnings = warnings};
    memset(scene, 0, sizeof *scene);
    memset(issues, 0, sizeof *issues);
    memset(warnings, 0, sizeof *warnings);
    *effective = json_object();
    if (too_deep(root, DEPTH_MAX))
        scene_mistake(&reader, NULL, "depth", NULL, json_integer(DEPTH_MAX),
                      "objects and arrays are nested more than %d deep", DEPTH_MAX);
    else
        scene_fields_read(&reader, NULL, scene_root_fields, root, scene, *effective);
    scene_solver_choose_shape(&reader, root, *effective);
    scene_check(&reader);
    if (issues->count == 0 && !reader.out_of_memory && *effective != NULL)
        return TALUS_OK;
    json_decref(*effective);
    *effective = NULL;
    talus_scene_release(scene);
    return reader.out_of_memory ? TALUS_MEMORY : TALUS_INVALID;
}

enum talus_status scene_read_file(const char *path, struct talus_scene *scene, json_t **effective,
                                  struct scene_issues *issues, struct scene_issues *warnings)
{
    json_error_t error;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    /* 1e20 may be written with all its digits. */
    if (root == NULL && json_error_code(&error) == json_error_numeric_overflow)
        root = json_load_file(path, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error);
    if (root != NULL) {
        enum talus_status status = scene_read(root, scene, effective, issues, warnings);
        json_decref(root);
        return status;
    }
    struct scene_reader reader = {.scene = scene, .issues = issues, .warnings = warnings};
    memset(scene, 0, sizeof *scene);
    memset(issues, 0, sizeof *issues);
    memset(warnings, 0, sizeof *warnings);
    *effective = NULL;
    scene_file_mistake(&reader, &error);
    return TALUS_INVALID;
}
