/* SPDX-License-Identifier: Apache-2.0 */
#include "output/lenient_text.h"
#include "worker/job_run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

struct job_usage job_measure(const struct job_run *run)
{
    struct rusage usage;
    struct job_usage measure = {.wall_seconds =
                                    run->counters.wall_seconds + job_now() - run->clock.start,
                                .cpu_seconds = run->counters.cpu_seconds,
                                .peak_memory_bytes = run->counters.peak_memory_bytes};
    if (getrusage(RUSAGE_SELF, &usage) == 0) {
        double peak = 1024.0 * (double)usage.ru_maxrss;
        measure.cpu_seconds += (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                               1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
        if (peak > measure.peak_memory_bytes)
            measure.peak_memory_bytes = peak;
    }
    return measure;
}

/* Share of the simulated time, and wall clock left at the pace of this attempt (NAN: unknown). */
struct pace {
    double fraction, eta_seconds;
};

static struct pace find_pace(const struct job_run *run, const struct talus_simulation_state *state,
                             double now)
{
    struct pace pace = {.fraction = 1.0, .eta_seconds = NAN};
    double done = state->time - run->clock.start_time;
    double left = state->duration - state->time;
    double settle = run->scene.solver.settle_time;
    if (state->duration + settle > 0.0 && !state->finished)
        pace.fraction = fmin((state->time + settle) / (state->duration + settle), 1.0);
    if (state->finished)
        pace.eta_seconds = 0.0;
    else if (done > 0.0)
        pace.eta_seconds = (now - run->clock.start) * left / done;
    return pace;
}

/* Particle-steps per second of wall clock inside the solver, so far. */
static double step_rate(const struct job_run *run)
{
    const struct job_counters *counters = &run->counters;
    return counters->step_seconds > 0.0 ? counters->particle_steps / counters->step_seconds : NAN;
}

enum talus_status job_report_progress(struct job_run *run, double now, struct talus_error *error)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(run->simulation, &state);
    struct pace pace = find_pace(run, &state, now);
    run->counters.progress_count++;
    return event_write(&run->events, PROTOCOL_PROGRESS,
                       json_pack("{s:f, s:f, s:I, s:o, s:I, s:o, s:o}", "fraction", pace.fraction,
                                 "time", state.time, "step", (json_int_t)state.step, "time_step",
                                 event_number(state.time_step), "particles",
                                 (json_int_t)state.particle_count, "particle_steps_per_second",
                                 event_number(step_rate(run)), "eta_seconds",
                                 event_number(pace.eta_seconds)),
                       error);
}

/* "  reaction wall 1.23e+04 N": the magnitude of the first reaction in the last row. */
static void describe_reaction(const struct job_run *run, char *text, size_t size)
{
    static const char prefix[] = "reaction.";
    double sum = 0.0;
    size_t length = 0; /* of "reaction.NAME" */
    const char *first = NULL;
    text[0] = '\0';
    for (size_t index = 0; index < run->column_count; index++) {
        const char *name = run->columns[index].name;
        const char *force = strstr(name, ".force.");
        if (strncmp(name, prefix, strlen(prefix)) != 0 || force == NULL)
            continue;
        if (first == NULL) {
            first = name;
            length = (size_t)(force - name);
        }
        if ((size_t)(force - name) == length && strncmp(name, first, length) == 0)
            sum += run->last_row[index] * run->last_row[index];
    }
    if (first != NULL)
        (void)snprintf(text, size, "  reaction %.*s %.3g N", (int)(length - strlen(prefix)),
                       first + strlen(prefix), sqrt(sum));
}

static void describe_eta(double seconds, char *text, size_t size)
{
    long total = isfinite(seconds) && seconds < 1e9 ? (long)(seconds + 0.5) : -1;
    if (total < 0)
        (void)snprintf(text, size, "?");
    else
        (void)snprintf(text, size, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
}

void job_print_progress(struct job_run *run, double now, bool last)
{
    struct talus_simulation_state state;
    char reaction[160], eta[32], line[400];
    talus_simulation_get_state(run->simulation, &state);
    struct pace pace = find_pace(run, &state, now);
    describe_reaction(run, reaction, sizeof reaction);
    describe_eta(pace.eta_seconds, eta, sizeof eta);
    (void)snprintf(line, sizeof line,
                   "%5.1f %%  t %.4g of %.4g s  step %llu  %.3g particle-steps/s  ETA %s%s",
                   100.0 * pace.fraction, state.time, state.duration,
                   (unsigned long long)state.step, step_rate(run), eta, reaction);
    job_log_progress(&run->log, line, last);
}

enum talus_status job_inform(struct job_run *run, const char *text, struct talus_error *error)
{
    job_log_write(&run->log, "info", text);
    return event_write(&run->events, PROTOCOL_LOG,
                       json_pack("{s:s, s:o}", "level", "info", "detail", lenient_text_json(text)),
                       error);
}

enum talus_status job_warn(struct job_run *run, const char *code, const char *pointer,
                           const char *text, struct talus_error *error)
{
    char line[1400];
    (void)snprintf(line, sizeof line, "%s%s%s", pointer, *pointer != '\0' ? ": " : "", text);
    job_log_write(&run->log, "warning", line);
    return event_write(&run->events, PROTOCOL_WARNING,
                       json_pack("{s:s, s:o, s:o}", "code", code, "pointer",
                                 lenient_text_json(pointer), "detail", lenient_text_json(text)),
                       error);
}
