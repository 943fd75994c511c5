/* SPDX-License-Identifier: Apache-2.0 */
#include "job_action.h"
#include "subcommand.h"

static const struct option_spec options[] = {{NULL, NULL, NULL}};

static int run(struct connection *connection, const struct arguments *arguments)
{
    return job_action_run(connection, arguments, "POST", "/cancel");
}

const struct subcommand subcommand_cancel = {
    .name = "cancel",
    .synopsis = "ID...",
    .summary = "cancels jobs",
    .details = "A running job is asked to stop; `talus watch` tells when it has.\n",
    .options = options,
    .operand_min = 1,
    .operand_max = -1,
    .run = run,
};
