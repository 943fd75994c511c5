/* SPDX-License-Identifier: Apache-2.0 */
/* One mistake at a time: each is found, is the only one reported, and is reported at its key. */
#ifndef TALUS_MISTAKE_FIXTURE_H
#define TALUS_MISTAKE_FIXTURE_H

#include "scene_fixture.h"

struct mistake {
    enum fixture_base base;
    const char *change;  /* pointer */
    const char *value;   /* JSON; NULL: removed */
    const char *pointer; /* where it must be found; NULL: where it was made */
    const char *code;
};

/* Checks them all, and prints those that are not found so. */
void mistakes_check(const struct mistake *mistakes, size_t count);

#endif
