/* SPDX-License-Identifier: Apache-2.0 */
/* References: what probes should read. */
#include "scene/scene_component.h"
#include "scene/scene_sections.h"

#include <stdlib.h>
#include <string.h>

struct reference_keys {
    struct talus_reference reference;
    double value, at;
    const char *name, *of_job;
    size_t probe_index; /* SIZE_MAX: unknown */
};

static void read_probe(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct reference_keys *keys = target;
    int index = scene_probe_find(reader, path, given);
    if (index < 0)
        return;
    keys->probe_index = (size_t)index;
    scene_put(reader, effective, path->key, json_string(json_string_value(given)));
}

static json_t *probe_schema(void)
{
    return json_pack("{s:s}", "type", "string");
}

static const struct scene_field point_field = {.key = "curve", .unit = "1"};

static bool read_point(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, double point[2])
{
    bool valid = true;
    if (json_array_size(given) != 2) {
        scene_mistake(reader, path, "length", given, json_integer(2),
                      "expected a pair [time, value]");
        return false;
    }
    for (size_t k = 0; k < 2; k++) {
        struct scene_path here = {.parent = path, .index = k};
        valid &=
            scene_number_read(reader, &here, &point_field, json_array_get(given, k), &point[k]);
    }
    return valid;
}

static void read_curve(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct talus_reference *reference = &((struct reference_keys *)target)->reference;
    size_t count = json_array_size(given);
    if (given == NULL)
        return;
    if (count < 2 || count > SCENE_CURVE_MAX) {
        scene_mistake(reader, path, json_is_array(given) ? "length" : "type", NULL, NULL,
                      "expected an array of 2 to %d pairs [time, value]", SCENE_CURVE_MAX);
        return;
    }
    reference->time = calloc(count, sizeof(double));
    reference->value = calloc(count, sizeof(double));
    if (reference->time == NULL || reference->value == NULL) {
        reader->out_of_memory = true;
        return;
    }
    json_t *list = json_array();
    for (size_t index = 0; index < count; index++) {
        struct scene_path here = {.parent = path, .index = index};
        double point[2] = {0.0, 0.0};
        if (!read_point(reader, &here, json_array_get(given, index), point))
            continue;
        if (index > 0 && point[0] <= reference->time[index - 1])
            scene_mistake(reader, &here, "order", NULL, NULL, "times must grow: %g after %g",
                          point[0], reference->time[index - 1]);
        reference->time[index] = point[0];
        reference->value[index] = point[1];
        if (json_array_append_new(list, json_pack("[f, f]", point[0], point[1])) != 0)
            reader->out_of_memory = true;
    }
    reference->point_count = count;
    scene_put(reader, effective, path->key, list);
}

static json_t *curve_schema(void)
{
    return json_pack("{s:s, s:i, s:i, s:{s:s, s:i, s:i, s:o}}", "type", "array", "minItems", 2,
                     "maxItems", (int)SCENE_CURVE_MAX, "items", "type", "array", "minItems", 2,
                     "maxItems", 2, "items", scene_number_schema(&point_field));
}

const struct scene_field scene_reference_fields[] = {
    {.key = "name",
     .kind = SCENE_NAME,
     .unit = "1",
     .offset = offsetof(struct reference_keys, name),
     .meaning = "name of the metric error.NAME; default the probe's"},
    {.key = "probe",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_probe,
     .schema = probe_schema,
     .meaning = "name of the probe"},
    {.key = "value",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .required = true,
     .default_value = NAN,
     .alternative = "what it should be",
     .offset = offsetof(struct reference_keys, value),
     .meaning = "value at the end, or at the time `at`"},
    {.key = "curve",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .alternative = "what it should be",
     .read = read_curve,
     .schema = curve_schema,
     .meaning = "pairs [time, value] with growing times"},
    {.key = "of_job",
     .kind = SCENE_NAME, /* becomes part of a path */
     .unit = "1",
     .required = true,
     .alternative = "what it should be",
     .offset = offsetof(struct reference_keys, of_job),
     .meaning = "id of a job whose probe of the same name is the reference"},
    {.key = "at",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .default_value = NAN,
     .needs = "value",
     .offset = offsetof(struct reference_keys, at),
     .meaning = "time of a single value"},
    {.key = NULL},
};

/* A single value becomes a curve of one point. */
static void finish_value(struct scene_reader *reader, const struct scene_path *path,
                         const struct reference_keys *keys, struct talus_reference *reference)
{
    struct scene_path at = {.parent = path, .key = "at"};
    if (isnan(keys->value))
        return;
    if (keys->at > reader->scene->duration)
        scene_mistake(reader, &at, "order", NULL, NULL, "%g s is after the end at %g s", keys->at,
                      reader->scene->duration);
    if (reference->time != NULL)
        return; /* both were given, which is a mistake already */
    reference->time = calloc(1, sizeof(double));
    reference->value = calloc(1, sizeof(double));
    if (reference->time == NULL || reference->value == NULL) {
        reader->out_of_memory = true;
        return;
    }
    reference->time[0] = keys->at;
    reference->value[0] = keys->value;
    reference->point_count = 1;
}

/* A reference is for one number: the probe must not read several. */
static void check_single(struct scene_reader *reader, const struct scene_path *path,
                         const struct talus_probe *probe)
{
    struct scene_path here = {.parent = path, .key = "probe"};
    bool vector =
        probe->kind == TALUS_PROBE_CENTRE_OF_MASS ||
        (probe->kind == TALUS_PROBE_REACTION && probe->quantity != TALUS_REACTION_CONTACT_AREA) ||
        ((probe->kind == TALUS_PROBE_POINT || probe->kind == TALUS_PROBE_INTEGRAL) &&
         scene_field_components(probe->field) > 1);
    if (vector && probe->component < 0 && reader->issues->count == 0)
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "the probe \"%s\" reads several components: give it a 'component'",
                      probe->name);
}

static void read_reference(struct scene_reader *reader, const struct scene_path *path,
                           const json_t *given, void *item, json_t *effective)
{
    struct reference_keys keys;
    memset(&keys, 0, sizeof keys);
    keys.probe_index = SIZE_MAX;
    keys.value = keys.at = NAN;
    scene_fields_read(reader, path, scene_reference_fields, given, &keys, effective);
    struct talus_reference *reference = &keys.reference;
    finish_value(reader, path, &keys, reference);
    if (keys.of_job != NULL)
        reference->of_job = scene_copy_text(reader, keys.of_job);
    if (keys.probe_index != SIZE_MAX) {
        const struct talus_probe *probe = &reader->scene->probes[keys.probe_index];
        reference->probe_index = keys.probe_index;
        check_single(reader, path, probe);
        if (keys.name == NULL)
            keys.name = probe->name;
        scene_put(reader, effective, "name", json_string(keys.name));
    }
    reference->name = scene_copy_text(reader, keys.name != NULL ? keys.name : "");
    memcpy(item, reference, sizeof *reference);
}

void scene_references_read(struct scene_reader *reader, const struct scene_path *path,
                           const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    void *items;
    const char *names[SCENE_ENTRY_MAX];
    scene->reference_count = scene_list_read(reader, path, given, 0, sizeof(struct talus_reference),
                                             &items, effective, read_reference);
    scene->references = items;
    for (size_t index = 0; index < scene->reference_count; index++)
        names[index] =
            scene->references[index].name[0] != '\0' ? scene->references[index].name : NULL;
    scene_names_check(reader, path, names, scene->reference_count);
}

json_t *scene_references_schema(void)
{
    return scene_list_schema(scene_reference_fields, 0);
}
