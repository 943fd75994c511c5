/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_run.h"

#include "jobs.h"
#include "studies/study_bisection.h"
#include "studies/study_life.h"
#include "studies/study_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct study_run *study_run_create(void)
{
    return calloc(1, sizeof(struct study_run));
}

void study_run_destroy(struct study_run *run)
{
    study_release(&run->study);
    json_decref(run->scene);
    json_decref(run->options);
    free(run);
}

enum talus_status study_run_settle(struct study_run *run, struct service *service,
                                   struct talus_error *error)
{
    const struct study *study = &run->study;
    if (study->cancel_requested)
        return study_end(service, study->id, STUDY_CANCELLED, NULL, NULL, error);
    if (study->kind == STUDY_BISECT)
        return study_bisection_settle(study, service, error);
    return study_end(service, study->id, STUDY_FINISHED, NULL, NULL, error);
}

enum talus_status study_run_stop(struct study_run *run, struct service *service,
                                 struct talus_error *error)
{
    static const enum row_state active[] = {ROW_QUEUED, ROW_RUNNING};
    enum talus_status status = TALUS_OK;
    size_t index;
    const json_t *id;
    if (run->stopped)
        return TALUS_OK;
    json_t *jobs = json_array();
    for (size_t state = 0; state < 2 && status == TALUS_OK; state++)
        status = study_store_row_jobs(service->store, run->study.id, active[state], jobs, error);
    json_array_foreach(jobs, index, id)
    {
        struct job job = {0};
        struct talus_error own = {0};
        if (status != TALUS_OK)
            break;
        /* One that has ended meanwhile has ended. */
        enum talus_status done = jobs_cancel(service, json_string_value(id), -1, &job, &own);
        if (done != TALUS_OK && strcmp(own.code, "state") != 0 &&
            strcmp(own.code, "not_found") != 0)
            status = talus_error_set(error, done, own.code, "", "%s", own.text);
        job_release(&job);
    }
    run->stopped = status == TALUS_OK;
    json_decref(jobs);
    return status;
}
