/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of named entries. */
#include "scene/scene_sections.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t
scene_list_read(struct scene_reader *reader, const struct scene_path *path, const json_t *given,
                size_t minimum, size_t item_size, void **items, json_t *effective,
                void (*read_entry)(struct scene_reader *reader, const struct scene_path *path,
                                   const json_t *given, void *item, json_t *effective))
{
    size_t count = json_array_size(given);
    *items = NULL;
    if (given != NULL && !json_is_array(given)) {
        scene_mistake(reader, path, "type", given, json_string("array"),
                      "expected an array, not %s", scene_type_word(given));
        return 0;
    }
    if (count < minimum || count > SCENE_ENTRY_MAX) {
        scene_mistake(reader, path, "length", NULL, NULL, "expected %zu to %d entries, not %zu",
                      minimum, SCENE_ENTRY_MAX, count);
        return 0;
    }
    json_t *list = json_array();
    scene_put(reader, effective, path->key, list);
    if (count == 0)
        return 0;
    *items = calloc(count, item_size);
    if (*items == NULL) {
        reader->out_of_memory = true;
        return 0;
    }
    for (size_t index = 0; index < count; index++) {
        struct scene_path here = {.parent = path, .index = index};
        json_t *entry = json_object();
        read_entry(reader, &here, json_array_get(given, index), (char *)*items + index * item_size,
                   entry);
        if (json_array_append_new(list, entry) != 0)
            reader->out_of_memory = true;
    }
    return count;
}

char *scene_entry_name(struct scene_reader *reader, const struct scene_path *path,
                       const char *given, const char *kind, json_t *effective)
{
    char name[64];
    (void)snprintf(name, sizeof name, "%s_%zu", kind, path->index);
    if (given == NULL)
        scene_put(reader, effective, "name", json_string(name));
    return scene_copy_text(reader, given != NULL ? given : name);
}

void scene_names_check(struct scene_reader *reader, const struct scene_path *path,
                       const char *const *names, size_t count)
{
    for (size_t index = 1; index < count; index++) {
        for (size_t before = 0; before < index; before++) {
            if (names[index] == NULL || names[before] == NULL ||
                strcmp(names[index], names[before]) != 0)
                continue;
            struct scene_path entry = {.parent = path, .index = index};
            struct scene_path here = {.parent = &entry, .key = "name"};
            scene_mistake(reader, &here, "taken", NULL, NULL,
                          "the name \"%s\" is taken by entry %zu", names[index], before);
            break;
        }
    }
}

/* Looks a name up in an array of structs whose member `name` lies at the start. Where the section
 * itself could not be read there is nothing to look up, and nothing new to report. */
static int find_entry(struct scene_reader *reader, const struct scene_path *path, const char *what,
                      const char *section, const json_t *given, const void *items, size_t item_size,
                      size_t count)
{
    const char **names = calloc(count + 1, sizeof *names);
    int found = -1;
    if (names == NULL) {
        reader->out_of_memory = true;
        return -1;
    }
    for (size_t index = 0; index < count; index++)
        memcpy(&names[index], (const char *)items + index * item_size, sizeof names[index]);
    if (count > 0 || !scene_issues_under(reader->issues, section))
        found = scene_name_find(reader, path, what, given, names, count);
    free(names);
    return found;
}

#define NAME_IS_FIRST(type) _Static_assert(offsetof(struct type, name) == 0, "name comes first")
NAME_IS_FIRST(talus_material);
NAME_IS_FIRST(talus_body);
NAME_IS_FIRST(talus_boundary);
NAME_IS_FIRST(talus_probe);

int scene_material_find(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given)
{
    const struct talus_scene *scene = reader->scene;
    return find_entry(reader, path, "material", "/materials", given, scene->materials,
                      sizeof *scene->materials, scene->material_count);
}

int scene_body_find(struct scene_reader *reader, const struct scene_path *path, const json_t *given)
{
    const struct talus_scene *scene = reader->scene;
    return find_entry(reader, path, "body", "/bodies", given, scene->bodies, sizeof *scene->bodies,
                      scene->body_count);
}

int scene_boundary_find(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given)
{
    const struct talus_scene *scene = reader->scene;
    return find_entry(reader, path, "boundary", "/boundaries", given, scene->boundaries,
                      sizeof *scene->boundaries, scene->boundary_count);
}

int scene_probe_find(struct scene_reader *reader, const struct scene_path *path,
                     const json_t *given)
{
    const struct talus_scene *scene = reader->scene;
    return find_entry(reader, path, "probe", "/probes", given, scene->probes, sizeof *scene->probes,
                      scene->probe_count);
}

json_t *scene_list_schema(const struct scene_field *table, size_t minimum)
{
    return json_pack("{s:s, s:I, s:i, s:o}", "type", "array", "minItems", (json_int_t)minimum,
                     "maxItems", (int)SCENE_ENTRY_MAX, "items", scene_fields_schema(table));
}
