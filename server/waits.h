/* SPDX-License-Identifier: Apache-2.0 */
/* Requests that wait for a job to change, without a thread each. */
#ifndef TALUS_WAITS_H
#define TALUS_WAITS_H

#include "request.h"
#include "talus/status.h"

struct waits;

TALUS_MUST_CHECK enum talus_status waits_create(struct waits **waits, struct talus_error *error);
/* Nothing may wait any more (waits_end). NULL is fine. */
void waits_destroy(struct waits *waits);
/* A mark of now: what changes after it is not missed by a request that parks with it. */
uint64_t waits_mark(struct waits *waits);
/* Parks a request until its job changes or its deadline passes; then it is handed to its lane
 * again. False: something changed since the mark, so look again. Once waits have ended, a request
 * is marked as expired instead. */
bool waits_park(struct waits *waits, struct request *request, uint64_t mark);
void waits_notify(struct waits *waits, const char *id);
/* Sends away those whose time is over. */
void waits_tick(struct waits *waits);
/* Sends all away, and lets nobody wait any more. */
void waits_end(struct waits *waits);

#endif
