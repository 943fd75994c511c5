/* SPDX-License-Identifier: Apache-2.0 */
#include "feed.h"

#include "job.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* Entries that are kept, and what is read from the store at once. */
enum { RECENT_MAX = 1024, PROGRESS_MAX = 1024, BATCH_ROWS = 256, OUT_BYTES = 64 << 10 };
static const int64_t entry_bytes = 250; /* about, for a backlog */

struct entry {
    int64_t row; /* or number of the progress */
    char *text;
};

/* The last entries there were; number n is at n % size. */
struct ring {
    struct entry *entries;
    size_t size;
    uint64_t count; /* ever added */
};

struct feed {
    struct store *store;
    pthread_mutex_t mutex;
    struct ring recent, progress;
    int64_t last; /* row of the last entry */
    bool begun;   /* `last` is known */
};

/* Takes the text over. */
static void ring_add(struct ring *ring, int64_t row,
                     char *text) /* NOLINT(readability-non-const-parameter) */
{
    struct entry *entry = &ring->entries[ring->count++ % ring->size];
    free(entry->text);
    *entry = (struct entry){.row = row, .text = text};
}

static void ring_release(struct ring *ring)
{
    for (size_t index = 0; ring->entries != NULL && index < ring->size; index++)
        free(ring->entries[index].text);
    free(ring->entries);
}

enum talus_status feed_create(struct feed **result, struct store *store, struct talus_error *error)
{
    struct feed *feed = calloc(1, sizeof *feed);
    *result = feed;
    if (feed == NULL)
        return talus_error_memory(error);
    feed->store = store;
    (void)pthread_mutex_init(&feed->mutex, NULL);
    feed->recent = (struct ring){calloc(RECENT_MAX, sizeof(struct entry)), RECENT_MAX, 0};
    feed->progress = (struct ring){calloc(PROGRESS_MAX, sizeof(struct entry)), PROGRESS_MAX, 0};
    if (feed->recent.entries != NULL && feed->progress.entries != NULL)
        return TALUS_OK;
    feed_destroy(feed);
    *result = NULL;
    return talus_error_memory(error);
}

void feed_destroy(struct feed *feed)
{
    if (feed == NULL)
        return;
    ring_release(&feed->recent);
    ring_release(&feed->progress);
    (void)pthread_mutex_destroy(&feed->mutex);
    free(feed);
}

/* A transition as its events: `state`, and `done` if nothing follows, or `study`. */
static void change_write(struct text *text, const struct store_change *change)
{
    json_t *members =
        json_pack("{s:s, s:s, s:s, s:I, s:s*, s:s*}", change->study ? "study" : "job", change->id,
                  "at", change->at, "state", change->state, "attempt", (json_int_t)change->attempt,
                  "reason", change->reason, "detail", change->detail);
    if (change->study)
        (void)json_object_del(members, "attempt");
    char *data = members == NULL ? NULL : json_dumps(members, JSON_COMPACT);
    const enum job_state state = job_state_find(change->state);
    const bool done = !change->study && state != JOB_STATE_COUNT && job_state_final(state);
    json_decref(members);
    text->failed = text->failed || data == NULL;
    text_print(text, "id: %" PRId64 "\nevent: %s\ndata: %s\n\n", change->row,
               change->study ? "study" : "state", data == NULL ? "" : data);
    if (done)
        text_print(text, "id: %" PRId64 "\nevent: done\ndata: %s\n\n", change->row,
                   data == NULL ? "" : data);
    free(data);
}

static bool change_keep(const struct store_change *change, void *context)
{
    struct feed *feed = context;
    struct text text = {0};
    change_write(&text, change);
    char *data = text_take(&text);
    if (data != NULL)
        ring_add(&feed->recent, change->row, data);
    feed->last = change->row;
    return true;
}

void feed_refresh(struct feed *feed)
{
    struct talus_error error = {0};
    int64_t before = -1;
    (void)pthread_mutex_lock(&feed->mutex);
    if (!feed->begun)
        feed->begun = store_changes_last(feed->store, &feed->last, &error) == TALUS_OK;
    while (feed->begun && feed->last != before) {
        before = feed->last;
        if (store_changes(feed->store, feed->last, BATCH_ROWS, change_keep, feed, &error) !=
            TALUS_OK)
            break;
    }
    (void)pthread_mutex_unlock(&feed->mutex);
}

void feed_progress(struct feed *feed, const char *job, const json_t *progress)
{
    struct text text = {0};
    json_t *members = json_pack("{s:s}", "job", job);
    if (members != NULL)
        (void)json_object_update_missing(members, (json_t *)(uintptr_t)progress);
    char *data = members == NULL ? NULL : json_dumps(members, JSON_COMPACT);
    if (data != NULL)
        text_print(&text, "event: progress\ndata: %s\n\n", data);
    free(data);
    json_decref(members);
    char *event = text_take(&text);
    if (event == NULL)
        return;
    (void)pthread_mutex_lock(&feed->mutex);
    ring_add(&feed->progress, (int64_t)feed->progress.count + 1, event);
    (void)pthread_mutex_unlock(&feed->mutex);
}

int64_t feed_last(struct feed *feed)
{
    feed_refresh(feed);
    (void)pthread_mutex_lock(&feed->mutex);
    int64_t last = feed->last;
    (void)pthread_mutex_unlock(&feed->mutex);
    return last;
}

void feed_reader_open(struct feed_reader *reader, struct feed *feed, int64_t row)
{
    memset(reader, 0, sizeof *reader);
    reader->feed = feed;
    reader->row = row;
    (void)pthread_mutex_lock(&feed->mutex);
    reader->progress = feed->progress.count;
    (void)pthread_mutex_unlock(&feed->mutex);
}

static bool change_tell(const struct store_change *change, void *context)
{
    struct feed_reader *reader = context;
    change_write(&reader->out, change);
    reader->row = change->row;
    return reader->out.length < OUT_BYTES;
}

/* Copies what the ring has for a reader; false if it lacks some of it. */
static bool recent_copy(struct feed_reader *reader)
{
    const struct feed *feed = reader->feed;
    const struct ring *ring = &feed->recent;
    uint64_t kept = ring->count < ring->size ? ring->count : ring->size;
    if (reader->row >= feed->last)
        return true;
    /* The entry before the oldest may be one that the reader lacks. */
    uint64_t index = ring->count - kept;
    if (kept == 0 || ring->entries[index % ring->size].row > reader->row + 1)
        return false;
    for (; index < ring->count && reader->out.length < OUT_BYTES; index++) {
        const struct entry *entry = &ring->entries[index % ring->size];
        if (entry->row <= reader->row)
            continue;
        text_add_string(&reader->out, entry->text);
        reader->row = entry->row;
    }
    return true;
}

/* Progress is for those who are up to date. */
static void progress_copy(struct feed_reader *reader)
{
    const struct ring *ring = &reader->feed->progress;
    if (ring->count > reader->progress + ring->size)
        reader->progress = ring->count - ring->size;
    while (reader->progress < ring->count && reader->out.length < OUT_BYTES)
        text_add_string(&reader->out, ring->entries[reader->progress++ % ring->size].text);
}

void feed_reader_fill(struct feed_reader *reader)
{
    struct feed *feed = reader->feed;
    struct talus_error error = {0};
    (void)pthread_mutex_lock(&feed->mutex);
    bool recent = recent_copy(reader);
    if (recent && reader->row >= feed->last)
        progress_copy(reader);
    else
        reader->progress = feed->progress.count;
    int64_t last = feed->last;
    (void)pthread_mutex_unlock(&feed->mutex);
    if (recent)
        return;
    int64_t before = reader->row;
    enum talus_status status =
        store_changes(feed->store, reader->row, BATCH_ROWS, change_tell, reader, &error);
    /* Rows of what was deleted are gone for good. */
    if (status == TALUS_OK && reader->row == before)
        reader->row = last;
}

int64_t feed_reader_backlog(struct feed_reader *reader)
{
    (void)pthread_mutex_lock(&reader->feed->mutex);
    int64_t rows = reader->feed->last - reader->row;
    (void)pthread_mutex_unlock(&reader->feed->mutex);
    return rows * entry_bytes;
}

void feed_reader_skip(struct feed_reader *reader)
{
    struct feed *feed = reader->feed;
    (void)pthread_mutex_lock(&feed->mutex);
    int64_t before = reader->row;
    reader->row = feed->last;
    reader->progress = feed->progress.count;
    (void)pthread_mutex_unlock(&feed->mutex);
    text_print(&reader->out, "id: %" PRId64 "\nevent: gap\ndata: {\"after\":\"%" PRId64 "\"}\n\n",
               reader->row, before);
}

void feed_reader_close(struct feed_reader *reader)
{
    text_release(&reader->out);
}
