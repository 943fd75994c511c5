/* SPDX-License-Identifier: Apache-2.0 */
/* Who may do what. Where the daemon listens on loopback or a Unix socket, a caller without a token
 * is a local user who may do everything, unless `require_token` is set; a token that is sent must
 * be valid everywhere. Elsewhere every route but those for ANYONE needs a token. */
#ifndef TALUS_ACCESS_H
#define TALUS_ACCESS_H

#include "config.h"
#include "request.h"

struct access;

/* Reads the tokens. TALUS_INVALID if the configuration contradicts itself or the listening socket
 * is not local and there are no tokens. *config is borrowed. */
TALUS_MUST_CHECK enum talus_status access_create(struct access **access,
                                                 const struct config *config, int listener,
                                                 struct talus_error *error);
/* NULL is fine. */
void access_destroy(struct access *access);
/* Reads the tokens again; with a mistake in the file those of before stay. */
TALUS_MUST_CHECK enum talus_status access_reload(struct access *access, struct talus_error *error);
/* Whether the daemon listens on loopback or a Unix socket. */
bool access_is_local(const struct access *access);
/* Whether the file of tokens has a mistake, so that older ones are in force. */
bool access_is_stale(struct access *access);
size_t access_token_count(struct access *access);

/* Finds out who calls and whether the route is for them; the route has been looked for. False: the
 * reply is made (400, 401, 403). */
bool access_check(struct request *request);
/* Whether the caller may change what the path names: with the role submit only what is theirs. May
 * wait for the store. False: the reply is made (403). */
bool access_owner_check(struct request *request);
/* Whether the request is to change something, by its method; its route may be unknown. */
bool access_is_change(const struct request *request);
/* Whether a token that was valid when its request came is so still. */
bool access_holds(struct access *access, const struct token_proof *proof);

#endif
