/* SPDX-License-Identifier: Apache-2.0 */
/* Workers as processes of this machine, each in a process group of its own. */
#ifndef TALUS_EXECUTOR_LOCAL_H
#define TALUS_EXECUTOR_LOCAL_H

#include "talus/status.h"

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

/* What to start; texts are borrowed. */
struct executor_task {
    const char *program, *folder;
    int64_t threads, attempt;
    bool resume;
    int lock;                         /* descriptor of the locked job.lock, which it inherits */
    int64_t memory_limit, disk_limit; /* [bytes], 0: none */
};

/* Starts a worker; its output goes to log.txt. */
TALUS_MUST_CHECK enum talus_status executor_start(const struct executor_task *task, pid_t *pid,
                                                  struct talus_error *error);
/* Whether a child has ended; then *wait_status is what waitpid says. */
bool executor_ended(pid_t pid, int *wait_status);
/* Changes the limits of a process and its future children [bytes], 0: none; pid 0: of all processes
 * that hold a job's lock. */
void executor_limit(pid_t pid, const char *folder, int64_t memory_limit, int64_t disk_limit);
/* Sends a signal to the group of a child. */
void executor_signal(pid_t pid, int signal_number);
/* Sends a signal to the groups of all processes that hold a job's lock: how an adopted worker is
 * reached. */
void executor_signal_holders(const char *folder, int signal_number);

#endif
