/* SPDX-License-Identifier: Apache-2.0 */
#include "byte_range.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Decimal digits only: strtoull also takes signs and white space. */
static bool number_parse(const char **text, uint64_t *number)
{
    if (**text < '0' || **text > '9')
        return false;
    char *end = NULL;
    errno = 0;
    *number = strtoull(*text, &end, 10);
    *text = end;
    if (errno == ERANGE)
        *number = UINT64_MAX;
    return true;
}

enum byte_range byte_range_parse(const char *header, uint64_t size, uint64_t *first,
                                 uint64_t *length)
{
    if (header == NULL || strncasecmp(header, "bytes=", 6) != 0)
        return BYTE_RANGE_WHOLE;
    const char *text = header + 6;
    uint64_t begin = 0, last = 0;
    bool has_begin = number_parse(&text, &begin);
    if (*text++ != '-')
        return BYTE_RANGE_WHOLE;
    bool has_last = number_parse(&text, &last);
    if (*text != '\0' || (!has_begin && !has_last) || (has_begin && has_last && last < begin))
        return BYTE_RANGE_WHOLE;
    if (!has_begin) {
        if (last == 0 || size == 0)
            return BYTE_RANGE_UNSATISFIABLE;
        begin = last >= size ? 0 : size - last;
        last = size - 1;
    } else if (begin >= size) {
        return BYTE_RANGE_UNSATISFIABLE;
    } else if (!has_last || last >= size) {
        last = size - 1;
    }
    *first = begin;
    *length = last - begin + 1;
    return BYTE_RANGE_PART;
}

bool etag_listed(const char *header, const char *etag, bool weak)
{
    size_t etag_length = strlen(etag);
    const char *text = header;
    while (*text != '\0') {
        text += strspn(text, " \t,");
        if (*text == '*')
            return true;
        bool is_weak = strncmp(text, "W/", 2) == 0;
        if (is_weak)
            text += 2;
        size_t length = strcspn(text, ",");
        while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '\t'))
            length--;
        if (length == etag_length && memcmp(text, etag, length) == 0 && (weak || !is_weak))
            return true;
        text += strcspn(text, ",");
    }
    return false;
}
