/* SPDX-License-Identifier: Apache-2.0 */
/* What the handlers of studies share. */
#ifndef TALUS_STUDY_REQUEST_H
#define TALUS_STUDY_REQUEST_H

#include "request.h"
#include "studies/study_draft.h"

extern const struct json_field operation_study_path[]; /* the path of a study: its id */

/* Reads the study that the path names, with or without its long texts. False: the reply is made. */
bool study_request_read(struct request *request, bool whole, struct study *study);
/* Reads and checks a study that was sent (borrowed) into an empty draft. False: the reply is made.
 * For handlers with a helper. */
bool study_request_check(struct request *request, const json_t *body, struct study_draft *draft);
/* The study with its ETag. */
void study_reply(struct request *request, unsigned int status, const struct study *study);

#endif
