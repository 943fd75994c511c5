/* SPDX-License-Identifier: Apache-2.0 */
/* A test double of scene/scene_json.h: reads the few keys that the double of the simulation and
 * the run look at, without defaults or checks beyond "duration". */
#include "scene/scene_json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double number(const json_t *object, const char *key, double fallback)
{
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : fallback;
}

static char *copy_text(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text == NULL ? NULL : strdup(text);
}

static void read_probes(struct talus_scene *scene, const json_t *list)
{
    scene->probe_count = json_array_size(list);
    scene->probes = calloc(scene->probe_count + 1, sizeof *scene->probes);
    for (size_t index = 0; index < scene->probe_count; index++) {
        const json_t *item = json_array_get(list, index);
        scene->probes[index].name = copy_text(item, "name");
        if (json_object_get(item, "boundary") != NULL)
            scene->probes[index].kind = TALUS_PROBE_REACTION;
        scene->probes[index].mean_from = number(item, "mean_from", (double)NAN);
    }
}

static void read_reference(struct talus_reference *reference, const struct talus_scene *scene,
                           const json_t *item)
{
    const char *probe = json_string_value(json_object_get(item, "probe"));
    const json_t *curve = json_object_get(item, "curve");
    for (size_t index = 0; index < scene->probe_count; index++) {
        if (strcmp(scene->probes[index].name, probe) == 0)
            reference->probe_index = index;
    }
    reference->name = copy_text(item, json_object_get(item, "name") != NULL ? "name" : "probe");
    reference->of_job = copy_text(item, "of_job");
    reference->point_count = curve != NULL ? json_array_size(curve) : 1;
    reference->time = calloc(reference->point_count, sizeof *reference->time);
    reference->value = calloc(reference->point_count, sizeof *reference->value);
    reference->time[0] = number(item, "at", (double)NAN);
    reference->value[0] = number(item, "value", 0.0);
    for (size_t index = 0; curve != NULL && index < reference->point_count; index++) {
        const json_t *point = json_array_get(curve, index);
        reference->time[index] = json_number_value(json_array_get(point, 0));
        reference->value[index] = json_number_value(json_array_get(point, 1));
    }
}

static void read_output(struct talus_output_options *output, const json_t *object)
{
    const json_t *frames = json_object_get(object, "frames");
    output->frames_every = number(frames, "every", 0.0);
    output->frame_double = strcmp(json_string_value(json_object_get(frames, "precision")) == NULL
                                      ? "single"
                                      : json_string_value(json_object_get(frames, "precision")),
                                  "double") == 0;
    output->frame_fields = 1u << TALUS_FIELD_VELOCITY | 1u << TALUS_FIELD_STRESS |
                           1u << TALUS_FIELD_ID | 1u << TALUS_FIELD_BODY;
    output->grid_fields = (uint32_t)number(frames, "grid_fields", 0.0);
    output->history_every = number(json_object_get(object, "history"), "every", 0.0);
    output->checkpoint_every = number(json_object_get(object, "checkpoints"), "every", 60.0);
    output->vtu = json_is_true(json_object_get(object, "vtu"));
}

static enum talus_status refuse(struct scene_issues *issues)
{
    issues->items = calloc(1, sizeof *issues->items);
    issues->count = 1;
    (void)snprintf(issues->items[0].pointer, sizeof issues->items[0].pointer, "/duration");
    (void)snprintf(issues->items[0].code, sizeof issues->items[0].code, "required");
    (void)snprintf(issues->items[0].detail, sizeof issues->items[0].detail, "is missing");
    return TALUS_INVALID;
}

enum talus_status scene_read_file(const char *path, struct talus_scene *scene, json_t **effective,
                                  struct scene_issues *issues, struct scene_issues *warnings)
{
    (void)warnings;
    json_t *root = json_load_file(path, 0, NULL);
    memset(scene, 0, sizeof *scene);
    if (json_object_get(root, "duration") == NULL) {
        json_decref(root);
        return refuse(issues);
    }
    scene->title = copy_text(root, "title");
    scene->duration = number(root, "duration", 0.0);
    scene->solver.time_step = number(json_object_get(root, "solver"), "time_step", 1e-3);
    read_probes(scene, json_object_get(root, "probes"));
    const json_t *references = json_object_get(root, "references");
    scene->reference_count = json_array_size(references);
    scene->references = calloc(scene->reference_count + 1, sizeof *scene->references);
    for (size_t index = 0; index < scene->reference_count; index++)
        read_reference(&scene->references[index], scene, json_array_get(references, index));
    read_output(&scene->output, json_object_get(root, "output"));
    *effective = root;
    return TALUS_OK;
}

void scene_hash(const json_t *effective, char hash[65])
{
    char *text = json_dumps(effective, JSON_COMPACT | JSON_SORT_KEYS);
    uint64_t value = 14695981039346656037u;
    for (const char *next = text; *next != '\0'; next++)
        value = (value ^ (unsigned char)*next) * 1099511628211u;
    free(text);
    (void)snprintf(hash, 65, "%064llx", (unsigned long long)value);
}
