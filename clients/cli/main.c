/* SPDX-License-Identifier: Apache-2.0 */
/* talus: the command-line client of talusd. */
#include "subcommand.h"
#include "talus/version.h"
#include "token_source.h"

#include <locale.h>
#include <stdio.h>
#include <string.h>

static const struct subcommand *const subcommands[] = {
#define SUBCOMMAND(name) &subcommand_##name,
#include "subcommands.def"
#undef SUBCOMMAND
};
enum { SUBCOMMAND_COUNT = sizeof subcommands / sizeof subcommands[0] };

static void print_usage(FILE *stream)
{
    (void)fprintf(stream, "talus: the client of talusd\n\nusage: talus COMMAND [OPTIONS]\n\n");
    for (size_t index = 0; index < SUBCOMMAND_COUNT; index++)
        (void)fprintf(stream, "  %-10s %s\n", subcommands[index]->name,
                      subcommands[index]->summary);
    (void)fprintf(stream,
                  "\ntalus COMMAND --help says more.\n"
                  "The server is --server URL, else $TALUS_SERVER, else http://127.0.0.1:8465; "
                  "unix:PATH works too.\nThe token, where the server wants one, is in the file of "
                  "--token-file, else in $TALUS_TOKEN.\n"
                  "exit codes: 0 done, 1 the job failed, 2 usage, 3 the server refused, "
                  "4 no server\n");
}

static void print_options(const struct option_spec *options)
{
    for (; options->name != NULL; options++) {
        char left[64];
        (void)snprintf(left, sizeof left, "--%s%s%s", options->name,
                       options->argument == NULL ? "" : " ",
                       options->argument == NULL ? "" : options->argument);
        (void)printf("  %-24s %s\n", left, options->meaning);
    }
}

static void print_help(const struct subcommand *subcommand)
{
    (void)printf("usage: talus %s [OPTIONS] %s\n\n%s.\n%s\n", subcommand->name,
                 subcommand->synopsis, subcommand->summary, subcommand->details);
    print_options(subcommand->options);
    print_options(arguments_common);
}

static int run_subcommand(const struct subcommand *subcommand, int argument_count,
                          char **argument_texts)
{
    struct arguments arguments;
    struct connection connection;
    char token[TOKEN_SOURCE_SIZE];
    if (!arguments_read(&arguments, subcommand->options, argument_count, argument_texts))
        return EXIT_USAGE;
    if (arguments_has(&arguments, "help")) {
        print_help(subcommand);
        return EXIT_DONE;
    }
    if (arguments.operand_count < subcommand->operand_min ||
        (subcommand->operand_max >= 0 && arguments.operand_count > subcommand->operand_max)) {
        (void)fprintf(stderr, "usage: talus %s [OPTIONS] %s\n", subcommand->name,
                      subcommand->synopsis);
        return EXIT_USAGE;
    }
    if (!token_source_read(arguments_value(&arguments, "token-file"), token))
        return EXIT_USAGE;
    int code = connection_open(&connection, arguments_value(&arguments, "server"), token);
    connection.json = arguments_has(&arguments, "json");
    if (code == EXIT_DONE)
        code = subcommand->run(&connection, &arguments);
    connection_close(&connection);
    if (fflush(stdout) != 0 && code == EXIT_DONE)
        code = EXIT_USAGE;
    return code;
}

static int dispatch(int argument_count, char **arguments)
{
    if (argument_count < 2) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(arguments[1], "--help") == 0 || strcmp(arguments[1], "help") == 0) {
        print_usage(stdout);
        return EXIT_DONE;
    }
    if (strcmp(arguments[1], "--version") == 0) {
        (void)printf("talus %s\n", talus_build());
        return EXIT_DONE;
    }
    for (size_t index = 0; index < SUBCOMMAND_COUNT; index++) {
        if (strcmp(arguments[1], subcommands[index]->name) == 0)
            return run_subcommand(subcommands[index], argument_count - 1, arguments + 1);
    }
    (void)fprintf(stderr, "talus: unknown command '%s'\n\n", arguments[1]);
    print_usage(stderr);
    return EXIT_USAGE;
}

int main(int argument_count, char **arguments)
{
    (void)setlocale(LC_CTYPE, "");
    if (curl_global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK) {
        (void)fprintf(stderr, "talus: libcurl cannot be started\n");
        return EXIT_USAGE;
    }
    const int code = dispatch(argument_count, arguments);
    curl_global_cleanup();
    return code;
}
