/* SPDX-License-Identifier: Apache-2.0 */
/* What all readers of parts of a scene share: where they are in the document, and how they report
 * what is wrong. Private to solver/scene. */
#ifndef TALUS_SCENE_READER_H
#define TALUS_SCENE_READER_H

#include "scene/scene_json.h"

#include <stdbool.h>

/* A place in the document, kept on the stack: key, or index where key is NULL. */
struct scene_path {
    const struct scene_path *parent; /* NULL: the root */
    const char *key;
    size_t index;
};

struct scene_reader {
    struct talus_scene *scene;     /* being filled */
    struct scene_issues *issues;   /* mistakes */
    struct scene_issues *warnings; /* what is accepted, with remarks */
    size_t axis_count;             /* 0: the dimension is not known */
    bool out_of_memory;
};

/* JSON Pointer of a place; cut off (never overflowing) if it does not fit. */
void scene_path_print(const struct scene_path *path, char pointer[256]);

/* Appends a mistake or a warning unless the list is full. `given` is borrowed (shown only if it is
 * small), `allowed` is taken over; both may be NULL. */
__attribute__((format(printf, 6, 7))) void scene_mistake(struct scene_reader *reader,
                                                         const struct scene_path *path,
                                                         const char *code, const json_t *given,
                                                         json_t *allowed, const char *format, ...);
__attribute__((format(printf, 4, 5))) void scene_warn(struct scene_reader *reader,
                                                      const struct scene_path *path,
                                                      const char *code, const char *format, ...);
/* A mistake of a place that is known by its pointer only. */
void scene_mistake_at(struct scene_reader *reader, const char *pointer, const char *code,
                      const char *detail);

/* Why a document could not be read: the file, or JSON. */
void scene_file_mistake(struct scene_reader *reader, const json_error_t *error);

/* Characters of UTF-8 text, as JSON Schema counts them. */
size_t scene_character_count(const char *text);
/* "object", "array", "string", "number", "boolean", "null" or "nothing" (NULL). */
const char *scene_type_word(const json_t *value);

/* The nearest of `words` (NULL-terminated) to a misspelt one, or NULL if none is near. */
const char *scene_suggest(const char *word, const char *const *words);

/* New array of strings; NULL without memory. */
json_t *scene_word_list(const char *const *words);

/* object[key] = value (taken over); notes missing memory. Does nothing where object is NULL. */
void scene_put(struct scene_reader *reader, json_t *object, const char *key, json_t *value);

/* strdup that notes missing memory. */
char *scene_copy_text(struct scene_reader *reader, const char *text);

#endif
