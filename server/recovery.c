/* SPDX-License-Identifier: Apache-2.0 */
#include "recovery.h"

#include "event_log.h"
#include "folder.h"
#include "jobs.h"
#include "store_recovery.h"
#include "studies/study_life.h"
#include "supervisor.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Jobs in an order that a search can use. */
struct recovery_job {
    char id[IDENTIFIER_LENGTH + 1];
    int64_t number; /* what the store told with it */
};

struct recovery_list {
    struct recovery_job *jobs;
    size_t count, capacity;
    bool failed;
};

static void list_note(const char *id, int64_t number, void *context)
{
    struct recovery_list *list = context;
    if (list->count == list->capacity) {
        size_t capacity = list->capacity == 0 ? 1024 : 2 * list->capacity;
        struct recovery_job *jobs = realloc(list->jobs, capacity * sizeof *jobs);
        list->failed = list->failed || jobs == NULL;
        if (jobs == NULL)
            return;
        list->jobs = jobs;
        list->capacity = capacity;
    }
    struct recovery_job *job = &list->jobs[list->count++];
    (void)snprintf(job->id, sizeof job->id, "%s", id);
    job->number = number;
}

/* Asks the store; release the list. */
static enum talus_status
list_read(struct service *service,
          enum talus_status (*ask)(struct store *store, store_recovery_visit *visit, void *context,
                                   struct talus_error *error),
          struct recovery_list *list, struct talus_error *error)
{
    memset(list, 0, sizeof *list);
    enum talus_status status = ask(service->store, list_note, list, error);
    return status == TALUS_OK && list->failed ? talus_error_memory(error) : status;
}

static void list_release(struct recovery_list *list)
{
    free(list->jobs);
}

static enum talus_status removals_complete(struct service *service, struct talus_error *error)
{
    struct recovery_list list;
    enum talus_status status = list_read(service, store_recovery_removals, &list, error);
    for (size_t index = 0; index < list.count && status == TALUS_OK; index++)
        status = jobs_removal_complete(service, list.jobs[index].id, error);
    list_release(&list);
    return status;
}

/* Adds the state lines that a dead daemon did not come to write. */
static enum talus_status states_complete(struct service *service, struct talus_error *error)
{
    struct recovery_list list;
    enum talus_status status = list_read(service, store_recovery_untold, &list, error);
    for (size_t index = 0; index < list.count && status == TALUS_OK; index++) {
        char *folder = jobs_folder(service, list.jobs[index].id);
        if (folder == NULL)
            status = talus_error_memory(error);
        else if (event_log_last_number(folder) < list.jobs[index].number)
            jobs_states_write(service, list.jobs[index].id, false);
        free(folder);
    }
    list_release(&list);
    return status;
}

static int id_compare(const void *a, const void *b)
{
    return strcmp(((const struct recovery_job *)a)->id, ((const struct recovery_job *)b)->id);
}

/* Removes folders that have no row: their jobs were never acknowledged. `known` is sorted. */
static enum talus_status orphans_remove(struct service *service, const struct recovery_list *known,
                                        struct talus_error *error)
{
    char *path = folder_join(service->state, "jobs");
    DIR *folder = path == NULL ? NULL : opendir(path);
    const struct dirent *entry;
    enum talus_status status = folder == NULL ? talus_error_memory(error) : TALUS_OK;
    while (folder != NULL && status == TALUS_OK && (entry = readdir(folder)) != NULL) {
        struct recovery_job job;
        if (!identifier_valid(entry->d_name))
            continue;
        memcpy(job.id, entry->d_name, sizeof job.id);
        if (known->count > 0 &&
            bsearch(&job, known->jobs, known->count, sizeof job, id_compare) != NULL)
            continue;
        char *orphan = jobs_folder(service, job.id);
        status = orphan == NULL ? talus_error_memory(error) : folder_remove(orphan, error);
        free(orphan);
    }
    if (folder != NULL)
        (void)closedir(folder);
    free(path);
    return status;
}

/* Hands jobs that run to the supervisor and removes folders without a job. */
static enum talus_status jobs_recover(struct service *service, struct talus_error *error)
{
    struct recovery_list list;
    enum talus_status status = list_read(service, store_recovery_jobs, &list, error);
    for (size_t index = 0; index < list.count && status == TALUS_OK; index++) {
        if (list.jobs[index].number == JOB_RUNNING)
            status = supervisor_adopt(service->supervisor, list.jobs[index].id, error);
    }
    if (list.count > 0)
        qsort(list.jobs, list.count, sizeof *list.jobs, id_compare);
    if (status == TALUS_OK)
        status = orphans_remove(service, &list, error);
    list_release(&list);
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
    enum talus_status status = removals_complete(service, error);
    if (status == TALUS_OK)
        status = states_complete(service, error);
    if (status == TALUS_OK)
        status = jobs_recover(service, error);
    if (status == TALUS_OK)
        status = studies_recover(service, error);
    service->recovered = status == TALUS_OK;
    if (status == TALUS_OK)
        recovery_mark(service);
    return status;
}

void recovery_mark(struct service *service)
{
    struct talus_error error = {0};
    if (!service->recovered || atomic_load(&service->untold))
        return;
    if (store_recovery_mark(service->store, &error) != TALUS_OK)
        (void)fprintf(stderr, "talusd: %s\n", error.text);
}
