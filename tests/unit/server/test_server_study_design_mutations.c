/* SPDX-License-Identifier: Apache-2.0 */
/* Whatever stands in a design, reading it ends in a plan or in mistakes. */
#include "study_design_fixture.h"

static const char *const designs[] = {
    GRID("{\"a\":[1,2],\"/duration\":[1,{\"label\":\"x\",\"value\":[1]}]}",
         "{\"/grid/cell\":\"a*2\",\"/solver/x\":\"a\"}"),
    "{\"list\":{\"rows\":[{\"a\":1},{\"a\":2}],\"set\":{\"/grid/cell\":\"a\"}}}",
    SAMPLE(SOBOL ",\"seed\":3", "\"min\":1,\"max\":2,\"scale\":\"log\""),
    COMPARE(ONE, OTHER, TIP ",\"cost\":\"wall_seconds\""),
    BISECT("\"/duration\"", "0", "1", "0.1", "\"n<1\""),
};
/* What could stand in a place; NULL: nothing. */
static const char *const replacements[] = {"null",
                                           "true",
                                           "0",
                                           "-1",
                                           "1e308",
                                           "0.5",
                                           "\"\"",
                                           "\"a\"",
                                           "\"/\"",
                                           "\"/grid/cell\"",
                                           "\"1/0\"",
                                           "[]",
                                           "{}",
                                           "[[]]",
                                           "[{}]",
                                           "{\"a\":{}}",
                                           "{\"\":\"\"}",
                                           "{\"/x/y\":\"a\"}",
                                           "[1,1]",
                                           "{\"label\":\"l\",\"value\":null}",
                                           "\"((((\"",
                                           "\"a\\u00e9\"",
                                           "12345678901234567",
                                           NULL};

/* A member of a document. */
struct place {
    json_t *parent;
    const char *key; /* NULL: of an array, at `index` */
    size_t index;
};

/* Finds the member with a number, in depth-first order; false if there are fewer, and then *number
 * is less by so many. */
static bool place_find(json_t *value, size_t *number, struct place *place)
{
    const char *key;
    json_t *member;
    size_t index;
    json_object_foreach(value, key, member)
    {
        *place = (struct place){.parent = value, .key = key};
        if ((*number)-- == 0 || place_find(member, number, place))
            return true;
    }
    json_array_foreach(value, index, member)
    {
        *place = (struct place){.parent = value, .index = index};
        if ((*number)-- == 0 || place_find(member, number, place))
            return true;
    }
    return false;
}

static void place_change(const struct place *place, const char *text)
{
    if (text == NULL && place->key != NULL)
        (void)json_object_del(place->parent, place->key);
    else if (text == NULL)
        (void)json_array_remove(place->parent, place->index);
    else if (place->key != NULL)
        (void)json_object_set_new(place->parent, place->key, design_parse(text));
    else
        (void)json_array_set_new(place->parent, place->index, design_parse(text));
}

/* Whether a design is a plan, whose rows all fit then; if not, there is a mistake under /design. */
static bool is_plan(const json_t *scene, const json_t *design)
{
    struct study_plan plan;
    json_t *errors = json_array(), *row;
    const bool good = study_plan_read(scene, design, 100, &plan, errors);
    if (good) {
        size_t index;
        json_array_foreach(plan.rows, index, row)
        {
            json_t *changed = study_scene(scene, json_object_get(row, "set"));
            assert_non_null(changed);
            json_decref(changed);
        }
        study_plan_release(&plan);
    } else {
        const json_t *first = json_array_get(errors, 0);
        assert_true(json_array_size(errors) > 0);
        assert_memory_equal(json_string_value(json_object_get(first, "pointer")), "/design", 7);
    }
    json_decref(errors);
    return good;
}

/* Each member of good designs is replaced by everything that could stand there, and removed. */
static void test_mutations(void **state)
{
    const size_t choice_count = sizeof replacements / sizeof replacements[0];
    size_t good = 0, bad = 0;
    json_t *scene = design_parse(design_scene);
    (void)state;
    for (size_t seed = 0; seed < sizeof designs / sizeof designs[0]; seed++) {
        bool there = true;
        for (size_t number = 0; there; number++) {
            for (size_t choice = 0; choice < choice_count && there; choice++) {
                struct place place;
                size_t left = number;
                json_t *design = design_parse(designs[seed]);
                there = place_find(design, &left, &place);
                if (there) {
                    place_change(&place, replacements[choice]);
                    if (is_plan(scene, design))
                        good++;
                    else
                        bad++;
                }
                json_decref(design);
            }
        }
    }
    json_decref(scene);
    assert_true(good > 50 && bad > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mutations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
