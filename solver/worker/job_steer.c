/* SPDX-License-Identifier: Apache-2.0 */
/* Orders from outside: another end, a frame or a restart point now. The counts of what was carried
 * out are part of a checkpoint, so that a resumed run repeats the orders that fell with what came
 * after its checkpoint, and no others. */
#include "worker/job_run.h"

#include <math.h>
#include <stdio.h>

/* Notes what was done for the receipt; takes the reference to `details`. */
static enum talus_status note(struct job_run *run, const char *what, json_t *details,
                              struct talus_error *error)
{
    char at[EVENT_TIME_SIZE];
    struct talus_simulation_state state;
    talus_simulation_get_clock(run->simulation, &state);
    event_time(at);
    if (run->steering == NULL)
        run->steering = json_array();
    json_t *entry = json_pack("{s:s, s:s, s:I, s:f}", "what", what, "at", at, "step",
                              (json_int_t)state.step, "time", state.time);
    int failed = json_object_update(entry, details);
    json_decref(details);
    if (failed != 0) {
        json_decref(entry);
        entry = NULL;
    }
    return json_array_append_new(run->steering, entry) == 0
               ? TALUS_OK
               : talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a note");
}

/* Moves the end of the run to a time [s], or to the present if that is later. */
static enum talus_status move_end(struct job_run *run, double wanted, struct talus_error *error)
{
    struct talus_simulation_state state;
    char text[200];
    talus_simulation_get_clock(run->simulation, &state);
    if (!isfinite(wanted) || wanted <= 0.0)
        return job_warn(run, "control", "", "end_time is not a time after 0; it is left alone",
                        error);
    /* The run may have passed the wanted end by the time it hears of it: then it ends here. */
    const double end_time = fmax(wanted, state.time);
    if (end_time == state.duration)
        return TALUS_OK;
    enum talus_status status = talus_simulation_set_duration(run->simulation, end_time, error);
    if (status == TALUS_OK)
        status = note(
            run, "end_time",
            json_pack("{s:f, s:f, s:f}", "wanted", wanted, "from", state.duration, "to", end_time),
            error);
    if (status != TALUS_OK)
        return status;
    (void)snprintf(text, sizeof text, "the end is moved from %g s to %g s%s", state.duration,
                   end_time, end_time > wanted ? ", the present time" : "");
    return job_inform(run, text, error);
}

enum talus_status job_repeat_moves(struct job_run *run, uint64_t step, struct talus_error *error)
{
    const struct job_options *options = run->options;
    enum talus_status status = TALUS_OK;
    while (status == TALUS_OK && run->end_moves_made < options->end_move_count &&
           options->end_moves[run->end_moves_made].step <= step)
        status = move_end(run, options->end_moves[run->end_moves_made++].end_time, error);
    return status;
}

static bool is_wanted(const struct control_wish *wish, bool at_start, uint64_t *count)
{
    const bool wanted = (wish->at_once && !at_start) || wish->count > *count;
    if (wish->count > *count)
        *count = wish->count;
    return wanted;
}

enum talus_status job_steer(struct job_run *run, bool at_start, struct talus_error *error)
{
    struct control_orders orders;
    struct talus_error mistake = {.status = TALUS_OK};
    enum talus_status status = control_read(run->options->folder, &orders, &mistake);
    if (status != TALUS_OK)
        return job_warn(run, "control", "", mistake.text, error);
    if (orders.end_time_given)
        status = move_end(run, orders.end_time, error);
    if (status == TALUS_OK && is_wanted(&orders.frame, at_start, &run->counters.frame_orders)) {
        status = note(run, "frame_now", json_object(), error);
        if (status == TALUS_OK)
            status = job_take_frame(run, error);
    }
    if (status == TALUS_OK &&
        is_wanted(&orders.checkpoint, at_start, &run->counters.checkpoint_orders)) {
        status = note(run, "checkpoint_now", json_object(), error);
        if (status == TALUS_OK)
            status = job_write_checkpoint(run, error);
    }
    return status;
}
