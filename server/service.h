/* SPDX-License-Identifier: Apache-2.0 */
/* Everything a running daemon consists of. Parts are made in the order of the members and destroyed
 * in reverse; each is thread-safe by itself. */
#ifndef TALUS_SERVICE_H
#define TALUS_SERVICE_H

#include "config.h"
#include "identifier.h"
#include "store.h"

#include <jansson.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <sys/types.h>

struct access;
struct metrics;
struct audit;
struct lanes;
struct waits;
struct events;
struct supervisor;
struct study_driver;
struct http_server;
struct calibration;
struct file_checksums;
struct job_cache;

struct service {
    const struct config *config;
    char *state;          /* absolute path of the state folder */
    char boot[64];        /* identifies the boot of the machine */
    int lock;             /* descriptor that holds the state folder's lock */
    atomic_bool draining; /* stops taking work */
    struct metrics *metrics;
    double began; /* monotonic [s] */
    struct access *access;
    struct audit *audit;
    struct identifier_source identifiers;
    pthread_mutex_t journal; /* one state line is written at a time */
    atomic_bool untold;      /* a state line could not be written */
    bool recovered;
    pthread_mutex_t schema_mutex;
    json_t *schema; /* of scenes, once a helper has told it */
    struct file_checksums *checksums;
    struct store *store;
    struct calibration *calibration;
    struct waits *waits;
    struct events *events;
    struct supervisor *supervisor;
    struct job_cache *job_cache;
    struct study_driver *studies;
    struct lanes *lanes;
    struct http_server *http;
};

/* Takes the state folder, reconciles what a dead daemon left, and starts. *config is borrowed, the
 * listening socket taken over. On
 * failure nothing is left running. */
TALUS_MUST_CHECK enum talus_status service_start(struct service *service,
                                                 const struct config *config, int listener,
                                                 struct talus_error *error);
/* Reads the tokens again; streams of tokens that are gone end. `user` sent the signal. */
void service_reload(struct service *service, uid_t user);
/* Refuses new work, lets requests under way end, leaves workers running, and stops. */
void service_stop(struct service *service);

#endif
