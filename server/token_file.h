/* SPDX-License-Identifier: Apache-2.0 */
/* The file of access tokens: one line NAME:ROLE:SHA256 for each, where SHA256 is that of the token
 * in hexadecimal digits; blank lines and lines that begin with # do not count. Tokens themselves
 * are kept nowhere. */
#ifndef TALUS_TOKEN_FILE_H
#define TALUS_TOKEN_FILE_H

#include "request_principal.h"
#include "talus/status.h"
#include "text.h"

#include <stdbool.h>
#include <stddef.h>

enum { TOKEN_LENGTH_MAX = 512 };

struct token {
    struct principal principal;
    unsigned char digest[TOKEN_DIGEST_SIZE]; /* SHA-256 */
};

/* Owns its tokens; names and digests are unique. A zeroed set is empty. */
struct token_set {
    struct token *tokens;
    size_t count;
};

/* Parses the content of a file (changed on the way) into an empty set. TALUS_INVALID, code
 * "tokens", if a line is wrong or there is no token at all; `mistakes` then gets one line of text
 * for each ("line 3: ...", never with anything that may be a secret) and the set stays empty. */
TALUS_MUST_CHECK enum talus_status token_set_parse(struct token_set *set, char *content,
                                                   struct text *mistakes,
                                                   struct talus_error *error);
/* The same for a file, which must be a regular one of at most 256 KiB that not everyone can write.
 * *exposed tells whether everyone can read it. TALUS_IO if it cannot be read. */
TALUS_MUST_CHECK enum talus_status token_set_read(struct token_set *set, const char *path,
                                                  bool *exposed, struct text *mistakes,
                                                  struct talus_error *error);
/* The token with this digest, or NULL. Takes the same time whichever it is, and if it is none. */
const struct token *token_set_find(const struct token_set *set,
                                   const unsigned char digest[TOKEN_DIGEST_SIZE]);
/* The digest of a token as a client sends it. False if no token looks like that: 1 to 512
 * characters of RFC 6750, section 2.1. */
bool token_digest(const char *token, unsigned char digest[TOKEN_DIGEST_SIZE]);
/* Wipes the set. */
void token_set_release(struct token_set *set);

#endif
