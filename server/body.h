/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_BODY_H
#define TALUS_BODY_H

#include "request.h"

#include <jansson.h>

/* The request's body as JSON (new reference), or NULL with the reply made: 400 with line and column
 * for what is not JSON, repeats a key or nests too deep. */
json_t *body_json(struct request *request);
/* For calls that take no body but an empty object. False: there is one, and the reply is made. */
bool body_absent(struct request *request);

#endif
