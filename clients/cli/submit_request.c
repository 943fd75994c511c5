/* SPDX-License-Identifier: Apache-2.0 */
#include "submit_request.h"

#include "problem_text.h"
#include "subcommand.h"

#include <errno.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

enum { ATTEMPTS_MAX = 3 };

json_t *json_file_read(const char *path)
{
    json_error_t mistake;
    FILE *stream = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    if (stream == NULL) {
        (void)fprintf(stderr, "talus: cannot open %s: %s\n", path, strerror(errno));
        return NULL;
    }
    json_t *value = json_loadf(stream, JSON_REJECT_DUPLICATES, &mistake);
    if (value == NULL)
        (void)fprintf(stderr, "talus: %s is not JSON: line %d, column %d: %s\n", path, mistake.line,
                      mistake.column, mistake.text);
    if (stream != stdin)
        (void)fclose(stream);
    return value;
}

/* A random key makes it safe to send a submission again when its answer was lost. */
static bool make_key(const char *given, char *header, size_t size)
{
    unsigned char bytes[16];
    if (given != NULL)
        return snprintf(header, size, "Idempotency-Key: %s", given) < (int)size;
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return false;
    size_t length = (size_t)snprintf(header, size, "Idempotency-Key: ");
    for (size_t index = 0; index < sizeof bytes; index++)
        length += (size_t)snprintf(header + length, size - length, "%02x", bytes[index]);
    return true;
}

int submit_request_send(struct connection *connection, const struct submit_request *request,
                        struct http_reply *reply)
{
    char key[512], problem[256] = "";
    bool answered = false;
    memset(reply, 0, sizeof *reply);
    if (!make_key(request->key, key, sizeof key)) {
        (void)fprintf(stderr, "talus: the idempotency key is too long\n");
        return EXIT_USAGE;
    }
    const struct http_request post = {.method = "POST",
                                      .path = request->path,
                                      .body = request->body,
                                      .headers = {request->makes_nothing ? NULL : key}};
    for (int attempt = 0; attempt < ATTEMPTS_MAX; attempt++) {
        if (attempt > 0)
            (void)nanosleep(&(struct timespec){.tv_nsec = 300000000}, NULL);
        http_reply_release(reply);
        answered = connection_send(connection, &post, reply, problem, sizeof problem);
        if (answered || reply->status != 0)
            break;
    }
    if (!answered) {
        (void)fprintf(stderr, "talus: %s\n", problem);
        return EXIT_NO_SERVER;
    }
    if (reply->status / 100 == 2)
        return EXIT_DONE;
    problem_print(stderr, reply->status, reply->body, reply->length);
    return EXIT_REFUSED;
}
