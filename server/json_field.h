/* SPDX-License-Identifier: Apache-2.0 */
/* Tables of the members of JSON objects: one entry drives the reader of request bodies, the check
 * of query parameters and the schemas in the OpenAPI document. A table ends with an entry whose key
 * is NULL. */
#ifndef TALUS_JSON_FIELD_H
#define TALUS_JSON_FIELD_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

enum json_field_kind {
    FIELD_TEXT,    /* read into char *, a copy that the target owns */
    FIELD_NUMBER,  /* read into double */
    FIELD_INTEGER, /* read into int64_t */
    FIELD_BOOLEAN, /* read into bool */
    FIELD_OBJECT,  /* its own table `fields`; offsets count from the same target */
    FIELD_LIST,    /* an array of `item` */
    FIELD_MAP,     /* an object with any keys, whose values are `item`; read into char *, as JSON */
    FIELD_ANY,     /* anything; never read */
    FIELD_SAME,    /* what `item` is, under another key and at its place */
    FIELD_SCENE,   /* a scene, which a helper checks; never read */
};

#define FIELD_NOWHERE ((size_t)-1)

struct json_field {
    const char *key;
    enum json_field_kind kind;
    bool optional; /* may be missing */
    bool nullable;
    double minimum, maximum;  /* numbers; both 0: no bounds */
    bool above_minimum;       /* the bound itself is excluded */
    double preset;            /* numbers and booleans that are missing */
    size_t most;              /* texts: characters; lists and maps: entries; 0: any number */
    const char *const *words; /* texts: one of these, NULL-terminated; NULL: any */
    const char *key_pattern;  /* maps: of the keys, which `key_holds` decides */
    bool (*key_holds)(const char *key);
    const struct json_field *fields; /* objects */
    bool partial;                    /* objects: of these members any may be missing */
    bool patch;                      /* objects and maps: a merge patch, where null takes a member
                                        away; never read */
    const struct json_field *item;   /* lists and maps; its key is not used */
    const char *schema;              /* what it is called in the document, NULL: not by itself */
    size_t offset;                   /* in the target, or FIELD_NOWHERE */
    const char *meaning;
};

/* Reads an object by its table into `target` and adds every mistake to `errors`; `parent` is the
 * JSON Pointer of the object. What is missing gets its preset; texts stay as they are. */
void json_fields_read(const struct json_field *table, const json_t *object, const char *parent,
                      void *target, json_t *errors);
/* Adds a mistake, with the nearest name, for every key of an object that is not in a
 * NULL-terminated list; `parent` is the JSON Pointer of the object. */
void json_keys_check(const json_t *object, const char *parent, const char *const *known,
                     json_t *errors);

/* Whether a number has bounds. */
bool json_field_bounded(const struct json_field *field);
/* The field that a FIELD_SAME stands for; any other as it is. */
struct json_field json_field_resolve(const struct json_field *field);
/* JSON Schema of a value; what has a name of its own is put into `named` and referred to. New
 * reference; NULL or an incomplete one if memory is short. */
json_t *json_field_schema(const struct json_field *field, json_t *named);

#endif
