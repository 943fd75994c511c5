/* SPDX-License-Identifier: Apache-2.0 */
/* The command line of a sub-command: long options from a table, and operands. */
#ifndef TALUS_ARGUMENTS_H
#define TALUS_ARGUMENTS_H

#include <stdbool.h>
#include <stddef.h>

struct option_spec {
    const char *name;     /* without dashes */
    const char *argument; /* what it is called in the help; NULL: a switch */
    const char *meaning;
};

enum { ARGUMENTS_GIVEN_MAX = 64, ARGUMENTS_OPTION_MAX = 24 };

struct arguments {
    struct {
        const char *name, *value; /* value "" for a switch */
    } given[ARGUMENTS_GIVEN_MAX]; /* in the order of the command line */
    size_t given_count;
    char **operands; /* [operand_count] */
    int operand_count;
};

/* Options that every sub-command has: --json, --server, --token-file, --help. */
extern const struct option_spec arguments_common[];

/* Reads arguments[1...]; strings are borrowed. False, with a message on stderr, for an option that
 * is in neither table. */
bool arguments_read(struct arguments *out, const struct option_spec *options, int argument_count,
                    char **arguments);

/* The last value of an option; NULL if it was not given. */
const char *arguments_value(const struct arguments *arguments, const char *name);
bool arguments_has(const struct arguments *arguments, const char *name);

/* A whole number within bounds; `otherwise` if the option was not given. False, with a message on
 * stderr, if it is something else. */
bool arguments_integer(const struct arguments *arguments, const char *name, long low, long high,
                       long otherwise, long *number);

#endif
