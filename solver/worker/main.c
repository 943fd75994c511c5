/* SPDX-License-Identifier: Apache-2.0 */
#include "base/protocol.h"
#include "talus/version.h"
#include "worker/command.h"
#include "worker/isa.h"

#include <stdio.h>
#include <string.h>

static const struct command commands[] = {
#define COMMAND(name, synopsis, summary) {#name, synopsis, summary, command_##name},
#include "worker/commands.def"
#undef COMMAND
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_usage(FILE *stream)
{
    (void)fprintf(stream, "talus-worker %s: runs one MPM scene in one process\n\n", talus_build());
    for (size_t index = 0; index < COMMAND_COUNT; index++)
        (void)fprintf(stream, "  talus-worker %s %s\n      %s\n", commands[index].name,
                      commands[index].synopsis, commands[index].summary);
}

int main(int argument_count, char **arguments)
{
    if (!isa_switch(arguments))
        return PROTOCOL_EXIT_OTHER;
    if (argument_count < 2) {
        print_usage(stderr);
        return PROTOCOL_EXIT_OTHER;
    }
    if (strcmp(arguments[1], "--help") == 0 || strcmp(arguments[1], "help") == 0) {
        print_usage(stdout);
        return PROTOCOL_EXIT_SUCCEEDED;
    }
    if (strcmp(arguments[1], "--version") == 0) {
        (void)printf("talus-worker %s\n", talus_build());
        return PROTOCOL_EXIT_SUCCEEDED;
    }
    for (size_t index = 0; index < COMMAND_COUNT; index++) {
        if (strcmp(arguments[1], commands[index].name) == 0)
            return commands[index].run(argument_count - 1, arguments + 1);
    }
    (void)fprintf(stderr, "talus-worker: unknown command '%s'\n\n", arguments[1]);
    print_usage(stderr);
    return PROTOCOL_EXIT_OTHER;
}
