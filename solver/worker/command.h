/* SPDX-License-Identifier: Apache-2.0 */
/* A sub-command of talus-worker: one file command_NAME.c and one line in commands.def. */
#ifndef TALUS_COMMAND_H
#define TALUS_COMMAND_H

struct command {
    const char *name, *synopsis, *summary;
    /* arguments[0] is the command's name. Returns an exit code (enum protocol_exit). */
    int (*run)(int argument_count, char **arguments);
};

#define COMMAND(name, synopsis, summary) int command_##name(int argument_count, char **arguments);
#include "worker/commands.def"
#undef COMMAND

#endif
