/* SPDX-License-Identifier: Apache-2.0 */
/* Submissions of jobs and studies: a file, sent again safely when its answer was lost. */
#ifndef TALUS_SUBMIT_REQUEST_H
#define TALUS_SUBMIT_REQUEST_H

#include "connection.h"

#include <jansson.h>
#include <stdbool.h>

struct submit_request {
    const char *path, *body;
    const char *key;    /* Idempotency-Key; NULL: a random one */
    bool makes_nothing; /* needs no key */
};

/* The JSON of a file ("-": standard input); NULL, with a message, if it is none. */
json_t *json_file_read(const char *path);
/* Sends it, three times at most. EXIT_DONE with an answer of 2xx in *reply; else the reason is
 * printed and the exit code returned. Release the reply in any case. */
int submit_request_send(struct connection *connection, const struct submit_request *request,
                        struct http_reply *reply);

#endif
