/* SPDX-License-Identifier: Apache-2.0 */
/* Which names the daemon may be called by, and from which pages: Host, Origin and CORS. */
#ifndef TALUS_HTTP_ORIGIN_H
#define TALUS_HTTP_ORIGIN_H

#include "config.h"
#include "request.h"

/* Whether `hosts` and `cors_origins` of the configuration are names and origins. */
TALUS_MUST_CHECK enum talus_status origin_config_check(const struct config *config,
                                                       struct talus_error *error);
/* Checks Host and Origin. False: the reply is made (403). */
bool origin_check(struct request *request, const char *host);
/* Answers what a browser asks before a call from a listed origin (204, or 404 without such a path).
 * False: the request is nothing of the kind. */
bool origin_preflight(struct request *request);
/* Adds what lets a page of a listed origin see the reply. */
void origin_reply(struct request *request);

#endif
