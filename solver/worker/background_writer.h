/* SPDX-License-Identifier: Apache-2.0 */
/* A thread that writes files while the simulation goes on. Tasks are done one after the other, in
 * the order in which they were given. At most WRITER_QUEUE wait, so that memory stays bounded; who
 * gives one more waits too.
 *
 * The first task that fails is the last one that is done: those behind it are dropped, and every
 * later call returns its error. Debian's HDF5 is not thread-safe: while the thread lives, whatever
 * uses HDF5 must be a task. All calls from one thread. */
#ifndef TALUS_BACKGROUND_WRITER_H
#define TALUS_BACKGROUND_WRITER_H

#include "talus/status.h"

enum { WRITER_QUEUE = 2 };

struct writer_task {
    enum talus_status (*perform)(void *context, struct talus_error *error);
    void (*release)(void *context); /* always called, once, when the task is done or dropped */
    void *context;                  /* belongs to the task */
};

struct background_writer; /* one per job, on the heap */

/* NULL when memory ran out. Starts its thread with the first task. */
struct background_writer *writer_create(void);
/* Waits until every task is done. NULL is fine. */
void writer_destroy(struct background_writer *writer);

/* Hands over a task, whatever is returned; waits for room. Where no thread can be had, and after
 * writer_finish, the task is done at once. */
TALUS_MUST_CHECK enum talus_status writer_give(struct background_writer *writer,
                                               const struct writer_task *task,
                                               struct talus_error *error);
/* The first error so far, without waiting. */
TALUS_MUST_CHECK enum talus_status writer_check(struct background_writer *writer,
                                                struct talus_error *error);
/* Waits until every task is done. */
TALUS_MUST_CHECK enum talus_status writer_drain(struct background_writer *writer,
                                                struct talus_error *error);
/* The same, and ends the thread: the caller may use HDF5 again. */
TALUS_MUST_CHECK enum talus_status writer_finish(struct background_writer *writer,
                                                 struct talus_error *error);

#endif
