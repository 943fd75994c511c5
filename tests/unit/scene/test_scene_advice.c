/* SPDX-License-Identifier: Apache-2.0 */
/* Every item of advice but those on symmetry: a scene that draws it and a near twin that does not.
 */
#include "advice_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define TIME_STEP "/solver/time_step"
#define COURANT "/solver/courant"
#define CONTROL "/solver/anti_locking/control"
#define FRAMES "/output/frames/every"
#define PRECISION "/output/frames/precision"
#define HISTORY "/output/history/every"
#define CHECKPOINTS "/output/checkpoints/every"
#define CELL "/grid/cell"

/* The critical step of the plane base is 8.0 ms; of the solid one 17 ms. */
static const struct advice_case steps[] = {
    {TIME_STEP, "small_time_step", BASE_PLANE, {{TIME_STEP, "1e-3"}}, {{TIME_STEP, "2e-3"}}},
    {COURANT, "small_time_step", BASE_PLANE, {{COURANT, "0.1"}}, {{COURANT, "0.3"}}},
    /* 60 steps would not show much. */
    {TIME_STEP,
     "small_time_step",
     BASE_PLANE,
     {{TIME_STEP, "1e-3"}},
     {{"/duration", "0.2"}, {"/references/0/curve", "[[0, 4], [0.1, 6]]"}}},
    /* There nobody knows the critical step well enough. */
    {TIME_STEP,
     "small_time_step",
     BASE_PLANE,
     {{TIME_STEP, "5e-4"}},
     {{"/solver/stress_update", "\"last\""}}},
    {TIME_STEP,
     "over_critical",
     BASE_PLANE,
     {{"/solver/allow_unstable", "true"}, {TIME_STEP, "0.02"}},
     {{TIME_STEP, "6e-3"}}},
    {COURANT,
     "over_critical",
     BASE_PLANE,
     {{"/solver/allow_unstable", "true"}, {COURANT, "1.5"}},
     {{COURANT, "0.9"}}},
    /* A jelly (9 m/s) that falls from 6 m gets faster than sound. */
    {TIME_STEP,
     "critical_in_motion",
     BASE_SOLID,
     {{"/materials/rubber/young_modulus", "6e4"},
      {"/gravity", "[0, -10, 0]"},
      {"/solver", "{\"time_step\": 0.05}"}},
     {{"/solver/time_step", "0.02"}}},
};

static const struct advice_case outputs[] = {
    {FRAMES,
     "many_frames",
     BASE_PLANE,
     {{"/output", "{\"frames\": {\"every\": 0.001}}"}},
     {{FRAMES, "0.01"}}},
    {FRAMES,
     "large_frames",
     BASE_PLANE,
     {{"/output", "{\"frames\": {\"every\": 0.01}}"},
      {"/bodies/0/particles_per_cell", "[80, 160]"},

      {"/boundaries/1/box", "{\"min\": [19, 0], \"max\": [20, 10]}"},
      {"/bodies/0/box/max", "[19, 10]"},
      {"/probes/1/face", "\"x_min\""}},
     {{"/bodies/0/particles_per_cell", "[4, 4]"}}},
    {PRECISION,
     "double_frames",
     BASE_PLANE,
     {{"/output", "{\"frames\": {\"precision\": \"double\"}}"},
      {"/bodies/0/particles_per_cell", "[40, 40]"}},
     {{"/bodies/0/particles_per_cell", "[4, 4]"}}},
    /* Some 6,200 steps of 0.3 ms. */
    {HISTORY,
     "fine_history",
     BASE_PLANE,
     {{"/duration", "20"}, {"/output", "{\"history\": {\"every\": 0.001}}"}},
     {{HISTORY, "0.01"}}},
    {HISTORY,
     "fine_history",
     BASE_PLANE,
     {{"/duration", "20"}, {"/output", "{\"history\": {\"every\": 0.001}}"}},
     {{"/duration", "0.5"}}}, /* few rows */
    {HISTORY,
     "fine_history", /* not closer than the step, and too many for the disk */
     BASE_PLANE,
     {{"/duration", "1e4"}, {"/output", "{\"history\": {\"every\": 0.004}}"}},
     {{HISTORY, "0.4"}}},
    {CHECKPOINTS,
     "frequent_checkpoints",
     BASE_PLANE,
     {{"/output", "{\"checkpoints\": {\"every\": 1}}"},
      {"/bodies/0/particles_per_cell", "[50, 50]"}},
     {{"/bodies/0/particles_per_cell", "[4, 4]"}}},
    {CHECKPOINTS,
     "frequent_checkpoints",
     BASE_PLANE,
     {{"/output", "{\"checkpoints\": {\"every\": 1}}"},
      {"/bodies/0/particles_per_cell", "[50, 50]"}},
     {{CHECKPOINTS, "30"}}},
};

#define NODES "{\"anti_locking\": {\"control\": \"node\"}}"
#define POISSON "/materials/rubber/poisson_ratio"
/* The default shape locks less than averages are for. */
#define LINEAR "{\"shape\": \"linear\"}"
static const struct advice_case averages[] = {
    {CONTROL, "locking", BASE_PLANE, {{"/solver", LINEAR}}, {{"/solver", "{}"}}},
    {CONTROL,
     "locking",
     BASE_PLANE,
     {{"/solver", "{\"shape\": \"gimp\"}"}},
     {{"/solver/shape", "\"bspline3\""}}},
    {CONTROL, "locking", BASE_SOLID, {{POISSON, "0.49"}, {"/solver", LINEAR}}, {{POISSON, "0.3"}}},
    {CONTROL,
     "locking",
     BASE_FLUID,
     {{"/solver", LINEAR}},
     {{"/solver", "{\"shape\": \"linear\", \"anti_locking\": {\"control\": \"cell\"}}"}}},
    /* What does not go into the plane goes across it. */
    {CONTROL,
     "locking",
     BASE_AXIAL,
     {{POISSON, "0.49"}, {"/bodies/0/sphere/centre", "[1, 1]"}, {"/solver", LINEAR}},
     {{"/dimension", "\"plane_stress\""}}},
    /* One cell between walls has one state. */
    {CONTROL,
     "locking",
     BASE_PLANE,
     {{"/solver", LINEAR}},
     {{"/grid/cell", "2"}, {"/bodies/0/box/max", "[2, 2]"}}},
    /* A material of which there is nothing. */
    {CONTROL,
     "locking",
     BASE_SOLID,
     {{"/materials/jelly",
       "{\"model\": \"linear_elastic\", \"density\": 1000, \"young_modulus\": 1e6,"
       " \"poisson_ratio\": 0.49}"},
      {"/bodies/0/material", "\"jelly\""},
      {"/solver", LINEAR}},
     {{"/bodies/0/material", "\"rubber\""}}},
    {CONTROL,
     "superfluous_anti_locking",
     BASE_SOLID,
     {{"/solver", "{\"anti_locking\": {\"control\": \"cell\"}}"}},
     {{POISSON, "0.45"}}},
    {CONTROL,
     "superfluous_anti_locking",
     BASE_SOLID,
     {{"/solver", NODES}},
     {{"/solver", "{\"anti_locking\": {\"control\": \"cell\", \"field\": \"full\"}}"}}},
    {CONTROL,
     "superfluous_anti_locking",
     BASE_AXIAL,
     {{POISSON, "0.49"},
      {"/bodies/0/sphere/centre", "[1, 1]"},
      {"/dimension", "\"plane_stress\""},
      {"/solver", "{\"anti_locking\": {\"control\": \"cell\"}}"}},
     {{"/dimension", "\"plane_strain\""}}},
    {CONTROL,
     "averaged_elastic_strain",
     BASE_SOLID,
     {{"/solver", NODES}, {POISSON, "0.49"}},
     {{"/solver", "{\"anti_locking\": {\"control\": \"cell\"}}"}}},
    {CONTROL,
     "averaged_elastic_strain",
     BASE_SOLID,
     {{"/solver", NODES}, {POISSON, "0.49"}},
     {{"/materials/rubber", "{\"model\": \"newtonian_fluid\", \"density\": 1000,"
                            " \"bulk_modulus\": 1e6}"}}},
};

#define PER_CELL "/bodies/0/particles_per_cell"
#define SPACING "/bodies/0/spacing"
#define COUNT "/bodies/0/count"
#define BOX "/boundaries/1/box"
static const struct advice_case resolutions[] = {
    {PER_CELL, "few_particles", BASE_PLANE, {{PER_CELL, "[1, 2]"}}, {{PER_CELL, "[2, 2]"}}},
    {SPACING, "few_particles", BASE_SOLID, {{SPACING, "[0.25, 0.4, 0.25]"}}, {{SPACING, "0.25"}}},
    {COUNT, "few_particles", BASE_FLUID, {{COUNT, "[6, 12]"}}, {{COUNT, "[12, 24]"}}},
    {COUNT, "few_particles", BASE_FLUID, {{COUNT, "[6, 12]"}}, {{COUNT, "[1, 1]"}}},
    {CELL, "coarse_grid", BASE_PLANE, {{CELL, "[0.5, 2]"}}, {{CELL, "[0.5, 1]"}}},
    /* A layer of many of the same is not thin. */
    {CELL,
     "coarse_grid",
     BASE_PLANE,
     {{"/bodies/0/box/max", "[4, 0.5]"}},
     {{"/bodies/-", "{\"material\": \"soil\", \"particles_per_cell\": 2,"
                    " \"box\": {\"min\": [0, 0.5], \"max\": [4, 2]}}"}}},
    /* Nor is one cell between two walls. */
    {CELL,
     "coarse_grid",
     BASE_PLANE,
     {{"/bodies/0/box/max", "[4, 0.5]"}},
     {{"/boundaries/-", "{\"plane\": {\"point\": [0, 0.5], \"normal\": [0, -1]},"
                        " \"condition\": \"slip\"}"}}},
    /* An obstacle in one row of nodes; an opening of one cell over it. */
    {CELL, "coarse_grid", BASE_PLANE, {{BOX "/min", "[9.6, 0]"}}, {{BOX "/min", "[9.5, 0]"}}},
    {CELL,
     "coarse_grid",
     BASE_PLANE,
     {{"/boundaries/-", "{\"box\": {\"min\": [8, 6.5], \"max\": [10, 10]},"
                        " \"condition\": \"slip\"}"}},
     {{"/boundaries/2/box/min", "[8, 8]"}}},
    {CELL,
     "coarse_grid",
     BASE_SOLID,
     {{"/boundaries/0/face/max", "[2.5, 0, 6]"}},
     {{"/boundaries/0/face/max", "[4, 0, 6]"}}},
    {CELL, "fine_grid", BASE_PLANE, {{CELL, "0.005"}}, {{CELL, "0.01"}}},
    /* A small obstacle needs what the body does not. */
    {CELL,
     "fine_grid",
     BASE_PLANE,
     {{CELL, "0.005"}},
     {{BOX, "{\"min\": [8, 0], \"max\": [8.5, 1]}"}}},
};

static void check_all(const struct advice_case *cases, size_t count)
{
    for (size_t index = 0; index < count; index++)
        advice_check(&cases[index]);
}
#define CHECK_ALL(cases) check_all(cases, sizeof(cases) / sizeof(cases)[0])

static void time_steps_are_judged(void **state)
{
    (void)state;
    CHECK_ALL(steps);
}

static void outputs_are_judged(void **state)
{
    (void)state;
    CHECK_ALL(outputs);
}

static void averages_are_judged(void **state)
{
    (void)state;
    CHECK_ALL(averages);
}

static void resolutions_are_judged(void **state)
{
    (void)state;
    CHECK_ALL(resolutions);
}

/* Programs can follow an item: what it sets is a number that does what the text says. */
static void savings_are_numbers(void **state)
{
    (void)state;
    const struct advice_change changes[ADVICE_CHANGE_MAX] = {{TIME_STEP, "1e-3"}};
    json_t *item = advice_item(advice_scene(BASE_PLANE, changes), TIME_STEP, "small_time_step");
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    struct talus_error error;
    fixture_read(scene, &result);
    json_t *forecast = scene_forecast(&result.scene, 1, NULL, &error);
    const double automatic = json_number_value(json_object_get(forecast, "time_step"));
    const double factor =
        json_number_value(json_object_get(json_object_get(item, "saving"), "particle_steps"));
    assert_true(fabs(factor - automatic / 1e-3) < 1e-9 * factor);
    assert_string_equal(json_string_value(json_object_get(json_object_get(item, "set"), TIME_STEP)),
                        "auto");
    /* Without a share of FLIP per step: that would have to change with the step. */
    const struct advice_change shares[ADVICE_CHANGE_MAX] = {{TIME_STEP, "1e-3"},
                                                            {"/solver/flip_ratio", "0.99"}};
    json_t *other = advice_item(advice_scene(BASE_PLANE, shares), TIME_STEP, "small_time_step");
    assert_non_null(other);
    assert_null(json_object_get(other, "set"));
    json_decref(other);
    json_decref(item);
    json_decref(forecast);
    json_decref(scene);
    fixture_result_release(&result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(time_steps_are_judged), cmocka_unit_test(outputs_are_judged),
        cmocka_unit_test(averages_are_judged),   cmocka_unit_test(resolutions_are_judged),
        cmocka_unit_test(savings_are_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
