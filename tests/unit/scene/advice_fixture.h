/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes, as changes to those of the fixture, and the advice that they draw. */
#ifndef TALUS_ADVICE_FIXTURE_H
#define TALUS_ADVICE_FIXTURE_H

#include "scene_fixture.h"

#include <stdbool.h>

enum { ADVICE_CHANGE_MAX = 6 };

struct advice_change { /* value NULL: removed; pointer NULL: no more */
    const char *pointer, *value;
};

/* A scene that draws an item, and what makes a near twin out of it that does not. */
struct advice_case {
    const char *pointer, *code;
    enum fixture_base base;
    struct advice_change scene[ADVICE_CHANGE_MAX];
    struct advice_change twin[ADVICE_CHANGE_MAX];
};

json_t *advice_scene(enum fixture_base base, const struct advice_change *changes);

/* A new reference to the item of that code, or NULL. The scene is stolen and must be valid, and all
 * of its items well formed; where the item says how it can be followed (`set`), following it must
 * give a valid scene that does not draw it any more. */
json_t *advice_item(json_t *scene, const char *pointer, const char *code);

/* Checks that the scene draws the item and that the twin does not. */
void advice_check(const struct advice_case *entry);

#endif
