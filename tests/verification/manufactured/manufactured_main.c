/* SPDX-License-Identifier: Apache-2.0 */
/* Runs a scene with the body force and the initial velocity of a manufactured solution and prints
 * one line of JSON: by how much the particles missed their places.
 *   talus-manufactured PROBLEM SCENE.json [THREADS] */
#include "manufactured.h"
#include "materials/material.h"
#include "scene/scene_json.h"
#include "talus/simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PROBLEM_COUNT = 2 };
static const struct manufactured *const problems[PROBLEM_COUNT] = {&axis_aligned, &vortex};

/* What the callbacks see: where each particle was in the beginning, by id. */
struct stage {
    const struct manufactured *problem;
    struct elastic elastic;
    double *reference; /* [3 * particle count] owned; NULL while it is being found */
    double start;      /* [s] instant of the initial velocities: half a step before t = 0, since in
                          the scheme they belong to the middle of the step behind */
};

struct errors {
    double largest, square, steps; /* relative to the amplitude; particle-steps */
    size_t count;
};

static void force(void *context, uint32_t id, const double position[3], double time, double out[3])
{
    const struct stage *stage = context;
    stage->problem->body_force(&stage->elastic,
                               stage->reference == NULL ? position : stage->reference + 3 * id,
                               time, out);
}

static void start_velocity(void *context, uint32_t id, const double position[3], double time,
                           double out[3])
{
    const struct stage *stage = context;
    (void)id;
    stage->problem->velocity(position, time + stage->start, out);
}

static struct talus_simulation *create(const struct talus_scene *scene, struct stage *stage,
                                       int threads)
{
    const struct talus_simulation_options options = {.threads = threads,
                                                     .body_force = force,
                                                     .initial_velocity = start_velocity,
                                                     .context = stage};
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    if (talus_simulation_create(scene, &options, &simulation, &error) != TALUS_OK)
        (void)fprintf(stderr, "%s: %s\n", error.pointer, error.text);
    return simulation;
}

/* The places of the particles by id and the first step, from a simulation that does not run. */
static double *find_references(const struct talus_scene *scene, struct stage *stage)
{
    struct talus_simulation *simulation = create(scene, stage, 1);
    if (simulation == NULL)
        return NULL;
    struct talus_simulation_state state;
    talus_simulation_get_state(simulation, &state);
    double *reference = calloc(3 * state.particle_count, sizeof *reference);
    if (reference != NULL)
        talus_simulation_read_positions(simulation, reference);
    stage->start = -0.5 * state.time_step;
    talus_simulation_destroy(simulation);
    return reference;
}

static int compare(const struct talus_simulation *simulation, const struct stage *stage,
                   struct errors *errors)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(simulation, &state);
    double *position = calloc(3 * state.particle_count, sizeof *position);
    if (position == NULL)
        return -1;
    talus_simulation_read_positions(simulation, position);
    double square = 0;
    errors->count = 0;
    for (size_t particle = 0; particle < state.particle_count; particle++) {
        const double *from = stage->reference + 3 * particle, *to = position + 3 * particle;
        double expected[2];
        if (!stage->problem->counts(from))
            continue;
        stage->problem->displacement(from, state.time, expected);
        const double miss = hypot(to[0] - from[0] - expected[0], to[1] - from[1] - expected[1]) /
                            stage->problem->amplitude;
        errors->largest = fmax(errors->largest, miss);
        square += miss * miss;
        errors->count++;
    }
    errors->square = fmax(errors->square, square / (double)errors->count);
    free(position);
    return 0;
}

static int run(struct talus_simulation *simulation, const struct stage *stage,
               struct errors *errors)
{
    enum { LOOKS = 20 };
    struct talus_simulation_state state;
    talus_simulation_get_state(simulation, &state);
    for (int look = 1; look <= LOOKS; look++) {
        const double until = state.duration * look / LOOKS;
        do {
            struct talus_error error = {0};
            if (talus_simulation_step(simulation, &error) != TALUS_OK) {
                (void)fprintf(stderr, "%s\n", error.text);
                return -1;
            }
            errors->steps += (double)state.particle_count;
        } while (!talus_simulation_is_nearest(simulation, until));
        if (compare(simulation, stage, errors) != 0)
            return -1;
    }
    return 0;
}

static struct elastic elastic_of(const struct talus_scene *scene)
{
    double bulk, shear;
    const double *values = scene->materials[0].values;
    material_elastic_moduli(material_table[scene->materials[0].model_index], values, &bulk, &shear);
    return (struct elastic){values[MATERIAL_VALUE_DENSITY], bulk - 2 * shear / 3, shear};
}

/* Of the processor. */
static double seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int solve(const struct talus_scene *scene, const struct manufactured *problem, int threads)
{
    struct stage stage = {.problem = problem, .elastic = elastic_of(scene)};
    struct errors errors = {0};
    stage.reference = find_references(scene, &stage);
    struct talus_simulation *simulation =
        stage.reference == NULL ? NULL : create(scene, &stage, threads);
    const double begin = seconds();
    const int status = simulation == NULL ? -1 : run(simulation, &stage, &errors);
    if (status == 0)
        (void)printf("{\"rms\": %.9g, \"largest\": %.9g, \"particles\": %zu, "
                     "\"particle_steps\": %.9g, \"seconds\": %.6g}\n",
                     sqrt(errors.square), errors.largest, errors.count, errors.steps,
                     seconds() - begin);
    talus_simulation_destroy(simulation);
    free(stage.reference);
    return status;
}

int main(int argument_count, char **arguments)
{
    const struct manufactured *problem = NULL;
    for (size_t index = 0; argument_count > 2 && index < PROBLEM_COUNT; index++)
        if (strcmp(arguments[1], problems[index]->name) == 0)
            problem = problems[index];
    if (problem == NULL) {
        (void)fprintf(stderr, "usage: %s axis-aligned|vortex SCENE.json [THREADS]\n", arguments[0]);
        return 2;
    }
    struct talus_scene scene;
    struct scene_issues issues = {0}, warnings = {0};
    json_t *effective = NULL;
    int status = 1;
    if (scene_read_file(arguments[2], &scene, &effective, &issues, &warnings) != TALUS_OK) {
        for (size_t index = 0; index < issues.count; index++)
            (void)fprintf(stderr, "%s: %s\n", issues.items[index].pointer,
                          issues.items[index].detail);
        status = 10;
    } else {
        const int threads = argument_count > 3 ? (int)strtol(arguments[3], NULL, 10) : 1;
        status = solve(&scene, problem, threads) == 0 ? 0 : 11;
        talus_scene_release(&scene);
    }
    json_decref(effective);
    scene_issues_release(&issues);
    scene_issues_release(&warnings);
    return status;
}
