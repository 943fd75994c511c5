/* SPDX-License-Identifier: Apache-2.0 */
/* Advice on dimensions and halves that a scene can do without. */
#include "advice_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define SIDE(place, normal, condition)                                                             \
    "{\"plane\": {\"point\": [0, 0, " #place "], \"normal\": [0, 0, " #normal "]},"                \
    " \"condition\": \"" condition "\"}"
#define FLOOR "{\"plane\": {\"point\": [0, 0, 0], \"normal\": [0, 1, 0]}, \"condition\": \"stick\"}"
#define BETWEEN_WALLS "[" FLOOR ", " SIDE(0, 1, "slip") ", " SIDE(10, -1, "slip") "]"
#define CHANNEL                                                                                    \
    {"/bodies/0/sphere", NULL}, {"/bodies/0/box", "{\"min\": [1, 0, 0], \"max\": [3, 2, 10]}"},    \
        {"/gravity", "[0, -10, 0]"},                                                               \
    {                                                                                              \
        "/boundaries", BETWEEN_WALLS                                                               \
    }

/* Not the same all along z, or free to move along it. */
static const struct advice_change spoiled[] = {
    {"/boundaries/2/condition", "\"stick\""},
    {"/boundaries/2/plane/point", "[0, 0, 9]"}, /* not where the body ends */
    {"/boundaries/2/tension_release", "true"},
    {"/boundaries/2/until", "0.5"},
    {"/boundaries/-", "{\"box\": {\"min\": [5, 0, 4], \"max\": [6, 5, 6.5]},"
                      " \"condition\": \"slip\"}"},
    {"/boundaries/-", "{\"face\": {\"min\": [5, 0, 0], \"max\": [5, 3, 4], \"normal\": [1, 0, 0]},"
                      " \"condition\": \"slip\"}"},
    {"/bodies/0/velocity", "[0, 0, 1]"},
    {"/bodies/0/velocity", "{\"rotation\": {\"about\": [5, 0, 5], \"rate\": [0, 1, 0]}}"},
    {"/bodies/0/traction", "[{\"face\": \"z_max\", \"pressure\": 1}]"},
    {"/bodies/0/traction", "[{\"face\": \"x_max\", \"value\": [0, 0, 1]}]"},
    {"/bodies/0/rotate", "{\"angle\": 180, \"about\": [5, 2, 5], \"axis\": [0, 1, 0]}"},
    {"/bodies/0/initial_stress", "[0, 0, 0, 0, 0, 5]"},
    {"/gravity", "[0, -10, [[0, 0], [1, 2]]]"},
    {"/gravity", "{\"magnitude\": 10, \"up\": [0, 1, 0], \"slopes\": ["
                 "{\"along\": [0, 0, 1], \"below\": 3, \"angle\": 10}]}"},
};

/* What leaves it the same all along z. */
static const struct advice_change harmless[] = {
    {"/bodies/0/velocity", "{\"rotation\": {\"about\": [5, 0, 5], \"rate\": [0, 0, 1]}}"},
    {"/bodies/0/traction", "[{\"face\": \"x_max\", \"pressure\": 1}]"},
    {"/bodies/0/rotate", "{\"angle\": 90, \"about\": [2, 1, 5], \"axis\": [0, 0, 1]}"},
    {"/bodies/0/initial_stress", "[1, 2, 3, 4, 0, 0]"},
    {"/gravity", "[1, -10, 0]"},
    {"/gravity", "{\"magnitude\": 10, \"up\": [0, 1, 0], \"slopes\": ["
                 "{\"along\": [1, 0, 0], \"below\": 3, \"angle\": 10}]}"},
    {"/boundaries/-", "{\"box\": {\"min\": [5, 0, 0], \"max\": [6, 5, 10]},"
                      " \"condition\": \"slip\"}"},
    {"/probes", "[{\"name\": \"p\", \"kind\": \"mass\", \"within\": {\"min\": [0, 0, 2],"
                " \"max\": [9, 9, 3]}}]"},
};

static const struct advice_change channel[ADVICE_CHANGE_MAX] = {CHANNEL};

static bool draws(json_t *scene, const char *pointer, const char *code)
{
    json_t *item = advice_item(scene, pointer, code);
    const bool drawn = item != NULL;
    json_decref(item);
    return drawn;
}

static double saving(json_t *scene, const char *pointer, const char *code)
{
    json_t *item = advice_item(scene, pointer, code);
    assert_non_null(item);
    const double factor =
        json_number_value(json_object_get(json_object_get(item, "saving"), "particle_steps"));
    json_decref(item);
    return factor;
}

static void uniform_scenes_are_seen(void **state)
{
    (void)state;
    /* 40 layers of particles along z */
    assert_true(saving(advice_scene(BASE_SOLID, channel), "/dimension", "uniform_axis") == 40.0);
    for (size_t k = 0; k < sizeof harmless / sizeof harmless[0]; k++) {
        json_t *scene = advice_scene(BASE_SOLID, channel);
        fixture_change(scene, harmless[k].pointer, harmless[k].value);
        assert_true(draws(scene, "/dimension", "uniform_axis"));
    }
    for (size_t k = 0; k < sizeof spoiled / sizeof spoiled[0]; k++) {
        json_t *scene = advice_scene(BASE_SOLID, channel);
        fixture_change(scene, spoiled[k].pointer, spoiled[k].value);
        assert_false(draws(scene, "/dimension", "uniform_axis"));
    }
}

/* A cylinder along z between the walls, and a column between walls on all sides. */
static void lines_and_cylinders_are_seen(void **state)
{
    (void)state;
    json_t *scene = advice_scene(BASE_SOLID, channel);
    fixture_change(scene, "/bodies/0/box", NULL);
    fixture_change(scene, "/bodies/0/cylinder",
                   "{\"from\": [3, 3, 0], \"to\": [3, 3, 10], \"radius\": 2}");
    assert_true(draws(json_deep_copy(scene), "/dimension", "uniform_axis"));
    fixture_change(scene, "/bodies/0/cylinder/to", "[3, 3, 9]");
    assert_false(draws(scene, "/dimension", "uniform_axis"));

    scene = advice_scene(BASE_SOLID, channel);
    fixture_change(scene, "/boundaries/-",
                   "{\"plane\": {\"point\": [1, 0, 0], \"normal\": [1, 0, 0]},"
                   " \"condition\": \"slip\"}");
    fixture_change(scene, "/boundaries/-",
                   "{\"plane\": {\"point\": [3, 0, 0], \"normal\": [-1, 0, 0]},"
                   " \"condition\": \"slip\"}");
    json_t *item = advice_item(scene, "/dimension", "uniform_axis");
    assert_non_null(strstr(json_string_value(json_object_get(item, "change")), "\"line\""));
    assert_true(json_number_value(
                    json_object_get(json_object_get(item, "saving"), "particle_steps")) == 320.0);
    json_decref(item);

    static const struct advice_case in_plane = {
        "/dimension",
        "uniform_axis",
        BASE_FLUID,
        {{"/boundaries/-",
          "{\"plane\": {\"point\": [0, 0], \"normal\": [1, 0]}, \"condition\": \"slip\"}"},
         {"/boundaries/-",
          "{\"plane\": {\"point\": [0.06, 0], \"normal\": [-1, 0]}, \"condition\": \"slip\"}"}},
        {{"/boundaries/2/plane/point", "[0.3, 0]"}}, /* it can flow */
    };
    advice_check(&in_plane);
}

#define ON_THE_FLOOR                                                                               \
    {"/gravity", "[0, -10, 0]"},                                                                   \
        {"/bodies/-", "{\"material\": \"rubber\", \"spacing\": [0.25, 0.25, 0.25],"                \
                      " \"cylinder\": {\"from\": [5, 1, 5], \"to\": [5, 3, 5], \"radius\": 2}}"},  \
    {                                                                                              \
        "/boundaries", "[" FLOOR "]"                                                               \
    }
static const struct advice_change of_revolution[ADVICE_CHANGE_MAX] = {ON_THE_FLOOR};

static void bodies_of_revolution_are_seen(void **state)
{
    (void)state;
    static const struct advice_change breaks[] = {
        {"/bodies/1/cylinder/to", "[5.5, 3, 5]"},
        {"/bodies/0/sphere/centre", "[5, 5, 5.5]"},
        {"/bodies/0/velocity", "[1, 0, 0]"},
        {"/bodies/0/clip", "{\"min\": [5, null, null], \"max\": [null, null, null]}"},
        {"/bodies/1/traction", "[{\"face\": \"outside\", \"value\": [1, 0, 0]}]"},
        {"/gravity", "[1, -10, 0]"},
        {"/boundaries/-", "{\"plane\": {\"point\": [5, 0, 0], \"normal\": [1, 0, 0]},"
                          " \"condition\": \"slip\"}"},
    };
    assert_true(draws(advice_scene(BASE_SOLID, of_revolution), "/dimension", "body_of_revolution"));
    /* Halves of it are no news then. */
    assert_false(draws(advice_scene(BASE_SOLID, of_revolution), "/grid", "mirror_symmetry"));
    for (size_t k = 0; k < sizeof breaks / sizeof breaks[0]; k++) {
        json_t *scene = advice_scene(BASE_SOLID, of_revolution);
        fixture_change(scene, breaks[k].pointer, breaks[k].value);
        assert_false(draws(scene, "/dimension", "body_of_revolution"));
    }
    json_t *scene = advice_scene(BASE_SOLID, of_revolution);
    fixture_change(scene, "/bodies/1/traction", "[{\"face\": \"outside\", \"pressure\": 1}]");
    assert_true(draws(scene, "/dimension", "body_of_revolution"));
}

/* Half a cylinder behind a smooth plane through its axis; friction there would hold it. */
static void halves_of_revolution_are_seen(void **state)
{
    (void)state;
    static const struct advice_case half = {
        "/dimension",
        "body_of_revolution",
        BASE_SOLID,
        {{"/bodies/0/sphere", NULL},
         {"/bodies/0/cylinder", "{\"from\": [5, 1, 5], \"to\": [5, 3, 5], \"radius\": 2}"},
         {"/bodies/0/clip", "{\"min\": [5, null, null], \"max\": [null, null, null]}"},
         {"/boundaries",
          "[{\"plane\": {\"point\": [5, 0, 0], \"normal\": [1, 0, 0]}, \"condition\": \"slip\"}]"}},
        {{"/boundaries/0/condition", "\"stick\""}},
    };
    advice_check(&half);
    /* 16 x 8 x 8 of pi / 4 of them, over 8 x 8 */
    const double factor =
        saving(advice_scene(BASE_SOLID, half.scene), "/dimension", "body_of_revolution");
    assert_true(factor > 12.0 && factor < 13.5);
}

static void mirror_images_are_seen(void **state)
{
    (void)state;
    static const struct advice_case cases[] = {
        {"/grid",
         "mirror_symmetry",
         BASE_SOLID,
         {CHANNEL,
          {"/boundaries/-", "{\"box\": {\"min\": [5, 0, 4], \"max\": [6, 5, 6]},"
                            " \"condition\": \"slip\"}"}},
         {{"/boundaries/3/box/max", "[6, 5, 6.5]"}}},
        /* Across its radius a body of revolution has no mirror; along its axis it has. */
        {"/grid",
         "mirror_symmetry",
         BASE_AXIAL,
         {{"/gravity", "[0, 0]"}, {"/bodies/0/velocity", "[0, 0]"}},
         {{"/gravity", "[0, -1]"}}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        advice_check(&cases[k]);
}

/* A ball over a floor in plane strain, its own image about x = 10. */
#define BALL                                                                                       \
    {"/probes", "[]"}, {"/references", "[]"},                                                      \
        {"/bodies/0", "{\"material\": \"soil\", \"particles_per_cell\": 2,"                        \
                      " \"sphere\": {\"centre\": [10, 5], \"radius\": 2}}"},                       \
    {                                                                                              \
        "/boundaries/1", "{\"box\": {\"min\": [9, 0], \"max\": [11, 2]}, \"condition\": \"slip\"}" \
    }

static void mirrors_are_broken(void **state)
{
    (void)state;
    static const struct advice_change ball[ADVICE_CHANGE_MAX] = {BALL};
    static const struct {
        struct advice_change change;
        bool mirrors;
    } changes[] = {
        {{"/bodies/0/velocity", "[0, -1]"}, true},
        {{"/bodies/0/velocity", "[1, 0]"}, false},
        {{"/bodies/0/velocity", "{\"rotation\": {\"about\": [10, 5], \"rate\": 1}}"}, false},
        {{"/bodies/0/initial_stress", "[-1, -1, -1, 0, 0, 0]"}, true},
        {{"/bodies/0/initial_stress", "[-1, -1, -1, 0.1, 0, 0]"}, false},
        {{"/bodies/0/clip", "{\"min\": [9, null], \"max\": [11, null]}"}, true},
        {{"/bodies/0/clip", "{\"min\": [10, null], \"max\": [null, null]}"}, false},
        {{"/bodies/0/traction", "[{\"face\": \"outside\", \"pressure\": 1}]"}, true},
        {{"/bodies/0/traction", "[{\"face\": \"outside\", \"value\": [1, 0]}]"}, false},
        {{"/boundaries/1/faces", "{\"x_min\": {\"condition\": \"stick\"}}"}, false},
        {{"/boundaries/1/faces",
          "{\"x_min\": {\"condition\": \"stick\"}, \"x_max\": {\"condition\": \"stick\"}}"},
         true},
        {{"/boundaries/1",
          "{\"box\": {\"min\": [9, 0], \"max\": [11, 2]}, \"condition\": \"velocity\","
          " \"velocity\": [0, 1]}"},
         true},
        {{"/boundaries/1",
          "{\"box\": {\"min\": [9, 0], \"max\": [11, 2]}, \"condition\": \"velocity\","
          " \"velocity\": [1, 0]}"},
         false},
        {{"/boundaries/1", "{\"face\": {\"min\": [8, 1], \"max\": [12, 1], \"normal\": [0, 1]},"
                           " \"condition\": \"stick\"}"},
         true},
        {{"/boundaries/1", "{\"face\": {\"min\": [8, 1], \"max\": [13, 1], \"normal\": [0, 1]},"
                           " \"condition\": \"stick\"}"},
         false},
        {{"/boundaries/-", "{\"plane\": {\"point\": [2, 0], \"normal\": [1, 0]},"
                           " \"condition\": \"slip\"}"},
         false},
        {{"/gravity", "[0.1, -9.81]"}, false},
        {{"/gravity", "[0, [[0, -9.81], [1, 0]]]"}, true},
        {{"/grid",
          "{\"cell\": 0.5, \"min\": [0, 0], \"max\": [21, 10], \"outside\": \"eliminate\"}"},
         false},
        {{"/probes", "[{\"name\": \"p\", \"kind\": \"front\", \"along\": [1, 0]}]"}, true},
        {{"/bodies/0", "{\"material\": \"soil\", \"particles_per_cell\": 2, \"polygon\":"
                       " {\"vertices\": [[8, 4], [12, 4], [10, 8]]}}"},
         true},
        {{"/bodies/0", "{\"material\": \"soil\", \"particles_per_cell\": 2, \"polygon\":"
                       " {\"vertices\": [[8, 4], [12, 4], [9, 8]]}}"},
         false},
    };
    assert_true(draws(advice_scene(BASE_PLANE, ball), "/grid", "mirror_symmetry"));
    for (size_t k = 0; k < sizeof changes / sizeof changes[0]; k++) {
        json_t *scene = advice_scene(BASE_PLANE, ball);
        fixture_change(scene, changes[k].change.pointer, changes[k].change.value);
        const bool drawn = draws(scene, "/grid", "mirror_symmetry");
        if (drawn != changes[k].mirrors)
            (void)fprintf(stderr, "%s %s\n", changes[k].change.pointer, changes[k].change.value);
        assert_int_equal(drawn, changes[k].mirrors);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_scenes_are_seen),
        cmocka_unit_test(lines_and_cylinders_are_seen),
        cmocka_unit_test(bodies_of_revolution_are_seen),
        cmocka_unit_test(halves_of_revolution_are_seen),
        cmocka_unit_test(mirror_images_are_seen),
        cmocka_unit_test(mirrors_are_broken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
