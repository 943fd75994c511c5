/* SPDX-License-Identifier: Apache-2.0 */
#include "talus/version.h"
#include "worker/command.h"

#include <stdio.h>

int command_version(int argument_count, char **arguments)
{
    (void)argument_count;
    (void)arguments;
    return printf("%s\n", talus_build()) < 0;
}
