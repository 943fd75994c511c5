/* SPDX-License-Identifier: Apache-2.0 */
#include "loadgen_lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The "at" of a line, an RFC 3339 time in UTC; negative without one. */
static double time_of_line(const char *line)
{
    static const char key[] = "\"at\":";
    const char *at = strstr(line, key);
    struct tm moment = {0};
    if (at == NULL)
        return -1;
    at = strchr(at + sizeof key - 1, '"');
    char *rest = at == NULL ? NULL : strptime(at + 1, "%Y-%m-%dT%H:%M:%S", &moment);
    if (rest == NULL)
        return -1;
    return (double)timegm(&moment) + (*rest == '.' ? strtod(rest, NULL) : 0);
}

bool written_lines_read(struct written_lines *lines, const char *path)
{
    FILE *stream = fopen(path, "re");
    char *line = NULL;
    size_t size = 0, capacity = 0;
    ssize_t length;
    int64_t end = 0;
    bool good = stream != NULL;
    while (good && (length = getline(&line, &size, stream)) > 0) {
        if (lines->count == capacity) {
            capacity = capacity == 0 ? 1024 : 2 * capacity;
            struct written_line *items = realloc(lines->items, capacity * sizeof *items);
            good = items != NULL;
            lines->items = good ? items : lines->items;
        }
        end += length;
        double at = time_of_line(line);
        if (good && at >= 0)
            lines->items[lines->count++] = (struct written_line){.end = end, .at = at};
    }
    if (!good)
        (void)fprintf(stderr, "talus-loadgen: cannot read %s\n", path);
    free(line);
    if (stream != NULL)
        (void)fclose(stream);
    return good;
}

static int line_compare(const void *left, const void *right)
{
    const struct written_line *one = left, *other = right;
    return (one->end > other->end) - (one->end < other->end);
}

const struct written_line *written_lines_find(const struct written_lines *lines, int64_t end)
{
    const struct written_line key = {.end = end};
    return lines->count == 0 ? NULL
                             : bsearch(&key, lines->items, lines->count, sizeof key, line_compare);
}

void written_lines_release(struct written_lines *lines)
{
    free(lines->items);
    memset(lines, 0, sizeof *lines);
}
