/* SPDX-License-Identifier: Apache-2.0 */
/* Boundaries that move, and that act in a part of the time. */
#include "scene/scene_boundary.h"
#include "scene/scene_component.h"
#include "scene/scene_time_table.h"

static const struct scene_field velocity_field = {
    .key = "velocity",
    .unit = "m/s",
    .minimum = -INFINITY,
    .maximum = INFINITY,
    .meaning = "prescribed velocity; each component a number or [[t, value], ...]",
};

void scene_boundary_velocity_read(struct scene_reader *reader, const struct scene_path *path,
                                  const json_t *given, void *target, json_t *effective)
{
    struct talus_boundary *boundary = &((struct boundary_keys *)target)->boundary;
    json_t *value = NULL;
    if (given != NULL &&
        scene_timed_vector_read(reader, path, &velocity_field, given, boundary->velocity,
                                boundary->velocity_tables, &value))
        scene_put(reader, effective, path->key, value);
}

json_t *scene_boundary_velocity_schema(void)
{
    return scene_timed_vector_schema(&velocity_field);
}

void scene_boundary_components_read(struct scene_reader *reader, const struct scene_path *path,
                                    const json_t *given, void *target, json_t *effective)
{
    struct talus_boundary *boundary = &((struct boundary_keys *)target)->boundary;
    const char *words[10];
    if (given == NULL)
        return;
    if (!json_is_array(given) || json_array_size(given) == 0 || json_array_size(given) > 3) {
        scene_mistake(reader, path, json_is_array(given) ? "length" : "type", given,
                      json_string("[\"x\", ...]"), "expected a list of 1 to 3 axes");
        return;
    }
    scene_component_words(3, reader->axis_count, words);
    for (size_t index = 0; index < json_array_size(given); index++) {
        struct scene_path here = {.parent = path, .index = index};
        const int axis = scene_component_read(reader, &here, json_array_get(given, index), words);
        for (size_t before = 0; before < index; before++) {
            if (json_equal(json_array_get(given, before), json_array_get(given, index)))
                scene_mistake(reader, &here, "duplicate", json_array_get(given, index), NULL,
                              "the axis is there twice");
        }
        if (axis >= 0)
            boundary->prescribed |= 1u << axis;
    }
    scene_put(reader, effective, path->key, json_deep_copy(given));
}

json_t *scene_boundary_components_schema(void)
{
    return json_pack("{s:s, s:i, s:i, s:b, s:{s:[s, s, s]}}", "type", "array", "minItems", 1,
                     "maxItems", 3, "uniqueItems", 1, "items", "enum", "x", "y", "z");
}

static bool any_face_prescribes(const struct talus_boundary *boundary)
{
    for (size_t face = 0; face < boundary->face_count; face++) {
        if (scene_condition_prescribes(boundary->faces[face].condition_index))
            return true;
    }
    return false;
}

/* All axes unless `components` names some. */
static void finish_components(struct scene_reader *reader, const json_t *given,
                              struct talus_boundary *boundary, json_t *effective)
{
    if (json_object_get(given, "components") != NULL)
        return;
    boundary->prescribed = (1u << reader->axis_count) - 1;
    json_t *list = json_array();
    for (size_t axis = 0; axis < reader->axis_count; axis++) {
        if (json_array_append_new(list, json_stringn(&"xyz"[axis], 1)) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, "components", list);
}

static void finish_velocity(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, struct talus_boundary *boundary, json_t *effective)
{
    static const char *const keys[] = {"velocity", "components", "stays"};
    if (any_face_prescribes(boundary)) {
        struct scene_path velocity = {.parent = path, .key = "velocity"};
        struct scene_path wall = {.parent = path, .key = "wall"};
        if (json_object_get(given, "velocity") == NULL)
            scene_mistake(reader, &velocity, "incomplete", NULL, NULL,
                          "the condition \"velocity\" needs 'velocity'");
        if (boundary->wall == TALUS_WALL_KEEP)
            scene_mistake(reader, &wall, "contradiction", NULL, NULL,
                          "a boundary with the condition \"velocity\" sets the velocity of the "
                          "material at once: \"wall\": \"stop\"");
        finish_components(reader, given, boundary, effective);
        return;
    }
    for (size_t key = 0; key < sizeof keys / sizeof keys[0]; key++) {
        struct scene_path here = {.parent = path, .key = keys[key]};
        const json_t *value = json_object_get(given, keys[key]);
        if (value != NULL && !json_is_false(value))
            scene_mistake(reader, &here, "contradiction", NULL, NULL,
                          "'%s' goes with the condition \"velocity\"", keys[key]);
    }
    boundary->prescribed = 0;
    (void)json_object_del(effective, "stays");
}

void scene_boundary_motion_finish(struct scene_reader *reader, const struct scene_path *path,
                                  const json_t *given, struct boundary_keys *keys,
                                  json_t *effective)
{
    struct talus_boundary *boundary = &keys->boundary;
    finish_velocity(reader, path, given, boundary, effective);
    boundary->timed = !isnan(keys->from) || !isnan(keys->until);
    boundary->from = isnan(keys->from) ? -INFINITY : keys->from;
    boundary->until = isnan(keys->until) ? INFINITY : keys->until;
    if (boundary->from < boundary->until)
        return;
    struct scene_path until = {.parent = path, .key = "until"};
    scene_mistake(reader, &until, "order", NULL, NULL, "until %g s must be after from %g s",
                  boundary->until, boundary->from);
}
