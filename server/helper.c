/* SPDX-License-Identifier: Apache-2.0 */
#include "helper.h"

#include "moment.h"
#include "text.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { ANSWERS_MAX = 1000, ANSWER_BYTES_MAX = 64 << 20 };

void helper_init(struct helper *helper, const struct config *config)
{
    memset(helper, 0, sizeof *helper);
    helper->config = config;
    helper->in = helper->out = -1;
}

void helper_stop(struct helper *helper)
{
    if (helper->in >= 0)
        (void)close(helper->in);
    if (helper->out >= 0)
        (void)close(helper->out);
    if (helper->pid > 0) {
        (void)kill(helper->pid, SIGKILL);
        while (waitpid(helper->pid, NULL, 0) < 0 && errno == EINTR)
            continue;
    }
    helper_init(helper, helper->config);
}

static void helper_limit(const struct helper *helper)
{
#ifndef __SANITIZE_ADDRESS__
    /* The address sanitizer reserves terabytes, which counts as data. */
    const struct rlimit memory = {(rlim_t)helper->config->helper_memory_bytes,
                                  (rlim_t)helper->config->helper_memory_bytes};
    (void)prlimit(helper->pid, RLIMIT_DATA, &memory, NULL);
#endif
    const struct rlimit file = {256U << 20, 256U << 20}, core = {0, 0};
    (void)prlimit(helper->pid, RLIMIT_FSIZE, &file, NULL);
    (void)prlimit(helper->pid, RLIMIT_CORE, &core, NULL);
}

/* Starts the program with its standard input and output on the given descriptors. */
static int helper_spawn(struct helper *helper, int in, int out)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t all, none;
    char *arguments[] = {helper->config->worker_program, "helper", NULL};
    (void)sigfillset(&all);
    (void)sigemptyset(&none);
    if (posix_spawn_file_actions_init(&actions) != 0)
        return ENOMEM;
    int failure = posix_spawnattr_init(&attributes);
    if (failure == 0) {
        (void)posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
        (void)posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
        (void)posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK |
                                                        POSIX_SPAWN_SETPGROUP);
        (void)posix_spawnattr_setsigdefault(&attributes, &all);
        (void)posix_spawnattr_setsigmask(&attributes, &none);
        failure =
            posix_spawnp(&helper->pid, arguments[0], &actions, &attributes, arguments, environ);
        (void)posix_spawnattr_destroy(&attributes);
    }
    (void)posix_spawn_file_actions_destroy(&actions);
    return failure;
}

static enum talus_status helper_start(struct helper *helper, struct talus_error *error)
{
    int question[2] = {-1, -1}, answer[2] = {-1, -1};
    int failure = pipe2(question, O_CLOEXEC) == 0 && pipe2(answer, O_CLOEXEC) == 0 ? 0 : errno;
    if (failure == 0)
        failure = helper_spawn(helper, question[0], answer[1]);
    (void)close(question[0]);
    (void)close(answer[1]);
    if (failure != 0) {
        (void)close(question[1]);
        (void)close(answer[0]);
        helper->pid = 0;
        return talus_error_set(error, TALUS_IO, "helper", "", "cannot start %s: %s",
                               helper->config->worker_program, strerror(failure));
    }
    helper->in = question[1];
    helper->out = answer[0];
    (void)fcntl(helper->in, F_SETFL, O_NONBLOCK);
    (void)fcntl(helper->out, F_SETFL, O_NONBLOCK);
    helper_limit(helper);
    return TALUS_OK;
}

static enum talus_status helper_dead(struct talus_error *error)
{
    return talus_error_set(error, TALUS_IO, "helper", "",
                           "the process that reads scenes died over this request");
}

/* Waits until a descriptor is ready. */
static enum talus_status helper_wait(int descriptor, short events, double deadline,
                                     struct talus_error *error)
{
    for (;;) {
        double left = deadline - moment_monotonic();
        struct pollfd ready = {.fd = descriptor, .events = events};
        int count = left <= 0 ? 0 : poll(&ready, 1, (int)(left * 1e3) + 1);
        if (count > 0)
            return TALUS_OK;
        if (count == 0)
            return talus_error_set(error, TALUS_LIMIT, "late", "",
                                   "reading the scene takes longer than allowed");
        if (errno != EINTR)
            return helper_dead(error);
    }
}

static enum talus_status question_write(struct helper *helper, const char *line, size_t length,
                                        double deadline, struct talus_error *error)
{
    while (length > 0) {
        ssize_t written = write(helper->in, line, length);
        if (written > 0) {
            line += written;
            length -= (size_t)written;
            continue;
        }
        if (written < 0 && errno != EAGAIN && errno != EINTR)
            return helper_dead(error);
        enum talus_status status = helper_wait(helper->in, POLLOUT, deadline, error);
        if (status != TALUS_OK)
            return status;
    }
    return TALUS_OK;
}

static enum talus_status answer_read(struct helper *helper, struct text *line, double deadline,
                                     struct talus_error *error)
{
    char buffer[16384];
    for (;;) {
        ssize_t length = read(helper->out, buffer, sizeof buffer);
        if (length > 0) {
            text_add(line, buffer, (size_t)length);
            if (line->failed || line->length > ANSWER_BYTES_MAX)
                return helper_dead(error);
            if (buffer[length - 1] == '\n')
                return TALUS_OK;
            continue;
        }
        if (length == 0 || (errno != EAGAIN && errno != EINTR))
            return helper_dead(error);
        enum talus_status status = helper_wait(helper->out, POLLIN, deadline, error);
        if (status != TALUS_OK)
            return status;
    }
}

/* One question to one process. */
static enum talus_status helper_exchange(struct helper *helper, const struct text *line,
                                         double deadline, json_t **answer,
                                         struct talus_error *error)
{
    struct text reply = {0};
    enum talus_status status = helper->pid == 0 ? helper_start(helper, error) : TALUS_OK;
    if (status == TALUS_OK)
        status = question_write(helper, line->data, line->length, deadline, error);
    if (status == TALUS_OK)
        status = answer_read(helper, &reply, deadline, error);
    *answer = status == TALUS_OK ? json_loadb(reply.data, reply.length, 0, NULL) : NULL;
    if (status == TALUS_OK && !json_is_object(*answer)) {
        json_decref(*answer);
        *answer = NULL;
        status = helper_dead(error);
    }
    text_release(&reply);
    helper->answer_count++;
    if (status != TALUS_OK || helper->answer_count >= ANSWERS_MAX)
        helper_stop(helper);
    return status;
}

enum talus_status helper_ask(struct helper *helper, const json_t *question, double seconds,
                             json_t **answer, struct talus_error *error)
{
    struct text line = {0};
    struct talus_error first = {0};
    double deadline = moment_monotonic() + seconds;
    bool used = helper->answer_count > 0;
    char *dump = json_dumps(question, JSON_COMPACT | JSON_REAL_PRECISION(17));
    if (dump != NULL)
        text_print(&line, "%s\n", dump);
    free(dump);
    *answer = NULL;
    if (line.data == NULL || line.failed) {
        text_release(&line);
        return talus_error_memory(error);
    }
    enum talus_status status = helper_exchange(helper, &line, deadline, answer, &first);
    /* An old process may have died of something else; a new one that dies too died of this. */
    if (status == TALUS_IO && used)
        status = helper_exchange(helper, &line, deadline, answer, error);
    else if (status != TALUS_OK)
        talus_error_set(error, status, first.code, "", "%s", first.text);
    text_release(&line);
    return status;
}
