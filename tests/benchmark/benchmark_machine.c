/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_machine.h"

#include <ctype.h>
#include <malloc.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What follows the key, its colon and blanks in the first such line of a file; false if none. */
static bool find_line(const char *path, const char *key, char *value, size_t size)
{
    char line[512];
    bool found = false;
    FILE *file = fopen(path, "r");
    while (file != NULL && !found && fgets(line, sizeof line, file) != NULL) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, key, strlen(key)) != 0 || colon == NULL)
            continue;
        (void)snprintf(value, size, "%s", colon + 1 + strspn(colon + 1, " \t"));
        value[strcspn(value, "\n")] = '\0';
        found = true;
    }
    if (file != NULL)
        (void)fclose(file);
    return found;
}

void benchmark_processor(char *name, size_t size)
{
    if (!find_line("/proc/cpuinfo", "model name", name, size))
        (void)snprintf(name, size, "unknown processor");
}

void benchmark_processor_slug(char *slug, size_t size)
{
    char name[256];
    size_t length = 0;
    benchmark_processor(name, sizeof name);
    for (const char *next = name; *next != '\0' && length + 1 < size; next++) {
        if (isalnum((unsigned char)*next))
            slug[length++] = (char)tolower((unsigned char)*next);
        else if (length > 0 && slug[length - 1] != '-')
            slug[length++] = '-';
    }
    while (length > 0 && slug[length - 1] == '-')
        length--;
    slug[length] = '\0';
}

double benchmark_free_memory(void)
{
    char value[64];
    if (!find_line("/proc/meminfo", "MemAvailable", value, sizeof value))
        return 0;
    return 1024.0 * strtod(value, NULL);
}

double benchmark_allocated_memory(void)
{
    const struct mallinfo2 info = mallinfo2();
    return (double)info.uordblks + (double)info.hblkhd;
}
