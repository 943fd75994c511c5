/* SPDX-License-Identifier: Apache-2.0 */
#include "scratch_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

int scratch_folder_make(void **state)
{
    char *path = strdup("/tmp/talus-unit-XXXXXX");
    *state = path;
    return path != NULL && mkdtemp(path) != NULL ? 0 : -1;
}

/* Files of the folder; it has no folders of its own. */
int scratch_folder_remove(void **state)
{
    char *path = *state;
    DIR *directory = opendir(path);
    const struct dirent *entry;
    while (directory != NULL && (entry = readdir(directory)) != NULL)
        (void)unlinkat(dirfd(directory), entry->d_name, 0);
    if (directory != NULL)
        (void)closedir(directory);
    int result = rmdir(path);
    free(path);
    return result;
}

const char *scratch_path(char path[SCRATCH_PATH_SIZE], const char *folder, const char *name)
{
    assert_true(snprintf(path, SCRATCH_PATH_SIZE, "%s/%s", folder, name) < SCRATCH_PATH_SIZE);
    return path;
}

size_t scratch_read(const char *path, char *text, size_t size)
{
    int descriptor = open(path, O_RDONLY);
    assert_true(descriptor >= 0);
    ssize_t length = read(descriptor, text, size - 1);
    assert_true(length >= 0);
    assert_int_equal(close(descriptor), 0);
    text[length] = '\0';
    return (size_t)length;
}

void scratch_append(const char *path, const char *text)
{
    int descriptor = open(path, O_WRONLY | O_APPEND | O_CREAT, 0644);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), strlen(text));
    assert_int_equal(close(descriptor), 0);
}
