/* SPDX-License-Identifier: Apache-2.0 */
/* The request target, taken apart strictly: the HTTP library is lenient about escapes, so its own
 * decoding is not used. */
#ifndef TALUS_TARGET_H
#define TALUS_TARGET_H

#include <stdbool.h>
#include <stddef.h>

enum { TARGET_SEGMENT_MAX = 16, TARGET_QUERY_MAX = 16 };

struct target_parameter {
    const char *name, *value; /* decoded; inside `storage` */
};

/* Owns `storage`, which everything else points into. */
struct target {
    char *storage;
    const char *segments[TARGET_SEGMENT_MAX]; /* decoded path segments */
    size_t segment_count;
    struct target_parameter query[TARGET_QUERY_MAX];
    size_t query_count;
};

/* Takes a target in origin form ("/v1/jobs?limit=5") apart. Returns NULL, or why it is refused (a
 * constant text): a bad escape, %00 or another control character, "." or "..", an escaped slash,
 * characters that a URI does not have, too many segments or parameters. */
const char *target_parse(struct target *target, const char *raw);
/* The value of a query parameter, or NULL. */
const char *target_query(const struct target *target, const char *name);
void target_release(struct target *target);

#endif
