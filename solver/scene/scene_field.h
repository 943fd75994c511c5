/* SPDX-License-Identifier: Apache-2.0 */
/* Tables of fields: one entry drives the reader, the JSON Schema and `describe`. A table describes
 * one JSON object and ends with an entry whose key is NULL. Private to solver/scene. */
#ifndef TALUS_SCENE_FIELD_H
#define TALUS_SCENE_FIELD_H

#include "scene/scene_reader.h"

#include <math.h>

enum scene_field_kind {
    SCENE_NUMBER,  /* double */
    SCENE_BOOLEAN, /* bool */
    SCENE_CHOICE,  /* a word out of `choices`; int (an enum): its index */
    SCENE_TEXT,    /* const char *, borrowed from the document */
    SCENE_NAME,    /* the same, restricted to letters, digits, '_' and '-' */
    SCENE_VECTOR,  /* double[3]: one number per axis */
    SCENE_OBJECT,  /* its own table `fields`; offsets count from the same target */
    SCENE_CUSTOM,  /* `read` and `schema` do everything */
};

/* How a number or choice is stored if not as its kind says. */
enum scene_field_storage {
    SCENE_STORE_NATURAL,
    SCENE_STORE_SIZE,
    SCENE_STORE_DOUBLE,
    SCENE_STORE_BOOLEAN
};

#define SCENE_NOWHERE ((size_t)-1)

struct scene_field {
    const char *key;
    enum scene_field_kind kind;
    const char *unit;
    double minimum, maximum;
    bool above_minimum, below_maximum; /* the bound itself is excluded */
    bool required;
    double default_value;    /* NAN: none; choices: index; booleans: 0 or 1; vectors: each part */
    const char *alternative; /* of the fields with the same word exactly one (required) or at most
                                one may be given */
    const char *also;        /* a second group of alternatives that it belongs to */
    const char *needs;       /* the key without which this one has no meaning */
    const char *const *choices; /* NULL-terminated */
    const char *const *lacking; /* words that are promised and not in this build, or NULL */
    const char *word;           /* number: a word that may stand for `word_value` */
    double word_value;
    bool whole;               /* numbers and vectors: whole numbers */
    bool open;                /* vectors: null stands for the default (an open side) */
    bool scalar;              /* vectors: one number stands for all axes */
    bool unsupported;         /* promised, not in this build: refused, and not in the schema */
    double lacking_bounds[2]; /* numbers outside of minimum..maximum but inside these are
                                 `unsupported` instead of wrong; both 0: none */
    const struct scene_field *fields; /* SCENE_OBJECT */
    enum scene_field_storage storage;
    size_t offset; /* in the target, or SCENE_NOWHERE */
    /* SCENE_CUSTOM: reads `given` (NULL: missing) into the target, fills in defaults, reports. */
    void (*read)(struct scene_reader *reader, const struct scene_path *path, const json_t *given,
                 void *target, json_t *effective);
    json_t *(*schema)(void);
    const char *meaning;
};

/* Reads an object (NULL: all defaults) by its table into `target`; what is effective goes to
 * `effective`. */
void scene_fields_read(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *table, const json_t *object, void *target,
                       json_t *effective);

/* The entry of that key, or NULL. */
const struct scene_field *scene_field_find(const struct scene_field *table, const char *key);
/* True if the target holds the default of a number, a word, or an object of these (stored as their
 * kind says). */
bool scene_field_is_default(const struct scene_field *field, const void *target);

/* The bounds of a number, which are never further than 1e30 from zero. */
void scene_bounds_read(const struct scene_field *field, double *minimum, double *maximum);
/* Reads one number; false (and a mistake) if it is not one or out of bounds. */
bool scene_number_read(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *field, const json_t *given, double *value);
/* Reads a vector; its effective form goes to *effective (new reference) on success. */
bool scene_vector_read(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *field, const json_t *given, double value[3],
                       json_t **effective);
/* True if it is an array with as many entries as the scene has axes; a mistake otherwise. */
bool scene_vector_length_check(struct scene_reader *reader, const struct scene_path *path,
                               const struct scene_field *field, const json_t *given);
/* A vector of zeros with one number per axis, as an effective value. */
json_t *scene_zero_vector(struct scene_reader *reader);
/* Index of a word, with mistakes for words that are unknown or lacking; -1 then. */
int scene_choice_read(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, const char *const *choices, const char *const *lacking);
/* Index of the entry with that name, or -1 with a mistake. A list of `count` names. */
int scene_name_find(struct scene_reader *reader, const struct scene_path *path, const char *what,
                    const json_t *given, const char *const *names, size_t count);

/* True if the field belongs to that group of alternatives. */
bool scene_field_in_group(const struct scene_field *field, const char *group);
/* Calls `visit` once for every group of alternatives of a table: `required`: one must be given. */
void scene_groups_visit(const struct scene_field *table,
                        void (*visit)(const struct scene_field *table, const char *group,
                                      bool required, void *context),
                        void *context);

/* JSON Schema of an object with this table; new reference. */
json_t *scene_fields_schema(const struct scene_field *table);
json_t *scene_field_schema(const struct scene_field *field);
/* Of one number: its type and bounds, without a word. */
json_t *scene_number_schema(const struct scene_field *field);
/* Of an array with as many entries as the scene has axes, plus `more`; takes the reference. */
json_t *scene_axes_schema(json_t *items, int more);
/* Marks a schema of a number or a vector: a number in a plane, a vector in space. */
json_t *scene_turn_schema(json_t *schema);
/* Puts a rule for objects in which `key` is `word`: keys that they must not have and keys that they
 * must have (NULL-terminated). */
void scene_rule_add(json_t *schema, const char *key, const char *word, const char *const *without,
                    const char *const *with);
/* [{"key","type","unit","minimum",...,"meaning"}] of a table, nested ones included. */
json_t *scene_fields_describe(const struct scene_field *table);

#endif
