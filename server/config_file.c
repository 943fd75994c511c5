/* SPDX-License-Identifier: Apache-2.0 */
#include "config_file.h"

#include "suggest.h"

#include <jansson.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum config_kind { CONFIG_KIND_TEXT, CONFIG_KIND_NUMBER, CONFIG_KIND_FLAG, CONFIG_KIND_LIST };

/* Where a key of the file goes. */
struct config_key {
    const char *name;
    enum config_kind kind;
    size_t offset; /* in struct config */
    double low, high;
};

static const struct config_key keys[] = {
#define CONFIG_TEXT(key, fallback, meaning)                                                        \
    {#key, CONFIG_KIND_TEXT, offsetof(struct config, key), 0, 0},
#define CONFIG_NUMBER(key, fallback, low, high, meaning)                                           \
    {#key, CONFIG_KIND_NUMBER, offsetof(struct config, key), low, high},
#define CONFIG_FLAG(key, meaning) {#key, CONFIG_KIND_FLAG, offsetof(struct config, key), 0, 0},
#define CONFIG_LIST(key, meaning) {#key, CONFIG_KIND_LIST, offsetof(struct config, key), 0, 0},
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
#undef CONFIG_FLAG
#undef CONFIG_LIST
};
enum { KEY_COUNT = sizeof keys / sizeof keys[0] };

static enum talus_status type_error(const struct config_key *key, const char *wanted,
                                    struct talus_error *error)
{
    return talus_error_set(error, TALUS_INVALID, "type", "", "%s: %s is wanted", key->name, wanted);
}

static enum talus_status number_read(double *member, const struct config_key *key,
                                     const json_t *value, struct talus_error *error)
{
    double number = json_number_value(value);
    if (!json_is_number(value) || number < key->low || number > key->high)
        return talus_error_set(error, TALUS_INVALID, "range", "",
                               "%s: a number from %g to %g is wanted", key->name, key->low,
                               key->high);
    if (isnan(*member))
        *member = number;
    return TALUS_OK;
}

static enum talus_status text_read(char **member, const struct config_key *key, const json_t *value,
                                   struct talus_error *error)
{
    if (!json_is_string(value))
        return type_error(key, "a string", error);
    if (*member == NULL)
        *member = strdup(json_string_value(value));
    return *member == NULL ? talus_error_memory(error) : TALUS_OK;
}

static enum talus_status list_read(char ***member, const struct config_key *key,
                                   const json_t *value, struct talus_error *error)
{
    size_t count = json_array_size(value);
    if (!json_is_array(value))
        return type_error(key, "an array of strings", error);
    char **texts = calloc(count + 1, sizeof *texts);
    *member = texts;
    if (texts == NULL)
        return talus_error_memory(error);
    for (size_t index = 0; index < count; index++) {
        const char *text = json_string_value(json_array_get(value, index));
        if (text == NULL)
            return type_error(key, "an array of strings", error);
        texts[index] = strdup(text);
        if (texts[index] == NULL)
            return talus_error_memory(error);
    }
    return TALUS_OK;
}

static enum talus_status unknown_key(const char *name, struct talus_error *error)
{
    const char *names[KEY_COUNT + 1] = {NULL};
    for (size_t index = 0; index < KEY_COUNT; index++)
        names[index] = keys[index].name;
    const char *near = suggest(name, names);
    return talus_error_set(error, TALUS_INVALID, "unknown_key", "", "unknown key %s%s%s", name,
                           near == NULL ? "" : "; did you mean ", near == NULL ? "" : near);
}

static enum talus_status key_read(struct config *config, const char *name, const json_t *value,
                                  struct talus_error *error)
{
    size_t index = 0;
    while (index < KEY_COUNT && strcmp(keys[index].name, name) != 0)
        index++;
    if (index == KEY_COUNT)
        return unknown_key(name, error);
    const struct config_key *key = &keys[index];
    void *member = (char *)config + key->offset;
    switch (key->kind) {
    case CONFIG_KIND_TEXT:
        return text_read(member, key, value, error);
    case CONFIG_KIND_NUMBER:
        return number_read(member, key, value, error);
    case CONFIG_KIND_LIST:
        return list_read(member, key, value, error);
    case CONFIG_KIND_FLAG:
        break;
    }
    *(bool *)member = json_is_true(value);
    return json_is_boolean(value) ? TALUS_OK : type_error(key, "true or false", error);
}

enum talus_status config_file_read(struct config *config, const char *path,
                                   struct talus_error *error)
{
    json_error_t problem;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &problem);
    if (!json_is_object(root)) {
        json_decref(root);
        return talus_error_set(error, TALUS_INVALID, "config", "",
                               "%s: not a JSON object (line %d, column %d: %s)", path, problem.line,
                               problem.column, problem.text);
    }
    enum talus_status status = TALUS_OK;
    const char *key;
    json_t *value;
    json_object_foreach(root, key, value)
    {
        if (status == TALUS_OK)
            status = key_read(config, key, value, error);
    }
    json_decref(root);
    return status;
}
