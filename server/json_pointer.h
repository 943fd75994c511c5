/* SPDX-License-Identifier: Apache-2.0 */
/* JSON Pointers (RFC 6901). */
#ifndef TALUS_JSON_POINTER_H
#define TALUS_JSON_POINTER_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

enum {
    JSON_POINTER_SIZE = 1024,    /* of a pointer as text, with its NUL */
    JSON_POINTER_DEPTH_MAX = 32, /* keys of a pointer */
};

/* Writes parent + "/" + key with ~ and / escaped; what does not fit is cut. `parent` may be the
 * text itself. */
void json_pointer_join(char pointer[JSON_POINTER_SIZE], const char *parent, const char *key);
/* The same with an index of an array. */
void json_pointer_join_index(char pointer[JSON_POINTER_SIZE], const char *parent, size_t index);

/* Whether a text is a pointer to something inside of a document: "/" before each key, ~ followed by
 * 0 or 1 only, not too long, not too deep. */
bool json_pointer_is_valid(const char *pointer);
/* Whether `pointer` points into what `outer` points at, or at the same. */
bool json_pointer_is_within(const char *pointer, const char *outer);

enum json_pointer_fit {
    JSON_POINTER_FITS,    /* a value can be put there */
    JSON_POINTER_NOWHERE, /* something before the last key is missing or is no object or array */
    JSON_POINTER_INDEX,   /* not an index of the array, nor the next one, nor "-" */
};

/* Whether a value can be put at a valid pointer. What fails is the key that ends at *length (or
 * NULL) bytes of the pointer. The last key of an object may be new; at an array the index behind
 * the last, or "-", appends. */
enum json_pointer_fit json_pointer_check(const json_t *document, const char *pointer,
                                         size_t *length);

/* The value at a valid pointer (borrowed), NULL if there is none. */
json_t *json_pointer_get(const json_t *document, const char *pointer);

/* A document (new reference) with the value, borrowed, put at a valid pointer. Only what lies on
 * the way is copied, the rest is shared with `document`. NULL if it does not fit or without memory.
 */
json_t *json_pointer_put(const json_t *document, const char *pointer, json_t *value);

#endif
