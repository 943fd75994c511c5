/* SPDX-License-Identifier: Apache-2.0 */
#include "tokens.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

struct tokens {
    const char *path; /* NULL: no tokens */
    pthread_rwlock_t lock;
    struct token_set set;
    bool stale; /* the file could not be read again */
};

static void mistakes_log(const char *path, const struct text *mistakes)
{
    if (mistakes->length > 0)
        (void)fprintf(stderr, "talusd: token file %s:\n%s", path, mistakes->data);
}

enum talus_status tokens_reload(struct tokens *tokens, struct talus_error *error)
{
    struct token_set fresh = {0};
    struct text mistakes = {0};
    bool exposed = false;
    if (tokens->path == NULL)
        return TALUS_OK;
    enum talus_status status = token_set_read(&fresh, tokens->path, &exposed, &mistakes, error);
    mistakes_log(tokens->path, &mistakes);
    text_release(&mistakes);
    if (status == TALUS_OK && exposed)
        (void)fprintf(stderr, "talusd: warning: everyone can read the token file %s (chmod 640)\n",
                      tokens->path);
    (void)pthread_rwlock_wrlock(&tokens->lock);
    struct token_set old = status == TALUS_OK ? tokens->set : fresh;
    if (status == TALUS_OK)
        tokens->set = fresh;
    tokens->stale = status != TALUS_OK;
    (void)pthread_rwlock_unlock(&tokens->lock);
    token_set_release(&old);
    return status;
}

enum talus_status tokens_create(struct tokens **result, const char *path, struct talus_error *error)
{
    struct tokens *tokens = calloc(1, sizeof *tokens);
    *result = tokens;
    if (tokens == NULL)
        return talus_error_memory(error);
    tokens->path = path;
    (void)pthread_rwlock_init(&tokens->lock, NULL);
    enum talus_status status = tokens_reload(tokens, error);
    if (status == TALUS_OK)
        return TALUS_OK;
    tokens_destroy(tokens);
    *result = NULL;
    return status;
}

void tokens_destroy(struct tokens *tokens)
{
    if (tokens == NULL)
        return;
    token_set_release(&tokens->set);
    (void)pthread_rwlock_destroy(&tokens->lock);
    free(tokens);
}

bool tokens_configured(const struct tokens *tokens)
{
    return tokens->path != NULL;
}

bool tokens_are_stale(struct tokens *tokens)
{
    (void)pthread_rwlock_rdlock(&tokens->lock);
    bool stale = tokens->stale;
    (void)pthread_rwlock_unlock(&tokens->lock);
    return stale;
}

size_t tokens_count(struct tokens *tokens)
{
    (void)pthread_rwlock_rdlock(&tokens->lock);
    size_t count = tokens->set.count;
    (void)pthread_rwlock_unlock(&tokens->lock);
    return count;
}

bool tokens_find(struct tokens *tokens, const unsigned char digest[TOKEN_DIGEST_SIZE],
                 struct principal *principal)
{
    (void)pthread_rwlock_rdlock(&tokens->lock);
    const struct token *token = token_set_find(&tokens->set, digest);
    bool found = token != NULL;
    if (found && principal != NULL)
        *principal = token->principal;
    (void)pthread_rwlock_unlock(&tokens->lock);
    return found;
}
