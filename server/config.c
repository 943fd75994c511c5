/* SPDX-License-Identifier: Apache-2.0 */
#include "config.h"

#include "folder.h"
#include "suggest.h"

#include <getopt.h>
#include <jansson.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const key_names[] = {
#define CONFIG_TEXT(key, fallback, meaning) #key,
#define CONFIG_NUMBER(key, fallback, low, high, meaning) #key,
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
    NULL,
};

static enum talus_status out_of_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
}

static enum talus_status usage_error(struct talus_error *error, const char *text)
{
    return talus_error_set(error, TALUS_INVALID, "usage", "", "%s (see talusd --help)", text);
}

void config_usage(FILE *stream)
{
    (void)fputs(
        "talusd: takes scenes over HTTP, runs them in workers, serves their results\n\n"
        "  talusd --state DIR [--listen ADDR:PORT or unix:PATH] [--workers N]\n"
        "         [--worker-program PATH] [--config FILE]\n\n"
        "  --state DIR            where jobs and the database are kept\n"
        "                         (default: $XDG_STATE_HOME/talus)\n"
        "  --listen ADDR:PORT     a loopback address (default 127.0.0.1:8465; port 0: any)\n"
        "  --listen unix:PATH     a Unix socket\n"
        "  --workers N            threads that run at once over all jobs\n"
        "                         (default: the cores)\n"
        "  --worker-program PATH  talus-worker (default: beside talusd, then in PATH)\n"
        "  --config FILE          a JSON object with any of these keys:\n",
        stream);
#define CONFIG_TEXT(key, fallback, meaning)                                                        \
    (void)fprintf(stream, "      %-22s %s\n", #key, meaning);
#define CONFIG_NUMBER(key, fallback, low, high, meaning)                                           \
    (void)fprintf(stream, "      %-22s %s (default %.12g)\n", #key, meaning, (double)(fallback));
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
    (void)fputs("  --help, --version\n", stream);
}

static bool text_replace(char **text, const char *value)
{
    char *copy = strdup(value);
    if (copy == NULL)
        return false;
    free(*text);
    *text = copy;
    return true;
}

static enum talus_status arguments_read(struct config *config, int argument_count, char **arguments,
                                        char **file, struct talus_error *error)
{
    static const struct option options[] = {
        {"state", required_argument, NULL, 's'},   {"listen", required_argument, NULL, 'l'},
        {"workers", required_argument, NULL, 'w'}, {"worker-program", required_argument, NULL, 'p'},
        {"config", required_argument, NULL, 'c'},  {"help", no_argument, NULL, 'h'},
        {"version", no_argument, NULL, 'v'},       {NULL, 0, NULL, 0},
    };
    int option;
    bool good = true;
    char *end = NULL;
    optind = 1;
    opterr = 0;
    while (good && (option = getopt_long(argument_count, arguments, "", options, NULL)) != -1) {
        switch (option) {
        case 's':
            good = text_replace(&config->state, optarg);
            break;
        case 'l':
            good = text_replace(&config->listen, optarg);
            break;
        case 'p':
            good = text_replace(&config->worker_program, optarg);
            break;
        case 'c':
            good = text_replace(file, optarg);
            break;
        case 'w':
            config->workers = strtod(optarg, &end);
            if (end == optarg || *end != '\0' || !(config->workers >= 1) ||
                config->workers > 4096 || floor(config->workers) < config->workers)
                return usage_error(error, "--workers needs a whole number from 1 to 4096");
            break;
        case 'h':
            config->help = true;
            break;
        case 'v':
            config->version = true;
            break;
        default:
            return usage_error(error, "an option is unknown or lacks its value");
        }
    }
    if (!good)
        return out_of_memory(error);
    return optind < argument_count ? usage_error(error, "too many arguments") : TALUS_OK;
}

/* Where a key of the file goes. */
struct config_key {
    const char *name;
    bool is_text;
    size_t offset; /* in struct config */
    double low, high;
};

static const struct config_key keys[] = {
#define CONFIG_TEXT(key, fallback, meaning) {#key, true, offsetof(struct config, key), 0, 0},
#define CONFIG_NUMBER(key, fallback, low, high, meaning)                                           \
    {#key, false, offsetof(struct config, key), low, high},
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
};
enum { KEY_COUNT = sizeof keys / sizeof keys[0] };

static enum talus_status number_read(struct config *config, const struct config_key *key,
                                     const json_t *value, struct talus_error *error)
{
    double *member = (double *)((char *)config + key->offset);
    double number = json_number_value(value);
    if (!json_is_number(value) || number < key->low || number > key->high)
        return talus_error_set(error, TALUS_INVALID, "range", "",
                               "%s: a number from %g to %g is "
                               "wanted",
                               key->name, key->low, key->high);
    if (isnan(*member))
        *member = number;
    return TALUS_OK;
}

/* Takes a key of the file unless the command line gave it. */
static enum talus_status key_read(struct config *config, const char *name, const json_t *value,
                                  struct talus_error *error)
{
    size_t index = 0;
    while (index < KEY_COUNT && strcmp(keys[index].name, name) != 0)
        index++;
    if (index == KEY_COUNT) {
        const char *near = suggest(name, key_names);
        return talus_error_set(error, TALUS_INVALID, "unknown_key", "", "unknown key %s%s%s", name,
                               near == NULL ? "" : "; did you mean ", near == NULL ? "" : near);
    }
    if (!keys[index].is_text)
        return number_read(config, &keys[index], value, error);
    char **member = (char **)((char *)config + keys[index].offset);
    if (!json_is_string(value))
        return talus_error_set(error, TALUS_INVALID, "type", "", "%s: a string is wanted", name);
    return *member != NULL || text_replace(member, json_string_value(value)) ? TALUS_OK
                                                                             : out_of_memory(error);
}

static enum talus_status file_read(struct config *config, const char *path,
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

static enum talus_status state_find(struct config *config, struct talus_error *error)
{
    const char *base = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    if (config->state != NULL)
        return TALUS_OK;
    if (base != NULL && base[0] == '/')
        config->state = folder_join(base, "talus");
    else if (home != NULL && home[0] == '/')
        config->state = folder_join(home, ".local/state/talus");
    else
        return usage_error(error, "--state is needed: neither XDG_STATE_HOME nor HOME is set");
    return config->state == NULL ? out_of_memory(error) : TALUS_OK;
}

static enum talus_status worker_find(struct config *config, struct talus_error *error)
{
    char path[4096];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (config->worker_program != NULL)
        return TALUS_OK;
    if (length > 0) {
        path[length] = '\0';
        char *slash = strrchr(path, '/');
        if (slash != NULL)
            *slash = '\0';
        config->worker_program = folder_join(path, "talus-worker");
        if (config->worker_program == NULL)
            return out_of_memory(error);
        if (access(config->worker_program, X_OK) == 0)
            return TALUS_OK;
    }
    return text_replace(&config->worker_program, "talus-worker") ? TALUS_OK : out_of_memory(error);
}

static bool defaults_fill(struct config *config)
{
    bool good = true;
#define CONFIG_TEXT(key, fallback, meaning)                                                        \
    {                                                                                              \
        const char *text = (fallback);                                                             \
        if (config->key == NULL && text != NULL)                                                   \
            good = good && text_replace(&config->key, text);                                       \
    }
#define CONFIG_NUMBER(key, fallback, low, high, meaning)                                           \
    if (isnan(config->key))                                                                        \
        config->key = (fallback);
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
    if (config->workers < 1) {
        long cores = sysconf(_SC_NPROCESSORS_ONLN);
        config->workers = cores > 0 ? (double)cores : 1;
    }
    return good;
}

enum talus_status config_read(struct config *config, int argument_count, char **arguments,
                              struct talus_error *error)
{
    char *file = NULL;
    memset(config, 0, sizeof *config);
#define CONFIG_TEXT(key, fallback, meaning)
#define CONFIG_NUMBER(key, fallback, low, high, meaning) config->key = NAN;
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
    enum talus_status status = arguments_read(config, argument_count, arguments, &file, error);
    if (status == TALUS_OK && file != NULL)
        status = file_read(config, file, error);
    if (status == TALUS_OK && !defaults_fill(config))
        status = out_of_memory(error);
    if (status == TALUS_OK && !config->help && !config->version)
        status = state_find(config, error);
    if (status == TALUS_OK)
        status = worker_find(config, error);
    free(file);
    return status;
}

void config_release(struct config *config)
{
#define CONFIG_TEXT(key, fallback, meaning) free(config->key);
#define CONFIG_NUMBER(key, fallback, low, high, meaning)
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
    memset(config, 0, sizeof *config);
}
