/* SPDX-License-Identifier: Apache-2.0 */
#include "fair_share.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double fair_share_half_life = 600;
static const double use_forgotten = 1e-3; /* [thread seconds] */

struct fair_owner {
    char *name;
    int64_t threads, jobs; /* that run */
    double use;            /* [thread seconds], fading */
    struct fair_owner *next;
};

static void owner_free(struct fair_owner *owner)
{
    free(owner->name);
    free(owner);
}

void fair_share_release(struct fair_share *share)
{
    while (share->first != NULL) {
        struct fair_owner *next = share->first->next;
        owner_free(share->first);
        share->first = next;
    }
}

static struct fair_owner *owner_find(const struct fair_share *share, const char *name)
{
    struct fair_owner *owner = share->first;
    while (owner != NULL && strcmp(owner->name, name) != 0)
        owner = owner->next;
    return owner;
}

void fair_share_begin(struct fair_share *share, double now)
{
    const double elapsed = share->now > 0 && now > share->now ? now - share->now : 0;
    const double left = exp2(-elapsed / fair_share_half_life);
    struct fair_owner **link = &share->first;
    share->now = now;
    while (*link != NULL) {
        struct fair_owner *owner = *link;
        owner->use = owner->use * left + elapsed * (double)owner->threads;
        owner->threads = owner->jobs = 0;
        if (owner->use < use_forgotten && elapsed > 0) {
            *link = owner->next;
            owner_free(owner);
        } else {
            link = &owner->next;
        }
    }
}

bool fair_share_note(struct fair_share *share, const char *name, int64_t threads)
{
    struct fair_owner *owner = owner_find(share, name);
    if (owner == NULL) {
        owner = calloc(1, sizeof *owner);
        char *copy = strdup(name);
        if (owner == NULL || copy == NULL) {
            free(owner);
            free(copy);
            return false;
        }
        owner->name = copy;
        owner->next = share->first;
        share->first = owner;
    }
    owner->threads += threads;
    owner->jobs++;
    return true;
}

int64_t fair_share_jobs(const struct fair_share *share, const char *name)
{
    const struct fair_owner *owner = owner_find(share, name);
    return owner == NULL ? 0 : owner->jobs;
}

/* Fills in what the order goes by. */
static void candidate_weigh(const struct fair_share *share, struct scheduler_candidate *candidate)
{
    const struct fair_owner *owner = owner_find(share, candidate->owner);
    candidate->owner_threads = owner == NULL ? 0 : owner->threads;
    candidate->owner_use = owner == NULL ? 0 : owner->use;
}

static int candidate_compare(const void *a, const void *b)
{
    const struct scheduler_candidate *left = a, *right = b;
    if (left->priority != right->priority)
        return left->priority > right->priority ? -1 : 1;
    if (left->owner_threads != right->owner_threads)
        return left->owner_threads < right->owner_threads ? -1 : 1;
    if (left->owner_use < right->owner_use || left->owner_use > right->owner_use)
        return left->owner_use < right->owner_use ? -1 : 1;
    return strcmp(left->id, right->id);
}

void fair_share_order(const struct fair_share *share, struct scheduler_candidate *candidates,
                      size_t count)
{
    for (size_t index = 0; index < count; index++)
        candidate_weigh(share, &candidates[index]);
    if (count > 0)
        qsort(candidates, count, sizeof *candidates, candidate_compare);
}
