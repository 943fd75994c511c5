/* SPDX-License-Identifier: Apache-2.0 */
#include "advice_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void apply(json_t *scene, const struct advice_change *changes)
{
    for (size_t k = 0; k < ADVICE_CHANGE_MAX && changes[k].pointer != NULL; k++)
        fixture_change(scene, changes[k].pointer, changes[k].value);
}

json_t *advice_scene(enum fixture_base base, const struct advice_change *changes)
{
    json_t *scene = fixture_scene(base);
    apply(scene, changes);
    return scene;
}

static void check_form(const json_t *item)
{
    static const char *const texts[] = {"pointer", "code", "detail", "change", "saves"};
    const json_t *saving = json_object_get(item, "saving");
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++)
        assert_true(json_string_length(json_object_get(item, texts[k])) > 0);
    if (saving != NULL) {
        assert_int_equal(json_object_size(saving), 1);
        assert_true(json_number_value(json_object_iter_value(json_object_iter((json_t *)saving))) >
                    1.0);
    }
}

/* The item, if there is one; what it was drawn by goes to *effective. */
static json_t *look(json_t *scene, const char *pointer, const char *code, json_t **effective)
{
    struct fixture_result result;
    json_t *found = NULL, *item;
    size_t index;
    fixture_read(scene, &result);
    for (size_t k = 0; k < result.issues.count; k++)
        (void)fprintf(stderr, "%s: %s: %s\n", code, result.issues.items[k].pointer,
                      result.issues.items[k].detail);
    assert_int_equal(result.status, TALUS_OK);
    json_t *list = scene_advice(&result.scene);
    json_array_foreach(list, index, item)
    {
        check_form(item);
        if (strcmp(json_string_value(json_object_get(item, "code")), code) == 0 &&
            strcmp(json_string_value(json_object_get(item, "pointer")), pointer) == 0 &&
            found == NULL)
            found = json_incref(item);
    }
    *effective = json_deep_copy(result.effective);
    json_decref(list);
    json_decref(scene);
    fixture_result_release(&result);
    return found;
}

static void follow(const json_t *set, json_t *effective, const char *pointer, const char *code)
{
    const char *place;
    json_t *value, *after;
    json_object_foreach((json_t *)set, place, value)
    {
        char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
        assert_non_null(text);
        fixture_change(effective, place, text);
        free(text);
    }
    json_t *left = look(effective, pointer, code, &after);
    if (left != NULL)
        (void)fprintf(stderr, "%s is still advised once followed\n", code);
    assert_null(left);
    json_decref(after);
}

json_t *advice_item(json_t *scene, const char *pointer, const char *code)
{
    json_t *effective, *item = look(scene, pointer, code, &effective);
    if (item != NULL && json_object_get(item, "set") != NULL)
        follow(json_object_get(item, "set"), effective, pointer, code);
    else
        json_decref(effective);
    return item;
}

void advice_check(const struct advice_case *entry)
{
    json_t *scene = advice_scene(entry->base, entry->scene);
    json_t *twin = json_deep_copy(scene);
    apply(twin, entry->twin);
    json_t *item = advice_item(scene, entry->pointer, entry->code);
    json_t *other = advice_item(twin, entry->pointer, entry->code);
    if (item == NULL || other != NULL)
        (void)fprintf(stderr, "%s: %s\n", entry->code,
                      item == NULL ? "not advised" : "advised to the twin as well");
    assert_non_null(item);
    assert_null(other);
    json_decref(item);
}
