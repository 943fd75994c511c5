/* SPDX-License-Identifier: Apache-2.0 */
#include "executor_local.h"

#include "base/protocol.h"
#include "folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* The environment with the lock's descriptor; free the array and its first entry. */
static char **environment_make(int lock)
{
    static const char begin[] = PROTOCOL_LOCK_ENVIRONMENT "=";
    size_t count = 0, kept = 1;
    while (environ[count] != NULL)
        count++;
    char **environment = calloc(count + 2, sizeof *environment);
    if (environment == NULL || asprintf(&environment[0], "%s%d", begin, lock) < 0) {
        free(environment);
        return NULL;
    }
    for (size_t index = 0; index < count; index++) {
        if (strncmp(environ[index], begin, sizeof begin - 1) != 0)
            environment[kept++] = environ[index];
    }
    return environment;
}

static bool actions_prepare(posix_spawn_file_actions_t *actions, const struct executor_task *task,
                            const char *log)
{
    return posix_spawn_file_actions_addopen(actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0) == 0 &&
           posix_spawn_file_actions_addopen(actions, STDOUT_FILENO, log,
                                            O_WRONLY | O_CREAT | O_APPEND, 0640) == 0 &&
           posix_spawn_file_actions_adddup2(actions, STDOUT_FILENO, STDERR_FILENO) == 0 &&
           /* onto itself: clears its close-on-exec flag in the child */
           posix_spawn_file_actions_adddup2(actions, task->lock, task->lock) == 0;
}

static bool attributes_prepare(posix_spawnattr_t *attributes)
{
    sigset_t all, none;
    (void)sigfillset(&all);
    (void)sigemptyset(&none);
    return posix_spawnattr_setflags(attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF |
                                                    POSIX_SPAWN_SETSIGMASK) == 0 &&
           posix_spawnattr_setpgroup(attributes, 0) == 0 &&
           posix_spawnattr_setsigdefault(attributes, &all) == 0 &&
           posix_spawnattr_setsigmask(attributes, &none) == 0;
}

static int worker_spawn(const struct executor_task *task, const char *scene, const char *log,
                        char **environment, pid_t *pid)
{
    char threads[24], attempt[24];
    (void)snprintf(threads, sizeof threads, "%" PRId64, task->threads);
    (void)snprintf(attempt, sizeof attempt, "%" PRId64, task->attempt);
    const char *arguments[] = {
        task->program, "run",   scene,       "--out", task->folder,
        "--threads",   threads, "--attempt", attempt, task->resume ? "--resume" : NULL,
        NULL};
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    if (posix_spawn_file_actions_init(&actions) != 0)
        return ENOMEM;
    int failure = posix_spawnattr_init(&attributes);
    if (failure == 0) {
        failure = ENOMEM;
        if (actions_prepare(&actions, task, log) && attributes_prepare(&attributes))
            failure = posix_spawnp(pid, task->program, &actions, &attributes,
                                   (char *const *)(uintptr_t)arguments, environment);
        (void)posix_spawnattr_destroy(&attributes);
    }
    (void)posix_spawn_file_actions_destroy(&actions);
    return failure;
}

/* The soft limit alone: a hard one could not be raised again. 0: as far as it goes. */
static void process_limit(pid_t pid, enum __rlimit_resource resource, int64_t bytes)
{
    struct rlimit limit;
    if (prlimit(pid, resource, NULL, &limit) != 0)
        return;
    limit.rlim_cur = bytes > 0 && (rlim_t)bytes < limit.rlim_max ? (rlim_t)bytes : limit.rlim_max;
    (void)prlimit(pid, resource, &limit, NULL);
}

struct limits {
    int64_t memory, disk;
};

static void process_limits(pid_t pid, void *context)
{
    const struct limits *limits = context;
    process_limit(pid, RLIMIT_DATA, limits->memory);
    process_limit(pid, RLIMIT_FSIZE, limits->disk);
}

static void worker_limit(pid_t pid, const struct executor_task *task)
{
    const struct rlimit core = {0, 0};
    struct limits limits = {.memory = task->memory_limit, .disk = task->disk_limit};
    (void)prlimit(pid, RLIMIT_CORE, &core, NULL);
    process_limits(pid, &limits);
}

enum talus_status executor_start(const struct executor_task *task, pid_t *pid,
                                 struct talus_error *error)
{
    char *scene = folder_join(task->folder, PROTOCOL_SCENE_FILE);
    char *log = folder_join(task->folder, PROTOCOL_LOG_FILE);
    char **environment = environment_make(task->lock);
    enum talus_status status = TALUS_OK;
    if (scene == NULL || log == NULL || environment == NULL) {
        status = talus_error_memory(error);
    } else {
        int failure = worker_spawn(task, scene, log, environment, pid);
        if (failure != 0)
            status = talus_error_set(error, TALUS_IO, "spawn", "", "cannot start %s: %s",
                                     task->program, strerror(failure));
        else
            worker_limit(*pid, task);
    }
    if (environment != NULL)
        free(environment[0]);
    free(environment);
    free(scene);
    free(log);
    return status;
}

bool executor_ended(pid_t pid, int *wait_status)
{
    return waitpid(pid, wait_status, WNOHANG) == pid;
}

void executor_signal(pid_t pid, int signal_number)
{
    if (pid > 1)
        (void)kill(-pid, signal_number);
}

/* Whether a process has a file open. */
static bool process_has_open(const char *pid, const struct stat *file)
{
    char path[300];
    (void)snprintf(path, sizeof path, "/proc/%s/fd", pid);
    DIR *folder = opendir(path);
    const struct dirent *entry;
    bool found = false;
    while (folder != NULL && !found && (entry = readdir(folder)) != NULL) {
        struct stat information;
        found = fstatat(dirfd(folder), entry->d_name, &information, 0) == 0 &&
                information.st_dev == file->st_dev && information.st_ino == file->st_ino;
    }
    if (folder != NULL)
        (void)closedir(folder);
    return found;
}

/* Visits every other process that holds a job's lock. */
static void holders_visit(const char *folder, void (*visit)(pid_t pid, void *context),
                          void *context)
{
    struct stat file;
    char *lock = folder_join(folder, PROTOCOL_LOCK_FILE);
    DIR *processes = lock != NULL && stat(lock, &file) == 0 ? opendir("/proc") : NULL;
    const struct dirent *entry;
    while (processes != NULL && (entry = readdir(processes)) != NULL) {
        if (entry->d_name[0] < '0' || entry->d_name[0] > '9')
            continue;
        pid_t pid = (pid_t)strtol(entry->d_name, NULL, 10);
        if (pid != getpid() && process_has_open(entry->d_name, &file))
            visit(pid, context);
    }
    if (processes != NULL)
        (void)closedir(processes);
    free(lock);
}

static void holder_signal(pid_t pid, void *context)
{
    const int *signal_number = context;
    pid_t group = getpgid(pid);
    if (group > 1 && group != getpgrp())
        (void)kill(-group, *signal_number);
    else
        (void)kill(pid, *signal_number);
}

void executor_signal_holders(const char *folder, int signal_number)
{
    holders_visit(folder, holder_signal, &signal_number);
}

void executor_limit(pid_t pid, const char *folder, int64_t memory_limit, int64_t disk_limit)
{
    struct limits limits = {.memory = memory_limit, .disk = disk_limit};
    if (pid > 0)
        process_limits(pid, &limits);
    else
        holders_visit(folder, process_limits, &limits);
}
