/* SPDX-License-Identifier: Apache-2.0 */
#include "loadgen_story.h"

#include <stdlib.h>
#include <string.h>

static void event_add(struct story *story, int64_t offset, uint64_t number)
{
    if (story->count == story->capacity) {
        size_t capacity = story->capacity == 0 ? 64 : 2 * story->capacity;
        struct story_event *events = realloc(story->events, capacity * sizeof *events);
        if (events == NULL) {
            story->failed = true;
            return;
        }
        story->events = events;
        story->capacity = capacity;
    }
    story->events[story->count++] =
        (struct story_event){.offset = offset, .number = number, .came = story->now};
}

static void line_read(struct story *story)
{
    char *end = NULL;
    if (strncmp(story->line, "id: ", 4) == 0) {
        int64_t offset = strtoll(story->line + 4, &end, 10);
        if (*end == '-')
            event_add(story, offset, strtoull(end + 1, NULL, 10));
        else
            story->failed = true;
    } else if (strncmp(story->line, "event: ", 7) == 0) {
        story->is_done = strcmp(story->line + 7, "done") == 0;
        story->is_gap = story->is_gap || strcmp(story->line + 7, "gap") == 0;
    } else if (story->line_length == 0) {
        story->done = story->done || story->is_done;
        story->is_done = false;
    }
}

void story_take(void *context, const char *data, size_t length)
{
    struct story *story = context;
    while (length > 0) {
        const char *newline = memchr(data, '\n', length);
        size_t part = newline == NULL ? length : (size_t)(newline - data);
        size_t room = sizeof story->line - 1 - story->line_length;
        size_t kept = part < room ? part : room;
        memcpy(story->line + story->line_length, data, kept);
        story->line_length += kept;
        if (newline == NULL)
            return;
        story->line[story->line_length] = '\0';
        line_read(story);
        story->line_length = 0;
        data += part + 1;
        length -= part + 1;
    }
}

bool story_equal(const struct story *one, const struct story *other)
{
    bool equal = one->count == other->count;
    for (size_t index = 0; index < one->count && equal; index++)
        equal = one->events[index].offset == other->events[index].offset &&
                one->events[index].number == other->events[index].number;
    return equal;
}

void story_release(struct story *story)
{
    free(story->events);
    memset(story, 0, sizeof *story);
}
