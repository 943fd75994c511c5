/* SPDX-License-Identifier: Apache-2.0 */
#include "job_cache.h"

#include "byte_range.h"
#include "identifier.h"
#include "job_reply.h"
#include "jobs.h"
#include "revision.h"
#include "service.h"
#include "supervisor.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* A job has one place, which it may have to leave to another. */
enum { PLACE_COUNT = 2048, BODY_BYTES_MAX = 32 << 10 };

/* Shared by its place and the answers that are being sent. */
struct cached_body {
    atomic_uint use_count;
    size_t length;
    char data[];
};

struct cached_job {
    char id[IDENTIFIER_LENGTH + 1], etag[REVISION_ETAG_SIZE];
    struct job_cache_mark mark;
    bool running;
    struct cached_body *body; /* NULL: empty */
};

struct job_cache {
    pthread_mutex_t mutex;
    struct cached_job places[PLACE_COUNT];
};

enum talus_status job_cache_create(struct job_cache **result, struct talus_error *error)
{
    struct job_cache *cache = calloc(1, sizeof *cache);
    *result = cache;
    if (cache == NULL)
        return talus_error_memory(error);
    (void)pthread_mutex_init(&cache->mutex, NULL);
    return TALUS_OK;
}

static void body_release(void *context)
{
    struct cached_body *body = context;
    if (body != NULL && atomic_fetch_sub(&body->use_count, 1) == 1)
        free(body);
}

void job_cache_destroy(struct job_cache *cache)
{
    if (cache == NULL)
        return;
    for (size_t index = 0; index < PLACE_COUNT; index++)
        body_release(cache->places[index].body);
    (void)pthread_mutex_destroy(&cache->mutex);
    free(cache);
}

/* Where a job has its place (FNV-1a). */
static struct cached_job *place_of(struct job_cache *cache, const char *id)
{
    uint32_t hash = 2166136261U;
    for (; *id != '\0'; id++)
        hash = (hash ^ (unsigned char)*id) * 16777619U;
    return &cache->places[hash % PLACE_COUNT];
}

struct job_cache_mark job_cache_mark(const struct service *service)
{
    return (struct job_cache_mark){.commits = store_commit_count(service->store),
                                   .progress = supervisor_progress_count(service->supervisor)};
}

/* A job as its answer, with one use; NULL without memory. */
static struct cached_body *body_make(struct service *service, const struct job *job)
{
    struct text text = {0};
    jobs_text_add(&text, service, job, NULL);
    text_add_string(&text, "\n");
    struct cached_body *body = text.failed ? NULL : malloc(sizeof *body + text.length);
    if (body != NULL) {
        atomic_init(&body->use_count, 1);
        body->length = text.length;
        memcpy(body->data, text.data, text.length);
    }
    text_release(&text);
    return body;
}

static void body_keep(struct job_cache *cache, const struct job *job, struct job_cache_mark mark,
                      struct cached_body *body)
{
    (void)atomic_fetch_add(&body->use_count, 1);
    (void)pthread_mutex_lock(&cache->mutex);
    struct cached_job *place = place_of(cache, job->id);
    struct cached_body *before = place->body;
    memcpy(place->id, job->id, sizeof place->id);
    revision_etag(job->revision, place->etag);
    place->mark = mark;
    place->running = job->state == JOB_RUNNING;
    place->body = body;
    (void)pthread_mutex_unlock(&cache->mutex);
    body_release(before);
}

static void reply_body(struct request *request, struct cached_body *body, const char *etag)
{
    reply_json_shared(&request->reply, MHD_HTTP_OK, body->data, body->length, body_release, body);
    reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
}

void job_cache_reply(struct request *request, const struct job *job, struct job_cache_mark mark)
{
    char etag[REVISION_ETAG_SIZE];
    struct cached_body *body = body_make(request->service, job);
    if (body == NULL)
        return;
    if (body->length <= BODY_BYTES_MAX && strlen(job->id) == IDENTIFIER_LENGTH)
        body_keep(request->service->job_cache, job, mark, body);
    revision_etag(job->revision, etag);
    reply_body(request, body, etag);
}

/* A true body of a job, with one more use, and its etag; or NULL. */
static struct cached_body *body_find(struct job_cache *cache, const char *id,
                                     struct job_cache_mark now, char etag[REVISION_ETAG_SIZE])
{
    struct cached_body *body = NULL;
    (void)pthread_mutex_lock(&cache->mutex);
    const struct cached_job *place = place_of(cache, id);
    if (place->body != NULL && strcmp(place->id, id) == 0 && place->mark.commits == now.commits &&
        (!place->running || place->mark.progress == now.progress)) {
        body = place->body;
        (void)atomic_fetch_add(&body->use_count, 1);
        memcpy(etag, place->etag, REVISION_ETAG_SIZE);
    }
    (void)pthread_mutex_unlock(&cache->mutex);
    return body;
}

bool job_cache_answer(struct request *request)
{
    char etag[REVISION_ETAG_SIZE];
    if (request->target.query_count > 0)
        return false;
    struct cached_body *body = body_find(request->service->job_cache, request->segment,
                                         job_cache_mark(request->service), etag);
    if (body == NULL)
        return false;
    const char *known = request_header(request, MHD_HTTP_HEADER_IF_NONE_MATCH);
    if (known == NULL || !etag_listed(known, etag, true)) {
        reply_body(request, body, etag);
        return true;
    }
    body_release(body);
    reply_empty(&request->reply, MHD_HTTP_NOT_MODIFIED);
    reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
    return true;
}
