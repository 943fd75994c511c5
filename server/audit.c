/* SPDX-License-Identifier: Apache-2.0 */
#include "audit.h"

#include "audit_line.h"
#include "folder.h"
#include "json_text.h"
#include "moment.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { WAITING_BYTES_MAX = 65536 };
static const double refusals_per_second = 10;
static const char log_name[] = "audit.ndjson";

/* The HTTP thread takes only `mutex`, which nobody holds while waiting for the disk. */
struct audit {
    char *folder;
    const struct config *config;
    pthread_t thread;
    pthread_mutex_t mutex; /* for what follows, down to `stopping` */
    pthread_cond_t wake;
    struct text waiting;            /* lines of refusals, written by the thread */
    double allowance, allowance_at; /* of refusals; a monotonic clock */
    uint64_t suppressed;
    bool stopping;
    pthread_mutex_t file_mutex; /* for the rest */
    int descriptor;
    off_t size;
    uint64_t lost;
    bool dirty; /* something is not flushed */
    bool started;
};

static void path_print(const struct audit *audit, int number, char *path, size_t size)
{
    if (number == 0)
        (void)snprintf(path, size, "%s/%s", audit->folder, log_name);
    else
        (void)snprintf(path, size, "%s/%s.%d", audit->folder, log_name, number);
}

/* The length of a file without a torn last line. */
static off_t whole_lines(int descriptor, off_t size)
{
    char last;
    while (size > 0 && pread(descriptor, &last, 1, size - 1) == 1 && last != '\n')
        size--;
    return size;
}

static bool log_open(struct audit *audit)
{
    char path[4200];
    struct stat information;
    path_print(audit, 0, path, sizeof path);
    audit->descriptor = open(path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0640);
    if (audit->descriptor < 0 || fstat(audit->descriptor, &information) != 0)
        return false;
    audit->size = whole_lines(audit->descriptor, information.st_size);
    return audit->size == information.st_size || ftruncate(audit->descriptor, audit->size) == 0;
}

/* Makes room for the log under its name: number 1 is the youngest. */
static void log_rotate(struct audit *audit)
{
    char from[4200], to[4200];
    struct talus_error error = {0};
    (void)fdatasync(audit->descriptor);
    (void)close(audit->descriptor);
    for (int number = (int)audit->config->audit_files; number > 0; number--) {
        path_print(audit, number - 1, from, sizeof from);
        path_print(audit, number, to, sizeof to);
        (void)rename(from, to);
    }
    if (!log_open(audit) || folder_sync(audit->folder, &error) != TALUS_OK)
        (void)fprintf(stderr, "talusd: the audit log cannot be rotated: %s\n", strerror(errno));
}

/* How many bytes of a text could be appended. */
static size_t text_write(int descriptor, const struct text *text)
{
    size_t done = 0;
    while (descriptor >= 0 && done < text->length) {
        ssize_t count = write(descriptor, text->data + done, text->length - done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            break;
        done += (size_t)count;
    }
    return done;
}

/* Appends whole lines; the file's mutex is held. What cannot be written is counted, and told once.
 */
static void lines_write(struct audit *audit, const struct text *lines)
{
    if (audit->descriptor < 0 && !log_open(audit))
        audit->descriptor = -1;
    size_t done = lines->failed ? 0 : text_write(audit->descriptor, lines);
    if (lines->failed || done < lines->length) {
        if (audit->lost == 0)
            (void)fprintf(stderr, "talusd: the audit log cannot be written: %s\n",
                          strerror(lines->failed ? ENOMEM : errno));
        audit->lost++;
        /* Half a line would spoil the one behind it. */
        if (done > 0 && ftruncate(audit->descriptor, audit->size) != 0)
            (void)fprintf(stderr, "talusd: the audit log has a torn line\n");
        return;
    }
    audit->size += (off_t)done;
    audit->dirty = true;
    if ((double)audit->size >= audit->config->audit_bytes)
        log_rotate(audit);
}

static void lines_flush(struct audit *audit)
{
    (void)pthread_mutex_lock(&audit->file_mutex);
    int descriptor = audit->dirty ? fcntl(audit->descriptor, F_DUPFD_CLOEXEC, 3) : -1;
    audit->dirty = false;
    (void)pthread_mutex_unlock(&audit->file_mutex);
    /* Changes go on while the disk is waited for. */
    if (descriptor < 0)
        return;
    (void)fdatasync(descriptor);
    (void)close(descriptor);
}

static void lines_append(struct audit *audit, const struct text *lines)
{
    (void)pthread_mutex_lock(&audit->file_mutex);
    lines_write(audit, lines);
    (void)pthread_mutex_unlock(&audit->file_mutex);
}

/* Waits for a second or the end. True: this is the end. */
static bool audit_wait(struct audit *audit, struct text *waiting)
{
    struct timespec until;
    int waited = 0;
    (void)clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec++;
    (void)pthread_mutex_lock(&audit->mutex);
    while (!audit->stopping && waited != ETIMEDOUT)
        waited = pthread_cond_timedwait(&audit->wake, &audit->mutex, &until);
    bool stopping = audit->stopping;
    *waiting = audit->waiting;
    audit->waiting = (struct text){0};
    (void)pthread_mutex_unlock(&audit->mutex);
    return stopping;
}

static void *audit_main(void *argument)
{
    struct audit *audit = argument;
    bool last = false;
    while (!last) {
        struct text waiting;
        last = audit_wait(audit, &waiting);
        if (waiting.length > 0 || waiting.failed)
            lines_append(audit, &waiting);
        text_release(&waiting);
        lines_flush(audit);
    }
    return NULL;
}

static enum talus_status audit_start(struct audit *audit, struct talus_error *error)
{
    if (!log_open(audit))
        return talus_error_set(error, TALUS_IO, "audit", "", "cannot open %s/%s: %s", audit->folder,
                               log_name, strerror(errno));
    audit->allowance = refusals_per_second;
    audit->allowance_at = moment_monotonic();
    audit->started = pthread_create(&audit->thread, NULL, audit_main, audit) == 0;
    return audit->started
               ? TALUS_OK
               : talus_error_set(error, TALUS_INTERNAL, "thread", "", "cannot start a thread");
}

enum talus_status audit_create(struct audit **result, const char *folder,
                               const struct config *config, struct talus_error *error)
{
    struct audit *audit = calloc(1, sizeof *audit);
    *result = NULL;
    if (audit == NULL)
        return talus_error_memory(error);
    (void)pthread_mutex_init(&audit->mutex, NULL);
    (void)pthread_mutex_init(&audit->file_mutex, NULL);
    (void)pthread_cond_init(&audit->wake, NULL);
    audit->config = config;
    audit->descriptor = -1;
    audit->folder = strdup(folder);
    enum talus_status status =
        audit->folder == NULL ? talus_error_memory(error) : audit_start(audit, error);
    if (status == TALUS_OK)
        *result = audit;
    else
        audit_destroy(audit);
    return status;
}

void audit_destroy(struct audit *audit)
{
    if (audit == NULL)
        return;
    if (audit->started) {
        (void)pthread_mutex_lock(&audit->mutex);
        audit->stopping = true;
        (void)pthread_cond_signal(&audit->wake);
        (void)pthread_mutex_unlock(&audit->mutex);
        (void)pthread_join(audit->thread, NULL);
    }
    if (audit->descriptor >= 0)
        (void)close(audit->descriptor);
    (void)pthread_cond_destroy(&audit->wake);
    (void)pthread_mutex_destroy(&audit->mutex);
    (void)pthread_mutex_destroy(&audit->file_mutex);
    free(audit->folder);
    free(audit);
}

void audit_request(struct audit *audit, const struct request *request)
{
    struct text line = {0};
    audit_line_request(&line, request, 0);
    lines_append(audit, &line);
    text_release(&line);
}

/* Whether another refusal may be told now; the mutex is held. */
static bool refusal_allowed(struct audit *audit)
{
    double now = moment_monotonic();
    audit->allowance += (now - audit->allowance_at) * refusals_per_second;
    audit->allowance_at = now;
    if (audit->allowance > refusals_per_second)
        audit->allowance = refusals_per_second;
    if (audit->allowance < 1 || audit->waiting.length > WAITING_BYTES_MAX)
        return false;
    audit->allowance -= 1;
    return true;
}

void audit_refusal(struct audit *audit, const struct request *request)
{
    (void)pthread_mutex_lock(&audit->mutex);
    if (refusal_allowed(audit)) {
        audit_line_request(&audit->waiting, request, audit->suppressed);
        audit->suppressed = 0;
    } else {
        audit->suppressed++;
    }
    (void)pthread_mutex_unlock(&audit->mutex);
}

void audit_reload(struct audit *audit, uid_t user, bool good, size_t token_count)
{
    char at[MOMENT_TEXT_SIZE];
    struct text line = {0};
    moment_now_text(at);
    json_t *object =
        json_pack("{s:s, s:s, s:s, s:I, s:s, s:s, s:I}", "at", at, "who", "local", "from", "signal",
                  "uid", (json_int_t)user, "action", "reload", "outcome", good ? "read" : "kept",
                  "tokens", (json_int_t)token_count);
    json_text_add(&line, object, 0);
    text_add_string(&line, "\n");
    json_decref(object);
    lines_append(audit, &line);
    text_release(&line);
}

uint64_t audit_lost_count(struct audit *audit)
{
    (void)pthread_mutex_lock(&audit->file_mutex);
    uint64_t count = audit->lost;
    (void)pthread_mutex_unlock(&audit->file_mutex);
    return count;
}
