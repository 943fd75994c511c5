/* SPDX-License-Identifier: Apache-2.0 */
#include "subcommand.h"

static const struct option_spec options[] = {{NULL, NULL, NULL}};

static int run(struct connection *connection, const struct arguments *arguments)
{
    (void)connection;
    (void)arguments;
    (void)fprintf(stderr, "talus: unsupported: this build has no studies; submit the jobs one by "
                          "one\n");
    return EXIT_USAGE;
}

const struct subcommand subcommand_study = {
    .name = "study",
    .synopsis = "[ARGUMENT...]",
    .summary = "not in this build (studies: sets of jobs from one scene)",
    .details = "",
    .options = options,
    .operand_min = 0,
    .operand_max = -1,
    .run = run,
};
