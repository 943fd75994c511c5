/* SPDX-License-Identifier: Apache-2.0 */
#include "output/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define ASIDE_SUFFIX ".part"

enum talus_status file_error(struct talus_error *error, int number, const char *action,
                             const char *path)
{
    if (number == ENOSPC || number == EDQUOT || number == EFBIG)
        return talus_error_set(error, TALUS_LIMIT, "disk_limit", "", "cannot %s %s: %s", action,
                               path, strerror(number));
    if (number == ENOMEM)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "cannot %s %s: %s", action, path,
                               strerror(number));
    return talus_error_set(error, TALUS_IO, "io", "", "cannot %s %s: %s", action, path,
                           strerror(number));
}

static enum talus_status check_length(int length, const char *path, struct talus_error *error)
{
    if (length < 0 || length >= FILE_PATH_SIZE)
        return talus_error_set(error, TALUS_IO, "path", "", "path too long: %.200s...", path);
    return TALUS_OK;
}

enum talus_status file_path(char path[FILE_PATH_SIZE], const char *folder, const char *name,
                            struct talus_error *error)
{
    return check_length(snprintf(path, FILE_PATH_SIZE, "%s/%s", folder, name), folder, error);
}

/* Length of the folder part of a path with its slash; 0 if there is none. */
static int folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash == NULL ? 0 : (int)(slash - path) + 1;
}

enum talus_status file_aside_path(char aside[FILE_PATH_SIZE], const char *path,
                                  struct talus_error *error)
{
    int prefix = folder_length(path);
    return check_length(
        snprintf(aside, FILE_PATH_SIZE, "%.*s.%s" ASIDE_SUFFIX, prefix, path, path + prefix), path,
        error);
}

static enum talus_status sync_path(const char *path, int flags, struct talus_error *error)
{
    int descriptor = open(path, flags | O_CLOEXEC);
    if (descriptor < 0)
        return file_error(error, errno, "open", path);
    enum talus_status status = TALUS_OK;
    if (fsync(descriptor) != 0)
        status = file_error(error, errno, "sync", path);
    (void)close(descriptor);
    return status;
}

enum talus_status file_publish(const char *aside, const char *path, struct talus_error *error)
{
    char folder[FILE_PATH_SIZE];
    int prefix = folder_length(path);
    enum talus_status status =
        check_length(prefix == 0 ? snprintf(folder, sizeof folder, ".")
                                 : snprintf(folder, sizeof folder, "%.*s", prefix, path),
                     path, error);
    if (status == TALUS_OK)
        status = sync_path(aside, O_RDONLY, error);
    if (status == TALUS_OK && rename(aside, path) != 0)
        status = file_error(error, errno, "rename", aside);
    if (status != TALUS_OK) {
        (void)unlink(aside);
        return status;
    }
    return sync_path(folder, O_RDONLY | O_DIRECTORY, error);
}

int file_write_all(int descriptor, const void *data, size_t length)
{
    const char *next = data;
    while (length > 0) {
        ssize_t written = write(descriptor, next, length);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return written < 0 ? errno : EIO;
        next += written;
        length -= (size_t)written;
    }
    return 0;
}

enum talus_status file_write_whole(const char *path, const void *data, size_t length,
                                   struct talus_error *error)
{
    char aside[FILE_PATH_SIZE];
    enum talus_status status = file_aside_path(aside, path, error);
    if (status != TALUS_OK)
        return status;
    int descriptor = open(aside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0)
        return file_error(error, errno, "create", aside);
    int failure = file_write_all(descriptor, data, length);
    if (close(descriptor) != 0 && failure == 0)
        failure = errno;
    if (failure != 0) {
        (void)unlink(aside);
        return file_error(error, failure, "write", path);
    }
    return file_publish(aside, path, error);
}

static enum talus_status read_descriptor(int descriptor, const char *path, char **text,
                                         size_t *length, struct talus_error *error)
{
    struct stat information;
    if (fstat(descriptor, &information) != 0)
        return file_error(error, errno, "inspect", path);
    size_t capacity = (size_t)information.st_size;
    char *buffer = malloc(capacity + 1);
    if (buffer == NULL)
        return file_error(error, ENOMEM, "read", path);
    size_t filled = 0;
    while (filled < capacity) {
        ssize_t count = read(descriptor, buffer + filled, capacity - filled);
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0) {
            free(buffer);
            return file_error(error, errno, "read", path);
        }
        if (count == 0)
            break;
        filled += (size_t)count;
    }
    buffer[filled] = '\0';
    *text = buffer;
    *length = filled;
    return TALUS_OK;
}

enum talus_status file_write_stream(const char *path,
                                    bool (*write)(FILE *stream, const void *context),
                                    const void *context, struct talus_error *error)
{
    char aside[FILE_PATH_SIZE];
    enum talus_status status = file_aside_path(aside, path, error);
    if (status != TALUS_OK)
        return status;
    FILE *stream = fopen(aside, "we");
    if (stream == NULL)
        return file_error(error, errno, "create", aside);
    if (!write(stream, context))
        status = file_error(error, errno, "write", path);
    if (fclose(stream) != 0 && status == TALUS_OK)
        status = file_error(error, errno, "write", path);
    if (status == TALUS_OK)
        return file_publish(aside, path, error);
    (void)unlink(aside);
    return status;
}

enum talus_status file_read_whole(const char *path, char **text, size_t *length,
                                  struct talus_error *error)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return file_error(error, errno, "open", path);
    enum talus_status status = read_descriptor(descriptor, path, text, length, error);
    (void)close(descriptor);
    return status;
}

enum talus_status file_make_folder(const char *path, struct talus_error *error)
{
    char partial[FILE_PATH_SIZE];
    enum talus_status status =
        check_length(snprintf(partial, sizeof partial, "%s", path), path, error);
    if (status != TALUS_OK)
        return status;
    for (char *slash = strchr(partial + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(partial, 0777) != 0 && errno != EEXIST)
            return file_error(error, errno, "make folder", partial);
        *slash = '/';
    }
    struct stat information;
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return file_error(error, errno, "make folder", path);
    if (stat(path, &information) != 0)
        return file_error(error, errno, "inspect", path);
    if (!S_ISDIR(information.st_mode))
        return file_error(error, ENOTDIR, "use", path);
    return TALUS_OK;
}

enum talus_status file_remove_some(const char *folder,
                                   bool (*goes)(const char *name, const void *context),
                                   const void *context, struct talus_error *error)
{
    DIR *directory = opendir(folder);
    if (directory == NULL)
        return errno == ENOENT ? TALUS_OK : file_error(error, errno, "list", folder);
    enum talus_status status = TALUS_OK;
    const struct dirent *entry;
    while (status == TALUS_OK && (entry = readdir(directory)) != NULL) {
        if (goes(entry->d_name, context) && unlinkat(dirfd(directory), entry->d_name, 0) != 0)
            status = file_error(error, errno, "remove", entry->d_name);
    }
    (void)closedir(directory);
    return status;
}

static bool is_aside(const char *name, const void *context)
{
    size_t length = strlen(name);
    size_t suffix = strlen(ASIDE_SUFFIX);
    (void)context;
    return name[0] == '.' && length > suffix && strcmp(name + length - suffix, ASIDE_SUFFIX) == 0;
}

enum talus_status file_remove_asides(const char *folder, struct talus_error *error)
{
    return file_remove_some(folder, is_aside, NULL, error);
}
