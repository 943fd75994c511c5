/* SPDX-License-Identifier: Apache-2.0 */
/* A bisection when every row so far has ended. Its searches, one or one for each row of `for_each`,
 * take their steps together, so that they share the machine. */
#ifndef TALUS_STUDY_BISECTION_H
#define TALUS_STUDY_BISECTION_H

#include "service.h"
#include "studies/study.h"

/* Adds the rows that the searches want next, or ends the study with its result. */
TALUS_MUST_CHECK enum talus_status study_bisection_settle(const struct study *study,
                                                          struct service *service,
                                                          struct talus_error *error);

#endif
