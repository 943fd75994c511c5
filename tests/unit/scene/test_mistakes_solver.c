/* SPDX-License-Identifier: Apache-2.0 */
/* Mistakes of the solver. */
#include "mistake_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct mistake solver[] = {
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
     "alternative"},
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
     "/solver/stabilise/settle/time", "incomplete"},
    {BASE_SOLID, "/solver", "{\"stabilise\": {\"settle\": {\"time\": 1}}}", "/bodies/0/velocity",
     "contradiction"},
    {BASE_PLANE, "/solver/stabilise", "{\"local_damping\": 1}", "/solver/stabilise/local_damping",
     "range"},
    {BASE_PLANE, "/solver/stabilise", "[]", NULL, "type"},
    {BASE_PLANE, "/solver/precision", "\"half\"", NULL, "unknown_value"},
    {BASE_PLANE, "/solver/tolerance", "1e-3", NULL, "unsupported"},
    {BASE_PLANE, "/solver/solver", "1", NULL, "unknown_key"},
};

static void mistakes_of_solver(void **state)
{
    (void)state;
    mistakes_check(solver, sizeof solver / sizeof solver[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_of_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
