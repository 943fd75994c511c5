/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/event_writer.h"

#include "output/file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Bytes of a file's end that are searched for its last whole line. */
enum { TAIL_BYTES = 1 << 20 };

static int line_attempt(const char *line, size_t length)
{
    json_t *object = json_loadb(line, length, 0, NULL);
    json_int_t attempt = json_integer_value(json_object_get(object, "attempt"));
    json_decref(object);
    return attempt > 0 && attempt < 1 << 30 ? (int)attempt : 0;
}

/* Length of `text` up to and with its last newline. */
static size_t whole_lines(const char *text, size_t length)
{
    while (length > 0 && text[length - 1] != '\n')
        length--;
    return length;
}

/* Cuts a torn last line and notes the attempt of the last whole one. */
static int mend_end(struct event_writer *writer, off_t size)
{
    size_t length = size < TAIL_BYTES ? (size_t)size : TAIL_BYTES;
    off_t start = size - (off_t)length;
    char *tail = malloc(length + 1);
    if (tail == NULL)
        return ENOMEM;
    int failure = 0;
    ssize_t count = pread(writer->descriptor, tail, length, start);
    if (count < 0) {
        failure = errno;
    } else {
        size_t whole = whole_lines(tail, (size_t)count);
        size_t line = whole == 0 ? 0 : whole_lines(tail, whole - 1);
        writer->last_attempt = line_attempt(tail + line, whole - line);
        /* Without any newline in the tail the line began before it: no line of ours is so long. */
        if (whole < (size_t)count && ftruncate(writer->descriptor, start + (off_t)whole) != 0)
            failure = errno;
    }
    free(tail);
    return failure;
}

enum talus_status event_open(struct event_writer *writer, const char *folder,
                             struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    struct stat information;
    *writer = (struct event_writer){.descriptor = -1, .mutex = PTHREAD_MUTEX_INITIALIZER};
    enum talus_status status = file_path(path, folder, PROTOCOL_EVENTS_FILE, error);
    if (status != TALUS_OK)
        return status;
    writer->descriptor = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (writer->descriptor < 0)
        return file_error(error, errno, "open", path);
    int failure = fstat(writer->descriptor, &information) != 0
                      ? errno
                      : mend_end(writer, information.st_size);
    return failure == 0 ? TALUS_OK : file_error(error, failure, "mend", path);
}

void event_time(char text[EVENT_TIME_SIZE])
{
    struct timespec now;
    struct tm parts;
    char seconds[24];
    (void)clock_gettime(CLOCK_REALTIME, &now);
    (void)gmtime_r(&now.tv_sec, &parts);
    (void)strftime(seconds, sizeof seconds, "%Y-%m-%dT%H:%M:%S", &parts);
    (void)snprintf(text, EVENT_TIME_SIZE, "%s.%06ldZ", seconds, now.tv_nsec / 1000);
}

json_t *event_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

/* The line with its newline; NULL when memory ran out. */
static char *make_line(const struct event_writer *writer, enum protocol_message message,
                       json_t *fields, size_t *length)
{
    char at[EVENT_TIME_SIZE];
    event_time(at);
    json_t *line = json_pack("{s:s, s:s, s:i}", "event", protocol_message_name(message), "at", at,
                             "attempt", writer->attempt);
    char *text = NULL;
    if (line != NULL && fields != NULL && json_object_update(line, fields) == 0)
        text = json_dumps(line, JSON_COMPACT);
    json_decref(line);
    if (text == NULL)
        return NULL;
    *length = strlen(text) + 1;
    text[*length - 1] = '\n'; /* in place of NUL: only ever written by its length */
    return text;
}

/* One whole line at the end of the file, or none; 0 or an errno value. */
static int append_line(const struct event_writer *writer, const char *line, size_t length)
{
    off_t end = lseek(writer->descriptor, 0, SEEK_END);
    int failure = file_write_all(writer->descriptor, line, length);
    if (failure != 0 && end >= 0 && ftruncate(writer->descriptor, end) != 0)
        failure = errno;
    return failure;
}

enum talus_status event_write(struct event_writer *writer, enum protocol_message message,
                              json_t *fields, struct talus_error *error)
{
    size_t length = 0;
    int failure = 0;
    (void)pthread_mutex_lock(&writer->mutex);
    char *line = make_line(writer, message, fields, &length);
    if (line != NULL)
        failure = append_line(writer, line, length);
    (void)pthread_mutex_unlock(&writer->mutex);
    json_decref(fields);
    if (line == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for an event");
    free(line);
    if (failure != 0)
        return file_error(error, failure, "append to", PROTOCOL_EVENTS_FILE);
    return TALUS_OK;
}

enum talus_status event_sync(struct event_writer *writer, struct talus_error *error)
{
    if (fsync(writer->descriptor) != 0)
        return file_error(error, errno, "sync", PROTOCOL_EVENTS_FILE);
    return TALUS_OK;
}

void event_close(struct event_writer *writer)
{
    if (writer->descriptor >= 0)
        (void)close(writer->descriptor);
    writer->descriptor = -1;
}
