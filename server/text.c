/* SPDX-License-Identifier: Apache-2.0 */
#include "text.h"

#include "number_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool text_reserve(struct text *text, size_t more)
{
    if (text->failed)
        return false;
    size_t needed = text->length + more + 1;
    if (needed <= text->capacity)
        return true;
    size_t capacity = text->capacity == 0 ? 256 : text->capacity;
    while (capacity < needed)
        capacity *= 2;
    char *data = realloc(text->data, capacity);
    if (data == NULL) {
        text->failed = true;
        return false;
    }
    text->data = data;
    text->capacity = capacity;
    return true;
}

void text_add(struct text *text, const char *data, size_t length)
{
    if (!text_reserve(text, length))
        return;
    if (length > 0)
        memcpy(text->data + text->length, data, length);
    text->length += length;
    text->data[text->length] = '\0';
}

void text_add_string(struct text *text, const char *string)
{
    text_add(text, string, strlen(string));
}

void text_print(struct text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    va_list again;
    va_copy(again, arguments);
    const size_t room = text->failed || text->data == NULL ? 0 : text->capacity - text->length;
    int length = vsnprintf(room == 0 ? NULL : text->data + text->length, room, format, arguments);
    va_end(arguments);
    if (length < 0) {
        text->failed = true;
    } else if ((size_t)length < room) {
        text->length += (size_t)length;
    } else if (text_reserve(text, (size_t)length)) {
        (void)vsnprintf(text->data + text->length, (size_t)length + 1, format, again);
        text->length += (size_t)length;
    }
    va_end(again);
}

void text_add_integer(struct text *text, int64_t value)
{
    char digits[24];
    size_t place = sizeof digits;
    uint64_t rest = value < 0 ? -(uint64_t)value : (uint64_t)value;
    do {
        digits[--place] = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest > 0);
    if (value < 0)
        digits[--place] = '-';
    text_add(text, digits + place, sizeof digits - place);
}

void text_add_number(struct text *text, double value)
{
    char number[NUMBER_TEXT_SIZE];
    if (isfinite(value))
        text_add(text, number, number_text(value, number));
    else
        text_add_string(text, "null");
}

void text_cut(struct text *text, size_t length)
{
    if (length < text->length) {
        text->length = length;
        text->data[length] = '\0';
    }
}

void text_drop(struct text *text, size_t length)
{
    if (length > text->length)
        length = text->length;
    if (length == 0)
        return;
    memmove(text->data, text->data + length, text->length - length);
    text->length -= length;
    text->data[text->length] = '\0';
}

char *text_take(struct text *text)
{
    text_add(text, "", 0);
    char *data = text->failed ? NULL : text->data;
    if (text->failed)
        free(text->data);
    memset(text, 0, sizeof *text);
    return data;
}

void text_release(struct text *text)
{
    free(text->data);
    memset(text, 0, sizeof *text);
}
