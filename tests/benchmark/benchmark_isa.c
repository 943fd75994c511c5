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

static bool has_v3(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
#else
    return false;
#endif
}

static bool has_v4(void)
{
#if defined(__x86_64__)
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd");
#else
    return false;
#endif
}

/* Best first; the plain program has no suffix, and is for all processors. */
static const struct variant {
    const char *name, *suffix;
    bool (*available)(void);
} variants[] = {
    {"x86-64-v4", "-x86-64-v4", has_v4},
    {"x86-64-v3", "-x86-64-v3", has_v3},
    {NULL, "", NULL},
};
enum { VARIANT_COUNT = sizeof variants / sizeof variants[0] };

const char *benchmark_isa(void)
{
    return talus_simulation_isa();
}

/* Path of this program without the suffix of its instruction set. 0 or -1. */
static int plain_path(char *path, size_t size)
{
    const ssize_t length = readlink("/proc/self/exe", path, size - 1);
    if (length <= 0)
        return -1;
    path[length] = '\0';
    for (size_t index = 0; index < VARIANT_COUNT; index++) {
        const size_t suffix = strlen(variants[index].suffix);
        if (suffix > 0 && strlen(path) > suffix &&
            strcmp(path + strlen(path) - suffix, variants[index].suffix) == 0)
            path[strlen(path) - suffix] = '\0';
    }
    return 0;
}

/* libgomp reads these when a program starts. */
static bool set_threads(void)
{
    return setenv(MARK, "1", 1) == 0 && setenv("OMP_PROC_BIND", "true", 0) == 0 &&
           setenv("OMP_PLACES", "cores", 0) == 0 && setenv("GOMP_SPINCOUNT", "20000", 0) == 0;
}

int benchmark_isa_switch(const char *wanted, char **arguments)
{
    char path[PATH_MAX], better[PATH_MAX + 32];
    if (getenv(MARK) != NULL)
        return wanted == NULL || strcmp(wanted, benchmark_isa()) == 0 ? 0 : -1;
    if (plain_path(path, sizeof path) != 0 || !set_threads())
        return -1;
    for (size_t index = 0; index < VARIANT_COUNT; index++) {
        const struct variant *variant = &variants[index];
        const bool meant =
            wanted == NULL || variant->name == NULL || strcmp(wanted, variant->name) == 0;
        if (!meant || (variant->available != NULL && !variant->available()))
            continue;
        (void)snprintf(better, sizeof better, "%s%s", path, variant->suffix);
        if (access(better, X_OK) == 0)
            (void)execv(better, arguments);
    }
    return -1;
}
