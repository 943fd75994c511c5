/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/job_run.h"

#include <math.h>
#include <string.h>
#include <time.h>

/* Seconds between two looks at signals, limits and clocks: short for people, long for steps. */
static const double attend_interval = 0.005;

double job_now(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

enum talus_status job_take_sample(struct job_run *run, struct talus_error *error)
{
    struct talus_simulation_state state;
    double *row = NULL;
    talus_simulation_get_clock(run->simulation, &state);
    if (run->counters.sampled_step == state.step)
        return TALUS_OK;
    enum talus_status status = history_add(&run->history, &row, error);
    if (status != TALUS_OK)
        return status;
    talus_simulation_sample(run->simulation, row);
    memcpy(run->last_row, row, run->column_count * sizeof *row);
    run->counters.sampled_step = state.step;
    run->announced = false;
    return TALUS_OK;
}

enum talus_status job_take_first(struct job_run *run, struct talus_error *error)
{
    struct talus_simulation_state state;
    talus_simulation_get_clock(run->simulation, &state);
    if (state.time < 0.0)
        return TALUS_OK;
    enum talus_status status = job_take_sample(run, error);
    if (status == TALUS_OK)
        status = job_take_frame(run, error);
    return status;
}

/* True if the present step end is the one nearest to k x every for the next k, which then moves
 * on. Where `every` is below the time step several k fall on one step end. */
static bool is_due(const struct job_run *run, double time, double every, uint64_t *next)
{
    bool due = false;
    if (!(every > 0.0))
        return false;
    while (talus_simulation_is_nearest(run->simulation, (double)*next * every)) {
        double behind = floor(time / every);
        due = true;
        *next += 1;
        if (behind > (double)*next && behind < 0x1p53)
            *next = (uint64_t)behind;
    }
    return due;
}

static enum talus_status take_due(struct job_run *run, const struct talus_simulation_state *state,
                                  struct talus_error *error)
{
    const struct talus_output_options *output = &run->scene.output;
    struct job_counters *counters = &run->counters;
    bool sample = is_due(run, state->time, output->history_every, &counters->next_sample);
    bool frame = is_due(run, state->time, output->frames_every, &counters->next_frame);
    enum talus_status status = TALUS_OK;
    if (sample)
        status = job_take_sample(run, error);
    if (status == TALUS_OK && frame)
        status = job_take_frame(run, error);
    return status;
}

/* Only the end of the next step can tell for sure, by the length of the step after it. */
static void expect_sample(struct job_run *run, const struct talus_simulation_state *state)
{
    const double every = run->scene.output.history_every;
    if (every > 0.0 &&
        state->time + 1.55 * state->time_step > (double)run->counters.next_sample * every)
        talus_simulation_expect_sample(run->simulation);
}

enum talus_status job_loop(struct job_run *run, struct talus_error *error)
{
    struct talus_simulation_state state;
    enum talus_status status = TALUS_OK;
    talus_simulation_get_clock(run->simulation, &state);
    status = job_repeat_moves(run, state.step, error);
    talus_simulation_get_clock(run->simulation, &state);
    while (status == TALUS_OK && !state.finished) {
        double begin = job_now();
        double stepped = (double)state.particle_count;
        bool settles = state.time < 0.0;
        expect_sample(run, &state);
        status = talus_simulation_step(run->simulation, error);
        double now = job_now();
        run->counters.step_seconds += now - begin;
        if (status != TALUS_OK)
            return status;
        run->counters.particle_steps += stepped;
        talus_simulation_get_clock(run->simulation, &state);
        /* At the end every time is "nearest"; the last row and frame are taken below. */
        if (state.finished)
            break;
        status = settles ? job_take_first(run, error) : take_due(run, &state, error);
        if (status == TALUS_OK)
            status = job_repeat_moves(run, state.step, error);
        if (status == TALUS_OK && now - run->clock.attended >= attend_interval)
            status = job_attend(run, now, error);
        if (status != TALUS_OK)
            return status;
        /* Steering may have moved the end to the present time. */
        talus_simulation_get_clock(run->simulation, &state);
    }
    if (status == TALUS_OK)
        status = job_take_sample(run, error);
    if (status == TALUS_OK)
        status = job_take_frame(run, error);
    return status;
}
