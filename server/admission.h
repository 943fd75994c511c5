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
/* Reads the Idempotency-Key; key->key stays NULL without one. `checksum` is storage for key->body.
 * False: the reply is made. */
bool admission_key(struct request *request, const json_t *body, struct store_key *key,
                   char checksum[CHECKSUM_SIZE]);
/* Whether results of so many bytes would fit. False: the reply is made. */
bool admission_disk(struct request *request, double bytes);
/* Adds a helper's errors, whose pointers go into the scene, to those of a request: `prefix` is the
 * pointer to the scene. */
void admission_errors(json_t *errors, const json_t *found, const char *prefix);
/* 422 with a list of mistakes (borrowed). */
void admission_refused(struct request *request, json_t *errors);

#endif
