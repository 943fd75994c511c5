/* SPDX-License-Identifier: Apache-2.0 */
#include "event_log.h"

#include "base/protocol.h"
#include "folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* A line beyond this is no event of ours. */
enum { LINE_MAX_BYTES = 16 << 20, READ_BYTES = 64 << 10 };

int event_log_lock(const char *folder)
{
    char *path = folder_join(folder, PROTOCOL_LOCK_FILE);
    if (path == NULL)
        return -1;
    int descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0640);
    free(path);
    if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        int reason = errno;
        (void)close(descriptor);
        errno = reason;
        return -1;
    }
    return descriptor;
}

void event_log_state_line(struct text *text, const struct store_transition *transition)
{
    json_t *line = json_pack("{s:s, s:s, s:I, s:I, s:s, s:s*, s:s*}", "event", "state", "at",
                             transition->at, "attempt", (json_int_t)transition->attempt, "number",
                             (json_int_t)transition->number, "state", transition->state, "reason",
                             transition->reason, "detail", transition->detail);
    char *dump = line == NULL ? NULL : json_dumps(line, JSON_COMPACT);
    if (dump == NULL)
        text->failed = true;
    else
        text_print(text, "%s\n", dump);
    free(dump);
    json_decref(line);
}

static int64_t state_line_number(const char *line)
{
    static const char begin[] = "{\"event\":\"state\"";
    if (strncmp(line, begin, sizeof begin - 1) != 0)
        return 0;
    json_t *root = json_loads(line, 0, NULL);
    int64_t number = json_integer_value(json_object_get(root, "number"));
    json_decref(root);
    return number;
}

static bool number_visit(char *line, size_t length, int64_t end, void *context)
{
    int64_t *highest = context;
    (void)length;
    (void)end;
    int64_t number = state_line_number(line);
    if (number > *highest)
        *highest = number;
    return true;
}

static enum talus_status line_append(const struct store_transition *transition, void *context,
                                     struct talus_error *error)
{
    (void)error;
    event_log_state_line(context, transition);
    return TALUS_OK;
}

static enum talus_status lines_write(const char *path, int64_t length, const struct text *lines,
                                     struct talus_error *error)
{
    int descriptor = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
    bool good = descriptor >= 0;
    struct stat information;
    if (good)
        good = fstat(descriptor, &information) == 0;
    if (good && information.st_size > length)
        good = ftruncate(descriptor, length) == 0;
    if (good && lines->length > 0)
        good = write(descriptor, lines->data, lines->length) == (ssize_t)lines->length;
    if (good)
        good = fdatasync(descriptor) == 0;
    if (descriptor >= 0)
        (void)close(descriptor);
    return good ? TALUS_OK
                : talus_error_set(error, TALUS_IO, "io", "", "cannot write %s: %s", path,
                                  strerror(errno));
}

enum talus_status event_log_repair(struct store *store, const char *id, const char *folder,
                                   struct talus_error *error)
{
    struct event_tail tail = {.descriptor = -1};
    struct text lines = {0};
    int64_t highest = 0;
    char *path = folder_join(folder, PROTOCOL_EVENTS_FILE);
    if (path == NULL)
        return talus_error_memory(error);
    enum talus_status status = event_tail_read(&tail, folder, number_visit, &highest, error);
    if (status == TALUS_OK)
        status = store_transitions(store, id, highest, line_append, &lines, error);
    if (status == TALUS_OK && lines.failed)
        status = talus_error_memory(error);
    if (status == TALUS_OK)
        status = lines_write(path, tail.offset, &lines, error);
    event_tail_close(&tail);
    text_release(&lines);
    free(path);
    return status;
}

int64_t event_log_last_number(const char *folder)
{
    enum { TAIL = 8192 };
    char buffer[TAIL + 1];
    int descriptor = folder_open(folder, PROTOCOL_EVENTS_FILE);
    if (descriptor < 0)
        return 0;
    off_t size = lseek(descriptor, 0, SEEK_END);
    off_t begin = size > TAIL ? size - TAIL : 0;
    ssize_t length = pread(descriptor, buffer, TAIL, begin);
    (void)close(descriptor);
    if (length <= 1 || buffer[length - 1] != '\n')
        return 0;
    buffer[length - 1] = '\0';
    const char *line = strrchr(buffer, '\n');
    return state_line_number(line == NULL ? buffer : line + 1);
}

/* Visits the complete lines of a buffer; returns how many bytes they take. */
static size_t lines_visit(char *buffer, size_t length, int64_t offset,
                          bool (*visit)(char *line, size_t length, int64_t end, void *context),
                          void *context, bool *more)
{
    size_t begin = 0;
    while (*more) {
        char *newline = memchr(buffer + begin, '\n', length - begin);
        if (newline == NULL)
            break;
        *newline = '\0';
        size_t end = (size_t)(newline - buffer) + 1;
        *more = visit(buffer + begin, end - begin - 1, offset + (int64_t)end, context);
        begin = end;
    }
    return begin;
}

enum talus_status event_tail_read(struct event_tail *tail, const char *folder,
                                  bool (*visit)(char *line, size_t length, int64_t end,
                                                void *context),
                                  void *context, struct talus_error *error)
{
    if (tail->descriptor < 0)
        tail->descriptor = folder_open(folder, PROTOCOL_EVENTS_FILE);
    struct stat information;
    if (tail->descriptor < 0 ||
        (fstat(tail->descriptor, &information) == 0 && information.st_size <= tail->offset))
        return TALUS_OK;
    size_t capacity = READ_BYTES;
    char *buffer = malloc(capacity);
    enum talus_status status = TALUS_OK;
    bool more = true;
    while (more && buffer != NULL) {
        ssize_t length = pread(tail->descriptor, buffer, capacity, tail->offset);
        if (length < 0)
            status =
                talus_error_set(error, TALUS_IO, "io", "", "cannot read the events in %s", folder);
        if (length <= 0)
            break;
        size_t used = lines_visit(buffer, (size_t)length, tail->offset, visit, context, &more);
        tail->offset += (int64_t)used;
        if (used == 0 && ((size_t)length < capacity || capacity >= LINE_MAX_BYTES))
            break;
        if (used == 0) {
            capacity *= 2;
            free(buffer);
            buffer = malloc(capacity);
        }
    }
    if (buffer == NULL)
        status = talus_error_memory(error);
    free(buffer);
    return status;
}

void event_tail_close(struct event_tail *tail)
{
    if (tail->descriptor >= 0)
        (void)close(tail->descriptor);
    tail->descriptor = -1;
}
