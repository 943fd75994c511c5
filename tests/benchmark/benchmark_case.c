/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_case.h"

#include <string.h>

/* K = 5 MPa and G = 3 MPa: waves of some 67 m/s. Compact bodies yield within a few steps, on the
 * cone as well as at its tip. */
#define SOLID "\"density\": 2000, \"bulk_modulus\": 5e6, \"shear_modulus\": 3e6"
#define ELASTIC "{\"model\": \"linear_elastic\", " SOLID "}"
#define FLUID                                                                                      \
    "{\"model\": \"newtonian_fluid\", \"density\": 1000, \"bulk_modulus\": 5e6, \"viscosity\": 1}"
#define CONE(strength)                                                                             \
    "{\"model\": \"drucker_prager_cap\", " SOLID                                                   \
    ", \"friction_angle\": 30, \"cone_strength\": " strength ", \"flow_ratio\": 0.3}"
#define MATSUOKA_NAKAI(cohesion)                                                                   \
    "{\"model\": \"matsuoka_nakai\", " SOLID                                                       \
    ", \"friction\": {\"a0\": 30, \"a1\": 3000, \"a2\": 1e-6, \"a3\": 150, \"a4\": 15, "           \
    "\"a5\": 200}, \"cohesion\": " cohesion "}"
#define J2(strength)                                                                               \
    "{\"model\": \"j2\", " SOLID ", \"yield_stress\": " strength                                   \
    ", \"isotropic_hardening\": 0, \"kinematic_hardening\": 0}"

const struct benchmark_case benchmark_cases[] = {
    {"elastic_2d", 2, ELASTIC, NULL, 3, false, false},
    {"drucker_prager_cap_2d", 2, CONE("4e3"), CONE("100"), 3, true, true},
    {"newtonian_fluid_2d", 2, FLUID, FLUID, 3, false, true},
    {"elastic_3d", 3, ELASTIC, NULL, 2, false, false},
    {"drucker_prager_cap_3d", 3, CONE("4e3"), CONE("100"), 2, true, true},
    {"matsuoka_nakai_3d", 3, MATSUOKA_NAKAI("2e3"), MATSUOKA_NAKAI("50"), 2, true, false},
    {"j2_3d", 3, J2("4e3"), J2("2e3"), 2, true, false},
    {"newtonian_fluid_3d", 3, FLUID, FLUID, 2, false, false},
};
const size_t benchmark_case_count = sizeof benchmark_cases / sizeof benchmark_cases[0];

const struct benchmark_case *benchmark_case_find(const char *name)
{
    for (size_t index = 0; index < benchmark_case_count; index++) {
        if (strcmp(benchmark_cases[index].name, name) == 0)
            return &benchmark_cases[index];
    }
    return NULL;
}

const char *benchmark_body_word(const struct benchmark_setup *setup)
{
    return setup->body == BENCHMARK_COMPACT ? "compact" : "flow";
}

const char *benchmark_ordering_word(const struct benchmark_setup *setup)
{
    return setup->last ? "last" : "modified_last";
}

const char *benchmark_shape_word(const struct benchmark_setup *setup)
{
    return setup->shape == NULL ? "linear" : setup->shape;
}

const char *benchmark_transfer_word(const struct benchmark_setup *setup)
{
    return setup->transfer == NULL ? "flip" : setup->transfer;
}

const char *benchmark_control_word(const struct benchmark_setup *setup)
{
    return setup->control == NULL ? "none" : setup->control;
}

const char *benchmark_field_word(const struct benchmark_setup *setup)
{
    return setup->field == NULL ? "volumetric" : setup->field;
}
