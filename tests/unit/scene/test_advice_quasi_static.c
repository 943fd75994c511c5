/* SPDX-License-Identifier: Apache-2.0 */
/* Advice on dynamic runs of something quasi-static. A rubber block of 1 x 1 m (E = 1 MPa): shear
 * waves cross it in 0.05 s, and go four times along it in the slowest period, 0.204 s. */
#include "advice_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define BASE                                                                                       \
    "{\"name\": \"base\", \"condition\": \"slip\","                                                \
    " \"plane\": {\"point\": [0, 0], \"normal\": [0, 1]}}"
#define PRESS(speed)                                                                               \
    "{\"name\": \"press\", \"condition\": \"velocity\", \"velocity\": [0, " speed "],"             \
    " \"plane\": {\"point\": [0, 1], \"normal\": [0, -1]}}"
#define RUBBER                                                                                     \
    {"/dimension", "\"plane_strain\""},                                                            \
    {                                                                                              \
        "/bodies/0", "{\"material\": \"rubber\", \"particles_per_cell\": 2,"                       \
                     " \"box\": {\"min\": [0, 0], \"max\": [1, 1]}}"                               \
    }

/* Pressed by a tenth in 40 s, 196 periods. */
static const struct advice_change pressed[ADVICE_CHANGE_MAX] = {
    RUBBER,
    {"/gravity", "[0, 0]"},
    {"/duration", "40"},
    {"/boundaries", "[" BASE ", " PRESS("-0.0025") "]"},
};

/* On its base, its weight there at once, for 98 periods. */
static const struct advice_change weighed[ADVICE_CHANGE_MAX] = {
    RUBBER,
    {"/duration", "20"},
    {"/boundaries", "[" BASE "]"},
};

static json_t *changed(const struct advice_change *base, const char *pointer, const char *value)
{
    json_t *scene = advice_scene(BASE_AXIAL, base);
    if (pointer != NULL)
        fixture_change(scene, pointer, value);
    return scene;
}

static void expect(const struct advice_change *base, const char *pointer, const char *value,
                   bool drawn)
{
    json_t *item = advice_item(changed(base, pointer, value), "/duration", "quasi_static");
    if ((item != NULL) != drawn)
        (void)fprintf(stderr, "%s %s\n", pointer == NULL ? "" : pointer,
                      value == NULL ? "" : value);
    assert_int_equal(item != NULL, drawn);
    json_decref(item);
}

static void slow_loads_are_seen(void **state)
{
    (void)state;
    expect(pressed, NULL, NULL, true);
    expect(pressed, "/duration", "10", false);                 /* 49 periods */
    expect(pressed, "/bodies/0/velocity", "[0, -0.1]", false); /* it flies */
    expect(pressed, "/boundaries", "[" BASE ", " PRESS("-0.02") "]", true);
    expect(pressed, "/boundaries", "[" BASE ", " PRESS("-0.2") "]", false); /* 0.6 % of c */
    expect(pressed, "/solver", "{\"pic_rate\": 1}", false);
    expect(pressed, "/solver", "{\"transfer\": \"pic\"}", false);
    expect(pressed, "/solver", "{\"stabilise\": {\"viscous_damping\": 0.1}}", false);
    expect(pressed, "/materials/rubber",
           "{\"model\": \"newtonian_fluid\", \"density\": 1000, \"bulk_modulus\": 1e6}", false);
    /* Its weight shakes it, unless it comes slowly too. */
    expect(pressed, "/gravity", "[0, -1]", false);
    /* A table that goes through its values in 2 s, or in 20. */
    expect(pressed, "/boundaries", "[" BASE ", " PRESS("[[0, 0], [2, -0.0025], [40, -0.0025]]") "]",
           false);
    expect(pressed, "/boundaries",
           "[" BASE ", " PRESS("[[0, 0], [10, -0.001], [20, -0.002], [40, -0.002]]") "]", true);
    expect(pressed, "/bodies/0/traction", "[{\"face\": \"y_max\", \"pressure\": 1}]", false);
    expect(pressed, "/bodies/0/traction",
           "[{\"face\": \"x_max\", \"pressure\": [[0, 0], [40, 100]]}]", true);
}

/* What fails under its weight slides in its own time. */
static void plastic_bodies_need_their_time(void **state)
{
    (void)state;
    json_t *scene = changed(pressed, "/gravity", "[0, -10]");
    fixture_change(scene, "/bodies/0/initial_stress", "{\"geostatic\": {\"k0\": 1}}");
    fixture_change(scene, "/duration", "20");
    json_t *elastic = advice_item(json_deep_copy(scene), "/duration", "quasi_static");
    assert_non_null(elastic);
    json_decref(elastic);
    fixture_change(scene, "/materials/rubber",
                   "{\"model\": \"tresca\", \"density\": 1000, \"young_modulus\": 1e6,"
                   " \"poisson_ratio\": 0.3, \"cohesion\": 1e4}");
    assert_null(advice_item(scene, "/duration", "quasi_static")); /* sqrt(L / g) is 0.32 s */
}

static void constant_loads_are_seen(void **state)
{
    (void)state;
    expect(weighed, NULL, NULL, true);
    expect(weighed, "/duration", "5", false);                /* a vibration that may be the aim */
    expect(weighed, "/bodies/0/box/min", "[0, 0.3]", false); /* it falls */
    expect(weighed, "/gravity", "[1, -10]", false);          /* it slides */
    expect(weighed, "/solver", "{\"stabilise\": {\"settle\": {\"time\": 5}}}", false);
    expect(weighed, "/boundaries/0/until", "10", false);
    expect(weighed, "/bodies/0/initial_stress", "{\"geostatic\": {\"k0\": 0.43}}", false);
    expect(weighed, "/solver", "{\"stabilise\": {\"local_damping\": 0.3}}", false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slow_loads_are_seen),
        cmocka_unit_test(plastic_bodies_need_their_time),
        cmocka_unit_test(constant_loads_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
