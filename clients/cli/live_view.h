/* SPDX-License-Identifier: Apache-2.0 */
/* Lines at the foot of a terminal that are rewritten in place; what is printed goes above them. On
 * anything but a terminal there are no such lines. */
#ifndef TALUS_LIVE_VIEW_H
#define TALUS_LIVE_VIEW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { LIVE_LINE_MAX = 8, LIVE_LINE_SIZE = 256 };

struct live_view {
    FILE *stream;
    bool terminal;
    int shown; /* lines on the screen now */
    char lines[LIVE_LINE_MAX][LIVE_LINE_SIZE];
    int count;       /* lines to show */
    double drawn_at; /* [s] monotonic clock */
};

void live_view_init(struct live_view *view, FILE *stream);
/* Sets what to show; drawn ten times a second at most. */
void live_view_set(struct live_view *view, int line, const char *text);
void live_view_truncate(struct live_view *view, int count);
void live_view_draw(struct live_view *view);
/* Prints a line that stays. */
__attribute__((format(printf, 2, 3))) void live_view_print(struct live_view *view,
                                                           const char *format, ...);
/* Draws for the last time and leaves the lines where they are. */
void live_view_finish(struct live_view *view);

#endif
