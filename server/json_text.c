/* SPDX-License-Identifier: Apache-2.0 */
#include "json_text.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { LEVEL_MAX = 100 };

static void value_add(struct text *text, const json_t *value, unsigned int indent,
                      unsigned int level);

static void line_begin(struct text *text, unsigned int indent, unsigned int level)
{
    if (indent == 0)
        return;
    text_print(text, "\n%*s", (int)(indent * level), "");
}

/* Whether a string is the same in JSON: nothing to escape, nothing that might not be UTF-8. */
static bool string_is_plain(const char *string)
{
    for (const char *at = string; *at != '\0'; at++) {
        if (*at < 0x20 || *at > 0x7e || *at == '"' || *at == '\\')
            return false;
    }
    return true;
}

void json_text_add_string(struct text *text, const char *string)
{
    if (string_is_plain(string)) {
        text_add_string(text, "\"");
        text_add_string(text, string);
        text_add_string(text, "\"");
        return;
    }
    json_t *value = json_string(string);
    char *quoted = value == NULL ? NULL : json_dumps(value, JSON_ENCODE_ANY);
    if (quoted == NULL)
        text->failed = true;
    else
        text_add_string(text, quoted);
    free(quoted);
    json_decref(value);
}

/* Arrays of plain values stay in one line: vectors and tables are easier to read so. */
static bool array_is_plain(const json_t *array)
{
    for (size_t index = 0; index < json_array_size(array); index++) {
        const json_t *member = json_array_get(array, index);
        if (json_is_object(member) || json_is_array(member))
            return false;
    }
    return true;
}

static void array_add(struct text *text, const json_t *array, unsigned int indent,
                      unsigned int level)
{
    unsigned int own = array_is_plain(array) ? 0 : indent;
    text_add_string(text, "[");
    for (size_t index = 0; index < json_array_size(array); index++) {
        if (index > 0)
            text_add_string(text, indent > 0 && own == 0 ? ", " : ",");
        line_begin(text, own, level + 1);
        value_add(text, json_array_get(array, index), indent, level + 1);
    }
    line_begin(text, own, level);
    text_add_string(text, "]");
}

static void object_add(struct text *text, const json_t *object, unsigned int indent,
                       unsigned int level)
{
    const char *key, *separator = "";
    json_t *member;
    text_add_string(text, "{");
    json_object_foreach((json_t *)(uintptr_t)object, key, member)
    {
        text_add_string(text, separator);
        separator = ",";
        line_begin(text, indent, level + 1);
        json_text_add_string(text, key);
        text_add_string(text, indent > 0 ? ": " : ":");
        value_add(text, member, indent, level + 1);
    }
    if (json_object_size(object) > 0)
        line_begin(text, indent, level);
    text_add_string(text, "}");
}

static void value_add(struct text *text, const json_t *value, unsigned int indent,
                      unsigned int level)
{
    if (value == NULL || level > LEVEL_MAX) {
        text->failed = true;
        return;
    }
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        object_add(text, value, indent, level);
        break;
    case JSON_ARRAY:
        array_add(text, value, indent, level);
        break;
    case JSON_STRING:
        json_text_add_string(text, json_string_value(value));
        break;
    case JSON_INTEGER:
        text_add_integer(text, json_integer_value(value));
        break;
    case JSON_REAL:
        text_add_number(text, json_real_value(value));
        break;
    case JSON_TRUE:
        text_add_string(text, "true");
        break;
    case JSON_FALSE:
        text_add_string(text, "false");
        break;
    default:
        text_add_string(text, "null");
        break;
    }
}

void json_text_add(struct text *text, const json_t *value, unsigned int indent)
{
    value_add(text, value, indent, 0);
}

char *json_text(const json_t *value, unsigned int indent)
{
    struct text text = {0};
    json_text_add(&text, value, indent);
    return text_take(&text);
}

json_t *json_number_make(double value)
{
    return floor(value) < value || fabs(value) > 9e15 ? json_real(value)
                                                      : json_integer((json_int_t)value);
}
