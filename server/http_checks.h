/* SPDX-License-Identifier: Apache-2.0 */
/* What the HTTP library lets pass and a careful server must not. */
#ifndef TALUS_HTTP_CHECKS_H
#define TALUS_HTTP_CHECKS_H

#include "request.h"

/* Checks framing, sizes, Host and Origin, then the target, and finds the route. Whatever is wrong
 * becomes the reply; reply.close says that the rest of the connection cannot be trusted. */
void http_check(struct request *request);
/* Whether a body follows the header fields. */
bool http_has_body(const struct request *request);

#endif
