/* SPDX-License-Identifier: Apache-2.0 */
/* The access tokens in force. Any thread may call any function. */
#ifndef TALUS_TOKENS_H
#define TALUS_TOKENS_H

#include "token_file.h"

struct tokens;

/* Reads the file (NULL: no tokens at all). Its mistakes go to the log, which is stderr. */
TALUS_MUST_CHECK enum talus_status tokens_create(struct tokens **tokens, const char *path,
                                                 struct talus_error *error);
/* NULL is fine. */
void tokens_destroy(struct tokens *tokens);
/* Reads the file again. With a mistake in it the tokens of before stay in force, and
 * tokens_are_stale is true until a reading succeeds. */
TALUS_MUST_CHECK enum talus_status tokens_reload(struct tokens *tokens, struct talus_error *error);
/* Whether there is a file of tokens. */
bool tokens_configured(const struct tokens *tokens);
bool tokens_are_stale(struct tokens *tokens);
size_t tokens_count(struct tokens *tokens);
/* Whether a token with this digest is in force; *principal (or NULL) gets its name and role. */
bool tokens_find(struct tokens *tokens, const unsigned char digest[TOKEN_DIGEST_SIZE],
                 struct principal *principal);

#endif
