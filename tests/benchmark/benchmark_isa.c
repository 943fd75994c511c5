/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_isa.h"

#include "talus/simulation.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Says that this process has been started by another program of the benchmark. */
#define MARK "TALUS_BENCHMARK_STARTED"

#if defined(__x86_64__)
static bool has_v3(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}

static bool has_v4(void)
{
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd");
}
#endif

/* Best first; the last one runs everywhere. */
static const struct variant {
    const char *name;
    bool (*available)(void);
} variants[] = {
#if defined(__x86_64__)
    {"x86-64-v4", has_v4},
    {"x86-64-v3", has_v3},
    {"x86-64-v2", NULL},
#else
    {"aarch64", NULL},
#endif
};
enum { VARIANT_COUNT = sizeof variants / sizeof variants[0] };

const char *benchmark_isa(void)
{
    return talus_simulation_isa();
}

bool benchmark_is_single(void)
{
    return talus_simulation_precision() == TALUS_PRECISION_SINGLE;
}

/* Takes "-END" off the end of a path, if it is there. */
static void cut_end(char *path, const char *end)
{
    const size_t length = strlen(path), tail = strlen(end) + 1;
    if (length > tail && path[length - tail] == '-' && strcmp(path + length - tail + 1, end) == 0)
        path[length - tail] = '\0';
}

/* Path of the program for double precision and any processor. 0 or -1. */
static int plain_path(char *path, size_t size)
{
    const ssize_t length = readlink("/proc/self/exe", path, size - 1);
    if (length <= 0)
        return -1;
    path[length] = '\0';
    for (size_t index = 0; index < VARIANT_COUNT; index++)
        cut_end(path, variants[index].name);
    cut_end(path, "single");
    return 0;
}

/* libgomp reads these when a program starts. */
static bool set_threads(void)
{
    return setenv(MARK, "1", 1) == 0 && setenv("OMP_PROC_BIND", "true", 0) == 0 &&
           setenv("OMP_PLACES", "cores", 0) == 0 && setenv("GOMP_SPINCOUNT", "20000", 0) == 0;
}

int benchmark_isa_switch(const char *wanted, bool single, char **arguments)
{
    char path[PATH_MAX], program[PATH_MAX + 32];
    if (getenv(MARK) != NULL)
        return (wanted == NULL || strcmp(wanted, benchmark_isa()) == 0) &&
                       single == benchmark_is_single()
                   ? 0
                   : -1;
    if (plain_path(path, sizeof path) != 0 || !set_threads())
        return -1;
    for (size_t index = 0; index < VARIANT_COUNT; index++) {
        const struct variant *variant = &variants[index];
        if ((wanted != NULL && strcmp(wanted, variant->name) != 0) ||
            (variant->available != NULL && !variant->available()))
            continue;
        (void)snprintf(program, sizeof program, "%s%s-%s", path, single ? "-single" : "",
                       variant->name);
        if (access(program, X_OK) == 0)
            (void)execv(program, arguments);
        if (!single && index + 1 == VARIANT_COUNT)
            (void)execv(path, arguments);
    }
    return -1;
}
