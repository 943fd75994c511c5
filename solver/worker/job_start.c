/* SPDX-License-Identifier: Apache-2.0 */
#include "output/file.h"
#include "worker/job_run.h"
#include "worker/precision.h"

#include "talus/version.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The first mistake, and how many more there are; every one goes to stderr. */
static void describe_issues(const struct job_run *run, const struct scene_issues *issues,
                            struct talus_error *error)
{
    const struct scene_issue *first = &issues->items[0];
    *error = (struct talus_error){.status = TALUS_OK};
    (void)talus_error_set(error, TALUS_INVALID, first->code, first->pointer,
                          issues->count > 1 ? "%s: %s (and %zu more)" : "%s: %s", first->pointer,
                          first->detail, issues->count - 1);
    for (size_t index = 0; index < issues->count; index++)
        (void)fprintf(stderr, "%s: %s: %s\n", run->options->scene_path,
                      issues->items[index].pointer, issues->items[index].detail);
}

static enum talus_status read_scene(struct job_run *run, struct scene_issues *warnings,
                                    struct talus_error *error)
{
    struct scene_issues issues = {.count = 0};
    enum talus_status status =
        scene_read_file(run->options->scene_path, &run->scene, &run->effective, &issues, warnings);
    if (status != TALUS_OK && issues.count > 0)
        describe_issues(run, &issues, error);
    else if (status != TALUS_OK)
        (void)talus_error_set(error, status, "scene", "", "cannot read %s: %s",
                              run->options->scene_path, talus_status_name(status));
    scene_issues_release(&issues);
    if (status != TALUS_OK)
        return status;
    scene_hash(run->effective, run->scene_hash);
    run->scene_text = json_dumps(run->effective, JSON_INDENT(2));
    if (run->scene_text == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for the scene");
    return TALUS_OK;
}

static enum talus_status refuse_results(const struct job_run *run, struct talus_error *error)
{
    static const char *const results[] = {PROTOCOL_HISTORY_FILE, PROTOCOL_CHECKPOINT_FILE,
                                          PROTOCOL_RECEIPT_FILE, "results.h5", "frames.hdf.series"};
    char path[FILE_PATH_SIZE];
    for (size_t index = 0; index < sizeof results / sizeof results[0]; index++) {
        enum talus_status status = file_path(path, run->options->folder, results[index], error);
        if (status != TALUS_OK)
            return status;
        if (access(path, F_OK) == 0)
            return talus_error_set(error, TALUS_IO, "exists", "",
                                   "%s holds the results of a run already: choose another --out, "
                                   "or go on with it by --resume",
                                   run->options->folder);
    }
    return TALUS_OK;
}

static bool is_same_file(const char *one, const char *other)
{
    struct stat first, second;
    return stat(one, &first) == 0 && stat(other, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

/* Going on with another scene than the folder's would destroy its results. */
static enum talus_status refuse_other_scene(const struct job_run *run, struct talus_error *error)
{
    char path[FILE_PATH_SIZE], hash[65];
    enum talus_status status = file_path(path, run->options->folder, PROTOCOL_SCENE_FILE, error);
    if (status != TALUS_OK || run->effective == NULL)
        return status;
    json_t *stored = json_load_file(path, JSON_REJECT_DUPLICATES, NULL);
    if (stored == NULL)
        return TALUS_OK;
    scene_hash(stored, hash);
    json_decref(stored);
    if (strcmp(hash, run->scene_hash) != 0 && !is_same_file(path, run->options->scene_path))
        return talus_error_set(error, TALUS_INVALID, "scene", "", "%s belongs to another scene",
                               run->options->folder);
    return TALUS_OK;
}

/* The folder is ours from here on, with its events and log. */
static enum talus_status enter_folder(struct job_run *run, struct talus_error *error)
{
    const struct job_options *options = run->options;
    enum talus_status status = file_make_folder(options->folder, error);
    if (status == TALUS_OK)
        status = job_lock_take(&run->lock, options->folder, error);
    if (status == TALUS_OK && !options->resume)
        status = refuse_results(run, error);
    if (status == TALUS_OK && options->resume)
        status = refuse_other_scene(run, error);
    if (status == TALUS_OK)
        status = job_log_open(&run->log, options->folder, options->quiet, error);
    if (status == TALUS_OK)
        status = event_open(&run->events, options->folder, error);
    if (status == TALUS_OK && (run->writer = writer_create()) == NULL)
        status = talus_error_memory(error);
    if (status != TALUS_OK)
        return status;
    run->events.attempt = options->attempt > 0 ? options->attempt
                          : options->resume    ? run->events.last_attempt + 1
                                               : 1;
    return TALUS_OK;
}

static enum talus_status prepare_subfolder(const struct job_run *run, const char *name, bool wanted,
                                           struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = file_path(path, run->options->folder, name, error);
    if (status == TALUS_OK && wanted)
        status = file_make_folder(path, error);
    if (status == TALUS_OK)
        status = file_remove_asides(path, error);
    if (status == TALUS_OK)
        status = frame_list_trim(path, run->frames.count, error);
    return status;
}

/* Files of an earlier attempt that no longer hold, and the folders for new ones. */
static enum talus_status prepare_files(const struct job_run *run, struct talus_error *error)
{
    static const char *const stale[] = {PROTOCOL_RECEIPT_FILE, "results.h5", "history.csv",
                                        "reactions.csv"};
    char path[FILE_PATH_SIZE];
    enum talus_status status = file_remove_asides(run->options->folder, error);
    for (size_t index = 0; status == TALUS_OK && index < sizeof stale / sizeof stale[0]; index++) {
        status = file_path(path, run->options->folder, stale[index], error);
        if (status == TALUS_OK && unlink(path) != 0 && errno != ENOENT)
            status = file_error(error, errno, "remove", path);
    }
    if (status == TALUS_OK)
        status = prepare_subfolder(run, "frames", true, error);
    if (status == TALUS_OK)
        status = prepare_subfolder(run, "vtk", run->scene.output.vtu, error);
    return status;
}

/* scene.json, unless it is what the scene was read from. */
static enum talus_status write_scene(const struct job_run *run, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = file_path(path, run->options->folder, PROTOCOL_SCENE_FILE, error);
    if (status != TALUS_OK || is_same_file(path, run->options->scene_path))
        return status;
    return file_write_whole(path, run->scene_text, strlen(run->scene_text), error);
}

/* The simulation: from the checkpoint if there is a usable one and --resume asks for it. */
static enum talus_status make_simulation(struct job_run *run, uint64_t *row, bool *restored,
                                         struct talus_error *error)
{
    struct talus_error reason = {.status = TALUS_OK};
    struct talus_simulation_options options = {.threads = run->options->threads,
                                               .all_threads = run->options->all_threads};
    char path[FILE_PATH_SIZE];
    enum talus_status status =
        file_path(path, run->options->folder, PROTOCOL_CHECKPOINT_FILE, error);
    *restored = false;
    if (status == TALUS_OK && run->options->resume && access(path, F_OK) == 0) {
        status = job_restore(run, row, &reason);
        *restored = status == TALUS_OK;
        if (*restored)
            return TALUS_OK;
        if (status == TALUS_MEMORY || strcmp(reason.code, "scene") == 0) {
            *error = reason;
            return status;
        }
        status = job_warn(run, "checkpoint", "", reason.text, error);
    }
    if (status != TALUS_OK)
        return status;
    run->counters = (struct job_counters){
        .next_sample = 1, .next_frame = 1, .sampled_step = UINT64_MAX, .framed_step = UINT64_MAX};
    return talus_simulation_create(&run->scene, &options, &run->simulation, error);
}

static enum talus_status announce_start(struct job_run *run, uint64_t row, bool restored,
                                        struct talus_error *error)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(run->simulation, &state);
    json_t *from = restored ? json_integer((json_int_t)state.step) : json_null();
    enum talus_status status = event_write(
        &run->events, PROTOCOL_STARTED,
        json_pack("{s:i, s:i, s:I, s:s, s:s, s:f, s:o}", "pid", (int)getpid(), "threads",
                  run->options->threads, "particles", (json_int_t)state.particle_count, "build",
                  talus_build(), "isa", talus_simulation_isa(), "duration", state.duration,
                  "resumed_from", from),
        error);
    /* Before anything is cut, so that nobody reads what comes as a continuation of what goes. */
    if (status == TALUS_OK && run->options->resume)
        status = event_write(&run->events, PROTOCOL_REWIND,
                             json_pack("{s:I, s:f, s:I}", "row", (json_int_t)row, "time",
                                       state.time, "frame", (json_int_t)run->frames.count),
                             error);
    run->clock.start_time = state.time;
    run->clock.particle_steps = run->counters.particle_steps;
    return status;
}

static enum talus_status open_history(struct job_run *run, uint64_t row, struct talus_error *error)
{
    run->columns = talus_simulation_columns(run->simulation, &run->column_count);
    run->last_row = calloc(run->column_count, sizeof *run->last_row);
    if (run->last_row == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for histories");
    enum talus_status status = history_open(&run->history, run->options->folder, run->columns,
                                            run->column_count, row, error);
    run->announced = true;
    return status;
}

static enum talus_status pass_scene_warnings(struct job_run *run,
                                             const struct scene_issues *warnings,
                                             struct talus_error *error)
{
    enum talus_status status = TALUS_OK;
    for (size_t index = 0; status == TALUS_OK && index < warnings->count; index++) {
        const struct scene_issue *warning = &warnings->items[index];
        status = job_warn(run, warning->code, warning->pointer, warning->detail, error);
    }
    return status;
}

static enum talus_status start_in_folder(struct job_run *run, const struct scene_issues *warnings,
                                         struct talus_error *error)
{
    uint64_t row = 0;
    bool restored = false;
    enum talus_status status = make_simulation(run, &row, &restored, error);
    if (status == TALUS_OK)
        status = announce_start(run, row, restored, error);
    if (status == TALUS_OK)
        status = prepare_files(run, error);
    if (status == TALUS_OK)
        status = write_scene(run, error);
    if (status == TALUS_OK)
        status = open_history(run, row, error);
    if (status == TALUS_OK && !restored)
        status = pass_scene_warnings(run, warnings, error);
    if (status == TALUS_OK && !restored)
        status = job_take_first(run, error);
    if (status == TALUS_OK)
        status = job_steer(run, true, error);
    return status;
}

enum talus_status job_start(struct job_run *run, struct talus_error *error)
{
    struct scene_issues warnings = {.count = 0};
    run->clock.start = job_now();
    run->clock.checkpoint = run->clock.start;
    run->clock.printed = run->clock.start;
    run->clock.tables = run->clock.start;
    enum talus_status scene_status = read_scene(run, &warnings, error);
    if (scene_status == TALUS_OK)
        scene_status =
            precision_switch(run->scene.solver.precision, run->options->arguments, error);
    enum talus_status status = scene_status;
    /* A bad scene makes no folder; in one that is ours already it is told as an event. */
    if (scene_status == TALUS_OK || getenv(PROTOCOL_LOCK_ENVIRONMENT) != NULL) {
        status = enter_folder(run, error);
        if (status == TALUS_OK)
            status = scene_status;
    }
    if (status == TALUS_OK)
        status = start_in_folder(run, &warnings, error);
    scene_issues_release(&warnings);
    return status;
}
