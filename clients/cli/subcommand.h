/* SPDX-License-Identifier: Apache-2.0 */
/* A sub-command of the client `talus`: one file subcommand_NAME.c and one line in subcommands.def.
 */
#ifndef TALUS_SUBCOMMAND_H
#define TALUS_SUBCOMMAND_H

#include "arguments.h"
#include "connection.h"

enum exit_code {
    EXIT_DONE = 0,
    EXIT_JOB_FAILED = 1, /* watched job failed or was cancelled */
    EXIT_USAGE = 2,      /* the command line, or a local file that it names */
    EXIT_REFUSED = 3,    /* the server answered with an error */
    EXIT_NO_SERVER = 4,  /* no answer */
};

struct subcommand {
    const char *name;
    const char *synopsis;              /* what follows the name: "ID [FILE...]" */
    const char *summary;               /* one line */
    const char *details;               /* for --help: more lines, or "" */
    const struct option_spec *options; /* ends with name NULL */
    int operand_min, operand_max;      /* how many arguments that are not options; max < 0: any */
    /* The connection is set up, not yet used. Returns an exit code. */
    int (*run)(struct connection *connection, const struct arguments *arguments);
};

#define SUBCOMMAND(name) extern const struct subcommand subcommand_##name;
#include "subcommands.def"
#undef SUBCOMMAND

#endif
