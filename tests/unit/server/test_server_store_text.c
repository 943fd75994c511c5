/* SPDX-License-Identifier: Apache-2.0 */
/* Lists by a part of the name hold what a look at every name holds, page by page and newest first,
 * after changes and removals too. */
#include "server_fixture.h"

#include "folder.h"
#include "identifier.h"
#include "store.h"
#include "store_internal.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { JOB_COUNT = 400, PAGE = 7 };

struct known {
    char id[IDENTIFIER_LENGTH + 1], name[64];
    bool gone;
};

static const char *const words[] = {"column", "Column", "at rest", "\"", "%", "_", "ä", "Ä",
                                    "ß",      "山",     "*",       "'",  "c", "-", ""};
enum { WORD_COUNT = sizeof words / sizeof words[0] };

static uint32_t draw(uint32_t *seed)
{
    *seed = *seed * 1664525U + 1013904223U;
    return *seed >> 16;
}

static void name_make(char name[64], uint32_t *seed)
{
    name[0] = '\0';
    for (uint32_t count = draw(seed) % 5; count > 0; count--)
        (void)strcat(name, words[draw(seed) % WORD_COUNT]);
}

static bool contains(const char *name, const char *text)
{
    for (;; name++) {
        size_t index = 0;
        while (text[index] != '\0' &&
               tolower((unsigned char)name[index]) == tolower((unsigned char)text[index]))
            index++;
        if (text[index] == '\0')
            return true;
        if (*name == '\0')
            return false;
    }
}

struct page {
    char ids[PAGE][IDENTIFIER_LENGTH + 1];
    size_t count;
};

static bool page_add(const struct job *job, void *context)
{
    struct page *page = context;
    (void)snprintf(page->ids[page->count++], sizeof page->ids[0], "%s", job->id);
    return true;
}

/* All pages of a text; `known` is oldest first. */
static void pages_check(struct store *store, const struct known *known, const char *text)
{
    struct talus_error error = {0};
    struct store_filter filter = {.state = JOB_STATE_COUNT, .text = text, .limit = PAGE};
    struct page page = {.count = 0};
    char before[IDENTIFIER_LENGTH + 1];
    size_t place = 0;
    for (size_t index = JOB_COUNT; index-- > 0;) {
        if (known[index].gone || !contains(known[index].name, text))
            continue;
        if (place == page.count) {
            page.count = place = 0;
            assert_int_equal(store_job_list(store, &filter, page_add, &page, &error), TALUS_OK);
            assert_true(page.count > 0);
        }
        assert_string_equal(page.ids[place++], known[index].id);
        (void)snprintf(before, sizeof before, "%s", known[index].id);
        filter.before = before;
    }
    assert_int_equal(place, page.count);
    page.count = 0;
    assert_int_equal(store_job_list(store, &filter, page_add, &page, &error), TALUS_OK);
    assert_int_equal(page.count, 0);
}

static void texts_check(struct store *store, const struct known *known, uint32_t *seed)
{
    char text[64];
    for (size_t index = 0; index < WORD_COUNT; index++)
        pages_check(store, known, words[index]);
    for (int count = 0; count < 40; count++) {
        name_make(text, seed);
        pages_check(store, known, text);
    }
}

static enum talus_status rename_to(struct job *job, void *context, struct talus_error *error)
{
    return job_text_set(&job->name, context, error);
}

/* `order`: in which the jobs of `known` are inserted. */
static void insert_all(struct store *store, const struct known *known, int step)
{
    struct talus_error error = {0};
    enum store_insert result;
    char existing[64];
    for (int count = 0; count < JOB_COUNT; count++) {
        const struct known *one = &known[count * step % JOB_COUNT];
        struct job job = fixture_job(one->id);
        assert_int_equal(job_text_set(&job.name, one->name, &error), TALUS_OK);
        assert_int_equal(store_job_insert(store, &job, NULL, NULL, &result, existing, &error),
                         TALUS_OK);
        job_release(&job);
    }
}

static void store_change_all(struct store *store, struct known *known, uint32_t *seed)
{
    struct talus_error error = {0};
    for (int index = 0; index < JOB_COUNT; index += 3) {
        if (index % 2 == 0) {
            assert_int_equal(store_job_remove(store, known[index].id, &error), TALUS_OK);
            known[index].gone = true;
        } else {
            name_make(known[index].name, seed);
            assert_int_equal(store_job_change(store, known[index].id, rename_to, known[index].name,
                                              NULL, &error),
                             TALUS_OK);
        }
    }
}

/* Takes the tables of names away, as a database of an older daemon lacks them. */
static void names_drop(const char *path)
{
    sqlite3 *database = NULL;
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    assert_true(store_execute(database, "DROP TRIGGER job_names_of_new;"
                                        "DROP TRIGGER job_names_of_changed;"
                                        "DROP VIEW job_names_entrance;DROP TABLE job_names;"
                                        "DROP TABLE job_name_parts;"));
    assert_int_equal(sqlite3_close(database), SQLITE_OK);
}

static void test_lists_by_text(void **state)
{
    struct talus_error error = {0};
    struct identifier_source source;
    struct store *store = NULL;
    struct known *known = calloc(JOB_COUNT, sizeof *known);
    char *folder = fixture_folder(), *path = folder_join(folder, "store");
    uint32_t seed = 7;
    (void)state;
    assert_int_equal(identifier_source_init(&source, &error), TALUS_OK);
    for (int index = 0; index < JOB_COUNT; index++) {
        assert_int_equal(identifier_next(&source, known[index].id, &error), TALUS_OK);
        name_make(known[index].name, &seed);
    }
    identifier_source_release(&source);
    assert_int_equal(store_open(path, &store, &error), TALUS_OK);
    insert_all(store, known, 7); /* hardly in the order of their identifiers */
    texts_check(store, known, &seed);
    store_change_all(store, known, &seed);
    texts_check(store, known, &seed);
    assert_true(store_execute(store->writer, "INSERT INTO job_name_parts (job_name_parts)"
                                             " VALUES ('integrity-check')"));
    store_close(store);
    names_drop(path);
    assert_int_equal(store_open(path, &store, &error), TALUS_OK);
    texts_check(store, known, &seed);
    store_close(store);
    free(path);
    free(known);
    fixture_folder_remove(folder);
}

/* Identifiers that two machines made in one millisecond may ask for one number. */
static void test_numbers_that_are_taken(void **state)
{
    static const char *const ids[] = {"01m817k35wqk69zp9g1vc1hvc8", "01m817k35wak69zp9g1vc1hvc8",
                                      "01m817k35wzk69zp9g1vc1hvc9", "01m817k35wbk69zp9g1vc1hvc8"};
    struct talus_error error = {0};
    struct store *store = NULL;
    struct page page = {.count = 0};
    enum store_insert result;
    char existing[64], *folder = fixture_folder(), *path = folder_join(folder, "store");
    const struct store_filter filter = {.state = JOB_STATE_COUNT, .text = "one"};
    (void)state;
    assert_int_equal(store_open(path, &store, &error), TALUS_OK);
    for (size_t index = 0; index < 4; index++) {
        struct job job = fixture_job(ids[index]);
        assert_int_equal(job_text_set(&job.name, "of one name", &error), TALUS_OK);
        assert_int_equal(store_job_insert(store, &job, NULL, NULL, &result, existing, &error),
                         TALUS_OK);
        job_release(&job);
    }
    assert_int_equal(store_job_list(store, &filter, page_add, &page, &error), TALUS_OK);
    assert_int_equal(page.count, 4);
    store_close(store);
    free(path);
    fixture_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lists_by_text),
                                       cmocka_unit_test(test_numbers_that_are_taken)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
