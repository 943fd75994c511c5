/* SPDX-License-Identifier: Apache-2.0 */
#include "token_file.h"

#include <errno.h>
#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILE_BYTES_MAX = 256 << 10 };

#define ALPHANUMERIC "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
static const char name_characters[] = ALPHANUMERIC "._@-";
static const char token_characters[] = ALPHANUMERIC "-._~+/=";
static const char white_space[] = " \t\r";

static const struct {
    const char *name;
    enum role role;
} roles[] = {{"read", ROLE_READ}, {"submit", ROLE_SUBMIT}, {"admin", ROLE_ADMIN}};

bool token_digest(const char *token, unsigned char digest[TOKEN_DIGEST_SIZE])
{
    unsigned int length = 0;
    size_t size = strlen(token);
    return size > 0 && size <= TOKEN_LENGTH_MAX && strspn(token, token_characters) == size &&
           EVP_Digest(token, size, digest, &length, EVP_sha256(), NULL) == 1 &&
           length == TOKEN_DIGEST_SIZE;
}

/* Cuts white space off both ends. */
static char *trim(char *text)
{
    text += strspn(text, white_space);
    for (size_t end = strlen(text); end > 0 && strchr(white_space, text[end - 1]) != NULL; end--)
        text[end - 1] = '\0';
    return text;
}

static bool digest_read(const char *text, unsigned char digest[TOKEN_DIGEST_SIZE])
{
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    for (size_t index = 0; index < (size_t)2 * TOKEN_DIGEST_SIZE; index++) {
        const char *digit = text[index] == '\0' ? NULL : strchr(digits, text[index]);
        if (digit == NULL)
            return false;
        unsigned int value = (unsigned int)(digit - digits) % 16;
        digest[index / 2] =
            (unsigned char)(index % 2 == 0 ? 16 * value : digest[index / 2] + value);
    }
    return text[2 * TOKEN_DIGEST_SIZE] == '\0';
}

/* What `sha256sum </dev/null` prints: a script has lost its token. */
static bool digest_is_of_nothing(const unsigned char digest[TOKEN_DIGEST_SIZE])
{
    unsigned char nothing[TOKEN_DIGEST_SIZE];
    return EVP_Digest("", 0, nothing, NULL, EVP_sha256(), NULL) == 1 &&
           memcmp(nothing, digest, sizeof nothing) == 0;
}

/* Reads the three parts of a line. Returns NULL or what is wrong; never with a part in the text: a
 * token may stand where it should not. */
static const char *line_read(char *line, struct token *token)
{
    char *name = line, *role = strchr(line, ':');
    char *digest = role == NULL ? NULL : strchr(role + 1, ':');
    if (digest == NULL || strchr(digest + 1, ':') != NULL)
        return "NAME:ROLE:SHA256 is wanted";
    *role++ = '\0';
    *digest++ = '\0';
    name = trim(name);
    size_t length = strlen(name), index = 0;
    if (length == 0 || length >= sizeof token->principal.name ||
        strspn(name, name_characters) != length)
        return "a name has 1 to 63 letters, digits, dots, underscores, hyphens and at signs";
    if (strcmp(name, "local") == 0)
        return "the name local stands for users without a token";
    memcpy(token->principal.name, name, length + 1);
    role = trim(role);
    while (index < sizeof roles / sizeof roles[0] && strcmp(roles[index].name, role) != 0)
        index++;
    if (index == sizeof roles / sizeof roles[0])
        return "the roles are read, submit and admin";
    token->principal.role = roles[index].role;
    if (!digest_read(trim(digest), token->digest))
        return "the SHA-256 of a token has 64 hexadecimal digits (the token itself does not belong "
               "here)";
    return digest_is_of_nothing(token->digest) ? "this is the SHA-256 of an empty token" : NULL;
}

/* Adds the token of a line, or a mistake. */
static void line_add(struct token_set *set, char *line, size_t number, struct text *mistakes)
{
    struct token token = {0};
    const char *mistake = line_read(line, &token);
    for (size_t index = 0; index < set->count && mistake == NULL; index++) {
        if (strcmp(set->tokens[index].principal.name, token.principal.name) == 0)
            mistake = "a line above has the same name";
        else if (memcmp(set->tokens[index].digest, token.digest, sizeof token.digest) == 0)
            mistake = "a line above has the same token";
    }
    if (mistake == NULL)
        set->tokens[set->count++] = token;
    else
        text_print(mistakes, "line %zu: %s\n", number, mistake);
}

enum talus_status token_set_parse(struct token_set *set, char *content, struct text *mistakes,
                                  struct talus_error *error)
{
    size_t line_count = 1, number = 0, before = mistakes->length;
    for (const char *end = content; (end = strchr(end, '\n')) != NULL; end++)
        line_count++;
    set->tokens = calloc(line_count, sizeof *set->tokens);
    set->count = 0;
    if (set->tokens == NULL)
        return talus_error_memory(error);
    for (char *line = content; line != NULL;) {
        char *next = strchr(line, '\n');
        if (next != NULL)
            *next++ = '\0';
        line = trim(line);
        number++;
        if (line[0] != '\0' && line[0] != '#')
            line_add(set, line, number, mistakes);
        line = next;
    }
    if (set->count == 0 && mistakes->length == before)
        text_add_string(mistakes, "there is no token in it\n");
    if (mistakes->length == before && !mistakes->failed)
        return TALUS_OK;
    token_set_release(set);
    return talus_error_set(error, TALUS_INVALID, "tokens", "", "the token file has mistakes");
}

static enum talus_status file_error(const char *path, const char *what, struct talus_error *error)
{
    return talus_error_set(error, TALUS_IO, "tokens", "", "token file %s: %s", path, what);
}

/* Reads a whole file that may not have more than FILE_BYTES_MAX bytes, with a NUL behind it. */
static enum talus_status content_read(int descriptor, char *content, const char *path,
                                      struct talus_error *error)
{
    size_t length = 0;
    while (length <= FILE_BYTES_MAX) {
        ssize_t got = read(descriptor, content + length, FILE_BYTES_MAX + 1 - length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return file_error(path, strerror(errno), error);
        if (got == 0)
            break;
        length += (size_t)got;
    }
    if (length > FILE_BYTES_MAX)
        return file_error(path, "it has more than 256 KiB", error);
    content[length] = '\0';
    return strlen(content) == length ? TALUS_OK : file_error(path, "it is not a text", error);
}

/* Opens the file, judges it and reads it. */
static enum talus_status file_read(const char *path, char *content, bool *exposed,
                                   struct talus_error *error)
{
    struct stat information = {0};
    enum talus_status status;
    /* Not to hang on a pipe. */
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0 || fstat(descriptor, &information) != 0)
        status = file_error(path, strerror(errno), error);
    else if (!S_ISREG(information.st_mode))
        status = file_error(path, "it is not a regular file", error);
    else if ((information.st_mode & S_IWOTH) != 0)
        status = file_error(path, "everyone can write it (chmod o-w)", error);
    else
        status = content_read(descriptor, content, path, error);
    *exposed = (information.st_mode & S_IROTH) != 0;
    if (descriptor >= 0)
        (void)close(descriptor);
    return status;
}

enum talus_status token_set_read(struct token_set *set, const char *path, bool *exposed,
                                 struct text *mistakes, struct talus_error *error)
{
    char *content = malloc(FILE_BYTES_MAX + 2);
    if (content == NULL)
        return talus_error_memory(error);
    enum talus_status status = file_read(path, content, exposed, error);
    if (status == TALUS_OK)
        status = token_set_parse(set, content, mistakes, error);
    free(content);
    return status;
}

const struct token *token_set_find(const struct token_set *set,
                                   const unsigned char digest[TOKEN_DIGEST_SIZE])
{
    const struct token *found = NULL;
    for (size_t index = 0; index < set->count; index++) {
        bool same = CRYPTO_memcmp(set->tokens[index].digest, digest, TOKEN_DIGEST_SIZE) == 0;
        found = same ? &set->tokens[index] : found;
    }
    return found;
}

void token_set_release(struct token_set *set)
{
    if (set->tokens != NULL)
        OPENSSL_cleanse(set->tokens, set->count * sizeof *set->tokens);
    free(set->tokens);
    *set = (struct token_set){0};
}
