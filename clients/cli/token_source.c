/* SPDX-License-Identifier: Apache-2.0 */
#include "token_source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The first line of a file. Prints what is wrong. */
static bool file_read(const char *path, char token[TOKEN_SOURCE_SIZE])
{
    struct stat information;
    FILE *stream = fopen(path, "re");
    bool good = stream != NULL && fgets(token, TOKEN_SOURCE_SIZE, stream) != NULL;
    if (!good)
        (void)fprintf(stderr, "talus: cannot read a token from %s\n", path);
    else if (fstat(fileno(stream), &information) == 0 && (information.st_mode & S_IROTH) != 0)
        (void)fprintf(stderr, "talus: warning: everyone can read the token in %s (chmod 600)\n",
                      path);
    if (stream != NULL)
        (void)fclose(stream);
    return good;
}

bool token_source_read(const char *path, char token[TOKEN_SOURCE_SIZE])
{
    const char *variable = getenv("TALUS_TOKEN");
    token[0] = '\0';
    if (path == NULL && variable != NULL)
        (void)snprintf(token, TOKEN_SOURCE_SIZE, "%s", variable);
    else if (path != NULL && !file_read(path, token))
        return false;
    size_t length = strcspn(token, "\r\n");
    bool whole = length + 2 <= TOKEN_SOURCE_SIZE;
    if (path != NULL)
        token[length] = '\0';
    if (whole && (path == NULL || length > 0) && strpbrk(token, " \t\r\n") == NULL)
        return true;
    (void)fprintf(stderr, "talus: what %s holds is not a token\n",
                  path == NULL ? "$TALUS_TOKEN" : path);
    return false;
}
