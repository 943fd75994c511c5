/* SPDX-License-Identifier: Apache-2.0 */
/* The token file: what it takes, what it refuses, and that a broken one changes nothing. */
#include "server_fixture.h"

#include "folder.h"
#include "tokens.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* printf %s abc | sha256sum, and of "b" and "c" */
#define ABC "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
#define B "3e23e8160039594a33894f6564e1b1348bbd7a0088d42c4acb73eeaed59c009d"
#define C "2e7d2c03a9507ae265ecf5b5356885a53393a2029d241394997265a1a25aefc6"

static enum talus_status parse(const char *content, struct token_set *set, struct text *mistakes)
{
    struct talus_error error = {0};
    char *copy = strdup(content);
    assert_non_null(copy);
    *set = (struct token_set){0};
    enum talus_status status = token_set_parse(set, copy, mistakes, &error);
    free(copy);
    return status;
}

static void test_good_file(void **state)
{
    struct token_set set;
    struct text mistakes = {0};
    unsigned char digest[TOKEN_DIGEST_SIZE];
    (void)state;
    assert_int_equal(parse("# who may do what\n\nalice:admin:" ABC "\r\n"
                           "  ci@build-2.x : submit : 3E23E8160039594A33894F6564E1B1348BBD7A0088D4"
                           "2C4ACB73EEAED59C009D \n\t# indented\nviewer_1:read:" C,
                           &set, &mistakes),
                     TALUS_OK);
    assert_int_equal(mistakes.length, 0);
    assert_int_equal(set.count, 3);
    assert_string_equal(set.tokens[1].principal.name, "ci@build-2.x");
    assert_true(token_digest("abc", digest));
    assert_int_equal(token_set_find(&set, digest)->principal.role, ROLE_ADMIN);
    assert_true(token_digest("b", digest));
    assert_int_equal(token_set_find(&set, digest)->principal.role, ROLE_SUBMIT);
    assert_true(token_digest("c", digest));
    assert_string_equal(token_set_find(&set, digest)->principal.name, "viewer_1");
    digest[TOKEN_DIGEST_SIZE - 1] ^= 1;
    assert_null(token_set_find(&set, digest));
    token_set_release(&set);
    assert_null(token_set_find(&set, digest));
}

static void test_every_mistake_has_its_line(void **state)
{
    static const char *const bad[] = {
        "alice",
        "alice:admin",
        "alice:admin:" ABC ":more",
        ":admin:" ABC,
        "local:admin:" ABC,
        "al ice:admin:" ABC,
        "al\xc3\xaf"
        "ce:admin:" ABC,
        "a123456789a123456789a123456789a123456789a123456789a123456789a123:read:" ABC,
        "alice:root:" ABC,
        "alice:Admin:" ABC,
        "alice::" ABC,
        "alice:admin:",
        "alice:admin:geheim",
        "alice:admin:" ABC "0",
        "alice:admin:" ABC "  -",
        "alice:admin:ga7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
        "alice:admin:e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
    };
    struct text all = {0}, mistakes = {0};
    struct token_set set;
    (void)state;
    text_add_string(&all, "good:read:" B "\n");
    for (size_t index = 0; index < sizeof bad / sizeof bad[0]; index++) {
        mistakes.length = 0;
        if (parse(bad[index], &set, &mistakes) != TALUS_INVALID)
            fail_msg("accepted: %s", bad[index]);
        assert_int_equal(set.count, 0);
        assert_int_equal(strncmp(mistakes.data, "line 1: ", 8), 0);
        text_print(&all, "%s\n", bad[index]);
    }
    mistakes.length = 0;
    assert_int_equal(parse(all.data, &set, &mistakes), TALUS_INVALID);
    for (size_t index = 0; index < sizeof bad / sizeof bad[0]; index++) {
        char start[32];
        (void)snprintf(start, sizeof start, "line %zu: ", index + 2);
        assert_non_null(strstr(mistakes.data, start));
    }
    assert_null(strstr(mistakes.data, "line 1:"));
    assert_null(strstr(mistakes.data, "geheim"));
    text_release(&all);
    text_release(&mistakes);
}

static void test_duplicates_and_nothing(void **state)
{
    struct text mistakes = {0};
    struct token_set set;
    (void)state;
    assert_int_equal(parse("a:read:" ABC "\n\na:admin:" B "\n", &set, &mistakes), TALUS_INVALID);
    assert_string_equal(mistakes.data, "line 3: a line above has the same name\n");
    mistakes.length = 0;
    assert_int_equal(parse("a:read:" ABC "\nb:admin:" ABC "\n", &set, &mistakes), TALUS_INVALID);
    assert_string_equal(mistakes.data, "line 2: a line above has the same token\n");
    mistakes.length = 0;
    assert_int_equal(parse("# none\n", &set, &mistakes), TALUS_INVALID);
    assert_string_equal(mistakes.data, "there is no token in it\n");
    text_release(&mistakes);
}

static void test_digest(void **state)
{
    char long_token[TOKEN_LENGTH_MAX + 2];
    unsigned char digest[TOKEN_DIGEST_SIZE];
    (void)state;
    memset(long_token, 'x', sizeof long_token - 1);
    long_token[sizeof long_token - 1] = '\0';
    assert_false(token_digest(long_token, digest));
    assert_true(token_digest(long_token + 1, digest));
    assert_false(token_digest("", digest));
    assert_false(token_digest("a b", digest));
    assert_false(token_digest("a,b", digest));
    assert_true(token_digest("aZ9-._~+/=", digest));
}

/* A token file in a folder of its own. */
struct file {
    char *folder, *path;
};

static void file_set(const struct file *file, const char *content, mode_t mode)
{
    fixture_write(file->folder, "tokens", content, strlen(content), 0);
    assert_int_equal(chmod(file->path, mode), 0);
}

static void test_files(void **state)
{
    struct file file = {.folder = fixture_folder()};
    struct talus_error error = {0};
    struct tokens *tokens = NULL;
    (void)state;
    file.path = folder_join(file.folder, "tokens");
    assert_int_equal(tokens_create(&tokens, file.path, &error), TALUS_IO);
    assert_null(tokens);
    assert_non_null(strstr(error.text, file.path));
    file_set(&file, "a:admin:" ABC "\n", 0646);
    assert_int_equal(tokens_create(&tokens, file.path, &error), TALUS_IO);
    file_set(&file, "a:admin\n", 0600);
    assert_int_equal(tokens_create(&tokens, file.path, &error), TALUS_INVALID);
    fixture_write(file.folder, "tokens", "a\0b", 3, 0);
    assert_int_equal(tokens_create(&tokens, file.path, &error), TALUS_IO);
    assert_int_equal(tokens_create(&tokens, file.folder, &error), TALUS_IO);
    size_t size = (256 << 10) + 1;
    char *blank = malloc(size);
    assert_non_null(blank);
    memset(blank, '\n', size);
    fixture_write(file.folder, "tokens", blank, size, 0);
    free(blank);
    assert_int_equal(tokens_create(&tokens, file.path, &error), TALUS_IO);
    assert_int_equal(tokens_create(&tokens, NULL, &error), TALUS_OK);
    assert_false(tokens_configured(tokens));
    assert_int_equal(tokens_reload(tokens, &error), TALUS_OK);
    tokens_destroy(tokens);
    free(file.path);
    fixture_folder_remove(file.folder);
}

/* Reads tokens while others are read from the file. */
struct reader {
    struct tokens *tokens;
    atomic_bool stop;
    atomic_int found, wrong;
};

static void *reader_main(void *argument)
{
    struct reader *reader = argument;
    struct principal principal;
    unsigned char always[TOKEN_DIGEST_SIZE], never[TOKEN_DIGEST_SIZE];
    bool good = token_digest("abc", always) && token_digest("nobody", never);
    while (good && !atomic_load(&reader->stop)) {
        good = tokens_find(reader->tokens, always, &principal) &&
               strcmp(principal.name, "a") == 0 && principal.role == ROLE_ADMIN &&
               !tokens_find(reader->tokens, never, NULL);
        atomic_fetch_add(&reader->found, 1);
    }
    atomic_store(&reader->wrong, !good);
    return NULL;
}

static void test_reload(void **state)
{
    struct file file = {.folder = fixture_folder()};
    struct talus_error error = {0};
    struct reader reader = {0};
    unsigned char second[TOKEN_DIGEST_SIZE];
    pthread_t thread;
    (void)state;
    file.path = folder_join(file.folder, "tokens");
    assert_true(token_digest("b", second));
    file_set(&file, "a:admin:" ABC "\nb:read:" B "\n", 0600);
    assert_int_equal(tokens_create(&reader.tokens, file.path, &error), TALUS_OK);
    assert_int_equal(pthread_create(&thread, NULL, reader_main, &reader), 0);
    for (int round = 0; round < 50 || atomic_load(&reader.found) < 50; round++) {
        file_set(&file, "a:admin:" ABC "\n", 0600);
        assert_int_equal(tokens_reload(reader.tokens, &error), TALUS_OK);
        assert_false(tokens_find(reader.tokens, second, NULL));
        assert_int_equal(tokens_count(reader.tokens), 1);
        file_set(&file, "a:admin:" ABC "\nb:read:" B "\n", 0600);
        assert_int_equal(tokens_reload(reader.tokens, &error), TALUS_OK);
        assert_false(tokens_are_stale(reader.tokens));
        if (round % 25 != 0)
            continue; /* the log has room for a few mistakes */
        file_set(&file, "a:admin:" ABC "\nb\n", 0600);
        assert_int_equal(tokens_reload(reader.tokens, &error), TALUS_INVALID);
        assert_true(tokens_are_stale(reader.tokens));
        assert_true(tokens_find(reader.tokens, second, NULL));
    }
    atomic_store(&reader.stop, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_false(atomic_load(&reader.wrong));
    tokens_destroy(reader.tokens);
    free(file.path);
    fixture_folder_remove(file.folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good_file),
        cmocka_unit_test(test_every_mistake_has_its_line),
        cmocka_unit_test(test_duplicates_and_nothing),
        cmocka_unit_test(test_digest),
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_reload),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
