/* SPDX-License-Identifier: Apache-2.0 */
#include "folder.h"

#include "base/protocol.h"

#include <errno.h>
#include <fcntl.h>
#include <fts.h>
#include <ftw.h>
#include <linux/openat2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static enum talus_status folder_error(struct talus_error *error, const char *action,
                                      const char *path)
{
    return talus_error_set(error, TALUS_IO, "io", "", "cannot %s %s: %s", action, path,
                           strerror(errno));
}

char *folder_join(const char *folder, const char *name)
{
    char *path = NULL;
    return asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : path;
}

enum talus_status folder_make(const char *path, struct talus_error *error)
{
    char *copy = strdup(path);
    if (copy == NULL)
        return talus_error_memory(error);
    enum talus_status status = TALUS_OK;
    for (char *slash = strchr(copy + 1, '/'); status == TALUS_OK; slash = strchr(slash + 1, '/')) {
        if (slash != NULL)
            *slash = '\0';
        if (mkdir(copy, 0750) != 0 && errno != EEXIST)
            status = folder_error(error, "make", copy);
        if (slash == NULL)
            break;
        *slash = '/';
    }
    free(copy);
    return status;
}

enum talus_status folder_sync(const char *path, struct talus_error *error)
{
    int descriptor = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return folder_error(error, "open", path);
    enum talus_status status =
        fsync(descriptor) == 0 ? TALUS_OK : folder_error(error, "flush", path);
    (void)close(descriptor);
    return status;
}

static enum talus_status write_all(int descriptor, const char *data, size_t length,
                                   const char *path, struct talus_error *error)
{
    while (length > 0) {
        ssize_t written = write(descriptor, data, length);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return folder_error(error, "write", path);
        data += written;
        length -= (size_t)written;
    }
    return fsync(descriptor) == 0 ? TALUS_OK : folder_error(error, "flush", path);
}

enum talus_status folder_write(const char *folder, const char *name, const char *data,
                               size_t length, struct talus_error *error)
{
    char *path = folder_join(folder, name);
    if (path == NULL)
        return talus_error_memory(error);
    int descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0640);
    enum talus_status status = descriptor < 0 ? folder_error(error, "make", path)
                                              : write_all(descriptor, data, length, path, error);
    if (descriptor >= 0 && close(descriptor) != 0 && status == TALUS_OK)
        status = folder_error(error, "close", path);
    free(path);
    return status;
}

enum talus_status folder_replace(const char *folder, const char *name, const char *data,
                                 size_t length, struct talus_error *error)
{
    char *aside_name = NULL, *path = folder_join(folder, name), *aside = NULL;
    if (asprintf(&aside_name, ".%s.tmp", name) >= 0)
        aside = folder_join(folder, aside_name);
    enum talus_status status = path == NULL || aside == NULL ? talus_error_memory(error) : TALUS_OK;
    if (aside != NULL && status == TALUS_OK && unlink(aside) != 0 && errno != ENOENT)
        status = folder_error(error, "remove", aside);
    if (status == TALUS_OK)
        status = folder_write(folder, aside_name, data, length, error);
    if (status == TALUS_OK && rename(aside, path) != 0)
        status = folder_error(error, "replace", path);
    if (status == TALUS_OK)
        status = folder_sync(folder, error);
    free(aside_name);
    free(aside);
    free(path);
    return status;
}

static int remove_entry(const char *path, const struct stat *information, int kind,
                        struct FTW *position)
{
    (void)information;
    (void)kind;
    (void)position;
    return remove(path) == 0 || errno == ENOENT ? 0 : -1;
}

enum talus_status folder_remove(const char *path, struct talus_error *error)
{
    /* A helper or a worker that is just ending may put another file there meanwhile. */
    enum { ATTEMPTS = 100 };
    const struct timespec pause = {.tv_nsec = 10 * 1000 * 1000};
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS) == 0 || errno == ENOENT)
            return TALUS_OK;
        if (errno != ENOTEMPTY && errno != EEXIST)
            break;
        (void)nanosleep(&pause, NULL);
    }
    return folder_error(error, "remove", path);
}

static bool component_public(const char *component, size_t length)
{
    static const char *const unfinished[] = {".tmp", ".part"};
    if (length == 0 || component[0] == '.')
        return false;
    for (size_t index = 0; index < length; index++) {
        if ((unsigned char)component[index] < 0x20 || component[index] == 0x7f)
            return false;
    }
    for (size_t index = 0; index < sizeof unfinished / sizeof unfinished[0]; index++) {
        size_t suffix = strlen(unfinished[index]);
        if (length >= suffix && memcmp(component + length - suffix, unfinished[index], suffix) == 0)
            return false;
    }
    return true;
}

bool folder_name_public(const char *name)
{
    if (strcmp(name, PROTOCOL_LOCK_FILE) == 0 || strcmp(name, PROTOCOL_CONTROL_FILE) == 0)
        return false;
    for (;;) {
        size_t length = strcspn(name, "/");
        if (!component_public(name, length))
            return false;
        if (name[length] == '\0')
            return true;
        name += length + 1;
    }
}

int folder_open(const char *folder, const char *name)
{
    int directory = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0)
        return -1;
    struct open_how how = {
        .flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK,
        .resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS,
    };
    int descriptor = (int)syscall(SYS_openat2, directory, name, &how, sizeof how);
    (void)close(directory);
    if (descriptor < 0)
        return -1;
    struct stat information;
    if (fstat(descriptor, &information) != 0 || !S_ISREG(information.st_mode)) {
        (void)close(descriptor);
        return -1;
    }
    return descriptor;
}

static int entry_compare(const FTSENT **left, const FTSENT **right)
{
    return strcmp((*left)->fts_name, (*right)->fts_name);
}

void folder_list(const char *folder, bool (*visit)(const char *name, void *context), void *context)
{
    size_t prefix = strlen(folder) + 1;
    char *root = strdup(folder);
    char *roots[] = {root, NULL};
    FTS *walk = root == NULL ? NULL : fts_open(roots, FTS_PHYSICAL | FTS_NOCHDIR, entry_compare);
    FTSENT *entry;
    while (walk != NULL && (entry = fts_read(walk)) != NULL) {
        if (entry->fts_info == FTS_D && entry->fts_level > 0 && entry->fts_name[0] == '.')
            (void)fts_set(walk, entry, FTS_SKIP);
        if (entry->fts_info == FTS_F && entry->fts_pathlen > prefix &&
            folder_name_public(entry->fts_path + prefix) &&
            !visit(entry->fts_path + prefix, context))
            break;
    }
    if (walk != NULL)
        (void)fts_close(walk);
    free(root);
}

double folder_free_bytes(const char *path)
{
    struct statvfs disk;
    return statvfs(path, &disk) == 0 ? (double)disk.f_bavail * (double)disk.f_frsize : -1;
}

int64_t folder_size(const char *path)
{
    char *root = strdup(path);
    char *roots[] = {root, NULL};
    FTS *walk = root == NULL ? NULL : fts_open(roots, FTS_PHYSICAL | FTS_NOCHDIR, NULL);
    FTSENT *entry;
    int64_t size = 0;
    while (walk != NULL && (entry = fts_read(walk)) != NULL) {
        if (entry->fts_info == FTS_F)
            size += (int64_t)entry->fts_statp->st_size;
    }
    if (walk != NULL)
        (void)fts_close(walk);
    free(root);
    return size;
}
