/* SPDX-License-Identifier: Apache-2.0 */
/* JSON as text with the shortest numbers: the JSON library writes 0.1 with 17 digits, which is
 * right for machines and unreadable for people. */
#ifndef TALUS_JSON_TEXT_H
#define TALUS_JSON_TEXT_H

#include "text.h"

#include <jansson.h>

/* Appends a value. `indent` is the number of blanks a level, 0: all in one line. */
void json_text_add(struct text *text, const json_t *value, unsigned int indent);
/* Appends a string, quoted. */
void json_text_add_string(struct text *text, const char *string);
/* A value as a new string (free it), NULL without memory. */
char *json_text(const json_t *value, unsigned int indent);

/* A new number; whole ones are integers, as a person would write them. NULL if it is not finite. */
json_t *json_number_make(double value);

#endif
