/* SPDX-License-Identifier: Apache-2.0 */
#include "job_action.h"
#include "subcommand.h"

static const struct option_spec options[] = {{NULL, NULL, NULL}};

static int run(struct connection *connection, const struct arguments *arguments)
{
    return job_action_run(connection, arguments, "POST", "/resume");
}

const struct subcommand subcommand_resume = {
    .name = "resume",
    .synopsis = "ID...",
    .summary = "lets failed or cancelled jobs go on from their last checkpoint",
    .details = "",
    .options = options,
    .operand_min = 1,
    .operand_max = -1,
    .run = run,
};
