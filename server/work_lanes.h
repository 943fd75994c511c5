/* SPDX-License-Identifier: Apache-2.0 */
/* Threads that do the slow part of requests while their connections are suspended: a few for files
 * and the store, and one for each helper process. */
#ifndef TALUS_WORK_LANES_H
#define TALUS_WORK_LANES_H

#include "config.h"
#include "request.h"
#include "talus/status.h"

struct lanes;

TALUS_MUST_CHECK enum talus_status lanes_create(struct lanes **lanes, const struct config *config,
                                                struct talus_error *error);
/* Answers what is queued, then ends the threads and helpers. NULL is fine. */
void lanes_destroy(struct lanes *lanes);
/* Hands a suspended request in; its connection is resumed when the reply is made. False: too many
 * wait; the request stays the caller's. */
bool lanes_hand_in(struct lanes *lanes, struct request *request);
/* Requests that are queued or being answered. */
size_t lanes_busy_count(struct lanes *lanes);

#endif
