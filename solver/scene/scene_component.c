/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_component.h"

#include "scene/scene_field.h"

#include <string.h>

const char *const scene_field_words[] = {
#define TALUS_FIELD(ENUM, name, components, unit, text) #name,
#include "talus/fields.def"
#undef TALUS_FIELD
    NULL,
};

const char *const scene_component_names[] = {"x",  "y",  "z",  "xx", "xy", "xz", "yx",
                                             "yy", "yz", "zx", "zy", "zz", NULL};

size_t scene_field_components(size_t field)
{
    static const size_t counts[] = {
#define TALUS_FIELD(ENUM, name, components, unit, text) components,
#include "talus/fields.def"
#undef TALUS_FIELD
    };
    return counts[field];
}

void scene_component_words(size_t count, size_t axis_count, const char *words[10])
{
    static const char *const vector[] = {"x", "y", "z"};
    static const char *const tensor[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
    static const char *const matrix[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
    const char *const *all = count == 9 ? matrix : (count == 6 ? tensor : vector);
    memset(words, 0, 10 * sizeof *words);
    if (count != 3 && count != 6 && count != 9)
        return; /* a single number has no components */
    for (size_t index = 0; index < count; index++) {
        /* Out of plane only the normal components of tensors exist. */
        const char *word = all[index];
        bool diagonal = count > 3 && word[0] == word[1];
        bool exists = diagonal;
        if (!diagonal) {
            exists = (size_t)(word[0] - 'x') < axis_count;
            if (word[1] != '\0')
                exists = exists && (size_t)(word[1] - 'x') < axis_count;
        }
        words[index] = exists || axis_count == 0 ? word : "";
    }
}

int scene_component_read(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, const char *const words[10])
{
    const char *shown[10] = {NULL};
    size_t shown_count = 0;
    if (given == NULL)
        return -1;
    for (size_t index = 0; words[index] != NULL; index++) {
        const char *word = json_string_value(given);
        if (word != NULL && word[0] != '\0' && strcmp(words[index], word) == 0)
            return (int)index;
        if (words[index][0] != '\0')
            shown[shown_count++] = words[index];
    }
    if (shown_count > 0 && scene_choice_read(reader, path, given, scene_component_names, NULL) >= 0)
        scene_mistake(reader, path, "dimension", given, scene_word_list(shown),
                      "there is no such component here");
    else if (shown_count == 0)
        scene_mistake(reader, path, "contradiction", given, NULL,
                      "this quantity has no components");
    return -1;
}
