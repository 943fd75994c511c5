/* SPDX-License-Identifier: Apache-2.0 */
/* What is written, and how often. */
#include "scene/scene_component.h"
#include "scene/scene_sections.h"

#include <string.h>

#define AT(member) offsetof(struct talus_output_options, member)

static const char *const grid_field_words[] = {"mass", "velocity", "reaction", NULL};
static const char *const precision_words[] = {"single", "double", NULL};

/* A list of words as a bit set; at most one of each. */
static uint32_t read_words(struct scene_reader *reader, const struct scene_path *path,
                           const json_t *given, const char *const *words, json_t *effective)
{
    uint32_t set = 0;
    if (!json_is_array(given)) {
        scene_mistake(reader, path, "type", given, json_string("array"),
                      "expected an array of words, not %s", scene_type_word(given));
        return 0;
    }
    for (size_t index = 0; index < json_array_size(given); index++) {
        struct scene_path here = {.parent = path, .index = index};
        int word = scene_choice_read(reader, &here, json_array_get(given, index), words, NULL);
        if (word >= 0 && (set & (1u << word)) != 0)
            scene_mistake(reader, &here, "duplicate", json_array_get(given, index), NULL,
                          "\"%s\" is there twice", words[word]);
        if (word >= 0)
            set |= 1u << word;
    }
    json_t *list = json_array();
    for (unsigned word = 0; words[word] != NULL; word++) {
        if ((set & (1u << word)) != 0 && json_array_append_new(list, json_string(words[word])) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, path->key, list);
    return set;
}

static json_t *words_schema(const char *const *words)
{
    return json_pack("{s:s, s:b, s:{s:o}}", "type", "array", "uniqueItems", 1, "items", "enum",
                     scene_word_list(words));
}

static void read_fields(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given, void *target, json_t *effective)
{
    json_t *value = given != NULL ? json_incref((json_t *)given)
                                  : json_pack("[s, s, s]", "velocity", "stress", "plastic_strain");
    ((struct talus_output_options *)target)->frame_fields =
        read_words(reader, path, value, scene_field_words, effective);
    json_decref(value);
}

static json_t *fields_schema(void)
{
    return words_schema(scene_field_words);
}

static void read_grid_fields(struct scene_reader *reader, const struct scene_path *path,
                             const json_t *given, void *target, json_t *effective)
{
    json_t *value = given != NULL ? json_incref((json_t *)given) : json_array();
    ((struct talus_output_options *)target)->grid_fields =
        read_words(reader, path, value, grid_field_words, effective);
    json_decref(value);
}

static json_t *grid_fields_schema(void)
{
    return words_schema(grid_field_words);
}

static const struct scene_field frame_fields[] = {
    {.key = "every",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .default_value = NAN,
     .offset = AT(frames_every),
     .meaning = "time between frames; 0: only the first and the last; default duration / 50"},
    {.key = "fields",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_fields,
     .schema = fields_schema,
     .meaning = "particle fields; default velocity, stress, plastic_strain"},
    {.key = "grid_fields",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_grid_fields,
     .schema = grid_fields_schema,
     .meaning = "node fields; default none"},
    {.key = "precision",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = precision_words,
     .storage = SCENE_STORE_BOOLEAN,
     .offset = AT(frame_double),
     .meaning = "floating point numbers in frames"},
    {.key = NULL},
};

static const struct scene_field history_fields[] = {
    {.key = "every",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .above_minimum = true,
     .default_value = NAN,
     .offset = AT(history_every),
     .meaning = "time between samples; default duration / 200"},
    {.key = NULL},
};

static const struct scene_field checkpoint_fields[] = {
    {.key = "every",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .above_minimum = true,
     .default_value = 60.0,
     .offset = AT(checkpoint_every),
     .meaning = "wall-clock time between restart points"},
    {.key = NULL},
};

const struct scene_field scene_output_fields[] = {
    {.key = "frames",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = frame_fields,
     .meaning = "pictures of all particles"},
    {.key = "history",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = history_fields,
     .meaning = "probes, energies, reactions over time"},
    {.key = "checkpoints",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = checkpoint_fields,
     .meaning = "restart points"},
    {.key = "vtk",
     .kind = SCENE_BOOLEAN,
     .unit = "1",
     .offset = AT(vtu),
     .meaning = "also write VTU files and a PVD list"},
    {.key = NULL},
};

/* Fills in an interval that depends on the duration, and bounds the number of intervals. */
static void finish_every(struct scene_reader *reader, const struct scene_path *path,
                         const char *part, double *every, double parts, double limit,
                         json_t *effective)
{
    double duration = reader->scene->duration;
    struct scene_path parent = {.parent = path, .key = part};
    struct scene_path here = {.parent = &parent, .key = "every"};
    if (json_object_get(json_object_get(effective, part), "every") == NULL &&
        !scene_issues_under(reader->issues, "/output")) {
        *every = duration / parts;
        scene_put(reader, json_object_get(effective, part), "every", json_real(*every));
    }
    if (*every > 0.0 && duration / *every > limit)
        scene_mistake(reader, &here, "limit", NULL, NULL,
                      "%.3g intervals in %g s; at most %.0f are allowed", duration / *every,
                      duration, limit);
}

void scene_output_read(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    json_t *inner = json_object();
    scene_fields_read(reader, path, scene_output_fields, given, &scene->output, inner);
    if (scene->duration > 0.0) {
        finish_every(reader, path, "frames", &scene->output.frames_every, 50.0, 1e6, inner);
        finish_every(reader, path, "history", &scene->output.history_every, 200.0, 1e7, inner);
    }
    scene_put(reader, effective, path->key, inner);
}

json_t *scene_output_schema(void)
{
    return scene_fields_schema(scene_output_fields);
}
