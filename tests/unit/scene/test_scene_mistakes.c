/* SPDX-License-Identifier: Apache-2.0 */
/* One mistake at a time: each is found, is the only one reported, and is reported at its key. */
#include "scene_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

struct mistake {
    enum fixture_base base;
    const char *change;  /* pointer */
    const char *value;   /* JSON; NULL: removed */
    const char *pointer; /* where it must be found; NULL: where it was made */
    const char *code;
};

#define SLOPE(REST) "{\"magnitude\": 10, \"up\": [0, 1], \"slopes\": [{\"angle\": 20, " REST "}]}"
#define BODY(REST) "{\"name\": \"heap\", \"material\": \"soil\", " REST "}"

static const struct mistake mistakes[] = {
    /* ---- root ---- */
    {BASE_PLANE, "/dimension", NULL, NULL, "required"},
    {BASE_PLANE, "/dimension", "\"plane\"", NULL, "unknown_value"},
    {BASE_PLANE, "/dimension", "3", NULL, "type"},
    {BASE_PLANE, "/dimension", "\"plane_stress\"", "/materials/soil/model", "contradiction"},
    {BASE_FLUID, "/dimension", "\"plane_stress\"", "/materials/water/model", "contradiction"},
    {BASE_AXIAL, "/grid/min/0", "-0.1", NULL, "range"},
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
    {BASE_PLANE, "/gravity", "[0, [[1, -9], [1, -9.81]]]", "/gravity/1/1/0", "range"},
    {BASE_PLANE, "/gravity", "{\"magnitude\": 10, \"up\": [0, 1]}", "/gravity/slopes", "required"},
    {BASE_PLANE, "/gravity", "{\"magnitude\": 10, \"up\": [0, 0], \"slopes\": []}", "/gravity/up",
     "range"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0.1], \"below\": 3"), "/gravity/slopes/0/along",
     "contradiction"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0]"), "/gravity/slopes/0/below", "required"},
    {BASE_PLANE, "/gravity",
     SLOPE("\"along\": [1, 0], \"below\": 3, \"beyond\": 3, \"about\": [0, 0]"),
     "/gravity/slopes/0/beyond", "contradiction"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0], \"beyond\": 3"), "/gravity/slopes/0/about",
     "required"},
    {BASE_PLANE, "/gravity", SLOPE("\"along\": [1, 0], \"below\": 3, \"about\": [0, 0]"),
     "/gravity/slopes/0/about", "contradiction"},
    {BASE_PLANE, "/audits", "{\"energy_growth\": -1}", "/audits/energy_growth", "range"},
    {BASE_PLANE, "/audits", "{\"energy_grow\": 1}", "/audits/energy_grow", "unknown_key"},
    /* ---- grid ---- */
    {BASE_PLANE, "/grid/cell", NULL, NULL, "required"},
    {BASE_PLANE, "/grid/cel", "1", NULL, "unknown_key"},
    {BASE_PLANE, "/grid/cell", "-0.5", NULL, "range"},
    {BASE_PLANE, "/grid/cell", "[0.5, 0]", "/grid/cell/1", "range"},
    {BASE_PLANE, "/grid/cell", "[0.5, 0.5, 0.5]", NULL, "length"},
    {BASE_PLANE, "/grid/cell", "[1e-6, 0.5]", "/grid/max/0", "range"},
    {BASE_PLANE, "/grid/max", "[20, 0]", "/grid/max/1", "range"},
    {BASE_PLANE, "/grid/max", "[3, 10]", "/bodies/0", "range"},
    {BASE_PLANE, "/grid/outside", "\"ignore\"", NULL, "unknown_value"},
    {BASE_PLANE, "/grid/outside_mass_limit", "1.5", NULL, "range"},
    /* ---- solver ---- */
    {BASE_PLANE, "/solver/kind", "\"quasi_static\"", NULL, "unsupported"},
    {BASE_PLANE, "/solver/time_step", "0", NULL, "range"},
    {BASE_PLANE, "/solver/time_step", "0.1", NULL, "over_critical"},
    {BASE_PLANE, "/solver/time_step", "\"automatic\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/courant", "0", NULL, "range"},
    {BASE_PLANE, "/solver/courant", "1.5", NULL, "over_critical"},
    {BASE_PLANE, "/solver/allow_unstable", "1", NULL, "type"},
    {BASE_PLANE, "/solver/cpdi_hybrid", "{\"scale\": 0}", "/solver/cpdi_hybrid/scale", "range"},
    {BASE_PLANE, "/solver/cpdi_hybrid", "{\"count\": 4}", NULL, "contradiction"},
    {BASE_PLANE, "/solver/cpdi_hybrid", "{\"count\": 2.5}", "/solver/cpdi_hybrid/count", "type"},
    {BASE_PLANE, "/solver/shape", "\"liner\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver", "{\"shape\": \"quadratic\", \"anti_locking\": {\"control\": \"cell\"}}",
     "/solver/anti_locking", "contradiction"},
    {BASE_PLANE, "/solver", "{\"shape\": \"quadratic\", \"transfer\": \"apic\"}",
     "/solver/transfer", "contradiction"},
    {BASE_PLANE, "/solver/gimp_scaling", "\"F\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/gimp_scaling", "\"stretch\"", NULL, "contradiction"},
    {BASE_PLANE, "/solver/transfer", "\"apic\"", NULL, "unstable"},
    {BASE_PLANE, "/solver/transfer", "\"tpic\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver", "{\"transfer\": \"pic\", \"pic_rate\": 1}", "/solver/pic_rate",
     "contradiction"},
    {BASE_PLANE, "/solver", "{\"transfer\": \"apic\", \"flip_ratio\": 0.9}", "/solver/flip_ratio",
     "contradiction"},
    {BASE_PLANE, "/solver", "{\"pic_rate\": 1, \"flip_ratio\": 0.9}", "/solver/flip_ratio",
     "contradiction"},
    {BASE_PLANE, "/solver/pic_rate", "-1", NULL, "range"},
    {BASE_PLANE, "/solver/flip_ratio", "1.01", NULL, "range"},
    {BASE_PLANE, "/solver/theta", "-0.5", NULL, "range"},
    {BASE_PLANE, "/solver/strain_theta", "0", NULL, "unstable"},
    {BASE_PLANE, "/solver", "{\"stress_update\": \"first\", \"strain_theta\": 0.5}",
     "/solver/strain_theta", "contradiction"},
    {BASE_PLANE, "/solver", "{\"pic_rate\": 1, \"strain_theta\": 0.5}", "/solver/strain_theta",
     "contradiction"},
    {BASE_PLANE, "/solver/strain_theta", "2", NULL, "range"},
    {BASE_PLANE, "/solver/strain", "\"rate\"", NULL, "unsupported"},
    {BASE_PLANE, "/solver/anti_locking/control", "\"nodes\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/anti_locking/averaging", "\"mean\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/anti_locking/averaging", "\"unweighted\"", NULL, "contradiction"},
    {BASE_PLANE, "/solver",
     "{\"precision\": \"single\","
     " \"anti_locking\": {\"control\": \"node\", \"field\": \"full\"}}",
     "/solver/precision", "precision"},
    {BASE_PLANE, "/solver/anti_locking/field", "\"fill\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/anti_locking", "{\"control\": \"none\", \"field\": \"full\"}",
     "/solver/anti_locking/field", "contradiction"},
    {BASE_PLANE, "/solver/anti_locking/apply", "\"stress\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/stabilise", "{\"front_smoothing\": {\"threshold\": 0}}",
     "/solver/stabilise/front_smoothing/threshold", "range"},
    {BASE_PLANE, "/solver/stabilise", "{\"front_smoothing\": {\"threshold\": 1.5}}",
     "/solver/stabilise/front_smoothing/threshold", "range"},
    {BASE_PLANE, "/solver/stabilise", "{\"front_smoothing\": {\"reading\": \"end\"}}",
     "/solver/stabilise/front_smoothing/reading", "unknown_value"},
    {BASE_PLANE, "/solver/stabilise", "{\"front_smoothing\": true}",
     "/solver/stabilise/front_smoothing", "type"},
    {BASE_PLANE, "/solver/stabilise", "{\"front_smoothing\": {}}",
     "/solver/stabilise/front_smoothing", "contradiction"},
    {BASE_PLANE, "/solver",
     "{\"stress_update\": \"first\", \"stabilise\": {\"front_smoothing\": {}}}",
     "/solver/stabilise/front_smoothing", "contradiction"},
    {BASE_PLANE, "/solver",
     "{\"stress_update\": \"last\", \"shape\": \"quadratic\", \"stabilise\": {\"front_smoothing\": "
     "{}}}",
     "/solver/stabilise/front_smoothing", "contradiction"},
    {BASE_PLANE, "/solver",
     "{\"stress_update\": \"last\", \"anti_locking\": {\"control\": \"node\"}, \"stabilise\": "
     "{\"front_smoothing\": {}}}",
     "/solver/stabilise/front_smoothing", "contradiction"},
    {BASE_PLANE, "/solver/stabilise", "{\"small_mass\": \"floor\"}", "/solver/stabilise/small_mass",
     "unknown_value"},
    {BASE_PLANE, "/solver",
     "{\"shape\": \"bspline2\", \"stabilise\": {\"small_mass\": \"redistribute\"}}",
     "/solver/stabilise/small_mass", "contradiction"},
    {BASE_PLANE, "/solver/stabilise", "{\"settle\": {\"time\": -1}}",
     "/solver/stabilise/settle/time", "range"},
    {BASE_PLANE, "/solver/stabilise", "{\"settle\": {\"damping\": 5}}",
     "/solver/stabilise/settle/time", "required"},
    {BASE_SOLID, "/solver", "{\"stabilise\": {\"settle\": {\"time\": 1}}}", "/bodies/0/velocity",
     "contradiction"},
    {BASE_PLANE, "/solver/stabilise", "{\"local_damping\": 1}", "/solver/stabilise/local_damping",
     "range"},
    {BASE_PLANE, "/solver/stabilise", "[]", NULL, "type"},
    {BASE_PLANE, "/solver/precision", "\"half\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/tolerance", "1e-3", NULL, "unsupported"},
    {BASE_PLANE, "/solver/solver", "1", NULL, "unknown_key"},
    /* ---- materials ---- */
    {BASE_PLANE, "/materials/soil/model", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/model", "\"sand\"", NULL, "unknown_value"},
    {BASE_PLANE, "/materials/soil/density", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/density", "0", NULL, "range"},
    {BASE_PLANE, "/materials/soil/density", "1e31", NULL, "range"},
    {BASE_PLANE, "/materials/soil/bulk_modulus", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/young_modulus", "1e6", NULL, "contradiction"},
    {BASE_PLANE, "/materials/soil/friction_angle", "95", NULL, "range"},
    {BASE_PLANE, "/materials/soil/friction_angle", NULL, NULL, "required"},
    {BASE_PLANE, "/materials/soil/cone_slope", "0.5", NULL, "contradiction"},
    {BASE_PLANE, "/materials/soil/cohesion", "5", "/materials/soil/cone_strength", "contradiction"},
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
     "/materials/soil/friction", "contradiction"},
    {BASE_PLANE, "/materials/soil",
     "{\"model\": \"mohr_coulomb\", \"density\": 2000,"
     "\"bulk_modulus\": 1e7, \"shear_modulus\": 5e6, \"friction_angle\": 30, \"cohesion\": 1e3,"
     "\"tensile_strength\": 2e3}",
     "/materials/soil/tensile_strength", "contradiction"},
    {BASE_PLANE, "/materials/soil",
     "{\"model\": \"tresca\", \"density\": 2000, \"bulk_modulus\": 1e7, \"shear_modulus\": 5e6,"
     "\"cohesion\": 1e3, \"residual_cohesion\": 500}",
     "/materials/soil/softening_rate", "required"},
    {BASE_PLANE, "/materials/soil", "[]", NULL, "type"},
    {BASE_PLANE, "/materials", "[]", NULL, "type"},
    /* ---- bodies ---- */
    {BASE_PLANE, "/bodies", "[]", NULL, "range"},
    {BASE_PLANE, "/bodies", "{}", NULL, "type"},
    {BASE_PLANE, "/bodies/0", "7", NULL, "type"},
    {BASE_PLANE, "/bodies/0/material", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/material", "\"sol\"", NULL, "unknown_name"},
    {BASE_PLANE, "/bodies/0/name", "\"my heap\"", NULL, "name"},
    {BASE_PLANE, "/bodies/0/box", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/sphere", "{\"centre\": [1, 1], \"radius\": 1}", NULL, "contradiction"},
    {BASE_PLANE, "/bodies/0/box/max", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/box/max", "[4, 0]", "/bodies/0/box/max/1", "range"},
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
     "/bodies/0/polygon", "contradiction"},
    {BASE_SOLID, "/bodies/0",
     "{\"material\": \"rubber\", \"count\": 9, \"polygon\": "
     "{\"vertices\": [[1, 1, 1], [2, 1, 1], [1, 2, 1]]}}",
     "/bodies/0/polygon/vertices", "contradiction"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [0]}"),
     "/bodies/0/points/volumes/0", "range"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1, 2]}"),
     "/bodies/0/points/volumes", "length"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [], \"volumes\": []}"),
     "/bodies/0/points/positions", "length"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[1, -1]], \"volumes\": [1]}"),
     "/bodies/0", "range"},
    {BASE_PLANE, "/bodies/0", BODY("\"points\": {\"positions\": [[9, 1]], \"volumes\": [1]}"),
     "/bodies/0", "contradiction"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1]}, \"spacing\": 1"),
     "/bodies/0/spacing", "contradiction"},
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
     "/bodies/0", "range"},
    {BASE_PLANE, "/bodies/0/rotate", "{\"angle\": 10}", "/bodies/0/rotate/about", "required"},
    {BASE_PLANE, "/bodies/0/rotate", "{\"angle\": 1, \"about\": [1, 1], \"axis\": [0, 1]}",
     "/bodies/0/rotate/axis", "contradiction"},
    {BASE_SOLID, "/bodies/0/rotate", "{\"angle\": 1, \"about\": [1, 1, 1]}",
     "/bodies/0/rotate/axis", "required"},
    {BASE_SOLID, "/bodies/0/rotate", "{\"angle\": 1, \"about\": [1, 1, 1], \"axis\": [0, 0, 0]}",
     "/bodies/0/rotate/axis", "range"},
    {BASE_PLANE, "/bodies/0/clip", "{\"min\": [5, null]}", "/bodies/0", "empty"},
    {BASE_PLANE, "/bodies/0/clip", "{\"low\": [5, null]}", "/bodies/0/clip/low", "unknown_key"},
    {BASE_PLANE, "/bodies/0/particles_per_cell", NULL, NULL, "required"},
    {BASE_PLANE, "/bodies/0/particles_per_cell", "[2, 0]", "/bodies/0/particles_per_cell/1",
     "range"},
    {BASE_PLANE, "/bodies/0/particles_per_cell", "[1e6, 1e6]", "/bodies/0", "range"},
    {BASE_PLANE, "/bodies/0/spacing", "[0.1, 0.1]", NULL, "contradiction"},
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
     "/bodies/0/velocity/beam_mode/to", "range"},
    {BASE_PLANE, "/bodies/0/velocity",
     "{\"beam_mode\": {\"mode\": 1, \"from\": [0, 0], \"to\": [1, 0], \"tip\": [0.1, 1]}}",
     "/bodies/0/velocity/beam_mode/tip", "contradiction"},
    {BASE_PLANE, "/bodies/0/velocity", "5", NULL, "type"},
    {BASE_PLANE, "/bodies/0/traction", "{}", NULL, "type"},
    {BASE_PLANE, "/bodies/0/traction", "[{\"face\": \"y_max\", \"kind\": \"dead\"}]",
     "/bodies/0/traction/0/value", "required"},
    {BASE_PLANE, "/bodies/0/traction",
     "[{\"face\": \"y_max\", \"value\": [0, 1], \"pressure\": 1}]", "/bodies/0/traction/0/pressure",
     "contradiction"},
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
     "/bodies/0/traction/0/face", "unknown_value"},
    {BASE_PLANE, "/bodies/0/traction", "[{\"face\": 3, \"pressure\": 1}]",
     "/bodies/0/traction/0/face", "type"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"polygon\": {\"vertices\": [[0, 0], [4, 0], [0, 4]]}, \"count\": 32, "
          "\"traction\": [{\"face\": \"side_1_to_3\", \"pressure\": 1}]"),
     "/bodies/0/traction/0/face", "unknown_value"},
    {BASE_PLANE, "/bodies/0",
     BODY("\"points\": {\"positions\": [[1, 1]], \"volumes\": [1]}, "
          "\"traction\": [{\"face\": \"x_min\", \"pressure\": 1}]"),
     "/bodies/0/traction/0/face", "contradiction"},
    {BASE_SOLID, "/bodies/0/traction", "[{\"face\": \"x_min\", \"pressure\": 1}]",
     "/bodies/0/traction/0/face", "unknown_value"},
    {BASE_SOLID, "/bodies/0/sphere/radius", "0", NULL, "range"},
    {BASE_SOLID, "/bodies/0/sphere/radius", "6", "/bodies/0", "range"},
    {BASE_SOLID, "/bodies/0/spacing", "[3, 3, 3]", "/bodies/0", "volume_factor"},
    {BASE_PLANE, "/bodies/0/initial_stress", "\"lithostatic\"", NULL, "unknown_value"},
    {BASE_PLANE, "/bodies/0/initial_stress", "[1, 2, 3]", NULL, "length"},
    {BASE_PLANE, "/bodies/0/initial_stress", "[-1, -1, -1, 0, 5, 0]", "/bodies/0/initial_stress/4",
     "contradiction"},
    {BASE_PLANE, "/bodies/0/initial_stress/geostatic/k0", "\"jakey\"", NULL, "unknown_value"},
    {BASE_PLANE, "/bodies/0/initial_stress/geostatic/k0", "-1", NULL, "range"},
    {BASE_PLANE, "/bodies/0/initial_stress/hydrostatic", "{}", "/bodies/0/initial_stress/geostatic",
     "contradiction"},
    {BASE_PLANE, "/gravity", NULL, "/bodies/0/initial_stress", "contradiction"},
    {BASE_FLUID, "/bodies/0/initial_stress", "{\"geostatic\": {\"k0\": 0.5}}", NULL,
     "contradiction"},
    {BASE_FLUID, "/bodies/0/initial_stress", "[-1, -2, -1, 0, 0, 0]", NULL, "contradiction"},
    /* ---- boundaries ---- */
    {BASE_PLANE, "/boundaries/0/condition", NULL, NULL, "required"},
    {BASE_PLANE, "/boundaries/0/condition", "\"slide\"", NULL, "unknown_value"},
    {BASE_PLANE, "/boundaries/0/condition", "\"slip\"", "/boundaries/0/friction_angle",
     "contradiction"},
    {BASE_PLANE, "/boundaries/0/friction_angle", NULL, "/boundaries/0/friction_coefficient",
     "required"},
    {BASE_PLANE, "/boundaries/0/friction_angle", "90", NULL, "range"},
    {BASE_PLANE, "/boundaries/0/friction_coefficient", "0.5", "/boundaries/0/friction_angle",
     "contradiction"},
    {BASE_PLANE, "/boundaries/0/plane/normal", "[0, 0]", NULL, "range"},
    {BASE_PLANE, "/boundaries/0/plane", NULL, NULL, "required"},
    {BASE_PLANE, "/boundaries/0/faces", "{}", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/0/adhesion", "-10", NULL, "range"},
    {BASE_PLANE, "/boundaries/0/turbulence", "0", NULL, "range"},
    {BASE_PLANE, "/boundaries/1/adhesion", "10", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/1/faces", "{\"x_min\": {\"condition\": \"slip\", \"turbulence\": 9}}",
     "/boundaries/1/faces/x_min/turbulence", "contradiction"},
    {BASE_PLANE, "/boundaries/1/condition", "\"velocity\"", "/boundaries/1/velocity", "required"},
    {BASE_PLANE, "/boundaries/1/velocity", "[1, 0]", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/1/components", "[\"x\"]", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/1/stays", "true", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"velocity\","
     "\"velocity\": [0, [[1, 0], [1, -2]]]}",
     "/boundaries/2/velocity/1/1/0", "range"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"velocity\","
     "\"velocity\": [0, -1], \"components\": [\"z\"]}",
     "/boundaries/2/components/0", "unknown_value"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"velocity\","
     "\"velocity\": [0, -1], \"wall\": \"keep\"}",
     "/boundaries/2/wall", "contradiction"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"slip\","
     "\"from\": 2, \"until\": 1}",
     "/boundaries/2/until", "range"},
    {BASE_PLANE, "/boundaries/0/until", "\"later\"", NULL, "type"},
    {BASE_PLANE, "/boundaries/0/wall", "\"hold\"", NULL, "unknown_value"},
    {BASE_PLANE, "/boundaries/0/tension_release", "\"yes\"", NULL, "type"},
    {BASE_PLANE, "/boundaries/0/body", "\"heep\"", NULL, "unknown_name"},
    {BASE_PLANE, "/boundaries/0/body", "\"heap\"", NULL, "unsupported"},
    {BASE_PLANE, "/boundaries/0/moment_about", "[0]", NULL, "length"},
    {BASE_PLANE, "/probes/1/name", "\"runout\"", NULL, "duplicate"},
    {BASE_PLANE, "/boundaries/1/box/max", "[8, 6]", "/boundaries/1/box/max/0", "range"},
    {BASE_PLANE, "/boundaries/1/faces", "{\"z_min\": {\"condition\": \"slip\"}}",
     "/boundaries/1/faces/z_min", "unknown_key"},
    {BASE_PLANE, "/boundaries/1/faces", "{\"x_min\": {\"condition\": \"friction\"}}",
     "/boundaries/1/faces/x_min/friction_coefficient", "required"},
    {BASE_PLANE, "/boundaries/1/faces", "{\"x_min\": {\"condition\": \"eliminate\"}}",
     "/boundaries/1/faces/x_min", "contradiction"},
    {BASE_SOLID, "/boundaries/0/face/max", "[8, 1, 6]", "/boundaries/0/face/max", "contradiction"},
    {BASE_SOLID, "/boundaries/0/face/normal", "[1, 0, 0]", NULL, "contradiction"},
    {BASE_SOLID, "/boundaries/0/face",
     "{\"point\": [0, 0, 0], \"normal\": [0, 1, 0],"
     "\"size\": [1]}",
     "/boundaries/0/face/size", "length"},
    {BASE_SOLID, "/boundaries/0/face/max", NULL, NULL, "required"},
    /* ---- probes and references ---- */
    {BASE_PLANE, "/probes/0/kind", "\"runout\"", NULL, "unknown_value"},
    {BASE_PLANE, "/probes/0/along", NULL, NULL, "required"},
    {BASE_PLANE, "/probes/0/along", "[0, 0]", NULL, "range"},
    {BASE_PLANE, "/probes/0/part", "\"kinetic\"", NULL, "unknown_key"},
    {BASE_PLANE, "/probes/0/on", "\"flor\"", NULL, "unknown_name"},
    {BASE_PLANE, "/probes/0/mean_from", "2", NULL, "range"},
    {BASE_PLANE, "/probes/1/component", "\"z\"", NULL, "unknown_value"},
    {BASE_PLANE, "/probes/1/boundary", NULL, NULL, "required"},
    {BASE_PLANE, "/probes/1/boundary", "\"floor\"", "/probes/1/face", "contradiction"},
    {BASE_PLANE, "/probes/1/quantity", "\"contact_area\"", "/probes/1/component", "contradiction"},
    {BASE_PLANE, "/probes/-", "{\"kind\": \"point\", \"at\": [1, 1]}", "/probes/2/field",
     "required"},
    {BASE_PLANE, "/probes/-", "{\"kind\": \"integral\", \"field\": \"stres\"}", "/probes/2/field",
     "unknown_value"},
    {BASE_SOLID, "/probes", "[{\"kind\": \"height\"}]", "/probes/0/along", "required"},
    {BASE_PLANE, "/references/0/probe", "\"run\"", NULL, "unknown_name"},
    {BASE_PLANE, "/references/-", "{\"probe\": \"load\", \"of_job\": \"../etc\"}",
     "/references/1/of_job", "name"},
    {BASE_PLANE, "/references/0/value", "1", "/references/0/curve", "contradiction"},
    {BASE_PLANE, "/references/0/curve", NULL, "/references/0/value", "required"},
    {BASE_PLANE, "/references/0/curve", "[[1, 2], [0, 3]]", "/references/0/curve/1", "range"},
    {BASE_PLANE, "/references/0/curve", "[[1, 2], [2]]", "/references/0/curve/1", "length"},
    {BASE_PLANE, "/references/-", "{\"probe\": \"load\", \"value\": 1, \"at\": 3}",
     "/references/1/at", "range"},
    {BASE_PLANE, "/references/-", "{\"probe\": \"runout\", \"value\": 1}", "/references/1/name",
     "duplicate"},
    /* ---- output ---- */
    {BASE_PLANE, "/output", "{\"frames\": {\"every\": -1}}", "/output/frames/every", "range"},
    {BASE_PLANE, "/output", "{\"frames\": {\"every\": 1e-7}}", "/output/frames/every", "range"},
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
enum { MISTAKE_COUNT = sizeof mistakes / sizeof mistakes[0] };

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

static void bases_are_valid(void **state)
{
    (void)state;
    for (int base = BASE_PLANE; base <= BASE_FLUID; base++) {
        struct fixture_result result;
        json_t *scene = fixture_scene((enum fixture_base)base);
        fixture_read(scene, &result);
        for (size_t index = 0; index < result.issues.count; index++)
            (void)fprintf(stderr, "%s: %s\n", result.issues.items[index].pointer,
                          result.issues.items[index].detail);
        assert_int_equal(result.status, TALUS_OK);
        assert_int_equal(result.warnings.count, 0);
        fixture_result_release(&result);
        json_decref(scene);
    }
}

static void each_mistake_is_found_alone(void **state)
{
    (void)state;
    size_t failures = 0;
    for (size_t index = 0; index < MISTAKE_COUNT; index++)
        failures += !is_found(&mistakes[index]);
    assert_int_equal(failures, 0);
    assert_true(MISTAKE_COUNT >= 90);
}

static void all_mistakes_are_reported_at_once(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/grid/cel", "1");
    fixture_change(scene, "/solver/shape", "\"linera\"");
    fixture_change(scene, "/materials/soil/density", "-1");
    fixture_change(scene, "/bodies/0/velocity", "[1]");
    fixture_change(scene, "/boundaries/1/box/max", "[0, 0]");
    fixture_change(scene, "/probes/1/component", "\"w\"");
    fixture_change(scene, "/output", "{\"frame\": {}}");
    fixture_read(scene, &result);
    assert_int_equal(result.issues.count, 8); /* the box is wrong on two axes */
    assert_non_null(fixture_find(&result.issues, "/output/frame", "unknown_key"));
    assert_non_null(fixture_find(&result.issues, "/grid/cel", "unknown_key"));
    fixture_result_release(&result);
    json_decref(scene);
}

static void there_are_fifty_at_most(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    for (int index = 0; index < 80; index++) {
        char pointer[32];
        (void)snprintf(pointer, sizeof pointer, "/solver/x%d", index);
        fixture_change(scene, pointer, "1");
    }
    fixture_read(scene, &result);
    assert_int_equal(result.issues.count, SCENE_ISSUE_MAX);
    fixture_result_release(&result);
    json_decref(scene);
}

static void near_misses_are_suggested(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/bodies/0/particels_per_cell", "[2, 2]");
    fixture_change(scene, "/solver/anti_locking/control", "\"cel\"");
    fixture_read(scene, &result);
    const struct scene_issue *key =
        fixture_find(&result.issues, "/bodies/0/particels_per_cell", "unknown_key");
    const struct scene_issue *word =
        fixture_find(&result.issues, "/solver/anti_locking/control", "unknown_value");
    assert_non_null(key);
    assert_non_null(strstr(key->detail, "'particles_per_cell'"));
    assert_non_null(word);
    assert_non_null(strstr(word->detail, "\"cell\""));
    assert_string_equal(json_string_value(word->given), "cel");
    assert_int_equal(json_array_size(word->allowed), 4);
    fixture_result_release(&result);
    json_decref(scene);
}

static void depth_is_limited(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE), *inner = json_array();
    for (int depth = 0; depth < 1000; depth++)
        inner = json_pack("[o]", inner);
    assert_int_equal(json_object_set_new(scene, "title", inner), 0);
    fixture_read(scene, &result);
    assert_non_null(fixture_find(&result.issues, "", "depth"));
    fixture_result_release(&result);
    json_decref(scene);
}

static void pointers_escape_their_keys(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    assert_int_equal(json_object_set_new(scene, "a/b~c", json_null()), 0);
    fixture_read(scene, &result);
    assert_non_null(fixture_find(&result.issues, "/a~1b~0c", "unknown_key"));
    fixture_result_release(&result);
    json_decref(scene);
}

static void issues_become_json(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/duration", "-1");
    fixture_read(scene, &result);
    json_t *list = scene_issues_json(&result.issues);
    json_t *issue = json_array_get(list, 0);
    assert_int_equal(json_array_size(list), 1);
    assert_string_equal(json_string_value(json_object_get(issue, "pointer")), "/duration");
    assert_string_equal(json_string_value(json_object_get(issue, "code")), "range");
    assert_true(json_number_value(json_object_get(issue, "given")) == -1.0);
    assert_true(json_number_value(json_object_get(json_object_get(issue, "allowed"), "above")) ==
                0.0);
    json_decref(list);
    fixture_result_release(&result);
    json_decref(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bases_are_valid),
        cmocka_unit_test(each_mistake_is_found_alone),
        cmocka_unit_test(all_mistakes_are_reported_at_once),
        cmocka_unit_test(there_are_fifty_at_most),
        cmocka_unit_test(near_misses_are_suggested),
        cmocka_unit_test(depth_is_limited),
        cmocka_unit_test(pointers_escape_their_keys),
        cmocka_unit_test(issues_become_json),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
