/* SPDX-License-Identifier: Apache-2.0 */
#include "recovery.h"

#include "event_log.h"
#include "folder.h"
#include "jobs.h"
#include "studies/study_life.h"
#include "supervisor.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

static enum talus_status out_of_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
}

/* What a walk over all jobs found; texts are owned. */
struct recovery {
    struct service *service;
    char **ids;
    int64_t *states; /* enum job_state, or -1: being deleted */
    int64_t *transitions;
    size_t count, capacity;
    bool failed;
};

static bool recovery_note(const struct job *job, void *context)
{
    struct recovery *recovery = context;
    if (recovery->count == recovery->capacity) {
        size_t capacity = recovery->capacity == 0 ? 64 : 2 * recovery->capacity;
        char **ids = realloc(recovery->ids, capacity * sizeof *ids);
        if (ids != NULL)
            recovery->ids = ids;
        int64_t *states = realloc(recovery->states, capacity * sizeof *states);
        if (states != NULL)
            recovery->states = states;
        int64_t *transitions = realloc(recovery->transitions, capacity * sizeof *transitions);
        if (transitions != NULL)
            recovery->transitions = transitions;
        recovery->failed = ids == NULL || states == NULL || transitions == NULL;
        if (recovery->failed)
            return false;
        recovery->capacity = capacity;
    }
    recovery->ids[recovery->count] = strdup(job->id);
    recovery->states[recovery->count] = job->deleting ? -1 : job->state;
    recovery->transitions[recovery->count] = job->transition_count;
    recovery->failed = recovery->ids[recovery->count] == NULL;
    recovery->count += !recovery->failed;
    return !recovery->failed;
}

static enum talus_status recover_job(struct service *service, const char *id, int64_t state,
                                     int64_t transition_count, struct talus_error *error)
{
    if (state < 0)
        return jobs_removal_complete(service, id, error);
    if (state == JOB_RUNNING)
        return supervisor_adopt(service->supervisor, id, error);
    char *folder = jobs_folder(service, id);
    if (folder != NULL && event_log_last_number(folder) < transition_count)
        jobs_states_write(service, id, false);
    free(folder);
    return folder == NULL ? out_of_memory(error) : TALUS_OK;
}

static int id_compare(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Removes folders that have no row: their jobs were never acknowledged. */
static enum talus_status orphans_remove(struct service *service, const struct recovery *recovery,
                                        struct talus_error *error)
{
    char *path = folder_join(service->state, "jobs");
    DIR *folder = path == NULL ? NULL : opendir(path);
    const struct dirent *entry;
    enum talus_status status = folder == NULL ? out_of_memory(error) : TALUS_OK;
    if (recovery->count > 0)
        qsort(recovery->ids, recovery->count, sizeof *recovery->ids, id_compare);
    while (folder != NULL && status == TALUS_OK && (entry = readdir(folder)) != NULL) {
        const char *name = entry->d_name;
        if (!identifier_valid(name) ||
            (recovery->count > 0 && bsearch(&name, recovery->ids, recovery->count,
                                            sizeof *recovery->ids, id_compare) != NULL))
            continue;
        char *orphan = jobs_folder(service, name);
        status = orphan == NULL ? out_of_memory(error) : folder_remove(orphan, error);
        free(orphan);
    }
    if (folder != NULL)
        (void)closedir(folder);
    free(path);
    return status;
}

static bool study_note(const struct study *study, void *context)
{
    return json_array_append_new(context, json_string(study->id)) == 0;
}

/* Completes the removals of studies. */
static enum talus_status studies_recover(struct service *service, struct talus_error *error)
{
    const struct study_filter filter = {.state = STUDY_STATE_COUNT, .deleting = true};
    json_t *ids = json_array();
    size_t index;
    const json_t *id;
    enum talus_status status = study_store_list(service->store, &filter, study_note, ids, error);
    json_array_foreach(ids, index, id)
    {
        if (status == TALUS_OK)
            status = study_removal_complete(service, json_string_value(id), error);
    }
    json_decref(ids);
    return status;
}

enum talus_status recovery_run(struct service *service, struct talus_error *error)
{
    struct recovery recovery = {.service = service};
    const struct store_filter filter = {.state = JOB_STATE_COUNT, .every = true};
    enum talus_status status =
        store_job_list(service->store, &filter, recovery_note, &recovery, error);
    if (status == TALUS_OK && recovery.failed)
        status = out_of_memory(error);
    for (size_t index = 0; index < recovery.count && status == TALUS_OK; index++)
        status = recover_job(service, recovery.ids[index], recovery.states[index],
                             recovery.transitions[index], error);
    if (status == TALUS_OK)
        status = orphans_remove(service, &recovery, error);
    if (status == TALUS_OK)
        status = studies_recover(service, error);
    for (size_t index = 0; index < recovery.count; index++)
        free(recovery.ids[index]);
    free(recovery.ids);
    free(recovery.states);
    free(recovery.transitions);
    return status;
}
