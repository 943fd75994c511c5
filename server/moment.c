/* SPDX-License-Identifier: Apache-2.0 */
#include "moment.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double clock_seconds(clockid_t clock)
{
    struct timespec now = {0};
    (void)clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double moment_monotonic(void)
{
    return clock_seconds(CLOCK_MONOTONIC);
}

double moment_now(void)
{
    return clock_seconds(CLOCK_REALTIME);
}

int64_t moment_now_milliseconds(void)
{
    return (int64_t)floor(moment_now() * 1e3);
}

void moment_text(double seconds, char text[MOMENT_TEXT_SIZE])
{
    time_t whole = (time_t)floor(seconds);
    int milliseconds = (int)floor((seconds - floor(seconds)) * 1e3);
    struct tm parts;
    char date[24];
    if (gmtime_r(&whole, &parts) == NULL)
        memset(&parts, 0, sizeof parts);
    (void)strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts);
    (void)snprintf(text, MOMENT_TEXT_SIZE, "%s.%03dZ", date, milliseconds);
}

void moment_now_text(char text[MOMENT_TEXT_SIZE])
{
    moment_text(moment_now(), text);
}

double moment_parse(const char *text)
{
    struct tm date = {0};
    const char *rest = text == NULL ? NULL : strptime(text, "%Y-%m-%dT%H:%M:%S", &date);
    if (rest == NULL)
        return 0;
    return (double)timegm(&date) + (*rest == '.' ? strtod(rest, NULL) : 0);
}
