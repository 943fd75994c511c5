/* SPDX-License-Identifier: Apache-2.0 */
#include "transfer.h"

#include "base/digest.h"
#include "problem_text.h"
#include "subcommand.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ATTEMPT_MAX = 5 };

bool transfer_name_is_safe(const char *name)
{
    if (name[0] == '\0' || name[0] == '/')
        return false;
    for (const char *part = name; part != NULL; part = strchr(part, '/')) {
        part += *part == '/';
        const size_t length = strcspn(part, "/");
        if (length == 0 || (length == 1 && part[0] == '.') ||
            (length == 2 && part[0] == '.' && part[1] == '.'))
            return false;
    }
    return true;
}

static int local_failure(const char *action, const char *path)
{
    (void)fprintf(stderr, "talus: cannot %s %s: %s\n", action, path, strerror(errno));
    return EXIT_USAGE;
}

/* Makes the folders above a path. */
static bool make_parents(const char *path)
{
    char folder[PATH_MAX];
    (void)snprintf(folder, sizeof folder, "%s", path);
    for (char *slash = strchr(folder + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(folder, 0777) != 0 && errno != EEXIST)
            return false;
        *slash = '/';
    }
    return true;
}

static bool has_sum(const char *path, const char *sha256)
{
    char sum[65];
    struct talus_error error = {0};
    return sha256[0] != '\0' && access(path, R_OK) == 0 &&
           digest_file(path, sum, &error) == TALUS_OK && strcmp(sum, sha256) == 0;
}

static int64_t size_of(const char *path)
{
    struct stat information;
    return stat(path, &information) == 0 ? (int64_t)information.st_size : 0;
}

struct sink {
    FILE *stream;
    bool failed;
};

static bool take_bytes(void *context, const char *bytes, size_t length)
{
    struct sink *sink = context;
    sink->failed = fwrite(bytes, 1, length, sink->stream) != length;
    return !sink->failed;
}

/* One request for what is missing of `part`. EXIT_DONE if the file is as long as it should be, or
 * *again if another request may bring more. */
static int fetch_rest(struct connection *connection, const char *path, const char *part,
                      const struct remote_file *file, bool *again)
{
    char range[64], problem[256];
    struct http_reply reply;
    const int64_t have = size_of(part);
    const bool go_on = have > 0 && have < file->bytes;
    struct sink sink = {.stream = fopen(part, go_on ? "ab" : "wb")};
    *again = false;
    if (sink.stream == NULL)
        return local_failure("write", part);
    (void)snprintf(range, sizeof range, "Range: bytes=%" PRId64 "-", have);
    const struct http_request request = {.method = "GET",
                                         .path = path,
                                         .headers = {go_on ? range : NULL},
                                         .receive = take_bytes,
                                         .context = &sink,
                                         .endless = true};
    const bool answered = connection_send(connection, &request, &reply, problem, sizeof problem);
    int code = EXIT_DONE;
    if (fclose(sink.stream) != 0 || sink.failed) {
        code = local_failure("write", part);
    } else if (!answered) {
        *again = reply.status / 100 == 2; /* it had begun */
        if (!*again)
            (void)fprintf(stderr, "talus: %s\n", problem);
        code = EXIT_NO_SERVER;
    } else if (reply.status / 100 != 2) {
        problem_print(stderr, reply.status, reply.body, reply.length);
        code = EXIT_REFUSED;
    } else if (go_on && reply.status != 206) { /* the whole came and was appended */
        (void)remove(part);
        *again = true;
        code = EXIT_REFUSED;
    }
    http_reply_release(&reply);
    return code;
}

static int fetch_part(struct connection *connection, const char *id, const char *part,
                      const struct remote_file *file)
{
    bool again = true;
    int code = EXIT_NO_SERVER;
    char *path = job_path(id, "/files/", file->name);
    if (path == NULL)
        return EXIT_USAGE;
    for (int attempt = 0; attempt < ATTEMPT_MAX && again; attempt++)
        code = fetch_rest(connection, path, part, file, &again);
    if (again && code == EXIT_NO_SERVER)
        (void)fprintf(stderr, "talus: the connection broke %d times while fetching %s\n",
                      ATTEMPT_MAX, file->name);
    free(path);
    return code;
}

enum transfer_outcome transfer_file(struct connection *connection, const char *id,
                                    const struct remote_file *file, const char *folder, int *code)
{
    char target[PATH_MAX], part[PATH_MAX];
    *code = EXIT_USAGE;
    if (!transfer_name_is_safe(file->name) ||
        snprintf(target, sizeof target, "%s/%s", folder, file->name) >= (int)sizeof target ||
        snprintf(part, sizeof part, "%s.part", target) >= (int)sizeof part) {
        (void)fprintf(stderr, "talus: '%s' cannot be the name of a file here\n", file->name);
        return TRANSFER_FAILED;
    }
    if (has_sum(target, file->sha256)) {
        *code = EXIT_DONE;
        return TRANSFER_ALREADY_THERE;
    }
    if (!make_parents(target)) {
        *code = local_failure("make the folder of", target);
        return TRANSFER_FAILED;
    }
    /* A complete part is left over when only the renaming was missing. */
    *code = has_sum(part, file->sha256) ? EXIT_DONE : fetch_part(connection, id, part, file);
    if (*code != EXIT_DONE)
        return TRANSFER_FAILED;
    if (file->sha256[0] != '\0' && !has_sum(part, file->sha256)) {
        (void)fprintf(stderr, "talus: %s does not have the SHA-256 that the server named\n",
                      file->name);
        (void)remove(part);
        *code = EXIT_REFUSED;
        return TRANSFER_FAILED;
    }
    if (rename(part, target) != 0) {
        *code = local_failure("rename", part);
        return TRANSFER_FAILED;
    }
    return TRANSFER_DONE;
}
