/* SPDX-License-Identifier: Apache-2.0 */
#include "live_view.h"

#include <stdarg.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static const double draw_interval = 0.1; /* [s] */

static double now(void)
{
    struct timespec time;
    (void)clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int terminal_width(const struct live_view *view)
{
    struct winsize size;
    if (ioctl(fileno(view->stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
        return size.ws_col;
    return 80;
}

void live_view_init(struct live_view *view, FILE *stream)
{
    memset(view, 0, sizeof *view);
    view->stream = stream;
    view->terminal = isatty(fileno(stream)) == 1;
}

void live_view_set(struct live_view *view, int line, const char *text)
{
    if (line >= LIVE_LINE_MAX)
        return;
    (void)snprintf(view->lines[line], LIVE_LINE_SIZE, "%s", text);
    if (view->count <= line)
        view->count = line + 1;
}

void live_view_truncate(struct live_view *view, int count)
{
    if (view->count > count)
        view->count = count;
}

static void erase(struct live_view *view)
{
    if (view->shown > 0)
        (void)fprintf(view->stream, "\033[%dA\r\033[J", view->shown);
    view->shown = 0;
}

static void draw_now(struct live_view *view)
{
    const int width = terminal_width(view);
    erase(view);
    /* A line as wide as the terminal would wrap, and the count of lines to erase be wrong. */
    for (int line = 0; line < view->count; line++)
        (void)fprintf(view->stream, "%.*s\n", width - 1, view->lines[line]);
    view->shown = view->count;
    view->drawn_at = now();
    (void)fflush(view->stream);
}

void live_view_draw(struct live_view *view)
{
    if (view->terminal && now() - view->drawn_at >= draw_interval)
        draw_now(view);
}

void live_view_print(struct live_view *view, const char *format, ...)
{
    va_list values;
    erase(view);
    va_start(values, format);
    (void)vfprintf(view->stream, format, values);
    va_end(values);
    (void)fputc('\n', view->stream);
    if (view->terminal)
        draw_now(view);
    else
        (void)fflush(view->stream);
}

void live_view_finish(struct live_view *view)
{
    if (view->terminal)
        draw_now(view);
    view->shown = 0;
}
