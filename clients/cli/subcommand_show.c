/* SPDX-License-Identifier: Apache-2.0 */
#include "job_text.h"
#include "subcommand.h"

#include <stdlib.h>

static const struct option_spec options[] = {{NULL, NULL, NULL}};

static int run(struct connection *connection, const struct arguments *arguments)
{
    json_t *job = NULL;
    char *path = job_path(arguments->operands[0], "", NULL);
    if (path == NULL)
        return EXIT_USAGE;
    const struct http_request request = {.method = "GET", .path = path};
    const int code = connection_ask(connection, &request, &job);
    if (code == EXIT_DONE && connection->json) {
        (void)json_dumpf(job, stdout, JSON_INDENT(2));
        (void)printf("\n");
    } else if (code == EXIT_DONE) {
        job_print(stdout, job);
    }
    json_decref(job);
    free(path);
    return code;
}

const struct subcommand subcommand_show = {
    .name = "show",
    .synopsis = "ID",
    .summary = "shows everything about a job",
    .details = "",
    .options = options,
    .operand_min = 1,
    .operand_max = 1,
    .run = run,
};
