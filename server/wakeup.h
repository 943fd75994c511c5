/* SPDX-License-Identifier: Apache-2.0 */
/* Wakes a thread that polls, from any other: an eventfd, which is readable once it was told. */
#ifndef TALUS_WAKEUP_H
#define TALUS_WAKEUP_H

#include "talus/status.h"

/* Makes a descriptor, which the caller closes. */
TALUS_MUST_CHECK enum talus_status wakeup_create(int *descriptor, struct talus_error *error);
/* `who` is whom it wakes, for the complaint when that fails. */
void wakeup_tell(int descriptor, const char *who);
/* Forgets what was told so far. */
void wakeup_clear(int descriptor, const char *who);

#endif
