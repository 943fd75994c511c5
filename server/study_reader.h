/* SPDX-License-Identifier: Apache-2.0 */
/* What the readers of the kinds of designs share. Private to study_*.c. */
#ifndef TALUS_STUDY_READER_H
#define TALUS_STUDY_READER_H

#include "json_pointer.h"
#include "study_design.h"

enum {
    STUDY_NAME_MAX = 64,     /* parameters of a study */
    STUDY_SET_MAX = 256,     /* pointers that a `set` has */
    STUDY_TEXT_MAX = 256,    /* bytes of a name or label */
    STUDY_CELL_MAX = 2000000 /* values in all rows together */
};

struct study_reader {
    const json_t *scene;
    size_t rows_max;
    struct study_plan *plan;
    json_t *errors;
};

/* Whether no mistake was added since there were `before`. */
bool study_good(const struct study_reader *reader, size_t before);
/* Whether there are so many mistakes that no more are of use. */
bool study_full(const struct study_reader *reader);

/* The readers of the kinds: `pointer` is the one of `design`, the value of the kind's key. */
void study_read_grid(struct study_reader *reader, const json_t *design, const char *pointer);
void study_read_list(struct study_reader *reader, const json_t *design, const char *pointer);
void study_read_sample(struct study_reader *reader, const json_t *design, const char *pointer);
void study_read_work_precision(struct study_reader *reader, const json_t *design,
                               const char *pointer);
void study_read_bisect(struct study_reader *reader, const json_t *design, const char *pointer);

/* A member that must be there and be an object (array): an issue and NULL if it is not. */
json_t *study_object(struct study_reader *reader, const json_t *parent, const char *key,
                     const char *pointer);
json_t *study_array(struct study_reader *reader, const json_t *parent, const char *key,
                    const char *pointer);
/* The same for a finite number, a whole one from low to high, and a text of 1 to STUDY_TEXT_MAX
 * bytes. */
bool study_number(struct study_reader *reader, const json_t *parent, const char *key,
                  const char *pointer, double *value);
const char *study_text(struct study_reader *reader, const json_t *parent, const char *key,
                       const char *pointer);
/* An issue if more rows than allowed, or too many values in them, were asked for. `rows` is a
 * double because it may be beyond all integers. */
bool study_rows_fit(struct study_reader *reader, double rows, size_t values, const char *pointer);

/* Checks a pointer of a `set` that stands at `place` in the request: that it is one, and that a
 * value can be put there. */
bool study_place_check(struct study_reader *reader, const char *pointer, const char *place);

/* A place of the scene and what a row puts there; all borrowed. */
struct study_item {
    const char *pointer;
    json_t *value;
    const char *place; /* of the object in the request that has `pointer` as a key */
    size_t order;      /* of the caller */
};

/* Sorts items so that what holds others comes first. */
void study_items_sort(struct study_item *items, size_t count);
/* The first of two neighbours in sorted items that are at the same place, or NULL. */
const struct study_item *study_items_repeated(const struct study_item *items, size_t count);
/* Whether some place is within another. */
bool study_items_nest(const struct study_item *items, size_t count);

/* Adds a row to the plan: `parameters` (the reference is taken) and sorted items. With `check` the
 * items are tried on the scene, and a pointer that leads nowhere is an issue. */
void study_row_add(struct study_reader *reader, json_t *parameters, const struct study_item *items,
                   size_t count, bool check);

#endif
