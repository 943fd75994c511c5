/* SPDX-License-Identifier: Apache-2.0 */
/* A read expression: a program in postfix order. Private to expression*.c. */
#ifndef TALUS_EXPRESSION_PROGRAM_H
#define TALUS_EXPRESSION_PROGRAM_H

#include "expression.h"

enum operation {
    PUSH_NUMBER,
    PUSH_NAME,
    ADD,
    SUBTRACT,
    MULTIPLY,
    DIVIDE,
    POWER,
    NEGATE,
    MINIMUM,
    MAXIMUM,
    SQUARE_ROOT,
    EXPONENTIAL,
    LOGARITHM,
    SINE,
    COSINE,
    TANGENT,
};

struct instruction {
    enum operation operation;
    int name;        /* PUSH_NAME */
    double number;   /* PUSH_NUMBER */
    size_t position; /* in the text */
};

struct expression {
    size_t count; /* no more than bytes in the text: each instruction has a byte of its own */
    struct instruction program[EXPRESSION_LENGTH_MAX];
};

/* Writes a mistake down; false, for the caller to return. */
bool expression_refuse(struct expression_mistake *mistake, size_t position, const char *text);

#endif
