/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_case.h"

#include "scene/scene_json.h"
#include "state/lanes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CELL 0.0625
/* Empty cells between the compact body and the end of its grid, a multiple of the lane count. */
enum { MARGIN = LANE_COUNT };

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
    {"elastic_2d", 2, ELASTIC, ELASTIC, 3, false},
    {"drucker_prager_cap_2d", 2, CONE("4e3"), CONE("100"), 3, true},
    {"fluid_2d", 2, FLUID, FLUID, 3, false},
    {"elastic_3d", 3, ELASTIC, ELASTIC, 2, false},
    {"drucker_prager_cap_3d", 3, CONE("4e3"), CONE("100"), 2, true},
    {"matsuoka_nakai_3d", 3, MATSUOKA_NAKAI("2e3"), MATSUOKA_NAKAI("50"), 2, true},
    {"j2_3d", 3, J2("4e3"), J2("2e3"), 2, true},
    {"newtonian_fluid_3d", 3, FLUID, FLUID, 2, false},
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

const char *benchmark_body_name(enum benchmark_body body)
{
    return body == BENCHMARK_COMPACT ? "compact" : "flow";
}

static json_t *vector(const double *values, size_t count)
{
    json_t *list = json_array();
    for (size_t index = 0; index < count; index++)
        (void)json_array_append_new(list, json_real(values[index]));
    return list;
}

/* Cells of a box of about that many particles, `aspect` times as high as wide; whole blocks along
 * x. */
static void size_body(const struct benchmark_setup *setup, double aspect, double size[3])
{
    const double axes = (double)setup->subject->axis_count;
    const double cells = (double)setup->particles / pow((double)setup->per_axis, axes);
    const double width = pow(cells / aspect, 1.0 / axes);
    size[0] = LANE_COUNT * fmax(1.0, round(width / LANE_COUNT));
    const double rest = pow(cells / aspect / size[0], 1.0 / (axes - 1.0));
    size[1] = fmax(1.0, round(aspect * rest));
    size[2] = setup->subject->axis_count == 3 ? fmax(1.0, round(cells / (size[0] * size[1]))) : 1.0;
}

/* The grid: the body, its margin, and on all sides as much nothing as is asked for. */
static void size_grid(const struct benchmark_setup *setup, const double size[3], double min[3],
                      double max[3])
{
    const double scale = pow(setup->domain_factor, 1.0 / (double)setup->subject->axis_count);
    for (size_t axis = 0; axis < 3; axis++) {
        const double empty = fmax(MARGIN, 0.5 * (scale - 1.0) * size[axis]);
        const double margin = MARGIN * ceil(empty / MARGIN);
        min[axis] = -margin * CELL;
        max[axis] = (size[axis] + margin) * CELL;
    }
}

static json_t *body_json(const struct benchmark_setup *setup, const double size[3])
{
    const size_t axes = setup->subject->axis_count;
    const double zero[3] = {0, 0, 0};
    const double top[3] = {size[0] * CELL, size[1] * CELL, size[2] * CELL};
    return json_pack("{s:s, s:s, s:{s:o, s:o}, s:i}", "name", "body", "material", "material", "box",
                     "min", vector(zero, axes), "max", vector(top, axes), "particles_per_cell",
                     (int)setup->per_axis);
}

static json_t *solver_json(const struct benchmark_setup *setup)
{
    return json_pack("{s:s, s:{s:s}}", "stress_update", setup->last ? "last" : "modified_last",
                     "anti_locking", "control", setup->cell ? "cell" : "none");
}

static json_t *output_json(const struct benchmark_setup *setup)
{
    json_t *fields = json_array();
    if (setup->tracked) {
        (void)json_array_append_new(fields, json_string("strain"));
        (void)json_array_append_new(fields, json_string("plastic_strain"));
    }
    return json_pack("{s:{s:f, s:o}}", "frames", "every", 0.0, "fields", fields);
}

static json_t *compact_json(const struct benchmark_setup *setup)
{
    double size[3], min[3], max[3];
    const size_t axes = setup->subject->axis_count;
    size_body(setup, 1.0, size);
    size_grid(setup, size, min, max);
    return json_pack("{s:s, s:f, s:{s:f, s:o, s:o}, s:o, s:{s:o}, s:[o], s:o}", "dimension",
                     axes == 2 ? "plane_strain" : "solid", "duration", 1e6, "grid", "cell", CELL,
                     "min", vector(min, axes), "max", vector(max, axes), "solver",
                     solver_json(setup), "materials", "material",
                     json_loads(setup->subject->material, 0, NULL), "bodies",
                     body_json(setup, size), "output", output_json(setup));
}

static bool read_scene(const json_t *root, struct talus_scene *scene)
{
    json_t *effective = NULL;
    struct scene_issues issues = {0}, warnings = {0};
    const enum talus_status status = scene_read(root, scene, &effective, &issues, &warnings);
    for (size_t index = 0; status != TALUS_OK && index < issues.count; index++)
        (void)fprintf(stderr, "talus-benchmark: scene: %s: %s\n", issues.items[index].pointer,
                      issues.items[index].detail);
    scene_issues_release(&issues);
    scene_issues_release(&warnings);
    json_decref(effective);
    return status == TALUS_OK;
}

bool benchmark_scene(const struct benchmark_setup *setup, struct talus_scene *scene)
{
    json_t *root = compact_json(setup);
    if (root == NULL) {
        (void)fprintf(stderr, "talus-benchmark: out of memory\n");
        return false;
    }
    const bool read = read_scene(root, scene);
    json_decref(root);
    return read;
}
