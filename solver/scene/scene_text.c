/* SPDX-License-Identifier: Apache-2.0 */
/* Small help with words and JSON values for the readers of a scene. */
#include "scene/scene_reader.h"

#include <stdlib.h>
#include <string.h>

size_t scene_character_count(const char *text)
{
    size_t count = 0;
    for (; *text != '\0'; text++)
        count += ((unsigned char)*text & 0xc0) != 0x80; /* the first byte of each in UTF-8 */
    return count;
}

const char *scene_type_word(const json_t *value)
{
    if (value == NULL)
        return "nothing";
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return "an array";
    case JSON_STRING:
        return "a string";
    case JSON_INTEGER:
    case JSON_REAL:
        return "a number";
    case JSON_TRUE:
    case JSON_FALSE:
        return "a boolean";
    default:
        return "null";
    }
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

enum { WORD_MAX = 40 };

/* Optimal string alignment distance: insertions, deletions, changes and swaps of neighbours. */
static size_t word_distance(const char *first, const char *second)
{
    size_t rows = strlen(first), columns = strlen(second);
    size_t distance[WORD_MAX + 1][WORD_MAX + 1];
    for (size_t i = 0; i <= rows; i++) {
        for (size_t j = 0; j <= columns; j++) {
            if (i == 0 || j == 0) {
                distance[i][j] = i + j;
                continue;
            }
            size_t change = first[i - 1] == second[j - 1] ? 0 : 1;
            size_t best = distance[i - 1][j - 1] + change;
            best = least(best, least(distance[i - 1][j], distance[i][j - 1]) + 1);
            if (i > 1 && j > 1 && first[i - 1] == second[j - 2] && first[i - 2] == second[j - 1])
                best = least(best, distance[i - 2][j - 2] + 1);
            distance[i][j] = best;
        }
    }
    return distance[rows][columns];
}

const char *scene_suggest(const char *word, const char *const *words)
{
    const char *nearest = NULL;
    size_t length = strlen(word), nearest_distance = length / 3 + 2;
    if (length > WORD_MAX)
        return NULL;
    for (; *words != NULL; words++) {
        if (strlen(*words) > WORD_MAX)
            continue;
        size_t distance = word_distance(word, *words);
        if (distance < nearest_distance && distance < strlen(*words)) {
            nearest_distance = distance;
            nearest = *words;
        }
    }
    return nearest;
}

json_t *scene_word_list(const char *const *words)
{
    json_t *list = json_array();
    for (; *words != NULL; words++) {
        if (json_array_append_new(list, json_string(*words)) != 0) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

void scene_put(struct scene_reader *reader, json_t *object, const char *key, json_t *value)
{
    if (object == NULL)
        json_decref(value);
    else if (value == NULL || json_object_set_new(object, key, value) != 0)
        reader->out_of_memory = true;
}

char *scene_copy_text(struct scene_reader *reader, const char *text)
{
    char *copy = strdup(text);
    if (copy == NULL)
        reader->out_of_memory = true;
    return copy;
}
