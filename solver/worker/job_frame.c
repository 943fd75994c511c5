/* SPDX-License-Identifier: Apache-2.0 */
#include "base/digest.h"
#include "output/file.h"
#include "output/frame.h"
#include "worker/job_run.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/* Path of "FOLDER/PREFIX_NNNNNN.EXTENSION" below the job's folder. */
static enum talus_status numbered_path(char path[FILE_PATH_SIZE], const struct job_run *run,
                                       const char *prefix, const char *extension,
                                       struct talus_error *error)
{
    char name[64];
    (void)snprintf(name, sizeof name, "%s_%06zu.%s", prefix, run->frames.count, extension);
    return file_path(path, run->options->folder, name, error);
}

/* Appends the frame that lies at `path` to the list and brings the series up to date. */
static enum talus_status note_frame(struct job_run *run, const struct frame *frame,
                                    const char *path, struct talus_error *error)
{
    char series[FILE_PATH_SIZE];
    struct stat information;
    struct frame_entry entry = {
        .time = frame->time, .step = frame->step, .particles = frame->point_count};
    if (stat(path, &information) != 0)
        return file_error(error, errno, "inspect", path);
    entry.bytes = (uint64_t)information.st_size;
    enum talus_status status = digest_file(path, entry.sha256, error);
    if (status == TALUS_OK)
        status = frame_list_add(&run->frames, &entry, error);
    if (status == TALUS_OK)
        status = file_path(series, run->options->folder, "frames.hdf.series", error);
    if (status == TALUS_OK)
        status = frame_list_write_series(&run->frames, series, "frames/frame_", error);
    return status;
}

static json_t *field_names(const struct frame *frame)
{
    json_t *names = json_array();
    for (size_t index = 0; index < frame->array_count; index++) {
        if (json_array_append_new(names, json_string(frame->arrays[index].name)) != 0) {
            json_decref(names);
            return NULL;
        }
    }
    return names;
}

static enum talus_status announce_frame(struct job_run *run, const struct frame *frame,
                                        struct talus_error *error)
{
    char name[64];
    size_t number = run->frames.count - 1;
    const struct frame_entry *entry = &run->frames.entries[number];
    (void)snprintf(name, sizeof name, "frames/frame_%06zu.hdf", number);
    json_t *event = json_pack("{s:I, s:f, s:I, s:I, s:o, s:I, s:s, s:s}", "n", (json_int_t)number,
                              "time", entry->time, "step", (json_int_t)entry->step, "particles",
                              (json_int_t)entry->particles, "fields", field_names(frame), "bytes",
                              (json_int_t)entry->bytes, "sha256", entry->sha256, "file", name);
    return event_write(&run->events, PROTOCOL_FRAME, event, error);
}

/* frames/grid_NNNNNN.hdf, on request; before the frame it belongs to is counted. */
static enum talus_status write_grid(const struct job_run *run, const struct frame *grid,
                                    struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = numbered_path(path, run, "frames/grid", "hdf", error);
    if (status == TALUS_OK)
        status = frame_write_vtkhdf(grid, path, run->scene.output.frame_double, error);
    return status;
}

static enum talus_status write_lists(const struct job_run *run, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = TALUS_OK;
    if (run->scene.output.grid_fields != 0) {
        status = file_path(path, run->options->folder, "grid.hdf.series", error);
        if (status == TALUS_OK)
            status = frame_list_write_series(&run->frames, path, "frames/grid_", error);
    }
    if (status == TALUS_OK && run->scene.output.vtu) {
        status = file_path(path, run->options->folder, "vtk/frames.pvd", error);
        if (status == TALUS_OK)
            status = frame_list_write_pvd(&run->frames, path, error);
    }
    return status;
}

/* A frame on its way to the disk. */
struct frame_task {
    struct job_run *run;
    struct frame particles, grid;
};

static enum talus_status write_frame(void *context, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    const struct frame_task *task = context;
    struct job_run *run = task->run;
    const struct talus_output_options *output = &run->scene.output;
    enum talus_status status = TALUS_OK;
    if (output->vtu) {
        status = numbered_path(path, run, "vtk/frame", "vtu", error);
        if (status == TALUS_OK)
            status = frame_write_vtu(&task->particles, path, output->frame_double, error);
    }
    if (status == TALUS_OK && output->grid_fields != 0)
        status = write_grid(run, &task->grid, error);
    if (status == TALUS_OK)
        status = numbered_path(path, run, "frames/frame", "hdf", error);
    if (status == TALUS_OK)
        status = frame_write_vtkhdf(&task->particles, path, output->frame_double, error);
    if (status == TALUS_OK)
        status = note_frame(run, &task->particles, path, error);
    if (status == TALUS_OK)
        status = write_lists(run, error);
    if (status == TALUS_OK)
        status = announce_frame(run, &task->particles, error);
    return status;
}

static void release_frame(void *context)
{
    struct frame_task *task = context;
    frame_release(&task->particles);
    frame_release(&task->grid);
    free(task);
}

static enum talus_status capture(struct frame_task *task, struct talus_error *error)
{
    const struct talus_output_options *output = &task->run->scene.output;
    const struct talus_simulation *simulation = task->run->simulation;
    enum talus_status status =
        frame_capture(&task->particles, simulation, output->frame_fields, error);
    if (status == TALUS_OK && output->grid_fields != 0)
        status = frame_capture_grid(&task->grid, simulation, output->grid_fields, error);
    return status;
}

enum talus_status job_take_frame(struct job_run *run, struct talus_error *error)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(run->simulation, &state);
    if (run->counters.framed_step == state.step)
        return TALUS_OK;
    struct frame_task *frame = calloc(1, sizeof *frame);
    if (frame == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a frame");
    frame->run = run;
    enum talus_status status = capture(frame, error);
    /* Rows up to the frame are told before it. */
    if (status == TALUS_OK)
        status = job_announce_history(run, error);
    if (status != TALUS_OK) {
        release_frame(frame);
        return status;
    }
    run->counters.framed_step = state.step;
    const struct writer_task task = {write_frame, release_frame, frame};
    return writer_give(run->writer, &task, error);
}
