/* SPDX-License-Identifier: Apache-2.0 */
#include "wakeup.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/eventfd.h>
#include <unistd.h>

enum talus_status wakeup_create(int *descriptor, struct talus_error *error)
{
    *descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    return *descriptor >= 0
               ? TALUS_OK
               : talus_error_set(error, TALUS_INTERNAL, "eventfd", "", "cannot make an eventfd");
}

void wakeup_tell(int descriptor, const char *who)
{
    const uint64_t one = 1;
    if (write(descriptor, &one, sizeof one) < 0 && errno != EAGAIN)
        (void)fprintf(stderr, "talusd: cannot wake %s\n", who);
}

void wakeup_clear(int descriptor, const char *who)
{
    uint64_t count;
    if (read(descriptor, &count, sizeof count) < 0 && errno != EAGAIN)
        (void)fprintf(stderr, "talusd: cannot read the wake-up of %s\n", who);
}
