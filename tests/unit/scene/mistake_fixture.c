/* SPDX-License-Identifier: Apache-2.0 */
#include "mistake_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static void print_result(const struct mistake *mistake, const struct scene_issues *issues)
{
    (void)fprintf(stderr, "%s = %s: expected %s at %s, got %zu:\n", mistake->change,
                  mistake->value != NULL ? mistake->value : "(removed)", mistake->code,
                  mistake->pointer != NULL ? mistake->pointer : mistake->change, issues->count);
    for (size_t index = 0; index < issues->count; index++)
        (void)fprintf(stderr, "    %s %s: %s\n", issues->items[index].pointer,
                      issues->items[index].code, issues->items[index].detail);
}

static bool is_found(const struct mistake *mistake)
{
    struct fixture_result result;
    json_t *scene = fixture_scene(mistake->base);
    fixture_change(scene, mistake->change, mistake->value);
    fixture_read(scene, &result);
    const char *pointer = mistake->pointer != NULL ? mistake->pointer : mistake->change;
    bool found = result.status == TALUS_INVALID && result.effective == NULL &&
                 fixture_find(&result.issues, pointer, mistake->code) != NULL &&
                 result.issues.count == 1 && result.issues.items[0].detail[0] != '\0';
    if (!found)
        print_result(mistake, &result.issues);
    fixture_result_release(&result);
    json_decref(scene);
    return found;
}

void mistakes_check(const struct mistake *mistakes, size_t count)
{
    size_t failures = 0;
    for (size_t index = 0; index < count; index++)
        failures += !is_found(&mistakes[index]);
    assert_int_equal(failures, 0);
}
