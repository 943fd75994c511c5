/* SPDX-License-Identifier: Apache-2.0 */
#include "frame_index.h"

#include "base/protocol.h"
#include "event_log.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* A frame that is written again replaces the first. */
static void frame_put(json_t *frames, json_t *frame)
{
    json_int_t number = json_integer_value(json_object_get(frame, "n"));
    size_t index = json_array_size(frames);
    while (index > 0) {
        json_int_t other =
            json_integer_value(json_object_get(json_array_get(frames, index - 1), "n"));
        if (other == number) {
            (void)json_array_set(frames, index - 1, frame);
            return;
        }
        if (other < number)
            break;
        index--;
    }
    (void)json_array_insert(frames, index, frame);
}

/* Frames after the time of the checkpoint are void. */
static void frames_rewind(json_t *frames, double time)
{
    while (json_array_size(frames) > 0) {
        size_t last = json_array_size(frames) - 1;
        if (json_number_value(json_object_get(json_array_get(frames, last), "time")) <= time)
            break;
        (void)json_array_remove(frames, last);
    }
}

static bool frames_line(char *line, size_t length, int64_t end, void *context)
{
    (void)end;
    json_t *root = json_loadb(line, length, 0, NULL);
    const char *name = json_string_value(json_object_get(root, "event"));
    enum protocol_message message =
        name == NULL ? PROTOCOL_MESSAGE_COUNT : protocol_message_find(name);
    if (message == PROTOCOL_FRAME) {
        (void)json_object_del(root, "event");
        (void)json_object_del(root, "at");
        (void)json_object_del(root, "attempt");
        (void)json_object_del(root, "file");
        frame_put(context, root);
    } else if (message == PROTOCOL_REWIND) {
        frames_rewind(context, json_number_value(json_object_get(root, "time")));
    }
    json_decref(root);
    return true;
}

json_t *frame_index_read(const char *folder)
{
    struct talus_error error = {0};
    struct event_tail tail = {.descriptor = -1};
    json_t *frames = json_array();
    int64_t before;
    enum talus_status status;
    do {
        before = tail.offset;
        status = event_tail_read(&tail, folder, frames_line, frames, &error);
    } while (status == TALUS_OK && tail.offset > before);
    event_tail_close(&tail);
    if (status != TALUS_OK) {
        json_decref(frames);
        return NULL;
    }
    return frames;
}

/* "12" -> 12; -1 for anything else. */
json_int_t frame_index_number(const char *name)
{
    char *end = NULL;
    if (name[0] < '0' || name[0] > '9')
        return -1;
    errno = 0;
    long long number = strtoll(name, &end, 10);
    return errno == 0 && *end == '\0' ? number : -1;
}

const json_t *frame_index_find(const json_t *frames, json_int_t number)
{
    size_t index;
    json_t *frame;
    json_array_foreach(frames, index, frame)
    {
        if (json_integer_value(json_object_get(frame, "n")) == number)
            return frame;
    }
    return NULL;
}
