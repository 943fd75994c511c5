/* SPDX-License-Identifier: Apache-2.0 */
/* What is asked of every request that makes something, whatever it makes: jobs and studies. */
#ifndef TALUS_ADMISSION_H
#define TALUS_ADMISSION_H

#include "checksum.h"
#include "request.h"
#include "store.h"

#include <jansson.h>

/* Whether the daemon is stopping and takes no work. True: the reply is made. */
bool admission_draining(struct request *request);
extern const struct json_field admission_key_headers[]; /* of its operation */
extern const char *const admission_made_headers[];      /* of its answer */

/* The key under which something is to be made, and what the store says of that. */
struct admission {
    char checksum[CHECKSUM_SIZE]; /* of the body */
    struct store_key key;         /* its key is NULL without one, its body is the checksum */
    enum store_insert result;     /* STORE_INSERTED: there is none under this key */
    char existing[64];            /* STORE_REPLAYED: what there is */
};

/* Reads the Idempotency-Key and looks for what it made before; *admission must stay where it is.
 * False: the reply is made. */
bool admission_key(struct request *request, const json_t *body, struct admission *admission);
/* 422: the key came with another body. */
void admission_other_body(struct request *request);
/* Adds to a reply where the thing is ("/v1/jobs/"), and whether an earlier call made it. */
void admission_made(struct request *request, const char *path, const char *id, bool replayed);
/* Whether results of so many bytes would fit. False: the reply is made. */
bool admission_disk(struct request *request, double bytes);
/* Adds a helper's errors, whose pointers go into the scene, to those of a request: `prefix` is the
 * pointer to the scene. */
void admission_errors(json_t *errors, const json_t *found, const char *prefix);
/* 422 with a list of mistakes (borrowed). */
void admission_refused(struct request *request, json_t *errors);

#endif
