/* SPDX-License-Identifier: Apache-2.0 */
#include "output/checkpoint_file.h"
#include "output/file.h"
#include "worker/job_run.h"

#include "talus/version.h"

#include <stdlib.h>
#include <string.h>

enum { CHECKPOINT_FORMAT = 2 };

/* UINT64_MAX ("none") is -1 in JSON. */
static json_int_t step_to_json(uint64_t step)
{
    return step == UINT64_MAX ? -1 : (json_int_t)step;
}

static uint64_t step_from_json(json_int_t step)
{
    return step < 0 ? UINT64_MAX : (uint64_t)step;
}

/* The counters; jansson prints doubles with 17 digits, which bring back the same bits. */
static json_t *counters_json(const struct job_run *run)
{
    const struct job_counters *counters = &run->counters;
    struct job_usage usage = job_measure(run);
    return json_pack(
        "{s:I, s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:I, s:I}", "next_sample",
        (json_int_t)counters->next_sample, "next_frame", (json_int_t)counters->next_frame,
        "sampled_step", step_to_json(counters->sampled_step), "framed_step",
        step_to_json(counters->framed_step), "progress_count", (json_int_t)counters->progress_count,
        "particle_steps", counters->particle_steps, "step_seconds", counters->step_seconds,
        "wall_seconds", usage.wall_seconds, "cpu_seconds", usage.cpu_seconds, "peak_memory_bytes",
        usage.peak_memory_bytes, "frame_orders", (json_int_t)counters->frame_orders,
        "checkpoint_orders", (json_int_t)counters->checkpoint_orders);
}

static int read_counters(const json_t *root, struct job_counters *counters)
{
    json_int_t next_sample = 0, next_frame = 0, sampled_step = 0, framed_step = 0, progress = 0;
    json_int_t frames = 0, checkpoints = 0;
    /* json_unpack does not modify the value; its signature predates const. */
    int result = json_unpack(
        (json_t *)(uintptr_t)root, "{s:I, s:I, s:I, s:I, s:I, s:F, s:F, s:F, s:F, s:F, s:I, s:I}",
        "next_sample", &next_sample, "next_frame", &next_frame, "sampled_step", &sampled_step,
        "framed_step", &framed_step, "progress_count", &progress, "particle_steps",
        &counters->particle_steps, "step_seconds", &counters->step_seconds, "wall_seconds",
        &counters->wall_seconds, "cpu_seconds", &counters->cpu_seconds, "peak_memory_bytes",
        &counters->peak_memory_bytes, "frame_orders", &frames, "checkpoint_orders", &checkpoints);
    counters->next_sample = (uint64_t)next_sample;
    counters->next_frame = (uint64_t)next_frame;
    counters->sampled_step = step_from_json(sampled_step);
    counters->framed_step = step_from_json(framed_step);
    counters->progress_count = (uint64_t)progress;
    counters->frame_orders = (uint64_t)frames;
    counters->checkpoint_orders = (uint64_t)checkpoints;
    return result;
}

/* A restart point on its way to the disk. The blobs belong to the simulation, which keeps them
 * until the next restart point is captured. */
struct checkpoint_task {
    struct job_run *run;
    const struct talus_blob *blobs;
    size_t blob_count;
    double time; /* [s] */
    uint64_t step, row_count;
    json_t *counters, *steering; /* steering: NULL where there was none */
};

static char *state_text(const struct checkpoint_task *task)
{
    const struct job_run *run = task->run;
    json_t *root = json_pack("{s:i, s:s, s:s, s:I, s:O, s:o, s:O*}", "format", CHECKPOINT_FORMAT,
                             "scene_hash", run->scene_hash, "build", talus_build(), "row",
                             (json_int_t)task->row_count, "counters", task->counters, "frames",
                             frame_list_json(&run->frames), "steering", task->steering);
    char *text = root == NULL ? NULL : json_dumps(root, JSON_COMPACT);
    json_decref(root);
    return text;
}

static enum talus_status write_file(const struct checkpoint_task *task, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status =
        file_path(path, task->run->options->folder, PROTOCOL_CHECKPOINT_FILE, error);
    if (status != TALUS_OK)
        return status;
    char *state = state_text(task);
    if (state == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a checkpoint");
    status = checkpoint_write(path, state, task->blobs, task->blob_count, error);
    free(state);
    return status;
}

static enum talus_status write_checkpoint(void *context, struct talus_error *error)
{
    const struct checkpoint_task *task = context;
    struct job_run *run = task->run;
    /* What the checkpoint counts on must be on the disk before it is. */
    enum talus_status status = history_sync(&run->history, error);
    if (status == TALUS_OK)
        status = event_sync(&run->events, error);
    if (status == TALUS_OK)
        status = write_file(task, error);
    if (status != TALUS_OK)
        return status;
    return event_write(&run->events, PROTOCOL_CHECKPOINT,
                       json_pack("{s:f, s:I, s:I, s:I}", "time", task->time, "step",
                                 (json_int_t)task->step, "row", (json_int_t)task->row_count,
                                 "frame", (json_int_t)run->frames.count),
                       error);
}

static void release_checkpoint(void *context)
{
    struct checkpoint_task *task = context;
    task->run->checkpoint_under_way = false;
    json_decref(task->counters);
    json_decref(task->steering);
    free(task);
}

/* NULL when memory ran out. */
static struct checkpoint_task *capture(struct job_run *run)
{
    struct talus_simulation_state state;
    struct checkpoint_task *task = calloc(1, sizeof *task);
    if (task == NULL)
        return NULL;
    talus_simulation_get_state(run->simulation, &state);
    *task = (struct checkpoint_task){.run = run,
                                     .time = state.time,
                                     .step = state.step,
                                     .row_count = run->history.row_count,
                                     .counters = counters_json(run),
                                     .steering = json_deep_copy(run->steering)};
    task->blobs = talus_simulation_checkpoint(run->simulation, &task->blob_count);
    run->checkpoint_under_way = true;
    if (task->blobs != NULL && task->counters != NULL)
        return task;
    release_checkpoint(task);
    return NULL;
}

enum talus_status job_write_checkpoint(struct job_run *run, struct talus_error *error)
{
    enum talus_status status = job_announce_history(run, error);
    /* One restart point at a time: their blobs share their memory. */
    if (status == TALUS_OK && run->checkpoint_under_way)
        status = writer_drain(run->writer, error);
    if (status != TALUS_OK)
        return status;
    struct checkpoint_task *checkpoint = capture(run);
    if (checkpoint == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a checkpoint");
    const struct writer_task task = {write_checkpoint, release_checkpoint, checkpoint};
    status = writer_give(run->writer, &task, error);
    run->clock.checkpoint = job_now();
    return status;
}

static enum talus_status not_usable(struct talus_error *error, const char *why)
{
    return talus_error_set(error, TALUS_INVALID, "checkpoint", "", "the checkpoint %s", why);
}

/* What the JSON part of a checkpoint says, before anything is taken over. */
struct restored {
    struct job_counters counters;
    struct frame_list frames;
    json_t *steering; /* owned */
    uint64_t row;
};

static enum talus_status read_state(const struct job_run *run, const char *text,
                                    struct restored *restored, struct talus_error *error)
{
    int format = 0;
    json_int_t row = 0;
    const char *hash = NULL;
    const json_t *counters = NULL, *frames = NULL;
    enum talus_status status = TALUS_OK;
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    if (root == NULL ||
        json_unpack(root, "{s:i, s:s, s:I, s:o, s:o}", "format", &format, "scene_hash", &hash,
                    "row", &row, "counters", &counters, "frames", &frames) != 0 ||
        format != CHECKPOINT_FORMAT || read_counters(counters, &restored->counters) != 0)
        status = not_usable(error, "is of another version");
    else if (strcmp(hash, run->scene_hash) != 0)
        status = talus_error_set(error, TALUS_INVALID, "scene", "",
                                 "the checkpoint belongs to another scene");
    else
        status = frame_list_read(&restored->frames, frames, error);
    restored->row = (uint64_t)row;
    restored->steering = json_incref(json_object_get(root, "steering"));
    json_decref(root);
    return status;
}

enum talus_status job_restore(struct job_run *run, uint64_t *row, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    struct checkpoint checkpoint;
    struct restored restored = {.row = 0};
    struct talus_simulation_options options = {.threads = run->options->threads,
                                               .all_threads = run->options->all_threads};
    enum talus_status status =
        file_path(path, run->options->folder, PROTOCOL_CHECKPOINT_FILE, error);
    if (status != TALUS_OK)
        return status;
    status = checkpoint_read(&checkpoint, path, error);
    if (status != TALUS_OK)
        return status;
    status = read_state(run, checkpoint.state, &restored, error);
    if (status == TALUS_OK)
        status = talus_simulation_restore(&run->scene, &options, checkpoint.blobs,
                                          checkpoint.blob_count, &run->simulation, error);
    checkpoint_release(&checkpoint);
    if (status != TALUS_OK) {
        frame_list_release(&restored.frames);
        json_decref(restored.steering);
        return status;
    }
    run->counters = restored.counters;
    run->frames = restored.frames;
    run->steering = restored.steering;
    *row = restored.row;
    return TALUS_OK;
}
