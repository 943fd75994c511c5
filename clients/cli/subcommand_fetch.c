/* SPDX-License-Identifier: Apache-2.0 */
#include "job_text.h"
#include "subcommand.h"
#include "transfer.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

static const struct option_spec options[] = {
    {"into", "DIR", "the folder to write to (default: the job's ID)"},
    {"list", NULL, "only list the files"},
    {NULL, NULL, NULL},
};

/* Whether a file was asked for: no pattern at all, its name, or a pattern that it matches. */
static bool is_wanted(const struct arguments *arguments, const char *name)
{
    for (int index = 1; index < arguments->operand_count; index++) {
        if (fnmatch(arguments->operands[index], name, 0) == 0)
            return true;
    }
    return arguments->operand_count == 1;
}

static struct remote_file file_of(const json_t *item)
{
    return (struct remote_file){.name = json_text(item, "name"),
                                .sha256 = json_text(item, "sha256"),
                                .bytes =
                                    (int64_t)json_integer_value(json_object_get(item, "bytes"))};
}

static void print_file(const struct connection *connection, const json_t *item, const char *note)
{
    char size[32];
    const struct remote_file file = file_of(item);
    bytes_format((double)file.bytes, size, sizeof size);
    if (connection->json) {
        (void)json_dumpf(item, stdout, JSON_COMPACT);
        (void)printf("\n");
    } else {
        (void)printf("%-40s %10s%s\n", file.name, size, note);
    }
    (void)fflush(stdout);
}

/* Fetches what is wanted; the worst exit code. */
static int fetch_files(struct connection *connection, const struct arguments *arguments,
                       const json_t *files)
{
    size_t index;
    json_t *item;
    int worst = EXIT_DONE, wanted_count = 0;
    const char *id = arguments->operands[0], *folder = arguments_value(arguments, "into");
    json_array_foreach(files, index, item)
    {
        int code = EXIT_DONE;
        const struct remote_file file = file_of(item);
        if (!is_wanted(arguments, file.name))
            continue;
        wanted_count++;
        if (arguments_has(arguments, "list")) {
            print_file(connection, item, "");
            continue;
        }
        const enum transfer_outcome outcome =
            transfer_file(connection, id, &file, folder == NULL ? id : folder, &code);
        if (outcome != TRANSFER_FAILED)
            print_file(connection, item,
                       outcome == TRANSFER_ALREADY_THERE ? "  already there" : "");
        worst = code > worst ? code : worst;
        if (code == EXIT_NO_SERVER)
            break;
    }
    if (wanted_count == 0 && arguments->operand_count > 1) {
        (void)fprintf(stderr, "talus: the job has no such file (talus fetch %s --list)\n", id);
        worst = EXIT_REFUSED;
    }
    return worst;
}

static int run(struct connection *connection, const struct arguments *arguments)
{
    json_t *files = NULL;
    char *path = job_path(arguments->operands[0], "/files", NULL);
    if (path == NULL)
        return EXIT_USAGE;
    const struct http_request request = {.method = "GET", .path = path};
    int code = connection_ask(connection, &request, &files);
    if (code == EXIT_DONE)
        code = fetch_files(connection, arguments, files);
    json_decref(files);
    free(path);
    return code;
}

const struct subcommand subcommand_fetch = {
    .name = "fetch",
    .synopsis = "ID [FILE...]",
    .summary = "fetches the files of a job, checked by their SHA-256",
    .details = "FILE is a name or a pattern like 'frames/*'; without any, all files are fetched.\n"
               "What is there already is left alone; what was cut off is gone on with.\n",
    .options = options,
    .operand_min = 1,
    .operand_max = -1,
    .run = run,
};
