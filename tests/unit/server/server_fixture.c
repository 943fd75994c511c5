/* SPDX-License-Identifier: Apache-2.0 */
#include "server_fixture.h"

#include "folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *fixture_folder(void)
{
    char *folder = strdup("/tmp/talus-unit-XXXXXX");
    assert_non_null(folder);
    assert_non_null(mkdtemp(folder));
    return folder;
}

void fixture_folder_remove(char *folder)
{
    struct talus_error error = {0};
    assert_int_equal(folder_remove(folder, &error), TALUS_OK);
    free(folder);
}

void fixture_write(const char *folder, const char *name, const void *data, size_t length,
                   int append)
{
    char *path = folder_join(folder, name);
    assert_non_null(path);
    FILE *stream = fopen(path, append ? "ab" : "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(data, 1, length, stream), length);
    assert_int_equal(fclose(stream), 0);
    free(path);
}

int store_fixture_setup(void **state)
{
    struct talus_error error = {0};
    struct store_fixture *fixture = calloc(1, sizeof *fixture);
    assert_non_null(fixture);
    fixture->folder = fixture_folder();
    fixture->path = folder_join(fixture->folder, "db.sqlite");
    assert_int_equal(store_open(fixture->path, &fixture->store, &error), TALUS_OK);
    *state = fixture;
    return 0;
}

int store_fixture_teardown(void **state)
{
    struct store_fixture *fixture = *state;
    store_close(fixture->store);
    fixture_folder_remove(fixture->folder);
    free(fixture->path);
    free(fixture);
    return 0;
}

struct job fixture_job(const char *id)
{
    struct talus_error error = {0};
    struct job job = {.threads = 1, .retries = 2};
    assert_int_equal(job_text_set(&job.id, id, &error), TALUS_OK);
    assert_int_equal(job_enter(&job, &error), TALUS_OK);
    return job;
}
