/* SPDX-License-Identifier: Apache-2.0 */
/* One run of one scene in one folder: what the parts of `talus-worker run` share.
 *
 *   job_start   folder, lock, scene, simulation (new or from a checkpoint), first row and frame
 *   job_loop    steps; rows, frames, checkpoints and events when they are due
 *   job_steer   orders from outside
 *   job_end     audit, tables, metrics, receipt, last event
 *
 * Looking never changes the run: when rows and frames are taken depends on the simulation alone,
 * never on the clock. Only checkpoints, events and tables follow the clock.
 *
 * What is slow to write (frames, checkpoints, tables) is captured between two steps and written by
 * the background writer, in order; a checkpoint counts on the rows, events and frames before it.
 * While its thread lives it owns `frames` and everything that uses HDF5; `events` is shared. */
#ifndef TALUS_JOB_RUN_H
#define TALUS_JOB_RUN_H

#include "output/history.h"
#include "scene/scene_json.h"
#include "talus/simulation.h"
#include "worker/background_writer.h"
#include "worker/control.h"
#include "worker/event_writer.h"
#include "worker/frame_list.h"
#include "worker/job_lock.h"
#include "worker/job_log.h"

/* Another end of the run, ordered when it had taken `step` steps. */
struct job_end_move {
    double end_time; /* [s] */
    uint64_t step;
};

struct job_options {
    const char *scene_path, *folder;
    int threads;         /* at least 1; fewer are used where more do not pay ... */
    bool all_threads;    /* ... but for this */
    int attempt;         /* 0: 1, or the one after the last in events.ndjson when resuming */
    double wall_seconds; /* of this attempt; 0: no limit */
    const struct job_end_move *end_moves; /* [end_move_count] in the order of their steps */
    size_t end_move_count;
    bool resume, quiet;
    char *const *arguments; /* of the sub-command, its name first */
};

/* What a checkpoint stores besides the simulation: with these an interrupted run goes on as if it
 * had not been. Counts of rows and frames are those of `history` and `frames`. */
struct job_counters {
    uint64_t next_sample, next_frame;   /* k of the next k x every */
    uint64_t sampled_step, framed_step; /* step of the last row and frame; UINT64_MAX: none */
    uint64_t progress_count;            /* progress lines so far */
    double particle_steps;
    double step_seconds;                      /* wall clock inside talus_simulation_step */
    double wall_seconds, cpu_seconds;         /* of earlier attempts up to the checkpoint */
    double peak_memory_bytes;                 /* of earlier attempts */
    uint64_t frame_orders, checkpoint_orders; /* of control.json, carried out */
};

/* Monotonic times [s] of this attempt. */
struct job_clock {
    double start;
    double attended;   /* signals, limits and events were last seen to */
    double checkpoint; /* last restart point */
    double history;    /* last history event */
    double tables;     /* history.csv and results.h5 were last replaced */
    double progress, printed;
    double start_time;     /* simulation time [s] when this attempt began */
    double particle_steps; /* at the last progress line */
};

struct job_run {
    const struct job_options *options;
    struct control control;
    struct job_lock lock;
    struct event_writer events;
    struct job_log log;
    struct talus_scene scene;
    json_t *effective;
    char *scene_text; /* `effective` as written to scene.json */
    char scene_hash[65];
    struct talus_simulation *simulation;
    const struct talus_column *columns;
    size_t column_count;
    double *last_row; /* [column_count] */
    struct history history;
    struct background_writer *writer; /* owned */
    struct frame_list frames;
    _Atomic double tables_cost; /* [s] that replacing history.csv and results.h5 took */
    _Atomic bool checkpoint_under_way;
    struct job_counters counters;
    struct job_clock clock;
    size_t end_moves_made; /* of the options */
    json_t *steering;      /* what was ordered from outside so far; NULL: nothing */
    uint64_t warning_count;
    bool announced; /* history rows that are in the file have been announced */
};

/* Monotonic time [s]. */
double job_now(void);

/* job_start.c */
TALUS_MUST_CHECK enum talus_status job_start(struct job_run *run, struct talus_error *error);

/* job_loop.c: until the end of the simulated time, or TALUS_CANCELLED, TALUS_LIMIT, ... */
TALUS_MUST_CHECK enum talus_status job_loop(struct job_run *run, struct talus_error *error);
/* A row or frame of the present state, unless there is one of this step already. The frame is
 * written, and announced, in the background. */
TALUS_MUST_CHECK enum talus_status job_take_sample(struct job_run *run, struct talus_error *error);
TALUS_MUST_CHECK enum talus_status job_take_frame(struct job_run *run, struct talus_error *error);
/* Both, of t = 0; nothing as long as the scene settles. */
TALUS_MUST_CHECK enum talus_status job_take_first(struct job_run *run, struct talus_error *error);

/* job_attend.c: between steps: signals, control.json, limits, checkpoints, warnings, events. */
TALUS_MUST_CHECK enum talus_status job_attend(struct job_run *run, double now,
                                              struct talus_error *error);
TALUS_MUST_CHECK enum talus_status job_pass_warnings(struct job_run *run,
                                                     struct talus_error *error);
/* All rows so far are in the file, and a history event says so. */
TALUS_MUST_CHECK enum talus_status job_announce_history(struct job_run *run,
                                                        struct talus_error *error);

/* job_steer.c */
/* Carries out what control.json says; `at_start`: not what it wants at every look. */
TALUS_MUST_CHECK enum talus_status job_steer(struct job_run *run, bool at_start,
                                             struct talus_error *error);
/* Moves the end as the options say for what steps there are by now. */
TALUS_MUST_CHECK enum talus_status job_repeat_moves(struct job_run *run, uint64_t step,
                                                    struct talus_error *error);

/* job_checkpoint.c */
/* A restart point of the present state, written in the background. */
TALUS_MUST_CHECK enum talus_status job_write_checkpoint(struct job_run *run,
                                                        struct talus_error *error);
/* Restores simulation, counters and list of frames, and sets *row to the rows that stand.
 * TALUS_INVALID or TALUS_IO if there is no usable checkpoint; nothing has changed then. */
TALUS_MUST_CHECK enum talus_status job_restore(struct job_run *run, uint64_t *row,
                                               struct talus_error *error);

/* job_report.c */
TALUS_MUST_CHECK enum talus_status job_report_progress(struct job_run *run, double now,
                                                       struct talus_error *error);
void job_print_progress(struct job_run *run, double now, bool last);
/* A line in log.txt and a `log` or `warning` event. */
TALUS_MUST_CHECK enum talus_status job_inform(struct job_run *run, const char *text,
                                              struct talus_error *error);
TALUS_MUST_CHECK enum talus_status job_warn(struct job_run *run, const char *code,
                                            const char *pointer, const char *text,
                                            struct talus_error *error);

/* job_end.c */
/* history.csv, reactions.csv and results.h5 from the first `row_count` rows, which are in the file.
 */
TALUS_MUST_CHECK enum talus_status job_write_tables(const struct job_run *run, uint64_t row_count,
                                                    const char *receipt, struct talus_error *error);
/* Ends a run that came out of start or loop with `outcome` (*error says more when it is not
 * TALUS_OK): writes what is left to write and the last event, prints the reason, and returns the
 * exit code. */
int job_end(struct job_run *run, enum talus_status outcome, struct talus_error *error);

void job_release(struct job_run *run);

/* job_metrics.c: all metrics of the job as a JSON object, from the simulation, the rows in
 * history.bin and the clock; new reference, NULL when memory ran out. */
json_t *job_metrics(struct job_run *run, const struct history_table *table);

/* job_references.c: adds error.NAME of every reference to `metrics`. */
TALUS_MUST_CHECK enum talus_status job_add_reference_errors(struct job_run *run,
                                                            const struct history_table *table,
                                                            json_t *metrics,
                                                            struct talus_error *error);

/* job_receipt.c: writes receipt.json (and results.h5 with the receipt in it). */
TALUS_MUST_CHECK enum talus_status job_write_receipt(struct job_run *run, const char *outcome,
                                                     json_t *metrics, struct talus_error *error);

/* Wall clock, processor time and memory of all attempts so far. */
struct job_usage {
    double wall_seconds, cpu_seconds, peak_memory_bytes;
};
struct job_usage job_measure(const struct job_run *run);

#endif
