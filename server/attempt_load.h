/* SPDX-License-Identifier: Apache-2.0 */
/* How busy the machine was with other jobs while an attempt ran. */
#ifndef TALUS_ATTEMPT_LOAD_H
#define TALUS_ATTEMPT_LOAD_H

#include <stdint.h>

struct attempt;

/* Threads of all attempts of a list; and of those whose workers still have something to do. */
int64_t attempt_load_threads(const struct attempt *first);
int64_t attempt_load_working(const struct attempt *first);
/* Accounts for the time since the last call: to be called whenever a list may change. */
void attempt_load_note(struct attempt *first, double now);
/* Threads of other jobs, on average over the attempt; negative if it was not watched all the
 * time. */
double attempt_load_busy(const struct attempt *attempt);

#endif
