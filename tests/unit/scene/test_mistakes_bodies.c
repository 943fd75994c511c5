/* SPDX-License-Identifier: Apache-2.0 */
/* Mistakes of materials and bodies. */
#include "mistake_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define BODY(REST) "{\"name\": \"heap\", \"material\": \"soil\", " REST "}"

static const struct mistake materials[] = {
    {BASE_PLANE, "/materials/soil/model", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/model", "\"sand\"", NULL, "unknown_value"},
    {BASE_PLANE, "/materials/soil/density", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/density", "0", NULL, "range"},
    {BASE_PLANE, "/materials/soil/density", "1e31", NULL, "range"},
    {BASE_PLANE, "/materials/soil/bulk_modulus", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/young_modulus", "1e6", NULL, "alternative"},
    {BASE_PLANE, "/materials/soil/friction_angle", "95", NULL, "range"},
    {BASE_PLANE, "/materials/soil/friction_angle", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/cone_slope", "0.5", NULL, "alternative"},
    {BASE_PLANE, "/materials/soil/cohesion", "5", "/materials/soil/cone_strength", "alternative"},
    {BASE_PLANE, "/materials/soil/frction_angle", "30", NULL, "unknown_key"},
    {BASE_PLANE, "/materials/soil/cone_fit", "\"middle\"", NULL, "unknown_value"},
    {BASE_SOLID, "/materials/rubber/poisson_ratio", "0.5", NULL, "range"},
    {BASE_SOLID, "/materials/rubber/friction_angle", "30", NULL, "unknown_key"},
    {BASE_FLUID, "/materials/water/exponent", "7", NULL, "contradiction"},
    {BASE_FLUID, "/materials/water/exponent", "0.9", NULL, "range"},
    {BASE_FLUID, "/materials/water/equation_of_state", "\"van_der_waals\"", NULL, "unknown_value"},
    {BASE_FLUID, "/materials/water/no_tension", "\"yes\"", NULL, "type"},
    {BASE_PLANE, "/materials/soil",
     "{\"model\": \"matsuoka_nakai\", \"density\": 2000,"
     "\"bulk_modulus\": 1e7, \"shear_modulus\": 5e6, \"friction\": {\"a1\": 9}}",
     "/materials/soil/friction/a0", "required"},
    {BASE_PLANE, "/materials/soil",
     "{\"model\": \"matsuoka_nakai\", \"density\": 2000,"
     "\"bulk_modulus\": 1e7, \"shear_modulus\": 5e6, \"friction\": {\"a0\": 35},"
     "\"friction_angle\": 30}",
     "/materials/soil/friction", "alternative"},
    {BASE_PLANE, "/materials/soil",
     "{\"model\": \"mohr_coulomb\", \"density\": 2000,"
     "\"bulk_modulus\": 1e7, \"shear_modulus\": 5e6, \"friction_angle\": 30, \"cohesion\": 1e3,"
     "\"tensile_strength\": 2e3}",
     "/materials/soil/tensile_strength", "contradiction"},
    {BASE_PLANE, "/materials/soil",
     "{\"model\": \"tresca\", \"density\": 2000, \"bulk_modulus\": 1e7, \"shear_modulus\": 5e6,"
     "\"cohesion\": 1e3, \"residual_cohesion\": 500}",
     "/materials/soil/softening_rate", "incomplete"},
    {BASE_PLANE, "/materials/soil", "[]", NULL, "type"},
    {BASE_PLANE, "/materials", "[]", NULL, "type"},
};

static const struct mistake bodies[] = {
    {BASE_PLANE, "/bodies", "[]", NULL, "length"},
    {BASE_PLANE, "/bodies", "{}", NULL, "type"},
    {BASE_PLANE, "/bodies/0", "7", NULL, "type"},
    {BASE_PLANE, "/bodies/0/material", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/material", "\"sol\"", NULL, "unknown_name"},
    {BASE_PLANE, "/bodies/0/name", "\"my heap\"", NULL, "name"},
    {BASE_PLANE, "/bodies/0/box", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/sphere", "{\"centre\": [1, 1], \"radius\": 1}", NULL, "alternative"},
    {BASE_PLANE, "/bodies/0/box/max", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/box/max", "[4, 0]", "/bodies/0/box/max/1", "order"},
    {BASE_PLANE, "/bodies/0/box/max", "[9, 2]", "/bodies/0", "contradiction"},
    {BASE_PLANE, "/bodies/0/box/max", "[4, 2, 1]", NULL, "length"},
    {BASE_PLANE, "/bodies/0", BODY("\"polygon\": {\"vertices\": [[0, 0], [1, 0]]}, \"count\": 9"),
     "/bodies/0/polygon/vertices", "length"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"polygon\": {\"vertices\": [[0, 0], [1, 1], [1, 0], [0, 1]]}, \"count\": 9"),
     "/bodies/0/polygon/vertices", "contradiction"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"polygon\": {\"vertices\": [[0, 0], [1, 0], [1, 0, 1]]}, \"count\": 9"),
     "/bodies/0/polygon/vertices/2", "length"},
    {BASE_PLANE, "/bodies/0", BODY("\"polygon\": {\"vertices\": [[0, 0], [1, 0], [0, 1]]}"),
     "/bodies/0/particles_per_cell", "required"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"polygon\": {\"vertices\": [[0, 0], [9, 0], [0, 9]]}, "
          "\"particles_per_cell\": 2, \"box\": {\"min\": [0, 0], "
          "\"max\": [1, 1]}"),
     "/bodies/0/polygon", "alternative"},
    {BASE_SOLID, "/bodies/0",
     "{\"material\": \"rubber\", \"count\": 9, \"polygon\": "
     "{\"vertices\": [[1, 1, 1], [2, 1, 1], [1, 2, 1]]}}",
     "/bodies/0/polygon/vertices", "contradiction"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [0]}"),
     "/bodies/0/points/volumes/0", "range"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1, 2]}"),
     "/bodies/0/points/volumes", "contradiction"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [], \"volumes\": []}"),
     "/bodies/0/points/positions", "length"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[1, -1]], \"volumes\": [1]}"),
     "/bodies/0", "outside"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[9, 1]], \"volumes\": [1]}"),
     "/bodies/0", "contradiction"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1]}, \"spacing\": 1"),
     "/bodies/0/spacing", "alternative"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1]}, \"clip\": {\"min\": [0, 0]}"),
     "/bodies/0/clip", "contradiction"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1]}, \"initial_stress\": "
          "{\"geostatic\": {\"k0\": 0.5}}"),
     "/bodies/0/initial_stress", "contradiction"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"box\": {\"min\": [0, 0], \"max\": [4, 2]}, \"count\": 4, "
          "\"rotate\": {\"angle\": 45, \"about\": [0, 0]}"),
     "/bodies/0", "outside"},
    {BASE_PLANE, "/bodies/0/rotate", "{\"angle\": 10}", "/bodies/0/rotate/about", "required"},
    {BASE_PLANE, "/bodies/0/rotate", "{\"angle\": 1, \"about\": [1, 1], \"axis\": [0, 1]}",
     "/bodies/0/rotate/axis", "contradiction"},
    {BASE_SOLID, "/bodies/0/rotate", "{\"angle\": 1, \"about\": [1, 1, 1]}",
     "/bodies/0/rotate/axis", "incomplete"},
    {BASE_SOLID, "/bodies/0/rotate", "{\"angle\": 1, \"about\": [1, 1, 1], \"axis\": [0, 0, 0]}",
     "/bodies/0/rotate/axis", "direction"},
    {BASE_PLANE, "/bodies/0/clip", "{\"min\": [5, null]}", "/bodies/0", "empty"},
    {BASE_PLANE, "/bodies/0/clip", "{\"low\": [5, null]}", "/bodies/0/clip/low", "unknown_key"},
    {BASE_PLANE, "/bodies/0/particles_per_cell", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/particles_per_cell", "[2, 0]", "/bodies/0/particles_per_cell/1",
     "range"},
    {BASE_PLANE, "/bodies/0/particles_per_cell", "[1e6, 1e6]", "/bodies/0", "limit"},
    {BASE_PLANE, "/bodies/0/spacing", "[0.1, 0.1]", NULL, "alternative"},
    {BASE_FLUID, "/bodies/0/count", "[12, 2.5]", "/bodies/0/count/1", "type"},
    {BASE_PLANE, "/bodies/0/velocity", "{\"rotation\": {\"about\": [0, 0], \"rate\": [0, 0, 1]}}",
     "/bodies/0/velocity/rotation/rate", "type"},
    {BASE_SOLID, "/bodies/0/velocity", "{\"rotation\": {\"about\": [0, 0, 0], \"rate\": 1}}",
     "/bodies/0/velocity/rotation/rate", "type"},
    {BASE_PLANE, "/bodies/0/velocity", "{\"rotation\": {\"rate\": 1}}",
     "/bodies/0/velocity/rotation/about", "required"},
    {BASE_PLANE, "/bodies/0/velocity",
     "{\"rotations\": {}, \"rotation\": {\"about\": [0, 0], \"rate\": 1}}",
     "/bodies/0/velocity/rotations", "unknown_key"},
    {BASE_PLANE, "/bodies/0/velocity", "{}", "/bodies/0/velocity/rotation", "required"},
    {BASE_PLANE, "/bodies/0/velocity",
     "{\"beam_mode\": {\"mode\": 1.5, \"from\": [0, 0], \"to\": [1, 0], \"tip\": [0, 1]}}",
     "/bodies/0/velocity/beam_mode/mode", "type"},
    {BASE_PLANE, "/bodies/0/velocity",
     "{\"beam_mode\": {\"mode\": 1, \"from\": [1, 0], \"to\": [1, 0], \"tip\": [0, 1]}}",
     "/bodies/0/velocity/beam_mode/to", "direction"},
    {BASE_PLANE, "/bodies/0/velocity",
     "{\"beam_mode\": {\"mode\": 1, \"from\": [0, 0], \"to\": [1, 0], \"tip\": [0.1, 1]}}",
     "/bodies/0/velocity/beam_mode/tip", "contradiction"},
    {BASE_PLANE, "/bodies/0/velocity", "5", NULL, "type"},
    {BASE_PLANE, "/bodies/0/traction", "{}", NULL, "type"},
    {BASE_PLANE, "/bodies/0/traction", "[{\"face\": \"y_max\", \"kind\": \"dead\"}]",
     "/bodies/0/traction/0/value", "required"},
    {BASE_PLANE, "/bodies/0/traction",
     "[{\"face\": \"y_max\", \"value\": [0, 1], \"pressure\": 1}]", "/bodies/0/traction/0/pressure",
     "alternative"},
    {BASE_PLANE, "/bodies/0/traction", "[{\"face\": \"y_max\", \"value\": [0, 1, 2]}]",
     "/bodies/0/traction/0/value", "length"},
    {BASE_PLANE, "/bodies/0/traction", "[{\"face\": \"y_max\", \"pressure\": [[0, 1], 2]}]",
     "/bodies/0/traction/0/pressure/1", "type"},
    {BASE_PLANE, "/bodies/0/traction",
     "[{\"face\": \"y_max\", \"value\": [0, 1], \"kind\": \"normal\"}]",
     "/bodies/0/traction/0/kind", "contradiction"},
    {BASE_PLANE, "/bodies/0/traction",
     "[{\"face\": \"y_max\", \"value\": [0, 1], \"kind\": \"follower\"}]",
     "/bodies/0/traction/0/kind", "unknown_value"},
    {BASE_PLANE, "/bodies/0/traction", "[{\"face\": \"z_max\", \"pressure\": 1}]",
     "/bodies/0/traction/0/face", "contradiction"},
    {BASE_PLANE, "/bodies/0/traction", "[{\"face\": 3, \"pressure\": 1}]",
     "/bodies/0/traction/0/face", "type"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"polygon\": {\"vertices\": [[0, 0], [4, 0], [0, 4]]}, \"count\": 32, "
          "\"traction\": [{\"face\": \"side_1_to_3\", \"pressure\": 1}]"),
     "/bodies/0/traction/0/face", "contradiction"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1]}, "
          "\"traction\": [{\"face\": \"x_min\", \"pressure\": 1}]"),
     "/bodies/0/traction/0/face", "contradiction"},
    {BASE_SOLID, "/bodies/0/traction", "[{\"face\": \"x_min\", \"pressure\": 1}]",
     "/bodies/0/traction/0/face", "contradiction"},
    {BASE_SOLID, "/bodies/0/sphere/radius", "0", NULL, "range"},
    {BASE_SOLID, "/bodies/0/sphere/radius", "6", "/bodies/0", "outside"},
    {BASE_SOLID, "/bodies/0/spacing", "[3, 3, 3]", "/bodies/0", "volume_factor"},
    {BASE_PLANE, "/bodies/0/initial_stress", "\"lithostatic\"", NULL, "unknown_value"},
    {BASE_PLANE, "/bodies/0/initial_stress", "[1, 2, 3]", NULL, "length"},
    {BASE_PLANE, "/bodies/0/initial_stress", "[-1, -1, -1, 0, 5, 0]", "/bodies/0/initial_stress/4",
     "contradiction"},
    {BASE_PLANE, "/bodies/0/initial_stress/geostatic/k0", "\"jakey\"", NULL, "unknown_value"},
    {BASE_PLANE, "/bodies/0/initial_stress/geostatic/k0", "-1", NULL, "range"},
    {BASE_PLANE, "/bodies/0/initial_stress/hydrostatic", "{}", "/bodies/0/initial_stress/geostatic",
     "alternative"},
    {BASE_PLANE, "/gravity", NULL, "/bodies/0/initial_stress", "contradiction"},
    {BASE_FLUID, "/bodies/0/initial_stress", "{\"geostatic\": {\"k0\": 0.5}}", NULL,
     "contradiction"},
    {BASE_FLUID, "/bodies/0/initial_stress", "[-1, -2, -1, 0, 0, 0]", NULL, "contradiction"},
};

static void mistakes_of_materials(void **state)
{
    (void)state;
    mistakes_check(materials, sizeof materials / sizeof materials[0]);
}

static void mistakes_of_bodies(void **state)
{
    (void)state;
    mistakes_check(bodies, sizeof bodies / sizeof bodies[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_of_materials),
        cmocka_unit_test(mistakes_of_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
