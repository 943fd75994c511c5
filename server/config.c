/* SPDX-License-Identifier: Apache-2.0 */
#include "config.h"

#include "config_file.h"
#include "folder.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static enum talus_status usage_error(struct talus_error *error, const char *text)
{
    return talus_error_set(error, TALUS_INVALID, "usage", "", "%s (see talusd --help)", text);
}

void config_usage(FILE *stream)
{
    (void)fputs(
        "talusd: takes scenes over HTTP, runs them in workers, serves their results\n\n"
        "  talusd --state DIR [--listen ADDR:PORT or unix:PATH] [--workers N]\n"
        "         [--tokens FILE] [--worker-program PATH] [--config FILE]\n\n"
        "  --state DIR            where jobs and the database are kept\n"
        "                         (default: $XDG_STATE_HOME/talus)\n"
        "  --listen ADDR:PORT     default 127.0.0.1:8465; port 0: any; an address that is\n"
        "                         not loopback needs --tokens\n"
        "  --listen unix:PATH     a Unix socket\n"
        "  --workers N            threads that run at once over all jobs\n"
        "                         (default: the cores)\n"
        "  --tokens FILE          who may do what: lines NAME:ROLE:SHA256 with the roles read,\n"
        "                         submit and admin; read again on SIGHUP\n"
        "  --worker-program PATH  talus-worker (default: beside talusd, then in PATH)\n"
        "  --config FILE          a JSON object with any of these keys:\n",
        stream);
#define CONFIG_TEXT(key, fallback, meaning)                                                        \
    (void)fprintf(stream, "      %-22s %s\n", #key, meaning);
#define CONFIG_NUMBER(key, fallback, low, high, meaning)                                           \
    (void)fprintf(stream, "      %-22s %s (default %.12g)\n", #key, meaning, (double)(fallback));
#define CONFIG_FLAG(key, meaning)                                                                  \
    (void)fprintf(stream, "      %-22s %s (default false)\n", #key, meaning);
#define CONFIG_LIST(key, meaning)                                                                  \
    (void)fprintf(stream, "      %-22s %s (default [])\n", #key, meaning);
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
#undef CONFIG_FLAG
#undef CONFIG_LIST
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
        {"state", required_argument, NULL, 's'},
        {"listen", required_argument, NULL, 'l'},
        {"workers", required_argument, NULL, 'w'},
        {"worker-program", required_argument, NULL, 'p'},
        {"config", required_argument, NULL, 'c'},
        {"help", no_argument, NULL, 'h'},
        {"version", no_argument, NULL, 'v'},
        {"tokens", required_argument, NULL, 't'},
        {NULL, 0, NULL, 0},
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
        case 't':
            good = text_replace(&config->tokens, optarg);
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
        return talus_error_memory(error);
    return optind < argument_count ? usage_error(error, "too many arguments") : TALUS_OK;
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
    return config->state == NULL ? talus_error_memory(error) : TALUS_OK;
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
            return talus_error_memory(error);
        if (access(config->worker_program, X_OK) == 0)
            return TALUS_OK;
    }
    return text_replace(&config->worker_program, "talus-worker") ? TALUS_OK
                                                                 : talus_error_memory(error);
}

/* False without memory. */
static bool default_text(char **text, const char *fallback)
{
    return *text != NULL || fallback == NULL || text_replace(text, fallback);
}

static void default_number(double *number, double fallback)
{
    if (isnan(*number))
        *number = fallback;
}

static bool defaults_fill(struct config *config)
{
    bool good = true;
#define CONFIG_TEXT(key, fallback, meaning) good = default_text(&config->key, fallback) && good;
#define CONFIG_NUMBER(key, fallback, low, high, meaning) default_number(&config->key, fallback);
#define CONFIG_FLAG(key, meaning)
#define CONFIG_LIST(key, meaning)
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
#undef CONFIG_FLAG
#undef CONFIG_LIST
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
#define CONFIG_FLAG(key, meaning)
#define CONFIG_LIST(key, meaning)
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
#undef CONFIG_FLAG
#undef CONFIG_LIST
    enum talus_status status = arguments_read(config, argument_count, arguments, &file, error);
    if (status == TALUS_OK && file != NULL)
        status = config_file_read(config, file, error);
    if (status == TALUS_OK && !defaults_fill(config))
        status = talus_error_memory(error);
    if (status == TALUS_OK && !config->help && !config->version)
        status = state_find(config, error);
    if (status == TALUS_OK)
        status = worker_find(config, error);
    free(file);
    return status;
}

static void list_release(char **texts)
{
    for (size_t index = 0; texts != NULL && texts[index] != NULL; index++)
        free(texts[index]);
    free(texts);
}

void config_release(struct config *config)
{
#define CONFIG_TEXT(key, fallback, meaning) free(config->key);
#define CONFIG_NUMBER(key, fallback, low, high, meaning)
#define CONFIG_FLAG(key, meaning)
#define CONFIG_LIST(key, meaning) list_release(config->key);
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
#undef CONFIG_FLAG
#undef CONFIG_LIST
    memset(config, 0, sizeof *config);
}
