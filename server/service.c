/* SPDX-License-Identifier: Apache-2.0 */
#include "service.h"

#include "access.h"
#include "audit.h"
#include "calibration.h"
#include "events.h"
#include "file_checksums.h"
#include "folder.h"
#include "http.h"
#include "http_origin.h"
#include "job_cache.h"
#include "jobs.h"
#include "moment.h"
#include "recovery.h"
#include "service_metrics.h"
#include "studies/study_driver.h"
#include "supervisor.h"
#include "waits.h"
#include "work_lanes.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* Load balancers and scripts see the refusal for at least this long. */
static const double drain_seconds_min = 0.5;
enum { LOCK_TRIALS = 40, LOCK_PAUSE_MICROSECONDS = 50000 };

static enum talus_status boot_read(char boot[64], struct talus_error *error)
{
    FILE *stream = fopen("/proc/sys/kernel/random/boot_id", "re");
    bool good = stream != NULL && fgets(boot, 64, stream) != NULL;
    if (stream != NULL)
        (void)fclose(stream);
    boot[strcspn(boot, "\n")] = '\0';
    return good ? TALUS_OK
                : talus_error_set(error, TALUS_IO, "boot", "", "cannot read the machine's boot id");
}

/* Makes the state folder and takes its lock. */
static enum talus_status state_take(struct service *service, struct talus_error *error)
{
    char path[4200];
    enum talus_status status = folder_make(service->config->state, error);
    if (status != TALUS_OK)
        return status;
    service->state = realpath(service->config->state, NULL);
    if (service->state == NULL)
        return talus_error_set(error, TALUS_IO, "state", "", "cannot use %s: %s",
                               service->config->state, strerror(errno));
    (void)snprintf(path, sizeof path, "%s/talusd.lock", service->state);
    service->lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0640);
    if (service->lock < 0)
        return talus_error_set(error, TALUS_IO, "state", "", "cannot open %s: %s", path,
                               strerror(errno));
    /* As with the socket, a child of a killed daemon may hold the lock for a moment. */
    int held = -1;
    for (int trial = 0; trial < LOCK_TRIALS && held != 0; trial++) {
        if (trial > 0)
            (void)usleep(LOCK_PAUSE_MICROSECONDS);
        held = flock(service->lock, LOCK_EX | LOCK_NB);
    }
    if (held != 0)
        return talus_error_set(error, TALUS_IO, "state", "", "another talusd uses %s",
                               service->state);
    (void)snprintf(path, sizeof path, "%s/jobs", service->state);
    return folder_make(path, error);
}

static enum talus_status parts_create(struct service *service, struct talus_error *error)
{
    char path[4200];
    (void)snprintf(path, sizeof path, "%s/talus.sqlite", service->state);
    enum talus_status status = metrics_create(&service->metrics, error);
    if (status == TALUS_OK)
        status = audit_create(&service->audit, service->state, service->config, error);
    if (status == TALUS_OK)
        status = identifier_source_init(&service->identifiers, error);
    if (status == TALUS_OK)
        status = file_checksums_create(&service->checksums, error);
    if (status == TALUS_OK)
        status = store_open(path, &service->store, error);
    if (status == TALUS_OK)
        status = calibration_create(&service->calibration, service->store, error);
    if (status == TALUS_OK)
        status = waits_create(&service->waits, error);
    if (status == TALUS_OK)
        status = events_create(&service->events, service, error);
    if (status == TALUS_OK)
        status = supervisor_create(&service->supervisor, service, error);
    if (status == TALUS_OK)
        status = job_cache_create(&service->job_cache, error);
    if (status == TALUS_OK)
        status = study_driver_create(&service->studies, service, error);
    if (status == TALUS_OK)
        status = recovery_run(service, error);
    if (status == TALUS_OK)
        status = lanes_create(&service->lanes, service->config, error);
    return status;
}

static void parts_destroy(struct service *service)
{
    lanes_destroy(service->lanes);
    study_driver_destroy(service->studies);
    supervisor_destroy(service->supervisor);
    job_cache_destroy(service->job_cache);
    events_destroy(service->events);
    waits_destroy(service->waits);
    calibration_destroy(service->calibration);
    recovery_mark(service);
    store_close(service->store);
    file_checksums_destroy(service->checksums);
    metrics_destroy(service->metrics);
    json_decref(service->schema);
    identifier_source_release(&service->identifiers);
    (void)pthread_mutex_destroy(&service->schema_mutex);
    (void)pthread_mutex_destroy(&service->journal);
    if (service->lock >= 0)
        (void)close(service->lock);
    audit_destroy(service->audit);
    access_destroy(service->access);
    free(service->state);
}

enum talus_status service_start(struct service *service, const struct config *config, int listener,
                                struct talus_error *error)
{
    memset(service, 0, sizeof *service);
    service->config = config;
    service->began = moment_monotonic();
    service->lock = -1;
    (void)pthread_mutex_init(&service->journal, NULL);
    (void)pthread_mutex_init(&service->schema_mutex, NULL);
    enum talus_status status = origin_config_check(config, error);
    if (status == TALUS_OK)
        status = access_create(&service->access, config, listener, error);
    if (status == TALUS_OK)
        status = boot_read(service->boot, error);
    if (status == TALUS_OK)
        status = state_take(service, error);
    if (status == TALUS_OK)
        status = parts_create(service, error);
    if (status == TALUS_OK)
        status = supervisor_start(service->supervisor, error);
    if (status == TALUS_OK)
        status = study_driver_start(service->studies, error);
    if (status == TALUS_OK)
        status = http_start(&service->http, service, listener, error);
    else
        (void)close(listener);
    if (status != TALUS_OK)
        parts_destroy(service);
    return status;
}

void service_reload(struct service *service, uid_t user)
{
    struct talus_error error = {0};
    bool good = access_reload(service->access, &error) == TALUS_OK;
    size_t count = access_token_count(service->access);
    if (good)
        events_access_recheck(service->events);
    audit_reload(service->audit, user, good, count);
    if (good)
        (void)fprintf(stderr, "talusd: %zu tokens are in force\n", count);
    else
        (void)fprintf(stderr, "talusd: %s; the %zu tokens of before stay in force\n", error.text,
                      count);
}

/* Waits until no request is being answered, between two durations. */
static void requests_wait(struct service *service, double at_least, double at_most)
{
    double begin = moment_monotonic();
    for (;;) {
        double elapsed = moment_monotonic() - begin;
        bool busy = lanes_busy_count(service->lanes) > 0;
        if (elapsed >= at_least && (!busy || elapsed >= at_most))
            return;
        (void)usleep(10000);
    }
}

void service_stop(struct service *service)
{
    atomic_store(&service->draining, true);
    waits_end(service->waits);
    requests_wait(service, drain_seconds_min, service->config->drain_seconds);
    http_close(service->http);
    /* Helpers have their own deadlines, so this ends. */
    while (lanes_busy_count(service->lanes) > 0)
        (void)usleep(10000);
    events_end(service->events);
    http_stop(service->http);
    parts_destroy(service);
}
