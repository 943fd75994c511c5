/* SPDX-License-Identifier: Apache-2.0 */
/* Mistakes of boundaries, probes and references. */
#include "mistake_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct mistake boundaries[] = {
    {BASE_PLANE, "/boundaries/0/condition", NULL, NULL, "required"},
    {BASE_PLANE, "/boundaries/0/condition", "\"slide\"", NULL, "unknown_value"},
    {BASE_PLANE, "/boundaries/0/condition", "\"slip\"", "/boundaries/0/friction_angle",
     "unknown_key"},
    {BASE_PLANE, "/boundaries/0/friction_angle", NULL, "/boundaries/0/friction_coefficient",
     "required"},
    {BASE_PLANE, "/boundaries/0/friction_angle", "90", NULL, "range"},
    {BASE_PLANE, "/boundaries/0/friction_coefficient", "0.5", "/boundaries/0/friction_angle",
     "alternative"},
    {BASE_PLANE, "/boundaries/0/plane/normal", "[0, 0]", NULL, "direction"},
    {BASE_PLANE, "/boundaries/0/plane", NULL, NULL, "required"},
    {BASE_PLANE, "/boundaries/0/faces", "{}", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/0/adhesion", "-10", NULL, "range"},
    {BASE_PLANE, "/boundaries/0/turbulence", "0", NULL, "range"},
    {BASE_PLANE, "/boundaries/1/adhesion", "10", NULL, "unknown_key"},
    {BASE_PLANE, "/boundaries/1/faces", "{\"x_min\": {\"condition\": \"slip\", \"turbulence\": 9}}",
     "/boundaries/1/faces/x_min/turbulence", "unknown_key"},
    {BASE_PLANE, "/boundaries/1/condition", "\"velocity\"", "/boundaries/1/velocity", "incomplete"},
    {BASE_PLANE, "/boundaries/1/velocity", "[1, 0]", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/1/components", "[\"x\"]", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/1/stays", "true", NULL, "contradiction"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"velocity\","
     "\"velocity\": [0, [[1, 0], [1, -2]]]}",
     "/boundaries/2/velocity/1/1/0", "order"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"velocity\","
     "\"velocity\": [0, -1], \"components\": [\"z\"]}",
     "/boundaries/2/components/0", "dimension"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"velocity\","
     "\"velocity\": [0, -1], \"wall\": \"keep\"}",
     "/boundaries/2/wall", "contradiction"},
    {BASE_PLANE, "/boundaries/-",
     "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]}, \"condition\": \"slip\","
     "\"from\": 2, \"until\": 1}",
     "/boundaries/2/until", "order"},
    {BASE_PLANE, "/boundaries/0/until", "\"later\"", NULL, "type"},
    {BASE_PLANE, "/boundaries/0/wall", "\"hold\"", NULL, "unknown_value"},
    {BASE_PLANE, "/boundaries/0/tension_release", "\"yes\"", NULL, "type"},
    {BASE_PLANE, "/boundaries/0",
     "{\"plane\": {\"point\": [0, 0], \"normal\": [0, 1]}, \"condition\": \"eliminate\","
     " \"body\": \"heep\"}",
     "/boundaries/0/body", "unknown_name"},
    {BASE_PLANE, "/boundaries/0/body", "\"heap\"", NULL, "unsupported"},
    {BASE_PLANE, "/boundaries/0/moment_about", "[0]", NULL, "length"},
    {BASE_PLANE, "/probes/1/name", "\"runout\"", NULL, "taken"},
    {BASE_PLANE, "/boundaries/1/box/max", "[8, 6]", "/boundaries/1/box/max/0", "order"},
    {BASE_PLANE, "/boundaries/1/faces", "{\"z_min\": {\"condition\": \"slip\"}}",
     "/boundaries/1/faces/z_min", "dimension"},
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
};

static const struct mistake probes_references[] = {
    {BASE_PLANE, "/probes/0/kind", "\"runout\"", NULL, "unknown_value"},
    {BASE_PLANE, "/probes/0/along", NULL, NULL, "required"},
    {BASE_PLANE, "/probes/0/along", "[0, 0]", NULL, "direction"},
    {BASE_PLANE, "/probes/0/part", "\"kinetic\"", NULL, "unknown_key"},
    {BASE_PLANE, "/probes/0/on", "\"flor\"", NULL, "unknown_name"},
    {BASE_PLANE, "/probes/0/mean_from", "2", NULL, "order"},
    {BASE_PLANE, "/probes/1/component", "\"z\"", NULL, "dimension"},
    {BASE_PLANE, "/probes/1/boundary", NULL, NULL, "required"},
    {BASE_PLANE, "/probes/1/boundary", "\"floor\"", "/probes/1/face", "contradiction"},
    {BASE_PLANE, "/probes/1/quantity", "\"contact_area\"", "/probes/1/component", "contradiction"},
    {BASE_PLANE, "/probes/-", "{\"kind\": \"point\", \"at\": [1, 1]}", "/probes/2/field",
     "required"},
    {BASE_PLANE, "/probes/-", "{\"kind\": \"integral\", \"field\": \"stres\"}", "/probes/2/field",
     "unknown_value"},
    {BASE_SOLID, "/probes", "[{\"kind\": \"height\"}]", "/probes/0/along", "incomplete"},
    {BASE_PLANE, "/references/0/probe", "\"run\"", NULL, "unknown_name"},
    {BASE_PLANE, "/references/-", "{\"probe\": \"load\", \"of_job\": \"../etc\"}",
     "/references/1/of_job", "name"},
    {BASE_PLANE, "/references/0/value", "1", "/references/0/curve", "alternative"},
    {BASE_PLANE, "/references/0/curve", NULL, "/references/0/value", "required"},
    {BASE_PLANE, "/references/0/curve", "[[1, 2], [0, 3]]", "/references/0/curve/1", "order"},
    {BASE_PLANE, "/references/0/curve", "[[1, 2], [2]]", "/references/0/curve/1", "length"},
    {BASE_PLANE, "/references/-", "{\"probe\": \"load\", \"value\": 1, \"at\": 3}",
     "/references/1/at", "order"},
    {BASE_PLANE, "/references/-", "{\"probe\": \"runout\", \"value\": 1}", "/references/1/name",
     "taken"},
};

static void mistakes_of_boundaries(void **state)
{
    (void)state;
    mistakes_check(boundaries, sizeof boundaries / sizeof boundaries[0]);
}

static void mistakes_of_probes_references(void **state)
{
    (void)state;
    mistakes_check(probes_references, sizeof probes_references / sizeof probes_references[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_of_boundaries),
        cmocka_unit_test(mistakes_of_probes_references),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
