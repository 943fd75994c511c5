/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_scene.h"

#include "scene/scene_json.h"
#include "state/lanes.h"
#include "talus/simulation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Cells are cubes of 1/16 m, so that bodies lie on grid lines. */
#define CELL 0.0625
/* Empty cells between the compact body and the end of its grid, whole blocks. */
#define MARGIN ((double)LANE_COUNT)
/* Columns are twice as high as wide, and waves 15 times as fast as sqrt(g height). */
#define ASPECT 2.0
#define SLOWNESS 15.0
#define WAVE_SPEED 67.0
/* Run-up in units of sqrt(height / g): the collapse is at its fastest. */
#define COLLAPSE_TIMES 1.5
/* Width of the ground in widths of the column. */
#define GROUND 16.0
/* Drift of elastic bodies over the wave speed, and how many cells before the measurement. */
#define DRIFT 0.02
#define DRIFT_CELLS 3.3

static json_t *vector(const double *values, size_t count)
{
    json_t *list = json_array();
    for (size_t index = 0; index < count; index++)
        (void)json_array_append_new(list, json_real(values[index]));
    return list;
}

/* Cells of a box of about that many particles, `aspect` times as high as wide. */
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

static json_t *grid_json(const struct benchmark_setup *setup, const double min[3],
                         const double max[3])
{
    double low[3], high[3];
    for (size_t axis = 0; axis < 3; axis++) {
        low[axis] = min[axis] * CELL;
        high[axis] = max[axis] * CELL;
    }
    return json_pack("{s:f, s:o, s:o}", "cell", CELL, "min",
                     vector(low, setup->subject->axis_count), "max",
                     vector(high, setup->subject->axis_count));
}

/* The body, its margin, and on all sides as much nothing as is asked for. */
static json_t *compact_grid(const struct benchmark_setup *setup, const double size[3])
{
    const double scale = pow(setup->domain_factor, 1.0 / (double)setup->subject->axis_count);
    const double least = setup->body == BENCHMARK_FLOW ? 8.0 * MARGIN : MARGIN;
    double min[3], max[3];
    for (size_t axis = 0; axis < 3; axis++) {
        const double empty = fmax(least, 0.5 * (scale - 1.0) * size[axis]);
        const double margin = MARGIN * ceil(empty / MARGIN);
        min[axis] = -margin;
        max[axis] = size[axis] + margin;
    }
    return grid_json(setup, min, max);
}

/* Ground on all of y = 0, and room for the collapse between walls. */
static json_t *flow_grid(const struct benchmark_setup *setup, const double size[3])
{
    const double min[3] = {0, 0, 0};
    const double max[3] = {GROUND * size[0], size[1] + 2.0 * MARGIN, GROUND * size[2]};
    return grid_json(setup, min, max);
}

static json_t *body_json(const struct benchmark_setup *setup, const double size[3], double drift)
{
    const size_t axes = setup->subject->axis_count;
    const double zero[3] = {0, 0, 0};
    const double top[3] = {size[0] * CELL, size[1] * CELL, size[2] * CELL};
    const double velocity[3] = {drift, 0.6 * drift, 0.8 * drift};
    return json_pack("{s:s, s:s, s:{s:o, s:o}, s:i, s:o}", "name", "body", "material", "material",
                     "box", "min", vector(zero, axes), "max", vector(top, axes),
                     "particles_per_cell", (int)setup->per_axis, "velocity",
                     vector(velocity, axes));
}

static json_t *wall_json(const char *name, const double point[3], const double normal[3],
                         size_t axes, bool rough)
{
    json_t *wall = json_pack("{s:s, s:{s:o, s:o}, s:s, s:b}", "name", name, "plane", "point",
                             vector(point, axes), "normal", vector(normal, axes), "condition",
                             rough ? "friction" : "slip", "tension_release", 1);
    if (rough)
        (void)json_object_set_new(wall, "friction_angle", json_real(20));
    return wall;
}

/* A rough ground, and slippery walls at the planes of symmetry and at the ends of the grid. */
static json_t *walls_json(const struct benchmark_setup *setup, const double size[3])
{
    static const char *const low[3] = {"x_min", "ground", "z_min"};
    static const char *const high[3] = {"x_max", NULL, "z_max"};
    const size_t axes = setup->subject->axis_count;
    json_t *list = json_array();
    for (size_t axis = 0; axis < axes; axis++) {
        double point[3] = {0, 0, 0}, normal[3] = {0, 0, 0};
        normal[axis] = 1.0;
        (void)json_array_append_new(
            list, wall_json(low[axis], point, normal, axes, axis == 1 && setup->subject->plastic));
        if (high[axis] == NULL)
            continue;
        point[axis] = GROUND * size[axis] * CELL;
        normal[axis] = -1.0;
        (void)json_array_append_new(list, wall_json(high[axis], point, normal, axes, false));
    }
    return list;
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

/* What is run up starts with modified_last at the default step. A slope of hat functions is
 * measured though it is unstable at light nodes: compact bodies hardly cross cells. */
static json_t *solver_json(const struct benchmark_setup *setup)
{
    const bool compact = setup->body == BENCHMARK_COMPACT;
    json_t *solver =
        json_pack("{s:s, s:s, s:s, s:b, s:{s:s, s:s}}", "shape", benchmark_shape_word(setup),
                  "transfer", benchmark_transfer_word(setup), "stress_update",
                  compact ? benchmark_ordering_word(setup) : "modified_last", "allow_unstable",
                  setup->transfer != NULL, "anti_locking", "control", benchmark_control_word(setup),
                  "field", benchmark_field_word(setup));
    if (compact && setup->courant > 0)
        (void)json_object_set_new(solver, "courant", json_real(setup->courant));
    return solver;
}

/* What all scenes share; takes over `grid` and `body`. */
static json_t *scene_json(const struct benchmark_setup *setup, const char *material, json_t *grid,
                          json_t *body)
{
    return json_pack("{s:s, s:f, s:o, s:o, s:{s:o}, s:[o], s:o}", "dimension",
                     setup->subject->axis_count == 2 ? "plane_strain" : "solid", "duration", 1e6,
                     "grid", grid, "solver", solver_json(setup), "materials", "material",
                     json_loads(material, 0, NULL), "bodies", body, "output", output_json(setup));
}

static json_t *box_json(const struct benchmark_setup *setup, double *develop_time)
{
    const double drift = setup->body == BENCHMARK_FLOW ? DRIFT * WAVE_SPEED : 0.0;
    double size[3];
    size_body(setup, 1.0, size);
    *develop_time = drift > 0 ? DRIFT_CELLS * CELL / drift : 0.0;
    return scene_json(setup, setup->subject->material, compact_grid(setup, size),
                      body_json(setup, size, drift));
}

static json_t *column_json(const struct benchmark_setup *setup, double *develop_time)
{
    double size[3];
    size_body(setup, ASPECT, size);
    const double height = size[1] * CELL;
    const double speed = WAVE_SPEED / SLOWNESS;
    const double gravity[3] = {0, -speed * speed / height, 0};
    json_t *scene = scene_json(setup, setup->subject->flow_material, flow_grid(setup, size),
                               body_json(setup, size, 0.0));
    *develop_time = COLLAPSE_TIMES * height / speed;
    if (scene != NULL &&
        (json_object_set_new(scene, "gravity", vector(gravity, setup->subject->axis_count)) != 0 ||
         json_object_set_new(scene, "boundaries", walls_json(setup, size)) != 0)) {
        json_decref(scene);
        return NULL;
    }
    return scene;
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

bool benchmark_scene_create(const struct benchmark_setup *setup, struct benchmark_scene *made)
{
    const bool falls = setup->body == BENCHMARK_FLOW && setup->subject->flow_material != NULL;
    memset(made, 0, sizeof *made);
    json_t *root =
        falls ? column_json(setup, &made->develop_time) : box_json(setup, &made->develop_time);
    if (root == NULL) {
        (void)fprintf(stderr, "talus-benchmark: out of memory\n");
        return false;
    }
    const bool read = read_scene(root, &made->scene);
    made->scene.solver.precision = talus_simulation_precision();
    json_decref(root);
    return read;
}

void benchmark_scene_release(struct benchmark_scene *made)
{
    talus_scene_release(&made->scene);
}
