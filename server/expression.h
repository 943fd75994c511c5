/* SPDX-License-Identifier: Apache-2.0 */
/* Arithmetic of a study: numbers, names, + - * / ^, parentheses, unary minus, min, max, sqrt, exp,
 * log (natural), sin, cos, tan (of degrees) and pi. ^ binds tighter than a minus before it and to
 * the right: -2^2 is -4, 2^3^2 is 512; * and / need to be written. */
#ifndef TALUS_EXPRESSION_H
#define TALUS_EXPRESSION_H

#include <stdbool.h>
#include <stddef.h>

enum { EXPRESSION_LENGTH_MAX = 1000 };

/* Where and why an expression was refused. */
struct expression_mistake {
    size_t position; /* of the byte, from 0 */
    char name[64];   /* the unknown name, cut; empty for other mistakes */
    char text[160];  /* for people, without the position */
};

struct expression;

/* The index of a name among the values, or -1 if there is no such name. */
typedef int expression_find(void *context, const char *name, size_t length);

/* Reads an expression; NULL with the mistake. The caller destroys it. */
struct expression *expression_create(const char *text, expression_find *find, void *context,
                                     struct expression_mistake *mistake);
void expression_destroy(struct expression *expression);

/* Calls `visit` for the index of each name that the expression uses, once per use. */
void expression_visit(const struct expression *expression, void (*visit)(void *context, int index),
                      void *context);

/* The value, `values` being indexed as `find` said. False with the mistake if some operation has no
 * finite result (a division by zero, the root of a negative number, an overflow). */
bool expression_evaluate(const struct expression *expression, const double *values, double *result,
                         struct expression_mistake *mistake);

/* Letters, digits and _, not beginning with a digit, and not a function or pi. */
bool expression_name_is_valid(const char *name);

#endif
