/* SPDX-License-Identifier: Apache-2.0 */
/* `set` of a design: which places of the scene take which parameters and expressions. Private to
 * study_*.c. */
#ifndef TALUS_STUDY_SET_H
#define TALUS_STUDY_SET_H

#include "study_reader.h"

/* Checks one value of a parameter: a number, a text or { "label", "value" }. */
bool study_value_check(struct study_reader *reader, const json_t *given, const char *pointer);
/* What a row shows of a checked value (the number, the text or the label), and what it puts into
 * the scene; borrowed. */
json_t *study_value_shown(const json_t *given);
json_t *study_value_set(const json_t *given);

struct study_set;

/* Checks the names of parameters, the keys of `parameters` (borrowed, at `pointer` in the request),
 * adds them to the plan and reads `set` of a design at `parent`. NULL with issues; the caller
 * destroys it. */
struct study_set *study_set_create(struct study_reader *reader, const json_t *design,
                                   const char *parent, const json_t *parameters,
                                   const char *pointer);
void study_set_destroy(struct study_set *set);
/* How many values a row has: its parameters and what it sets. */
size_t study_set_size(const struct study_set *set);

/* Adds the row that gives these checked values (one a name, in order, borrowed). An expression
 * without a finite value is an issue that names the row; each is told once. */
void study_set_row(struct study_set *set, struct study_reader *reader, json_t *const *given);

#endif
