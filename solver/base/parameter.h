/* SPDX-License-Identifier: Apache-2.0 */
/* A parameter of a material, boundary condition or shape: one table entry drives validation, JSON
 * Schema, `describe` and documentation. Tables end with an entry whose key is NULL. */
#ifndef TALUS_PARAMETER_H
#define TALUS_PARAMETER_H

#include <math.h>
#include <stdbool.h>

enum parameter_kind { PARAMETER_NUMBER, PARAMETER_BOOLEAN, PARAMETER_CHOICE };

struct parameter {
    const char *key;    /* JSON key; a dot for a key of a nested object: "friction.a0" */
    const char *symbol; /* as in the equations */
    const char *unit;   /* "Pa", "deg", "1", ... */
    enum parameter_kind kind;
    double minimum, maximum;           /* -INFINITY / INFINITY: open */
    bool above_minimum, below_maximum; /* the bound itself is excluded */
    bool required;                     /* with `alternative`: one of the group is required */
    double default_value;              /* NAN: none; choices: index; booleans: 0 or 1 */
    /* Name of a group of alternatives, or NULL: exactly one (required) or at most one of its
     * top-level keys may be given; the keys of one nested object stand or fall together. `required`
     * and the default of a key hold only if its alternative is the chosen one; if none is given,
     * the alternative with a default is chosen. */
    const char *alternative;
    const char *const *choices; /* PARAMETER_CHOICE: NULL-terminated */
    const char *const
        *reserved_choices; /* names refused as `unsupported`; NULL-terminated or NULL */
    const char *meaning;   /* for people */
};

#endif
