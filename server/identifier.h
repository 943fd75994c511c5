/* SPDX-License-Identifier: Apache-2.0 */
/* Job identifiers: 26 characters of Crockford's base 32 in lower case (a ULID): 48 bits of
 * milliseconds, then 80 random bits. They sort by time of creation and need no escaping in a URL or
 * a path. */
#ifndef TALUS_IDENTIFIER_H
#define TALUS_IDENTIFIER_H

#include "talus/status.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

enum { IDENTIFIER_LENGTH = 26 };

/* Makes identifiers that grow even within one millisecond or when the clock steps back; within one
 * millisecond their last 15 bits do, for 16,384 of them. */
struct identifier_source {
    pthread_mutex_t mutex;
    int64_t last_milliseconds;
    uint8_t random[10];
};

/* TALUS_INTERNAL if the mutex cannot be made. */
TALUS_MUST_CHECK enum talus_status identifier_source_init(struct identifier_source *source,
                                                          struct talus_error *error);
void identifier_source_release(struct identifier_source *source);
/* TALUS_IO if the system has no random bytes. */
TALUS_MUST_CHECK enum talus_status identifier_next(struct identifier_source *source,
                                                   char identifier[IDENTIFIER_LENGTH + 1],
                                                   struct talus_error *error);
/* Whether a text has the form of an identifier (and so is safe as a folder's name). */
bool identifier_valid(const char *text);

#endif
