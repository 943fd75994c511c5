/* SPDX-License-Identifier: Apache-2.0 */
/* Range requests (RFC 9110, section 14) and entity tags (section 8.8.3). */
#ifndef TALUS_BYTE_RANGE_H
#define TALUS_BYTE_RANGE_H

#include <stdbool.h>
#include <stdint.h>

enum byte_range {
    BYTE_RANGE_WHOLE,         /* no range, one that is to be ignored, or several */
    BYTE_RANGE_PART,          /* answer 206 with [*first, *first + *length) */
    BYTE_RANGE_UNSATISFIABLE, /* answer 416 */
};

/* Reads a Range header (NULL: none) for a representation of `size` bytes. */
enum byte_range byte_range_parse(const char *header, uint64_t size, uint64_t *first,
                                 uint64_t *length);
/* Whether a list of entity tags (If-Match, If-None-Match; "*" matches all) names `etag` (with its
 * quotes). A weak tag W/"x" counts only if `weak`. */
bool etag_listed(const char *header, const char *etag, bool weak);

#endif
