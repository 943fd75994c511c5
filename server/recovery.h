/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_RECOVERY_H
#define TALUS_RECOVERY_H

#include "service.h"

/* Brings folders and store into agreement after a daemon died at any instant: completes removals,
 * drops folders that never became jobs, adds missing state lines, hands running jobs to the
 * supervisor. Nothing else may touch jobs meanwhile. */
TALUS_MUST_CHECK enum talus_status recovery_run(struct service *service, struct talus_error *error);
/* Notes how far all is in agreement, which the next start need not look at again. For when nobody
 * changes jobs: does nothing unless recovery was complete and every state line since was written.
 */
void recovery_mark(struct service *service);

#endif
