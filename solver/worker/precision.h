/* SPDX-License-Identifier: Apache-2.0 */
/* The worker is built once per precision: talus-worker and talus-worker-ISA compute in double,
 * talus-worker-single-ISA beside them in single precision (see CMakeLists.txt). */
#ifndef TALUS_PRECISION_H
#define TALUS_PRECISION_H

#include "talus/scene.h"
#include "talus/status.h"

/* If this program computes in another precision than `wanted`, replaces it by the one beside it
 * that does, for the same instruction set. `arguments` are those of the sub-command, with its name
 * first. Comes back only if nothing is to be done or the other program cannot be started
 * (TALUS_UNSUPPORTED). Signals that are blocked stay blocked and pending ones pending. */
TALUS_MUST_CHECK enum talus_status
precision_switch(enum talus_precision wanted, char *const *arguments, struct talus_error *error);

#endif
