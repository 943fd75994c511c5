/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_MATERIAL_ISSUE_H
#define TALUS_MATERIAL_ISSUE_H

#include "materials/material.h"

struct material_issues { /* a caller's array being filled by `check` */
    struct material_issue *items;
    size_t count, capacity;
};

/* Appends an issue while there is room. */
__attribute__((format(printf, 4, 5))) void material_issue_add(struct material_issues *issues,
                                                              const char *key, const char *code,
                                                              const char *format, ...);

#endif
