/* SPDX-License-Identifier: Apache-2.0 */
/* What a daemon that starts asks the store: little, however long its history is. */
#ifndef TALUS_STORE_RECOVERY_H
#define TALUS_STORE_RECOVERY_H

#include "store.h"

/* Told of a job; it must not call the store. */
typedef void store_recovery_visit(const char *id, int64_t number, void *context);

/* Visits every job, with its state. */
TALUS_MUST_CHECK enum talus_status store_recovery_jobs(struct store *store,
                                                       store_recovery_visit *visit, void *context,
                                                       struct talus_error *error);
/* Visits the jobs that are being removed. */
TALUS_MUST_CHECK enum talus_status store_recovery_removals(struct store *store,
                                                           store_recovery_visit *visit,
                                                           void *context,
                                                           struct talus_error *error);
/* Visits the jobs that neither run nor are being removed and have transitions behind the last mark,
 * with the number of the last one: all others have their state lines. */
TALUS_MUST_CHECK enum talus_status store_recovery_untold(struct store *store,
                                                         store_recovery_visit *visit, void *context,
                                                         struct talus_error *error);
/* Notes that all transitions up to now have their state lines, but for those of jobs that run. */
TALUS_MUST_CHECK enum talus_status store_recovery_mark(struct store *store,
                                                       struct talus_error *error);

#endif
