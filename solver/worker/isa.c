/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/isa.h"

#include "talus/simulation.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool processor_has_v3(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
#else
    return false;
#endif
}

/* Threads that wait for each other spin for some 50 us and then sleep: long enough for the passes
 * of a step, and they do not burn the cores that other jobs need (libgomp's default is some ms).
 * Read by libgomp when a program starts. */
static bool spin_briefly(void)
{
    return setenv("GOMP_SPINCOUNT", "20000", 0) == 0;
}

void isa_switch(char **arguments)
{
    const char *forced = getenv("TALUS_ISA");
    const char *wanted = forced != NULL ? forced : "x86-64-v3";
    char path[PATH_MAX], better[PATH_MAX + 32];
    if (strcmp(talus_simulation_isa(), "x86-64") != 0 || strcmp(wanted, "x86-64-v3") != 0 ||
        !processor_has_v3())
        return;
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0)
        return;
    path[length] = '\0';
    (void)snprintf(better, sizeof better, "%s-%s", path, wanted);
    if (access(better, X_OK) == 0 && spin_briefly())
        (void)execv(better, arguments);
}
