/* SPDX-License-Identifier: Apache-2.0 */
/* When the lines of an events.ndjson were written, by the offset behind each. */
#ifndef TALUS_LOADGEN_LINES_H
#define TALUS_LOADGEN_LINES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct written_line {
    int64_t end; /* offset behind the line */
    double at;   /* [s since 1970] */
};

struct written_lines {
    struct written_line *items;
    size_t count;
};

/* False, with the reason on stderr, if the file cannot be read. */
bool written_lines_read(struct written_lines *lines, const char *path);
/* NULL if no line with a time ends there. */
const struct written_line *written_lines_find(const struct written_lines *lines, int64_t end);
void written_lines_release(struct written_lines *lines);

#endif
