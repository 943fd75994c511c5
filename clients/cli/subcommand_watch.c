/* SPDX-License-Identifier: Apache-2.0 */
#include "subcommand.h"
#include "watch.h"

static const struct option_spec options[] = {
    {"reaction", "NAME", "show this reaction only, e.g. column.x_min (default: all boundaries)"},
    {NULL, NULL, NULL},
};

static int run(struct connection *connection, const struct arguments *arguments)
{
    return watch_job(connection, arguments->operands[0], arguments_value(arguments, "reaction"));
}

const struct subcommand subcommand_watch = {
    .name = "watch",
    .synopsis = "ID",
    .summary = "follows a job: progress and the forces on its boundaries",
    .details = "Takes a broken connection up again where it was. Exit code 1 if the job fails or\n"
               "is cancelled.\n",
    .options = options,
    .operand_min = 1,
    .operand_max = 1,
    .run = run,
};
