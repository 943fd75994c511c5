/* SPDX-License-Identifier: Apache-2.0 */
#include "target.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static int hexadecimal_digit(char character)
{
    if (character >= '0' && character <= '9')
        return character - '0';
    if (character >= 'a' && character <= 'f')
        return character - 'a' + 10;
    if (character >= 'A' && character <= 'F')
        return character - 'A' + 10;
    return -1;
}

/* Decodes in place. Returns NULL or why not. */
static const char *decode(char *text, bool plus_is_space)
{
    char *out = text;
    for (const char *in = text; *in != '\0'; in++) {
        if (*in == '+' && plus_is_space) {
            *out++ = ' ';
            continue;
        }
        if (*in != '%') {
            *out++ = *in;
            continue;
        }
        int high = hexadecimal_digit(in[1]);
        int low = high < 0 ? -1 : hexadecimal_digit(in[2]);
        if (low < 0)
            return "a percent sign is not followed by two hexadecimal digits";
        int value = 16 * high + low;
        if (value < 0x20 || value == 0x7f)
            return "an escape stands for a control character";
        *out++ = (char)value;
        in += 2;
    }
    *out = '\0';
    json_t *probe = json_string(text);
    json_decref(probe);
    return probe == NULL ? "the escapes are not UTF-8" : NULL;
}

static const char *path_parse(struct target *target, char *path)
{
    char *next = path;
    while (next != NULL) {
        char *segment = next;
        next = strchr(segment, '/');
        if (next != NULL)
            *next++ = '\0';
        if (target->segment_count == TARGET_SEGMENT_MAX)
            return "the path has too many segments";
        const char *problem = decode(segment, false);
        if (problem != NULL)
            return problem;
        if (strcmp(segment, ".") == 0 || strcmp(segment, "..") == 0)
            return "the path has a segment '.' or '..'";
        if (strchr(segment, '/') != NULL || strchr(segment, '\\') != NULL)
            return "a path segment holds a slash";
        target->segments[target->segment_count++] = segment;
    }
    if (target->segment_count == 1 && target->segments[0][0] == '\0')
        target->segment_count = 0;
    return NULL;
}

static const char *query_parse(struct target *target, char *query)
{
    char *next = query;
    while (next != NULL && *next != '\0') {
        char *name = next;
        next = strchr(name, '&');
        if (next != NULL)
            *next++ = '\0';
        if (target->query_count == TARGET_QUERY_MAX)
            return "there are too many query parameters";
        char *value = strchr(name, '=');
        if (value != NULL)
            *value++ = '\0';
        const char *problem = decode(name, true);
        if (problem == NULL && value != NULL)
            problem = decode(value, true);
        if (problem != NULL)
            return problem;
        target->query[target->query_count].name = name;
        target->query[target->query_count].value = value == NULL ? "" : value;
        target->query_count++;
    }
    return NULL;
}

const char *target_parse(struct target *target, const char *raw)
{
    memset(target, 0, sizeof *target);
    if (raw[0] != '/')
        return "the request target does not begin with a slash";
    for (const char *character = raw; *character != '\0'; character++) {
        if (*character <= 0x20 || *character == 0x7f || strchr("#\"<>\\^`{|}", *character) != NULL)
            return "the request target holds a character that must be escaped";
    }
    target->storage = strdup(raw);
    if (target->storage == NULL)
        return "out of memory";
    char *query = strchr(target->storage, '?');
    if (query != NULL)
        *query++ = '\0';
    const char *problem = path_parse(target, target->storage + 1);
    return problem != NULL ? problem : query_parse(target, query);
}

const char *target_query(const struct target *target, const char *name)
{
    for (size_t index = 0; index < target->query_count; index++) {
        if (strcmp(target->query[index].name, name) == 0)
            return target->query[index].value;
    }
    return NULL;
}

void target_release(struct target *target)
{
    free(target->storage);
    memset(target, 0, sizeof *target);
}
