/* SPDX-License-Identifier: Apache-2.0 */
/* A growing byte string. A zeroed struct is an empty text; `data` is NUL-terminated once anything
 * was added. Running out of memory sets `failed`, which sticks: check it once, at the end. */
#ifndef TALUS_TEXT_H
#define TALUS_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct text {
    char *data;
    size_t length, capacity;
    bool failed;
};

void text_add(struct text *text, const char *data, size_t length);
void text_add_string(struct text *text, const char *string);
__attribute__((format(printf, 2, 3))) void text_print(struct text *text, const char *format, ...);
void text_add_integer(struct text *text, int64_t value);
/* A JSON number with the fewest digits that read back to the same double; null for what JSON
 * cannot hold. */
void text_add_number(struct text *text, double value);
/* Shortens it to `length` bytes. */
void text_cut(struct text *text, size_t length);
/* Removes the first `length` bytes. */
void text_drop(struct text *text, size_t length);
/* Hands the string over (free() it), or NULL if it failed; the text is empty afterwards. */
char *text_take(struct text *text);
void text_release(struct text *text);

#endif
