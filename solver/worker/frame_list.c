/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/frame_list.h"

#include "output/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static enum talus_status no_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a list of frames");
}

enum talus_status frame_list_add(struct frame_list *list, const struct frame_entry *entry,
                                 struct talus_error *error)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity == 0 ? 64 : 2 * list->capacity;
        struct frame_entry *entries = realloc(list->entries, capacity * sizeof *entries);
        if (entries == NULL)
            return no_memory(error);
        list->entries = entries;
        list->capacity = capacity;
    }
    list->entries[list->count++] = *entry;
    return TALUS_OK;
}

void frame_list_release(struct frame_list *list)
{
    free(list->entries);
    memset(list, 0, sizeof *list);
}

json_t *frame_list_json(const struct frame_list *list)
{
    json_t *array = json_array();
    for (size_t index = 0; index < list->count; index++) {
        const struct frame_entry *entry = &list->entries[index];
        if (json_array_append_new(
                array, json_pack("{s:f, s:I, s:I, s:I, s:s}", "time", entry->time, "step",
                                 (json_int_t)entry->step, "particles", (json_int_t)entry->particles,
                                 "bytes", (json_int_t)entry->bytes, "sha256", entry->sha256)) !=
            0) {
            json_decref(array);
            return NULL;
        }
    }
    return array;
}

enum talus_status frame_list_read(struct frame_list *list, const json_t *array,
                                  struct talus_error *error)
{
    for (size_t index = 0; index < json_array_size(array); index++) {
        struct frame_entry entry = {.time = 0.0};
        json_int_t step = 0, particles = 0, bytes = 0;
        const char *sha256 = NULL;
        if (json_unpack(json_array_get(array, index), "{s:F, s:I, s:I, s:I, s:s}", "time",
                        &entry.time, "step", &step, "particles", &particles, "bytes", &bytes,
                        "sha256", &sha256) != 0)
            return talus_error_set(error, TALUS_IO, "checkpoint", "",
                                   "the checkpoint's list of frames is damaged");
        entry.step = (uint64_t)step;
        entry.particles = (uint64_t)particles;
        entry.bytes = (uint64_t)bytes;
        (void)snprintf(entry.sha256, sizeof entry.sha256, "%s", sha256);
        enum talus_status status = frame_list_add(list, &entry, error);
        if (status != TALUS_OK)
            return status;
    }
    return TALUS_OK;
}

/* The name of one frame's file in a series. */
static json_t *series_file(const char *prefix, size_t index, double time)
{
    char name[256];
    (void)snprintf(name, sizeof name, "%s%06zu.hdf", prefix, index);
    return json_pack("{s:s, s:f}", "name", name, "time", time);
}

enum talus_status frame_list_write_series(const struct frame_list *list, const char *path,
                                          const char *prefix, struct talus_error *error)
{
    json_t *files = json_array();
    for (size_t index = 0; index < list->count; index++) {
        if (json_array_append_new(files, series_file(prefix, index, list->entries[index].time)) !=
            0) {
            json_decref(files);
            return no_memory(error);
        }
    }
    json_t *root = json_pack("{s:s, s:o}", "file-series-version", "1.0", "files", files);
    char *text = root == NULL ? NULL : json_dumps(root, JSON_INDENT(1));
    enum talus_status status =
        text == NULL ? no_memory(error) : file_write_whole(path, text, strlen(text), error);
    free(text);
    json_decref(root);
    return status;
}

enum talus_status frame_list_write_pvd(const struct frame_list *list, const char *path,
                                       struct talus_error *error)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (stream == NULL)
        return no_memory(error);
    (void)fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                "byte_order=\"LittleEndian\">\n<Collection>\n",
                stream);
    for (size_t index = 0; index < list->count; index++)
        (void)fprintf(stream, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"frame_%06zu.vtu\"/>\n",
                      list->entries[index].time, index);
    (void)fputs("</Collection>\n</VTKFile>\n", stream);
    int failed = ferror(stream);
    failed = fclose(stream) != 0 || failed;
    enum talus_status status =
        failed ? no_memory(error) : file_write_whole(path, text, length, error);
    free(text);
    return status;
}

/* Whether a name is PREFIX_NNNNNN.EXTENSION with a number from *context on. */
static bool is_later(const char *name, const void *context)
{
    const size_t *count = context;
    const char *underline = strrchr(name, '_');
    char *end = NULL;
    if (underline == NULL || underline[1] < '0' || underline[1] > '9')
        return false;
    size_t number = strtoul(underline + 1, &end, 10);
    return *end == '.' && number >= *count;
}

enum talus_status frame_list_trim(const char *folder, size_t count, struct talus_error *error)
{
    return file_remove_some(folder, is_later, &count, error);
}
