/* SPDX-License-Identifier: Apache-2.0 */
#include "base/digest.h"
#include "output/file.h"
#include "worker/job_run.h"

#include "talus/version.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static json_t *frame_results(const struct job_run *run)
{
    json_t *list = json_array();
    for (size_t index = 0; index < run->frames.count; index++) {
        const struct frame_entry *entry = &run->frames.entries[index];
        char name[64];
        (void)snprintf(name, sizeof name, "frames/frame_%06zu.hdf", index);
        if (json_array_append_new(list, json_pack("{s:s, s:I, s:s}", "file", name, "bytes",
                                                  (json_int_t)entry->bytes, "sha256",
                                                  entry->sha256)) != 0) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

/* Adds a file of the folder to the list, with its size and digest. */
static enum talus_status add_result(const struct job_run *run, json_t *list, const char *name,
                                    struct talus_error *error)
{
    char path[FILE_PATH_SIZE], sha256[65];
    struct stat information;
    enum talus_status status = file_path(path, run->options->folder, name, error);
    if (status == TALUS_OK && stat(path, &information) != 0)
        status = file_error(error, errno, "inspect", path);
    if (status == TALUS_OK)
        status = digest_file(path, sha256, error);
    if (status != TALUS_OK)
        return status;
    if (json_array_append_new(list, json_pack("{s:s, s:I, s:s}", "file", name, "bytes",
                                              (json_int_t)information.st_size, "sha256", sha256)) !=
        0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a receipt");
    return TALUS_OK;
}

/* What repeats the results in a folder that holds scene.json, bit for bit; free() it, NULL when
 * memory ran out. */
static char *repeat_command(const struct job_run *run)
{
    char *command = NULL;
    size_t length = 0, index;
    const json_t *note;
    FILE *stream = open_memstream(&command, &length);
    if (stream == NULL)
        return NULL;
    (void)fprintf(stream, "TALUS_ISA=%s talus-worker run scene.json --out repeat --threads %d",
                  talus_simulation_isa(), run->options->threads);
    json_array_foreach(run->steering, index, note)
    {
        if (strcmp(json_string_value(json_object_get(note, "what")), "end_time") == 0)
            (void)fprintf(stream, " --end-time %.17g@%lld",
                          json_number_value(json_object_get(note, "to")),
                          (long long)json_integer_value(json_object_get(note, "step")));
    }
    const int failed = ferror(stream);
    if (fclose(stream) == 0 && failed == 0)
        return command;
    free(command);
    return NULL;
}

/* Everything but the results; borrows `metrics`. NULL when memory ran out. */
static json_t *make_receipt(const struct job_run *run, const char *outcome, json_t *metrics)
{
    char state_hash[20], at[EVENT_TIME_SIZE];
    const char *build = talus_build();
    const char *compiler = strchr(build, ' ');
    char *command = repeat_command(run);
    (void)snprintf(state_hash, sizeof state_hash, "%016llx",
                   (unsigned long long)talus_simulation_state_hash(run->simulation));
    event_time(at);
    json_t *receipt = json_pack(
        "{s:s, s:s, s:s, s:s, s:s, s:s, s:i, s:i, s:b, s:O*, s:s, s:s, s:s, s:O}", "outcome",
        outcome, "scene_hash", run->scene_hash, "build", build, "compiler",
        compiler == NULL ? "unknown" : compiler + 1, "isa", talus_simulation_isa(), "precision",
        talus_simulation_precision() == TALUS_PRECISION_SINGLE ? "single" : "double", "threads",
        run->options->threads, "attempt", run->events.attempt, "steered", run->steering != NULL,
        "steering", run->steering, "command", command, "state_hash", state_hash, "finished_at", at,
        "metrics", metrics);
    free(command);
    return receipt;
}

static enum talus_status write_text(const struct job_run *run, const json_t *receipt,
                                    struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    char *text = json_dumps(receipt, JSON_INDENT(2));
    enum talus_status status = file_path(path, run->options->folder, PROTOCOL_RECEIPT_FILE, error);
    if (text == NULL)
        status = talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a receipt");
    if (status == TALUS_OK)
        status = file_write_whole(path, text, strlen(text), error);
    free(text);
    return status;
}

/* results.h5 holds the receipt without its own digest, receipt.json the whole. */
static enum talus_status write_results(struct job_run *run, const json_t *receipt, json_t *results,
                                       struct talus_error *error)
{
    enum talus_status status = add_result(run, results, PROTOCOL_HISTORY_FILE, error);
    if (status != TALUS_OK)
        return status;
    char *text = json_dumps(receipt, JSON_INDENT(2));
    if (text == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a receipt");
    status = job_write_tables(run, run->history.row_count, text, error);
    free(text);
    if (status == TALUS_OK)
        status = add_result(run, results, "results.h5", error);
    /* It holds this receipt, and with it how long the run took. */
    if (status == TALUS_OK &&
        json_object_set_new(json_array_get(results, json_array_size(results) - 1), "varies",
                            json_true()) != 0)
        status = talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a receipt");
    if (status == TALUS_OK)
        status = write_text(run, receipt, error);
    return status;
}

enum talus_status job_write_receipt(struct job_run *run, const char *outcome, json_t *metrics,
                                    struct talus_error *error)
{
    json_t *receipt = make_receipt(run, outcome, metrics);
    json_t *results = frame_results(run);
    if (receipt == NULL || results == NULL || json_object_set(receipt, "results", results) != 0) {
        json_decref(receipt);
        json_decref(results);
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a receipt");
    }
    enum talus_status status = write_results(run, receipt, results, error);
    json_decref(results);
    json_decref(receipt);
    return status;
}
