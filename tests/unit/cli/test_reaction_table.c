/* SPDX-License-Identifier: Apache-2.0 */
#include "reaction_table.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void add(struct reaction_table *table, const char *text)
{
    json_t *data = json_loads(text, 0, NULL);
    assert_non_null(data);
    assert_true(reaction_table_add(table, data));
    json_decref(data);
}

static void test_peak_is_of_the_vector(void **state)
{
    (void)state;
    struct reaction_table table = {0};
    add(&table, "{\"name\":\"reaction.wall.force.x\",\"time\":[0.1,0.2],\"value\":[3e3,-6e3]}");
    add(&table, "{\"name\":\"reaction.wall.force.y\",\"time\":[0.1,0.2],\"value\":[4e3,8e3]}");
    add(&table, "{\"name\":\"reaction.wall.contact_area\",\"time\":[0.1],\"value\":[1e9]}");
    add(&table, "{\"name\":\"reaction.wall.instant.x\",\"time\":[0.1],\"value\":[1e9]}");
    assert_int_equal(table.count, 1);
    assert_true(fabs(table.items[0].peak - 10e3) < 1e-9 && table.items[0].peak_time == 0.2);
    /* Later rows are not added to the earlier ones. */
    add(&table, "{\"name\":\"reaction.wall.force.x\",\"time\":[0.3,0.4],\"value\":[6e3,1e3]}");
    add(&table, "{\"name\":\"reaction.wall.force.y\",\"time\":[0.3,0.4],\"value\":[6e3,2e3]}");
    assert_true(fabs(table.items[0].peak - 10e3) < 1e-9);
    char text[128];
    reaction_format(&table.items[0], "N/m", text, sizeof text);
    assert_string_equal(text, "wall: (1.0, 2.0) kN/m, peak 10 kN/m at 0.200 s");
    reaction_table_rewind(&table, 0.15);
    assert_true(table.items[0].peak == 0.0);
    reaction_table_release(&table);
}

static void test_series_names(void **state)
{
    (void)state;
    char name[32];
    int component;
    assert_true(reaction_series_parse("reaction.a.x_min.force.z", name, sizeof name, &component));
    assert_string_equal(name, "a.x_min");
    assert_int_equal(component, 2);
    const char *const others[] = {"reaction.force.x",
                                  "reaction..force.x",
                                  "reaction.a.force.w",
                                  "reaction.a.force.xx",
                                  "reaction.a.instant.x",
                                  "probe.a.force.x",
                                  "energy.kinetic",
                                  "",
                                  "reaction.a_name_that_is_far_too_long_for_the_room.force.x"};
    for (size_t index = 0; index < sizeof others / sizeof others[0]; index++)
        assert_false(reaction_series_parse(others[index], name, sizeof name, &component));
}

static void test_force_format(void **state)
{
    (void)state;
    char text[48];
    force_format(-75300.0, "N", text, sizeof text);
    assert_string_equal(text, "-75.3 kN");
    force_format(0.0, NULL, text, sizeof text);
    assert_string_equal(text, "0 N");
    force_format(2.5e6, "N/m", text, sizeof text);
    assert_string_equal(text, "2.5 MN/m");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_peak_is_of_the_vector),
        cmocka_unit_test(test_series_names),
        cmocka_unit_test(test_force_format),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
