/* SPDX-License-Identifier: Apache-2.0 */
/* A test double of talus/simulation.h: a cloud of points that falls and bounces on y = 0, chaotic
 * enough that a state restored wrongly shows. The scene's title carries what a test wants of it,
 * as words KEY=NUMBER:
 *   particles=N  delay_us=N (a step takes so long)  unstable=STEP  memory=STEP  warn=STEP  audit=1
 */
#include "talus/simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COLUMN_FIXED = 5, BLOB_COUNT = 3 };

/* Everything a checkpoint stores besides the arrays. */
struct fake_state {
    double time, duration, impulse, interval_begin, last_force, peak, peak_time;
    uint64_t step;
};

struct talus_simulation {
    struct fake_state state;
    double time_step, gravity;
    size_t particle_count;
    double *height, *velocity; /* [particle_count] */
    long delay_us, unstable, memory, warn, audit;
    bool warning_pending;
    struct talus_column *columns;
    size_t column_count;
    struct talus_metric metrics[3];
    struct talus_blob blobs[BLOB_COUNT];
    double *saved; /* [2 * particle_count] heights and velocities of the last checkpoint */
    struct fake_state saved_state;
};

static long read_word(const char *title, const char *key, long fallback)
{
    const char *found = title == NULL ? NULL : strstr(title, key);
    return found == NULL ? fallback : strtol(found + strlen(key), NULL, 10);
}

static enum talus_status fail_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for particles");
}

static void name_column(struct talus_simulation *simulation, size_t index, const char *prefix,
                        const char *name, const char *unit)
{
    struct talus_column *column = &simulation->columns[index];
    (void)snprintf(column->name, sizeof column->name, "%s%s", prefix, name);
    (void)snprintf(column->unit, sizeof column->unit, "%s", unit);
}

static enum talus_status make_columns(struct talus_simulation *simulation,
                                      const struct talus_scene *scene, struct talus_error *error)
{
    simulation->column_count = COLUMN_FIXED + scene->probe_count;
    simulation->columns = calloc(simulation->column_count, sizeof *simulation->columns);
    if (simulation->columns == NULL)
        return fail_memory(error);
    name_column(simulation, 0, "time", "", "s");
    name_column(simulation, 1, "energy.kinetic", "", "J");
    name_column(simulation, 2, "reaction.floor.force.x", "", "N");
    name_column(simulation, 3, "reaction.floor.force.y", "", "N");
    name_column(simulation, 4, "reaction.floor.instant.y", "", "N");
    for (size_t index = 0; index < scene->probe_count; index++)
        name_column(simulation, COLUMN_FIXED + index, "probe.", scene->probes[index].name, "m");
    return TALUS_OK;
}

static void read_wishes(struct talus_simulation *made, const char *title)
{
    made->particle_count = (size_t)read_word(title, "particles=", 100);
    made->delay_us = read_word(title, "delay_us=", 0);
    made->unstable = read_word(title, "unstable=", -1);
    made->memory = read_word(title, "memory=", -1);
    made->warn = read_word(title, "warn=", -1);
    made->audit = read_word(title, "audit=", 0);
}

/* NULL when memory ran out. */
static struct talus_simulation *make_simulation(const struct talus_scene *scene,
                                                struct talus_error *error)
{
    struct talus_simulation *made = calloc(1, sizeof *made);
    if (made == NULL)
        return NULL;
    made->state.duration = scene->duration;
    made->time_step = scene->solver.time_step;
    made->gravity = 9.81;
    read_wishes(made, scene->title);
    made->height = malloc((made->particle_count + 1) * sizeof *made->height);
    made->velocity = calloc(made->particle_count + 1, sizeof *made->velocity);
    if (made->height == NULL || made->velocity == NULL ||
        make_columns(made, scene, error) != TALUS_OK) {
        talus_simulation_destroy(made);
        return NULL;
    }
    for (size_t index = 0; index < made->particle_count; index++)
        made->height[index] = 0.1 + 0.01 * (double)(index % 97);
    return made;
}

enum talus_status talus_simulation_create(const struct talus_scene *scene,
                                          const struct talus_simulation_options *options,
                                          struct talus_simulation **simulation,
                                          struct talus_error *error)
{
    (void)options;
    *simulation = make_simulation(scene, error);
    return *simulation == NULL ? fail_memory(error) : TALUS_OK;
}

void talus_simulation_destroy(struct talus_simulation *simulation)
{
    if (simulation == NULL)
        return;
    free(simulation->height);
    free(simulation->velocity);
    free(simulation->columns);
    free(simulation->saved);
    free(simulation);
}

static double next_step(const struct talus_simulation *simulation)
{
    double left = simulation->state.duration - simulation->state.time;
    return left < 1.5 * simulation->time_step ? left : simulation->time_step;
}

enum talus_status talus_simulation_step(struct talus_simulation *simulation,
                                        struct talus_error *error)
{
    struct fake_state *state = &simulation->state;
    double step = next_step(simulation);
    double impulse = 0.0;
    if ((long)state->step == simulation->unstable)
        return talus_error_set(error, TALUS_UNSTABLE, "non_finite", "",
                               "particle 7 at t = %g s: velocity is not finite; halve the step",
                               state->time);
    if ((long)state->step == simulation->memory)
        return fail_memory(error);
    for (size_t index = 0; index < simulation->particle_count; index++) {
        simulation->velocity[index] -= step * simulation->gravity;
        simulation->height[index] += step * simulation->velocity[index];
        if (simulation->height[index] < 0.0) {
            impulse -= (1.0 + 0.9) * -simulation->velocity[index];
            simulation->height[index] = -simulation->height[index];
            simulation->velocity[index] *= -0.9 - 0.01 * sin(1e4 * simulation->height[index]);
        }
    }
    state->impulse += impulse;
    state->last_force = impulse / step;
    state->step++;
    state->time = step == state->duration - state->time ? state->duration : state->time + step;
    if (fabs(state->last_force) > state->peak) {
        state->peak = fabs(state->last_force);
        state->peak_time = state->time;
    }
    if ((long)state->step == simulation->warn)
        simulation->warning_pending = true;
    if (simulation->delay_us > 0)
        (void)usleep((useconds_t)simulation->delay_us);
    return TALUS_OK;
}

void talus_simulation_get_state(const struct talus_simulation *simulation,
                                struct talus_simulation_state *state)
{
    *state = (struct talus_simulation_state){
        .time = simulation->state.time,
        .duration = simulation->state.duration,
        .step = simulation->state.step,
        .time_step = next_step(simulation),
        .critical_time_step = 2.0 * simulation->time_step,
        .particle_count = simulation->particle_count,
        .initial_particle_count = simulation->particle_count,
        .active_cell_count = 1,
        .memory_bytes = 2 * simulation->particle_count * sizeof(double),
        .finished = simulation->state.time >= simulation->state.duration,
    };
}

enum talus_status talus_simulation_set_duration(struct talus_simulation *simulation,
                                                double duration, struct talus_error *error)
{
    if (!(duration >= simulation->state.time))
        return talus_error_set(error, TALUS_INVALID, "range", "/duration",
                               "the end (%g s) lies before the present time (%g s)", duration,
                               simulation->state.time);
    simulation->state.duration = duration;
    return TALUS_OK;
}

bool talus_simulation_is_nearest(const struct talus_simulation *simulation, double time)
{
    double now = simulation->state.time;
    double next = now + next_step(simulation);
    return now >= simulation->state.duration || fabs(next - time) >= fabs(now - time);
}

const struct talus_column *talus_simulation_columns(const struct talus_simulation *simulation,
                                                    size_t *count)
{
    *count = simulation->column_count;
    return simulation->columns;
}

void talus_simulation_sample(struct talus_simulation *simulation, double *row)
{
    struct fake_state *state = &simulation->state;
    double energy = 0.0, height = 0.0;
    for (size_t index = 0; index < simulation->particle_count; index++) {
        energy += 0.5 * simulation->velocity[index] * simulation->velocity[index];
        height += simulation->height[index] / (double)simulation->particle_count;
    }
    double length = state->time - state->interval_begin;
    row[0] = state->time;
    row[1] = energy;
    row[2] = 0.0;
    row[3] = length > 0.0 ? state->impulse / length : 0.0;
    row[4] = state->last_force;
    for (size_t index = COLUMN_FIXED; index < simulation->column_count; index++)
        row[index] = height;
    state->impulse = 0.0;
    state->interval_begin = state->time;
}

const struct talus_metric *talus_simulation_metrics(struct talus_simulation *simulation,
                                                    size_t *count)
{
    simulation->metrics[0] =
        (struct talus_metric){.name = "reaction.floor.peak", .value = simulation->state.peak};
    simulation->metrics[1] = (struct talus_metric){.name = "reaction.floor.peak_time",
                                                   .value = simulation->state.peak_time};
    simulation->metrics[2] = (struct talus_metric){.name = "energy_error", .value = (double)NAN};
    *count = 3;
    return simulation->metrics;
}

bool talus_simulation_take_warning(struct talus_simulation *simulation,
                                   struct talus_warning *warning)
{
    if (!simulation->warning_pending)
        return false;
    simulation->warning_pending = false;
    *warning = (struct talus_warning){.code = "time_step",
                                      .pointer = "/solver/time_step",
                                      .text = "the step is near the critical one"};
    return true;
}

enum talus_status talus_simulation_audit(struct talus_simulation *simulation,
                                         struct talus_error *error)
{
    if (simulation->audit == 0)
        return TALUS_OK;
    return talus_error_set(error, TALUS_AUDIT, "energy", "", "energy grew by 3 %%");
}

void talus_simulation_read_positions(const struct talus_simulation *simulation, double *out)
{
    for (size_t index = 0; index < simulation->particle_count; index++) {
        out[3 * index] = 0.001 * (double)index;
        out[3 * index + 1] = simulation->height[index];
        out[3 * index + 2] = 0.0;
    }
}

enum talus_status talus_simulation_read_field(const struct talus_simulation *simulation,
                                              enum talus_field field, double *out,
                                              struct talus_error *error)
{
    for (size_t index = 0; index < simulation->particle_count; index++) {
        switch (field) {
        case TALUS_FIELD_VELOCITY:
            out[3 * index] = 0.0;
            out[3 * index + 1] = simulation->velocity[index];
            out[3 * index + 2] = 0.0;
            break;
        case TALUS_FIELD_STRESS:
            for (size_t component = 0; component < 6; component++)
                out[6 * index + component] = (double)(index * 10 + component);
            break;
        case TALUS_FIELD_ID:
            out[index] = (double)index;
            break;
        case TALUS_FIELD_BODY:
            out[index] = 0.0;
            break;
        default:
            return talus_error_set(error, TALUS_UNSUPPORTED, "field", "", "not in this double");
        }
    }
    return TALUS_OK;
}

size_t talus_simulation_read_nodes(const struct talus_simulation *simulation, double *position,
                                   double *mass, double *velocity, double *reaction, double *area)
{
    enum { NODE_COUNT = 3 };
    for (size_t node = 0; node < NODE_COUNT; node++) {
        for (size_t axis = 0; axis < 3; axis++) {
            if (position != NULL)
                position[3 * node + axis] = axis == 0 ? (double)node : 0.0;
            if (velocity != NULL)
                velocity[3 * node + axis] = 0.0;
            if (reaction != NULL)
                reaction[3 * node + axis] = axis == 1 ? simulation->state.last_force / 3.0 : 0.0;
        }
        if (mass != NULL)
            mass[node] = 1.0;
        if (area != NULL)
            area[node] = 0.25;
    }
    return NODE_COUNT;
}

const struct talus_blob *talus_simulation_checkpoint(struct talus_simulation *simulation,
                                                     size_t *count)
{
    size_t count_of_particles = simulation->particle_count;
    size_t bytes = count_of_particles * sizeof(double);
    free(simulation->saved);
    simulation->saved = malloc(2 * bytes + 1);
    if (simulation->saved == NULL)
        return NULL;
    simulation->saved_state = simulation->state;
    memcpy(simulation->saved, simulation->height, bytes);
    memcpy(simulation->saved + count_of_particles, simulation->velocity, bytes);
    simulation->blobs[0] = (struct talus_blob){
        .name = "state", .data = &simulation->saved_state, .bytes = sizeof simulation->saved_state};
    simulation->blobs[1] =
        (struct talus_blob){.name = "height", .data = simulation->saved, .bytes = bytes};
    simulation->blobs[2] = (struct talus_blob){
        .name = "velocity", .data = simulation->saved + count_of_particles, .bytes = bytes};
    *count = BLOB_COUNT;
    return simulation->blobs;
}

enum talus_status talus_simulation_restore(const struct talus_scene *scene,
                                           const struct talus_simulation_options *options,
                                           const struct talus_blob *blobs, size_t blob_count,
                                           struct talus_simulation **simulation,
                                           struct talus_error *error)
{
    (void)options;
    struct talus_simulation *made = make_simulation(scene, error);
    if (made == NULL)
        return fail_memory(error);
    size_t bytes = made->particle_count * sizeof(double);
    if (blob_count != BLOB_COUNT || strcmp(blobs[0].name, "state") != 0 ||
        blobs[0].bytes != sizeof made->state || strcmp(blobs[1].name, "height") != 0 ||
        blobs[1].bytes != bytes || blobs[2].bytes != bytes) {
        talus_simulation_destroy(made);
        return talus_error_set(error, TALUS_INVALID, "checkpoint", "", "blobs of another scene");
    }
    memcpy(&made->state, blobs[0].data, blobs[0].bytes);
    memcpy(made->height, blobs[1].data, bytes);
    memcpy(made->velocity, blobs[2].data, bytes);
    *simulation = made;
    return TALUS_OK;
}

void talus_simulation_get_clock(struct talus_simulation *simulation,
                                struct talus_simulation_state *state)
{
    talus_simulation_get_state(simulation, state);
}

void talus_simulation_expect_sample(struct talus_simulation *simulation)
{
    (void)simulation;
}

uint64_t talus_simulation_state_hash(const struct talus_simulation *simulation)
{
    uint64_t hash = 14695981039346656037u; /* FNV-1a */
    for (size_t index = 0; index < simulation->particle_count; index++) {
        uint64_t bits = 0;
        memcpy(&bits, &simulation->height[index], sizeof bits);
        hash = (hash ^ bits) * 1099511628211u;
    }
    return hash;
}

enum talus_status talus_simulation_estimate(const struct talus_scene *scene,
                                            struct talus_estimate *estimate,
                                            struct talus_error *error)
{
    (void)error;
    *estimate = (struct talus_estimate){.time_step = scene->solver.time_step};
    return TALUS_OK;
}

const char *talus_simulation_isa(void)
{
    return "none";
}

enum talus_precision talus_simulation_precision(void)
{
    return TALUS_PRECISION_DOUBLE;
}
