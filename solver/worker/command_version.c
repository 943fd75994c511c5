/* SPDX-License-Identifier: Apache-2.0 */
#include "talus/simulation.h"
#include "talus/version.h"
#include "worker/command.h"

#include <stdio.h>

int command_version(int argument_count, char **arguments)
{
    (void)argument_count;
    (void)arguments;
    return printf("%s %s\n", talus_build(), talus_simulation_isa()) < 0;
}
