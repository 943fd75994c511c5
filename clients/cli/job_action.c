/* SPDX-License-Identifier: Apache-2.0 */
#include "job_action.h"

#include "job_text.h"
#include "subcommand.h"

#include <stdlib.h>

static void print_outcome(const struct connection *connection, const char *id, const json_t *job)
{
    if (connection->json) {
        if (job != NULL)
            (void)json_dumpf(job, stdout, JSON_COMPACT);
        else
            (void)printf("{\"id\":\"%s\",\"deleted\":true}", id);
        (void)printf("\n");
        return;
    }
    const bool leaving = json_is_true(json_object_get(job, "cancel_requested"));
    (void)printf("%s %s%s\n", id, job == NULL ? "deleted" : json_text(job, "state"),
                 leaving ? " (cancel requested)" : "");
}

int job_action_run(struct connection *connection, const struct arguments *arguments,
                   const char *method, const char *suffix)
{
    return resource_action_run(connection, "jobs", arguments->operands, arguments->operand_count,
                               method, suffix);
}

int resource_action_run(struct connection *connection, const char *collection, char *const *ids,
                        int count, const char *method, const char *suffix)
{
    int worst = EXIT_DONE;
    for (int index = 0; index < count; index++) {
        json_t *job = NULL;
        char *path = resource_path(collection, ids[index], suffix, NULL);
        if (path == NULL)
            return EXIT_USAGE;
        const struct http_request request = {.method = method, .path = path};
        const int code = connection_ask(connection, &request, &job);
        if (code == EXIT_DONE)
            print_outcome(connection, ids[index], job);
        worst = code > worst ? code : worst;
        json_decref(job);
        free(path);
    }
    return worst;
}
