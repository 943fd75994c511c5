/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/precision.h"

#include "talus/simulation.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Takes "-END" off the end of a path; false if it is not there. */
static bool cut_end(char *path, const char *end)
{
    const size_t length = strlen(path), tail = strlen(end) + 1;
    if (length < tail || path[length - tail] != '-' || strcmp(path + length - tail + 1, end) != 0)
        return false;
    path[length - tail] = '\0';
    return true;
}

/* The program beside this one for the same instruction set and the wanted precision: the plain
 * program is the one for double precision and the lowest instruction set. Empty where there is no
 * /proc. */
static void other_program(enum talus_precision wanted, char program[static PATH_MAX])
{
    const char *isa = talus_simulation_isa();
    char plain[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", plain, PATH_MAX - 1);
    plain[length > 0 ? length : 0] = '\0';
    (void)cut_end(plain, isa);
    (void)cut_end(plain, "single");
    const bool single = wanted == TALUS_PRECISION_SINGLE;
    const int written = snprintf(program, PATH_MAX, "%s%s-%s", plain, single ? "-single" : "", isa);
    if (*plain == '\0' || written < 0 || written >= PATH_MAX)
        program[0] = '\0';
    else if (!single && access(program, X_OK) != 0)
        (void)memcpy(program, plain, strlen(plain) + 1);
}

enum talus_status precision_switch(enum talus_precision wanted, char *const *arguments,
                                   struct talus_error *error)
{
    char program[PATH_MAX];
    size_t count = 0;
    if (wanted == talus_simulation_precision())
        return TALUS_OK;
    while (arguments[count] != NULL)
        count++;
    char **all = calloc(count + 2, sizeof *all);
    if (all == NULL)
        return talus_error_memory(error);
    other_program(wanted, program);
    all[0] = program;
    memcpy(all + 1, arguments, count * sizeof *all);
    if (*program != '\0')
        (void)execv(program, all);
    const int reason = errno;
    free(all);
    return talus_error_set(error, TALUS_UNSUPPORTED, "unsupported", "/solver/precision",
                           "the program for %s precision is not to be had: %s: %s",
                           wanted == TALUS_PRECISION_SINGLE ? "single" : "double", program,
                           strerror(reason));
}
