/* SPDX-License-Identifier: Apache-2.0 */
#include "arguments.h"

#include <assert.h>
#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct option_spec arguments_common[] = {
    {"json", NULL, "print JSON for machines"},
    {"server", "URL", "http://HOST:PORT or unix:PATH (default: $TALUS_SERVER, else the loopback)"},
    {"token-file", "FILE", "holds the token for the server (default: $TALUS_TOKEN)"},
    {"help", NULL, "print this help"},
    {NULL, NULL, NULL},
};

static size_t add_options(struct option *options, size_t count, const struct option_spec *specs)
{
    for (; specs->name != NULL; specs++) {
        assert(count < ARGUMENTS_OPTION_MAX);
        options[count++] = (struct option){
            specs->name, specs->argument == NULL ? no_argument : required_argument, NULL, 0};
    }
    return count;
}

bool arguments_read(struct arguments *out, const struct option_spec *options, int argument_count,
                    char **arguments)
{
    struct option table[ARGUMENTS_OPTION_MAX + 1] = {{0}};
    const size_t count = add_options(table, 0, options);
    (void)add_options(table, count, arguments_common);
    memset(out, 0, sizeof *out);
    int option, index = 0;
    optind = 1;
    while ((option = getopt_long(argument_count, arguments, "", table, &index)) != -1) {
        if (option != 0)
            return false; /* getopt has said why */
        if (out->given_count == ARGUMENTS_GIVEN_MAX) {
            (void)fprintf(stderr, "talus: too many options\n");
            return false;
        }
        out->given[out->given_count].name = table[index].name;
        out->given[out->given_count].value = optarg == NULL ? "" : optarg;
        out->given_count++;
    }
    out->operands = arguments + optind;
    out->operand_count = argument_count - optind;
    return true;
}

const char *arguments_value(const struct arguments *arguments, const char *name)
{
    for (size_t index = arguments->given_count; index > 0; index--) {
        if (strcmp(arguments->given[index - 1].name, name) == 0)
            return arguments->given[index - 1].value;
    }
    return NULL;
}

bool arguments_has(const struct arguments *arguments, const char *name)
{
    return arguments_value(arguments, name) != NULL;
}

bool arguments_integer(const struct arguments *arguments, const char *name, long low, long high,
                       long otherwise, long *number)
{
    const char *text = arguments_value(arguments, name);
    char *end = NULL;
    *number = otherwise;
    if (text == NULL)
        return true;
    errno = 0;
    *number = strtol(text, &end, 10);
    if (text[0] != '\0' && *end == '\0' && errno == 0 && *number >= low && *number <= high)
        return true;
    (void)fprintf(stderr, "talus: --%s takes a whole number from %ld to %ld\n", name, low, high);
    return false;
}
