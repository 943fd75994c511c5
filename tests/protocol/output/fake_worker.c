/* SPDX-License-Identifier: Apache-2.0 */
/* `talus-worker run` around the doubles of scene and simulation. */
#include "worker/command.h"

int main(int argument_count, char **arguments)
{
    /* As talus-worker does for its sub-commands. */
    return argument_count < 2 ? 1 : command_run(argument_count - 1, arguments + 1);
}
