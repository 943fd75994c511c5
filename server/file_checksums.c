/* SPDX-License-Identifier: Apache-2.0 */
#include "file_checksums.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { SLOT_COUNT = 4096 };

/* What a file was when its checksum was taken. */
struct slot {
    dev_t device;
    ino_t inode;
    off_t size;
    struct timespec modified;
    char checksum[CHECKSUM_SIZE];
};

struct file_checksums {
    pthread_mutex_t mutex;
    struct slot slots[SLOT_COUNT];
};

enum talus_status file_checksums_create(struct file_checksums **result, struct talus_error *error)
{
    *result = calloc(1, sizeof **result);
    if (*result == NULL)
        return talus_error_memory(error);
    (void)pthread_mutex_init(&(*result)->mutex, NULL);
    return TALUS_OK;
}

void file_checksums_destroy(struct file_checksums *checksums)
{
    if (checksums == NULL)
        return;
    (void)pthread_mutex_destroy(&checksums->mutex);
    free(checksums);
}

static bool slot_matches(const struct slot *slot, const struct stat *file)
{
    return slot->checksum[0] != '\0' && slot->device == file->st_dev &&
           slot->inode == file->st_ino && slot->size == file->st_size &&
           slot->modified.tv_sec == file->st_mtim.tv_sec &&
           slot->modified.tv_nsec == file->st_mtim.tv_nsec;
}

enum talus_status file_checksum(struct file_checksums *checksums, int descriptor,
                                char checksum[CHECKSUM_SIZE], struct talus_error *error)
{
    struct stat file;
    if (fstat(descriptor, &file) != 0)
        return talus_error_set(error, TALUS_IO, "io", "", "a file cannot be read");
    struct slot *slot = &checksums->slots[(size_t)file.st_ino % SLOT_COUNT];
    (void)pthread_mutex_lock(&checksums->mutex);
    bool known = slot_matches(slot, &file);
    if (known)
        memcpy(checksum, slot->checksum, CHECKSUM_SIZE);
    (void)pthread_mutex_unlock(&checksums->mutex);
    if (known)
        return TALUS_OK;
    enum talus_status status = checksum_descriptor(descriptor, checksum, error);
    if (status != TALUS_OK)
        return status;
    (void)pthread_mutex_lock(&checksums->mutex);
    slot->device = file.st_dev;
    slot->inode = file.st_ino;
    slot->size = file.st_size;
    slot->modified = file.st_mtim;
    memcpy(slot->checksum, checksum, CHECKSUM_SIZE);
    (void)pthread_mutex_unlock(&checksums->mutex);
    return TALUS_OK;
}
