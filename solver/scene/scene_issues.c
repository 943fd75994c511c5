/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_json.h"

#include <stdlib.h>
#include <string.h>

void scene_issues_release(struct scene_issues *issues)
{
    for (size_t index = 0; index < issues->count; index++) {
        json_decref(issues->items[index].given);
        json_decref(issues->items[index].allowed);
    }
    free(issues->items);
    memset(issues, 0, sizeof *issues);
}
