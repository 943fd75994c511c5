/* SPDX-License-Identifier: Apache-2.0 */
/* Time: RFC 3339 UTC for people and files, a monotonic clock for deadlines. */
#ifndef TALUS_MOMENT_H
#define TALUS_MOMENT_H

#include <stdint.h>

enum { MOMENT_TEXT_SIZE = 32 };

/* Seconds of a clock that never goes back; its origin means nothing. */
double moment_monotonic(void);
/* Seconds since 1970. */
double moment_now(void);
/* Milliseconds since 1970. */
int64_t moment_now_milliseconds(void);
/* "2026-11-22T08:13:24.123Z" */
void moment_text(double seconds, char text[MOMENT_TEXT_SIZE]);
/* Seconds since 1970 of such a text; 0 for anything else. */
double moment_parse(const char *text);
void moment_now_text(char text[MOMENT_TEXT_SIZE]);

#endif
