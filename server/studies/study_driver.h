/* SPDX-License-Identifier: Apache-2.0 */
/* The thread that drives studies: it turns rows into jobs as places get free, lets bisections take
 * their next step, and ends studies. It keeps nothing that the store does not have, and looks at
 * what the table of transitions says has changed, so a thousand waiting rows cost nothing. */
#ifndef TALUS_STUDY_DRIVER_H
#define TALUS_STUDY_DRIVER_H

#include "service.h"

struct study_driver;

/* *service is borrowed. Nothing is driven before study_driver_start. */
TALUS_MUST_CHECK enum talus_status study_driver_create(struct study_driver **driver,
                                                       struct service *service,
                                                       struct talus_error *error);
TALUS_MUST_CHECK enum talus_status study_driver_start(struct study_driver *driver,
                                                      struct talus_error *error);
/* Ends the thread; studies go on under the next daemon. NULL is fine. */
void study_driver_destroy(struct study_driver *driver);
/* Looks at the studies now. NULL is fine. */
void study_driver_wake(struct study_driver *driver);
/* The same when nothing has changed in the rows, as when jobs are to be stopped. */
void study_driver_wish(struct study_driver *driver);

#endif
