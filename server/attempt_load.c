/* SPDX-License-Identifier: Apache-2.0 */
#include "attempt_load.h"

#include "attempt.h"

int64_t attempt_load_threads(const struct attempt *first)
{
    int64_t threads = 0;
    for (const struct attempt *attempt = first; attempt != NULL; attempt = attempt->next)
        threads += attempt->threads;
    return threads;
}

int64_t attempt_load_working(const struct attempt *first)
{
    int64_t threads = 0;
    for (const struct attempt *attempt = first; attempt != NULL; attempt = attempt->next)
        threads += attempt->last == NULL ? attempt->threads : 0;
    return threads;
}

void attempt_load_note(struct attempt *first, double now)
{
    const int64_t threads = attempt_load_threads(first);
    for (struct attempt *attempt = first; attempt != NULL; attempt = attempt->next) {
        const double elapsed = attempt->watched_until > 0 ? now - attempt->watched_until : 0;
        attempt->watched_seconds += elapsed;
        attempt->busy_seconds += elapsed * (double)(threads - attempt->threads);
        attempt->watched_until = now;
    }
}

double attempt_load_busy(const struct attempt *attempt)
{
    if (attempt->pid == 0)
        return -1;
    return attempt->watched_seconds > 0 ? attempt->busy_seconds / attempt->watched_seconds : 0;
}
