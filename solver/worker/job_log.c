/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/job_log.h"

#include "base/protocol.h"
#include "output/file.h"
#include "worker/event_writer.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_standard_error(int descriptor)
{
    struct stat one, other;
    return fstat(descriptor, &one) == 0 && fstat(STDERR_FILENO, &other) == 0 &&
           one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

enum talus_status job_log_open(struct job_log *log, const char *folder, bool quiet,
                               struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = file_path(path, folder, PROTOCOL_LOG_FILE, error);
    if (status != TALUS_OK)
        return status;
    log->descriptor = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (log->descriptor < 0)
        return file_error(error, errno, "open", path);
    log->echo = !quiet && !is_standard_error(log->descriptor);
    log->terminal = log->echo && isatty(STDERR_FILENO) == 1;
    log->line_open = false;
    return TALUS_OK;
}

static void end_progress_line(struct job_log *log)
{
    if (log->line_open)
        (void)fputc('\n', stderr);
    log->line_open = false;
}

void job_log_write(struct job_log *log, const char *level, const char *text)
{
    char at[EVENT_TIME_SIZE];
    char line[2048];
    event_time(at);
    int length = snprintf(line, sizeof line, "%s %s %s\n", at, level, text);
    if (length >= (int)sizeof line) {
        length = (int)sizeof line - 1;
        line[length - 1] = '\n';
    }
    int failure = log->descriptor < 0 ? 0 : file_write_all(log->descriptor, line, (size_t)length);
    if (log->echo) {
        end_progress_line(log);
        (void)fprintf(stderr, "talus-worker: %s: %s\n", level, text);
        if (failure != 0)
            (void)fprintf(stderr, "talus-worker: cannot write %s: %s\n", PROTOCOL_LOG_FILE,
                          strerror(failure));
    }
}

void job_log_progress(struct job_log *log, const char *text, bool last)
{
    if (!log->echo)
        return;
    if (log->terminal) {
        (void)fprintf(stderr, "\r\033[K%s", text);
        log->line_open = true;
        if (last)
            end_progress_line(log);
    } else {
        (void)fprintf(stderr, "%s\n", text);
    }
    (void)fflush(stderr);
}

void job_log_close(struct job_log *log)
{
    end_progress_line(log);
    if (log->descriptor >= 0)
        (void)close(log->descriptor);
    log->descriptor = -1;
}
