/* SPDX-License-Identifier: Apache-2.0 */
#include "json_pointer.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { INDEX_DIGITS_MAX = 9 };

void json_pointer_join(char pointer[JSON_POINTER_SIZE], const char *parent, const char *key)
{
    size_t length = strlen(parent);
    if (length > JSON_POINTER_SIZE - 2)
        length = JSON_POINTER_SIZE - 2;
    memmove(pointer, parent, length);
    pointer[length++] = '/';
    for (; *key != '\0' && length + 3 < JSON_POINTER_SIZE; key++) {
        bool escaped = *key == '~' || *key == '/';
        if (escaped)
            pointer[length++] = '~';
        pointer[length++] = !escaped ? *key : *key == '~' ? '0' : '1';
    }
    pointer[length] = '\0';
}

void json_pointer_join_index(char pointer[JSON_POINTER_SIZE], const char *parent, size_t index)
{
    char key[24];
    (void)snprintf(key, sizeof key, "%zu", index);
    json_pointer_join(pointer, parent, key);
}

bool json_pointer_is_valid(const char *pointer)
{
    size_t depth = 0;
    if (pointer[0] != '/' || strlen(pointer) >= JSON_POINTER_SIZE)
        return false;
    for (const char *in = pointer; *in != '\0'; in++) {
        depth += *in == '/';
        if (*in == '~' && in[1] != '0' && in[1] != '1')
            return false;
    }
    return depth <= JSON_POINTER_DEPTH_MAX;
}

bool json_pointer_is_within(const char *pointer, const char *outer)
{
    size_t length = strlen(outer);
    return strncmp(pointer, outer, length) == 0 &&
           (pointer[length] == '\0' || pointer[length] == '/');
}

/* Takes the key behind the "/" that *rest points at, unescaped, and moves *rest behind it. */
static void key_take(const char **rest, char key[JSON_POINTER_SIZE])
{
    const char *in = *rest + 1;
    size_t length = 0;
    for (; *in != '\0' && *in != '/'; in++) {
        bool escaped = *in == '~';
        if (escaped)
            in++;
        key[length++] = !escaped ? *in : *in == '0' ? '~' : '/';
    }
    key[length] = '\0';
    *rest = in;
}

/* The index that a key names in an array of `count` members, `count` for "-"; SIZE_MAX if it is no
 * index (RFC 6901: digits, no leading zero). */
static size_t index_of(const char *key, size_t count)
{
    size_t length = strlen(key), index = 0;
    if (strcmp(key, "-") == 0)
        return count;
    if (length == 0 || length > INDEX_DIGITS_MAX || (key[0] == '0' && length > 1))
        return SIZE_MAX;
    for (; *key != '\0'; key++) {
        if (*key < '0' || *key > '9')
            return SIZE_MAX;
        index = 10 * index + (size_t)(*key - '0');
    }
    return index;
}

static json_t *member_of(const json_t *parent, const char *key)
{
    if (json_is_array(parent))
        return json_array_get(parent, index_of(key, json_array_size(parent)));
    return json_object_get(parent, key);
}

json_t *json_pointer_get(const json_t *document, const char *pointer)
{
    char key[JSON_POINTER_SIZE];
    json_t *value = NULL;
    while (*pointer != '\0') {
        key_take(&pointer, key);
        value = member_of(document, key);
        document = value;
    }
    return value;
}

enum json_pointer_fit json_pointer_check(const json_t *document, const char *pointer,
                                         size_t *length)
{
    char key[JSON_POINTER_SIZE];
    for (const char *rest = pointer; document != NULL;) {
        const char *before = rest;
        key_take(&rest, key);
        if (length != NULL)
            *length = (size_t)(rest - pointer);
        if (!json_is_array(document) && !json_is_object(document)) {
            if (length != NULL && before > pointer)
                *length = (size_t)(before - pointer);
            return JSON_POINTER_NOWHERE;
        }
        if (json_is_array(document) &&
            index_of(key, json_array_size(document)) > json_array_size(document))
            return JSON_POINTER_INDEX;
        if (*rest == '\0')
            return JSON_POINTER_FITS;
        document = member_of(document, key);
    }
    return JSON_POINTER_NOWHERE;
}

/* Replaces, adds or appends a member; takes the reference. 0 when it is done. */
static int member_put(json_t *parent, const char *key, json_t *value)
{
    if (json_is_object(parent))
        return json_object_set_new_nocheck(parent, key, value);
    size_t count = json_array_size(parent), index = index_of(key, count);
    return index < count ? json_array_set_new(parent, index, value)
                         : json_array_append_new(parent, value);
}

json_t *json_pointer_put(const json_t *document, const char *pointer, json_t *value)
{
    char key[JSON_POINTER_SIZE];
    if (json_pointer_check(document, pointer, NULL) != JSON_POINTER_FITS)
        return NULL;
    json_t *copy = json_copy((json_t *)(uintptr_t)document), *parent = copy;
    for (const char *rest = pointer; parent != NULL && *rest != '\0';) {
        key_take(&rest, key);
        json_t *member = *rest == '\0' ? json_incref(value) : json_copy(member_of(parent, key));
        if (member == NULL || member_put(parent, key, member) != 0) {
            json_decref(copy);
            return NULL;
        }
        parent = member;
    }
    if (parent == NULL)
        json_decref(copy);
    return parent == NULL ? NULL : copy;
}
