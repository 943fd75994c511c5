/* SPDX-License-Identifier: Apache-2.0 */
#include "talus/status.h"

#include <stdarg.h>
#include <stdio.h>

enum talus_status talus_error_set(struct talus_error *error, enum talus_status status,
                                  const char *code, const char *pointer, const char *format, ...)
{
    if (error == NULL || error->status != TALUS_OK)
        return status;
    error->status = status;
    (void)snprintf(error->code, sizeof error->code, "%s", code);
    (void)snprintf(error->pointer, sizeof error->pointer, "%s", pointer);
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return status;
}

enum talus_status talus_error_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
}

const char *talus_status_name(enum talus_status status)
{
    static const char *const names[] = {
        [TALUS_OK] = "ok",
        [TALUS_INVALID] = "invalid",
        [TALUS_UNSUPPORTED] = "unsupported",
        [TALUS_UNSTABLE] = "unstable",
        [TALUS_CANCELLED] = "cancelled",
        [TALUS_MEMORY] = "memory",
        [TALUS_LIMIT] = "limit",
        [TALUS_AUDIT] = "audit",
        [TALUS_IO] = "io",
        [TALUS_INTERNAL] = "internal",
    };
    return names[status];
}
