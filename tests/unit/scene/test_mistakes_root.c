/* SPDX-License-Identifier: Apache-2.0 */
/* Mistakes of the scene itself, its grid and its output. */
#include "mistake_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SLOPE(REST) "{\"magnitude\": 10, \"up\": [0, 1], \"slopes\": [{\"angle\": 20, " REST "}]}"

static const struct mistake root[] = {
    {BASE_PLANE, "/dimension", NULL, NULL, "required"},
    {BASE_PLANE, "/dimension", "\"plane\"", NULL, "unknown_value"},
    {BASE_PLANE, "/dimension", "3", NULL, "type"},
    {BASE_PLANE, "/dimension", "\"plane_stress\"", "/materials/soil/model", "contradiction"},
    {BASE_FLUID, "/dimension", "\"plane_stress\"", "/materials/water/model", "contradiction"},
    {BASE_AXIAL, "/grid/min/0", "-0.1", NULL, "dimension"},
    {BASE_AXIAL, "/gravity/0", "-1", NULL, "contradiction"},
    {BASE_AXIAL, "/bodies/0/velocity", "{\"rotation\": {\"about\": [0.5, 0.5], \"rate\": 1}}", NULL,
     "contradiction"},
    {BASE_AXIAL, "/dimension", "\"axial\"", NULL, "unknown_value"},
    {BASE_PLANE, "/duration", NULL, NULL, "required"},
    {BASE_PLANE, "/duration", "0", NULL, "range"},
    {BASE_PLANE, "/duration", "\"long\"", NULL, "type"},
    {BASE_PLANE, "/duration", "null", NULL, "type"},
    {BASE_PLANE, "/grid", NULL, NULL, "required"},
    {BASE_PLANE, "/materials", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies", NULL, NULL, "required"},
    {BASE_PLANE, "/bodys", "[]", NULL, "unknown_key"},
    {BASE_PLANE, "/title", "7", NULL, "type"},
    {BASE_PLANE, "/phases", "[]", NULL, "unsupported"},
    {BASE_PLANE, "/gravity", "[0, -9.81, 0]", NULL, "length"},
    {BASE_PLANE, "/gravity", "[0, \"down\"]", "/gravity/1", "type"},
    {BASE_PLANE, "/gravity", "[0, [[0, -9], [1, \"-9.81\"]]]", "/gravity/1/1/1", "type"},
    {BASE_PLANE, "/gravity", "[0, [[0, -9], [1]]]", "/gravity/1/1", "type"},
    {BASE_PLANE, "/gravity", "[[], -9.81]", "/gravity/0", "length"},
    {BASE_PLANE, "/gravity", "[0, [[1, -9], [1, -9.81]]]", "/gravity/1/1/0", "order"},
    {BASE_PLANE, "/gravity", "{\"magnitude\": 10, \"up\": [0, 1]}", "/gravity/slopes", "required"},
    {BASE_PLANE, "/gravity", "{\"magnitude\": 10, \"up\": [0, 0], \"slopes\": []}", "/gravity/up",
     "direction"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0.1], \"below\": 3"), "/gravity/slopes/0/along",
     "contradiction"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0]"), "/gravity/slopes/0/below", "required"},
    {BASE_PLANE, "/gravity",
     SLOPE("\"along\": [1, 0], \"below\": 3, \"beyond\": 3, \"about\": [0, 0]"),
     "/gravity/slopes/0/beyond", "alternative"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0], \"beyond\": 3"), "/gravity/slopes/0/about",
     "required"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0], \"below\": 3, \"about\": [0, 0]"),
     "/gravity/slopes/0/beyond", "required"},
    {BASE_PLANE, "/audits", "{\"energy_growth\": -1}", "/audits/energy_growth", "range"},
    {BASE_PLANE, "/audits", "{\"energy_grow\": 1}", "/audits/energy_grow", "unknown_key"},
};

static const struct mistake grid[] = {
    {BASE_PLANE, "/grid/cell", NULL, NULL, "required"},
    {BASE_PLANE, "/grid/cel", "1", NULL, "unknown_key"},
    {BASE_PLANE, "/grid/cell", "-0.5", NULL, "range"},
    {BASE_PLANE, "/grid/cell", "[0.5, 0]", "/grid/cell/1", "range"},
    {BASE_PLANE, "/grid/cell", "[0.5, 0.5, 0.5]", NULL, "length"},
    {BASE_PLANE, "/grid/cell", "[1e-6, 0.5]", "/grid/max/0", "limit"},
    {BASE_PLANE, "/grid/max", "[20, 0]", "/grid/max/1", "order"},
    {BASE_PLANE, "/grid/max", "[3, 10]", "/bodies/0", "outside"},
    {BASE_PLANE, "/grid/outside", "\"ignore\"", NULL, "unknown_value"},
    {BASE_PLANE, "/grid/outside_mass_limit", "1.5", NULL, "range"},
};

static const struct mistake output[] = {
    {BASE_PLANE, "/output", "{\"frames\": {\"every\": -1}}", "/output/frames/every", "range"},
    {BASE_PLANE, "/output", "{\"frames\": {\"every\": 1e-7}}", "/output/frames/every", "limit"},
    {BASE_PLANE, "/output", "{\"frames\": {\"fields\": [\"velocities\"]}}",
     "/output/frames/fields/0", "unknown_value"},
    {BASE_PLANE, "/output", "{\"frames\": {\"fields\": [\"stress\", \"stress\"]}}",
     "/output/frames/fields/1", "duplicate"},
    {BASE_PLANE, "/output", "{\"frames\": {\"precision\": \"half\"}}", "/output/frames/precision",
     "unknown_value"},
    {BASE_PLANE, "/output", "{\"history\": {\"every\": 0}}", "/output/history/every", "range"},
    {BASE_PLANE, "/output", "{\"checkpoints\": {\"evry\": 1}}", "/output/checkpoints/evry",
     "unknown_key"},
};

static void mistakes_of_root(void **state)
{
    (void)state;
    mistakes_check(root, sizeof root / sizeof root[0]);
}

static void mistakes_of_grid(void **state)
{
    (void)state;
    mistakes_check(grid, sizeof grid / sizeof grid[0]);
}

static void mistakes_of_output(void **state)
{
    (void)state;
    mistakes_check(output, sizeof output / sizeof output[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_of_root),
        cmocka_unit_test(mistakes_of_grid),
        cmocka_unit_test(mistakes_of_output),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
