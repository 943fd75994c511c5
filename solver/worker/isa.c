/* SPDX-License-Identifier: Apache-2.0 */
/* This file and main.c are compiled for every processor of the architecture; the solver is not. */
#include "worker/isa.h"

#include "talus/simulation.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct isa {
    const char *name; /* also the end of its program's name */
    bool (*processor_has)(void);
};

#if defined(__x86_64__)
#include <cpuid.h>

enum { LEAF_FEATURES = 1, LEAF_EXTENDED_FEATURES = 0x80000001 };

/* What the compilers' __builtin_cpu_supports has no common names for. */
static bool has_bits(unsigned leaf, unsigned needed)
{
    unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
    return __get_cpuid(leaf, &eax, &ebx, &ecx, &edx) != 0 && (ecx & needed) == needed;
}

/* The levels of the x86-64 psABI, section "Micro-architecture levels". */
static bool has_v2(void)
{
    return has_bits(LEAF_FEATURES,
                    bit_SSE3 | bit_SSSE3 | bit_SSE4_1 | bit_SSE4_2 | bit_POPCNT | bit_CMPXCHG16B) &&
           has_bits(LEAF_EXTENDED_FEATURES, bit_LAHF_LM);
}

/* __builtin_cpu_supports also asks whether the operating system saves the wide registers. */
static bool has_v3(void)
{
    return has_v2() && has_bits(LEAF_FEATURES, bit_MOVBE | bit_F16C) &&
           has_bits(LEAF_EXTENDED_FEATURES, bit_LZCNT) && __builtin_cpu_supports("avx2") &&
           __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}

static bool has_v4(void)
{
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}

/* The best one first. */
static const struct isa known[] = {
    {"x86-64-v4", has_v4}, {"x86-64-v3", has_v3}, {"x86-64-v2", has_v2}};
#define KNOWN_NAMES "x86-64-v2, x86-64-v3, x86-64-v4"
#else
static bool has_base(void)
{
    return true;
}

#if defined(__aarch64__)
#define KNOWN_NAMES "aarch64"
#else
#define KNOWN_NAMES "generic"
#endif
static const struct isa known[] = {{KNOWN_NAMES, has_base}};
#endif
enum { KNOWN_COUNT = sizeof known / sizeof known[0] };

__attribute__((format(printf, 1, 2))) static bool refuse(const char *format, ...)
{
    va_list values;
    va_start(values, format);
    (void)fputs("talus-worker: ", stderr);
    (void)vfprintf(stderr, format, values);
    (void)fputc('\n', stderr);
    va_end(values);
    return false;
}

/* KNOWN_COUNT if there is none of that name. */
static size_t isa_find(const char *name)
{
    size_t index = 0;
    while (index < KNOWN_COUNT && strcmp(known[index].name, name) != 0)
        index++;
    return index;
}

/* Empty where there is no /proc. */
static void own_path(char path[static PATH_MAX])
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_MAX - 1);
    path[length > 0 ? length : 0] = '\0';
}

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

/* The program for another instruction set beside the plain one; false if it is not there. */
static bool program_beside(const char *plain, const char *name, char program[static PATH_MAX])
{
    const int length = snprintf(program, PATH_MAX, "%s-%s", plain, name);
    return length > 0 && length < PATH_MAX && access(program, X_OK) == 0;
}

/* The best program: the plain one if no better one is there. */
static void choose_best(const char *plain, size_t own, char program[static PATH_MAX])
{
    for (size_t index = 0; index < own; index++) {
        if (known[index].processor_has() && program_beside(plain, known[index].name, program))
            return;
    }
    (void)memcpy(program, plain, strlen(plain) + 1);
}

/* The program that TALUS_ISA asks for. */
static bool choose_forced(const char *plain, size_t own, const char *forced,
                          char program[static PATH_MAX])
{
    const size_t wanted = isa_find(forced);
    if (wanted == KNOWN_COUNT)
        return refuse("TALUS_ISA=%s is unknown; there are: " KNOWN_NAMES, forced);
    if (!known[wanted].processor_has())
        return refuse("TALUS_ISA=%s: this processor lacks it", forced);
    if (wanted == own)
        (void)memcpy(program, plain, strlen(plain) + 1);
    else if (!program_beside(plain, forced, program))
        return refuse("TALUS_ISA=%s: there is no program %s", forced, program);
    return true;
}

/* Threads that wait for each other spin for some 50 us and then sleep: long enough for the passes
 * of a step, and they do not burn the cores that other jobs need (libgomp's default is some ms).
 * Read by libgomp when a program starts, so that even the plain program starts again. */
static bool become(const char *program, const char *plain, char **arguments)
{
    static const char variable[] = "GOMP_SPINCOUNT";
    const bool stays = strcmp(program, plain) == 0;
    if (stays && getenv(variable) != NULL)
        return true;
    if (setenv(variable, "20000", 0) == 0)
        (void)execv(program, arguments);
    return stays || refuse("%s: %s", program, strerror(errno));
}

bool isa_switch(char **arguments)
{
    char plain[PATH_MAX], program[PATH_MAX];
    const char *forced = getenv("TALUS_ISA");
    const char *own_name = talus_simulation_isa();
    const size_t own = isa_find(own_name);
    if (own < KNOWN_COUNT && !known[own].processor_has())
        return refuse("this program is built for %s, which this processor lacks", own_name);
    own_path(plain);
    /* A program that is not the plain one was chosen, by that one or by whoever started it. */
    if (*plain == '\0' || ends_with(plain, own_name))
        return forced == NULL || strcmp(forced, own_name) == 0 ||
               refuse("TALUS_ISA=%s, but this program is built for %s", forced, own_name);
    if (forced == NULL)
        choose_best(plain, own, program);
    else if (!choose_forced(plain, own, forced, program))
        return false;
    return become(program, plain, arguments);
}
