/* SPDX-License-Identifier: Apache-2.0 */
/* The body of a submission or a forecast: what surrounds the scene. */
#ifndef TALUS_SUBMISSION_H
#define TALUS_SUBMISSION_H

#include "job.h"

#include <jansson.h>

/* Reads everything but the scene into an empty *job and adds each mistake to *errors. `workers` is
 * the largest number of threads that can run. *scene is borrowed, NULL if it is missing. */
void submission_read(const json_t *body, int64_t workers, struct job *job, const json_t **scene,
                     json_t *errors);

#endif
