/* SPDX-License-Identifier: Apache-2.0 */
#include "access.h"

#include "address.h"
#include "service.h"
#include "studies/study_store.h"
#include "tokens.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct access {
    bool local, required;
    struct tokens *tokens;
};

enum talus_status access_create(struct access **result, const struct config *config, int listener,
                                struct talus_error *error)
{
    *result = NULL;
    bool local = address_is_local(listener);
    if (config->tokens == NULL && !local)
        return talus_error_set(error, TALUS_INVALID, "tokens", "",
                               "%s is not a loopback address: it needs a file of tokens "
                               "(--tokens)",
                               config->listen);
    if (config->tokens == NULL && config->require_token)
        return talus_error_set(error, TALUS_INVALID, "tokens", "",
                               "require_token needs a file of tokens (--tokens)");
    struct access *access = calloc(1, sizeof *access);
    if (access == NULL)
        return talus_error_memory(error);
    access->local = local;
    access->required = !local || config->require_token;
    enum talus_status status = tokens_create(&access->tokens, config->tokens, error);
    if (status != TALUS_OK) {
        free(access);
        return status;
    }
    *result = access;
    return TALUS_OK;
}

void access_destroy(struct access *access)
{
    if (access == NULL)
        return;
    tokens_destroy(access->tokens);
    free(access);
}

enum talus_status access_reload(struct access *access, struct talus_error *error)
{
    return tokens_reload(access->tokens, error);
}

bool access_is_local(const struct access *access)
{
    return access->local;
}

bool access_is_stale(struct access *access)
{
    return tokens_are_stale(access->tokens);
}

size_t access_token_count(struct access *access)
{
    return tokens_count(access->tokens);
}

bool access_holds(struct access *access, const struct token_proof *proof)
{
    return !proof->given || tokens_find(access->tokens, proof->digest, NULL);
}

/* 401 or 403 with the challenge of RFC 6750. */
static bool refuse(struct request *request, unsigned int status, const char *code,
                   const char *challenge, const char *detail)
{
    reply_problem(&request->reply, status, code, request->raw, NULL, "%s", detail);
    reply_header(&request->reply, MHD_HTTP_HEADER_WWW_AUTHENTICATE, challenge);
    request->route = NULL; /* nothing may handle it, even if memory for the reply has run out */
    request->refused = true;
    return false;
}

static const char challenge_plain[] = "Bearer realm=\"talusd\"";
static const char challenge_invalid[] = "Bearer realm=\"talusd\", error=\"invalid_token\"";
static const char challenge_role[] = "Bearer realm=\"talusd\", error=\"insufficient_scope\"";

/* URLs are kept in histories and logs, so a token in one is told to whoever reads those. */
static bool target_check(struct request *request)
{
    for (size_t index = 0; index < request->target.query_count; index++) {
        const char *name = request->target.query[index].name;
        if (strcasecmp(name, "token") != 0 && strcasecmp(name, "access_token") != 0)
            continue;
        request->raw[strcspn(request->raw, "?")] = '\0';
        reply_problem(&request->reply, MHD_HTTP_BAD_REQUEST, "token_in_url", request->raw, NULL,
                      "a token belongs into the header field Authorization, never into a URL: "
                      "replace this one, others may have seen it");
        request->route = NULL;
        request->refused = true;
        return false;
    }
    return true;
}

/* The token of Authorization: Bearer, or NULL: another scheme is meant for someone else. */
static const char *token_sent(const struct request *request)
{
    static const char scheme[] = "Bearer";
    const char *value = request_header(request, MHD_HTTP_HEADER_AUTHORIZATION);
    if (value == NULL || strncasecmp(value, scheme, sizeof scheme - 1) != 0)
        return NULL;
    value += sizeof scheme - 1;
    return *value == '\0' || *value == ' ' ? value + strspn(value, " ") : NULL;
}

static bool authenticate(struct request *request)
{
    struct access *access = request->service->access;
    const char *token = token_sent(request);
    request->principal = (struct principal){.role = ROLE_ANYONE};
    if (token == NULL) {
        request->principal.role = access->required ? ROLE_ANYONE : ROLE_ADMIN;
        return true;
    }
    request->proof.given = true;
    if (token_digest(token, request->proof.digest) &&
        tokens_find(access->tokens, request->proof.digest, &request->principal))
        return true;
    return refuse(request, MHD_HTTP_UNAUTHORIZED, "token_invalid", challenge_invalid,
                  tokens_configured(access->tokens)
                      ? "this token is not valid"
                      : "this daemon has no tokens: call it without one");
}

bool access_check(struct request *request)
{
    if (!target_check(request) || !authenticate(request))
        return false;
    enum role needed = request->route == NULL ? ROLE_READ : request->route->role;
    if (request->principal.role >= needed)
        return true;
    if (request->principal.role == ROLE_ANYONE)
        return refuse(request, MHD_HTTP_UNAUTHORIZED, "token_missing", challenge_plain,
                      "a token is needed: Authorization: Bearer TOKEN");
    /* A path that does not exist has its 404 already. */
    return request->route == NULL ||
           refuse(request, MHD_HTTP_FORBIDDEN, "role", challenge_role,
                  needed == ROLE_ADMIN ? "this needs a token with the role admin"
                                       : "this needs a token with the role submit or admin");
}

bool access_is_change(const struct request *request)
{
    static const char *const safe[] = {"GET", "HEAD", "OPTIONS", "TRACE"}; /* RFC 9110, 9.2.1 */
    for (size_t index = 0; index < sizeof safe / sizeof safe[0]; index++) {
        if (strcmp(request->method, safe[index]) == 0)
            return false;
    }
    /* A forecast has a body, and nothing else of a submission. */
    return request->route == NULL || request->route->handle != handle_forecast;
}

static enum talus_status job_owner(struct request *request, char *owner, size_t size,
                                   struct talus_error *error)
{
    struct job job = {0};
    enum talus_status status =
        store_job_read(request->service->store, request->segment, &job, error);
    if (status == TALUS_OK)
        (void)snprintf(owner, size, "%s", job.owner == NULL ? "" : job.owner);
    job_release(&job);
    return status;
}

static enum talus_status study_owner(struct request *request, char *owner, size_t size,
                                     struct talus_error *error)
{
    struct study study = {0};
    enum talus_status status =
        study_store_read(request->service->store, request->segment, false, &study, error);
    if (status == TALUS_OK)
        (void)snprintf(owner, size, "%s", study.owner == NULL ? "" : study.owner);
    study_release(&study);
    return status;
}

/* How to find out whose a thing is; things of other paths belong to nobody. */
static const struct {
    const char *path; /* behind v1/ */
    enum talus_status (*read)(struct request *request, char *owner, size_t size,
                              struct talus_error *error);
} owners[] = {{"jobs", job_owner}, {"studies", study_owner}};

bool access_owner_check(struct request *request)
{
    char owner[sizeof request->principal.name];
    struct talus_error error = {0};
    size_t index = 0;
    if (request->principal.role >= ROLE_ADMIN || request->segment == NULL ||
        !access_is_change(request))
        return true;
    while (index < sizeof owners / sizeof owners[0] &&
           strcmp(owners[index].path, request->target.segments[1]) != 0)
        index++;
    bool known = index < sizeof owners / sizeof owners[0];
    enum talus_status status =
        known ? owners[index].read(request, owner, sizeof owner, &error) : TALUS_OK;
    /* What does not exist the handler says. */
    if (status != TALUS_OK || (known && strcmp(owner, request->principal.name) == 0))
        return true;
    return refuse(request, MHD_HTTP_FORBIDDEN, "owner", challenge_role,
                  "this was not submitted with your token: it needs one with the role admin");
}
