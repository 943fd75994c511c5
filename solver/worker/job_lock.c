/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/job_lock.h"

#include "base/protocol.h"
#include "output/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* The descriptor named by the environment, if it is this folder's lock file; -1 otherwise. */
static int inherited_descriptor(const char *path)
{
    const char *text = getenv(PROTOCOL_LOCK_ENVIRONMENT);
    struct stat inherited, expected;
    char *end = NULL;
    if (text == NULL || *text == '\0')
        return -1;
    long number = strtol(text, &end, 10);
    if (*end != '\0' || number < 0 || number > 1 << 20)
        return -1;
    int descriptor = (int)number;
    if (fstat(descriptor, &inherited) != 0 || stat(path, &expected) != 0 ||
        inherited.st_dev != expected.st_dev || inherited.st_ino != expected.st_ino)
        return -1;
    return descriptor;
}

enum talus_status job_lock_take(struct job_lock *lock, const char *folder,
                                struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    lock->descriptor = -1;
    enum talus_status status = file_path(path, folder, PROTOCOL_LOCK_FILE, error);
    if (status != TALUS_OK)
        return status;
    lock->descriptor = inherited_descriptor(path);
    lock->inherited = lock->descriptor >= 0;
    if (!lock->inherited)
        lock->descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock->descriptor < 0)
        return file_error(error, errno, "open", path);
    /* On an inherited lock this changes nothing: it belongs to the open file description. */
    if (flock(lock->descriptor, LOCK_EX | LOCK_NB) != 0) {
        int number = errno;
        job_lock_release(lock);
        if (number == EWOULDBLOCK)
            return talus_error_set(error, TALUS_IO, "locked", "",
                                   "another run holds %s: wait for it, or choose another --out",
                                   folder);
        return file_error(error, number, "lock", path);
    }
    if (lock->inherited && fcntl(lock->descriptor, F_SETFD, FD_CLOEXEC) != 0)
        return file_error(error, errno, "keep", path);
    return TALUS_OK;
}

void job_lock_release(struct job_lock *lock)
{
    if (lock->descriptor >= 0)
        (void)close(lock->descriptor);
    lock->descriptor = -1;
}
