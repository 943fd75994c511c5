/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_driver.h"

#include "moment.h"
#include "studies/study_run.h"
#include "studies/study_store.h"
#include "waits.h"
#include "wakeup.h"

#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Queued jobs of studies for each thread that jobs run on: enough that none of them waits for the
 * next, few enough that what users submit by hand does not queue behind a whole study. */
enum { AHEAD_PER_WORKER = 2 };
static const double retry_seconds = 1;
static const char wakeup_name[] = "the studies";

struct study_driver {
    struct service *service;
    pthread_t thread;
    bool started;
    atomic_bool stopping;
    atomic_bool wishes; /* something is wanted of a study that no transition tells */
    int wake;           /* wakeup.h */
    int64_t seen;       /* transitions up to this one are known */
    struct study_run *first;
    struct helper helper;
    double retry_at; /* monotonic, 0: nothing is to be tried again */
    uint64_t turn;
};

enum talus_status study_driver_create(struct study_driver **result, struct service *service,
                                      struct talus_error *error)
{
    struct study_driver *driver = calloc(1, sizeof *driver);
    *result = driver;
    if (driver == NULL)
        return talus_error_memory(error);
    driver->service = service;
    helper_init(&driver->helper, service->config);
    enum talus_status status = wakeup_create(&driver->wake, error);
    if (status != TALUS_OK) {
        free(driver);
        *result = NULL;
    }
    return status;
}

void study_driver_wake(struct study_driver *driver)
{
    if (driver != NULL)
        wakeup_tell(driver->wake, wakeup_name);
}

void study_driver_wish(struct study_driver *driver)
{
    if (driver != NULL)
        atomic_store(&driver->wishes, true);
    study_driver_wake(driver);
}

static void driver_complain(struct study_driver *driver, const char *id,
                            const struct talus_error *error)
{
    (void)fprintf(stderr, "talusd: study %s: %s\n", id, error->text);
    driver->retry_at = moment_monotonic() + retry_seconds;
}

static struct study_run **run_link(struct study_driver *driver, const char *id)
{
    struct study_run **link = &driver->first;
    while (*link != NULL && strcmp((*link)->study.id, id) != 0)
        link = &(*link)->next;
    return link;
}

static void run_drop(struct study_run **link)
{
    struct study_run *run = *link;
    *link = run->next;
    study_run_destroy(run);
}

/* Reads a study anew; NULL if it does not run (any more), and then it is not in the list. */
static struct study_run *run_read(struct study_driver *driver, const char *id)
{
    struct talus_error error = {0};
    struct study study = {0};
    struct study_run **link = run_link(driver, id);
    enum talus_status status = study_store_read(driver->service->store, id, false, &study, &error);
    if (status != TALUS_OK && status != TALUS_INVALID) {
        driver_complain(driver, id, &error);
        return NULL;
    }
    if (status != TALUS_OK || study.state != STUDY_RUNNING) {
        study_release(&study);
        if (*link != NULL)
            run_drop(link);
        return NULL;
    }
    if (*link == NULL)
        *link = study_run_create();
    if (*link == NULL) {
        study_release(&study);
        return NULL;
    }
    study_release(&(*link)->study);
    (*link)->study = study;
    return *link;
}

/* A study has changed: those who wait for it are told, and what is due is done. */
static void run_look(struct study_driver *driver, const char *id)
{
    struct talus_error error = {0};
    enum talus_status status = TALUS_OK;
    waits_notify(driver->service->waits, id);
    struct study_run *run = run_read(driver, id);
    if (run == NULL)
        return;
    if (run->study.cancel_requested && study_active_count(&run->study) > 0)
        status = study_run_stop(run, driver->service, &error);
    else if (run->study.counts[ROW_WAITING] == 0 && study_active_count(&run->study) == 0)
        status = study_run_settle(run, driver->service, &error);
    if (status != TALUS_OK && strcmp(error.code, "state") != 0 &&
        strcmp(error.code, "not_found") != 0)
        driver_complain(driver, id, &error);
}

static bool id_note(const char *id, void *context)
{
    return json_array_append_new(context, json_string(id)) == 0;
}

static bool study_note(const struct study *study, void *context)
{
    return id_note(study->id, context);
}

/* Looks at all studies of a list (the reference is taken). */
static void runs_look(struct study_driver *driver, json_t *ids)
{
    size_t index;
    const json_t *id;
    json_array_foreach(ids, index, id)
    {
        run_look(driver, json_string_value(id));
    }
    json_decref(ids);
}

static void changes_look(struct study_driver *driver)
{
    struct talus_error error = {0};
    json_t *ids = json_array();
    if (study_store_changes(driver->service->store, &driver->seen, id_note, ids, &error) !=
        TALUS_OK)
        driver_complain(driver, "-", &error);
    runs_look(driver, ids);
}

static void all_look(struct study_driver *driver)
{
    const struct study_filter filter = {.state = STUDY_RUNNING};
    struct talus_error error = {0};
    json_t *ids = json_array();
    if (study_store_list(driver->service->store, &filter, study_note, ids, &error) != TALUS_OK)
        driver_complain(driver, "-", &error);
    runs_look(driver, ids);
}

static int64_t queued_count(const struct study_driver *driver)
{
    int64_t count = 0;
    for (const struct study_run *run = driver->first; run != NULL; run = run->next)
        count += run->study.counts[ROW_QUEUED];
    return count;
}

/* The study whose turn it is: the one with the fewest jobs, then the one that waited longest. */
static struct study_run *run_pick(struct study_driver *driver)
{
    struct study_run *best = NULL;
    for (struct study_run *run = driver->first; run != NULL; run = run->next) {
        if (run->study.counts[ROW_WAITING] == 0 || run->study.cancel_requested)
            continue;
        int64_t active = study_active_count(&run->study);
        int64_t least = best == NULL ? 0 : study_active_count(&best->study);
        if (best == NULL || active < least || (active == least && run->turn < best->turn))
            best = run;
    }
    return best;
}

/* Turns rows into jobs while places are free. */
static void places_fill(struct study_driver *driver)
{
    struct service *service = driver->service;
    int64_t ahead = AHEAD_PER_WORKER * (int64_t)service->config->workers;
    while (!atomic_load(&driver->stopping) && !atomic_load(&service->draining) &&
           driver->retry_at <= 0 && queued_count(driver) < ahead) {
        struct study_run *run = run_pick(driver);
        if (run == NULL)
            return;
        run->turn = ++driver->turn;
        if (study_run_start_row(run, service, &driver->helper) == ROW_NOT_NOW)
            driver->retry_at = moment_monotonic() + retry_seconds;
        /* Its counts are others now; and what else has changed meanwhile must not wait either. */
        char *id = strdup(run->study.id);
        if (id != NULL)
            run_look(driver, id);
        free(id);
        changes_look(driver);
    }
}

static void driver_wait(struct study_driver *driver)
{
    struct pollfd ready = {.fd = driver->wake, .events = POLLIN};
    double left = driver->retry_at - moment_monotonic();
    int timeout = driver->retry_at <= 0 ? -1 : left <= 0 ? 0 : (int)(left * 1e3) + 1;
    if (poll(&ready, 1, timeout) > 0)
        wakeup_clear(driver->wake, wakeup_name);
}

static void *driver_main(void *argument)
{
    struct study_driver *driver = argument;
    all_look(driver);
    while (!atomic_load(&driver->stopping)) {
        bool again = driver->retry_at > 0 && moment_monotonic() >= driver->retry_at;
        bool wished = atomic_exchange(&driver->wishes, false);
        if (again)
            driver->retry_at = 0;
        if (again || wished)
            all_look(driver);
        changes_look(driver);
        places_fill(driver);
        driver_wait(driver);
    }
    helper_stop(&driver->helper);
    return NULL;
}

enum talus_status study_driver_start(struct study_driver *driver, struct talus_error *error)
{
    driver->started = pthread_create(&driver->thread, NULL, driver_main, driver) == 0;
    return driver->started
               ? TALUS_OK
               : talus_error_set(error, TALUS_INTERNAL, "thread", "", "cannot start a thread");
}

void study_driver_destroy(struct study_driver *driver)
{
    if (driver == NULL)
        return;
    atomic_store(&driver->stopping, true);
    study_driver_wake(driver);
    if (driver->started)
        (void)pthread_join(driver->thread, NULL);
    while (driver->first != NULL)
        run_drop(&driver->first);
    (void)close(driver->wake);
    free(driver);
}
