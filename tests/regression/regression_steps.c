/* SPDX-License-Identifier: Apache-2.0 */
/* Takes some steps of a small scene, for callgrind to count: regression_steps SCENE. Without an
 * argument: the names of the scenes. Prints build, instruction set, and particles times steps. */
#include "simulation_fixture.h"
#include "talus/version.h"

#include <stdio.h>

enum { STEPS_BEFORE = 20, STEPS_COUNTED = 30 };

struct regression_scene {
    const char *name, *model;
    size_t axis_count;
    bool last; /* stress_update: last */
    enum talus_anti_locking_control control;
    enum talus_anti_locking_field field;
};

/* One per main kernel. */
static const struct regression_scene scenes[] = {
    {"soil_3d", "drucker_prager_cap", 3, false, TALUS_CONTROL_NONE, TALUS_FIT_VOLUMETRIC},
    {"soil_3d_last", "drucker_prager_cap", 3, true, TALUS_CONTROL_NONE, TALUS_FIT_VOLUMETRIC},
    {"soil_3d_anti_locking", "drucker_prager_cap", 3, false, TALUS_CONTROL_CELL,
     TALUS_FIT_VOLUMETRIC},
    {"soil_3d_node", "drucker_prager_cap", 3, false, TALUS_CONTROL_NODE, TALUS_FIT_VOLUMETRIC},
    {"elastic_2d_last", "linear_elastic", 2, true, TALUS_CONTROL_NONE, TALUS_FIT_VOLUMETRIC},
    {"elastic_2d_node", "linear_elastic", 2, true, TALUS_CONTROL_NODE, TALUS_FIT_VOLUMETRIC},
    {"elastic_2d_node_full", "linear_elastic", 2, true, TALUS_CONTROL_NODE, TALUS_FIT_FULL},
    {"fluid_2d_anti_locking", "newtonian_fluid", 2, false, TALUS_CONTROL_CELL,
     TALUS_FIT_VOLUMETRIC},
    {"metal_3d_last", "j2", 3, true, TALUS_CONTROL_NONE, TALUS_FIT_VOLUMETRIC},
    {"mobilised_3d", "matsuoka_nakai", 3, false, TALUS_CONTROL_NONE, TALUS_FIT_VOLUMETRIC},
};

/* A block that slides over a rough floor and yields. */
static void build(struct simulation_fixture *fixture, const struct regression_scene *scene)
{
    static const int64_t count[3] = {32, 16, 8};
    static const double min[3] = {0.4, 0.2, 0.2}, max[3] = {2.4, 1.0, 0.6};
    simulation_fixture_init(fixture, scene->axis_count, 0.1, count);
    const size_t material = simulation_fixture_add_sample(fixture, material_find(scene->model));
    struct talus_body *body =
        simulation_fixture_add_box(fixture, material, min, max, scene->axis_count == 3 ? 2 : 4);
    body->velocity[0] = 2.0;
    fixture->scene.gravity[1] = -9.81;
    simulation_fixture_add_plane(fixture, "floor", 1, 0.2, 1, "friction", 0.3);
    if (scene->last)
        fixture->scene.solver.stress_update = TALUS_STRESS_LAST;
    fixture->scene.solver.anti_locking = scene->control;
    fixture->scene.solver.anti_locking_field = scene->field;
}

/* What callgrind counts. */
__attribute__((noinline)) void regression_counted_steps(struct talus_simulation *simulation);
__attribute__((noinline)) void regression_counted_steps(struct talus_simulation *simulation)
{
    simulation_run_steps(simulation, STEPS_COUNTED);
}

static int take_steps(const struct regression_scene *scene)
{
    struct simulation_fixture fixture;
    build(&fixture, scene);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    const size_t particles = simulation_particle_count(simulation);
    simulation_run_steps(simulation, STEPS_BEFORE);
    regression_counted_steps(simulation);
    talus_simulation_destroy(simulation);
    return printf("%s\n%s\n%zu\n", talus_build(), talus_simulation_isa(),
                  particles * STEPS_COUNTED) < 0;
}

int main(int argument_count, char **arguments)
{
    for (size_t index = 0; index < LENGTH(scenes); index++) {
        if (argument_count < 2)
            (void)puts(scenes[index].name);
        else if (strcmp(arguments[1], scenes[index].name) == 0)
            return take_steps(&scenes[index]);
    }
    return argument_count >= 2;
}
