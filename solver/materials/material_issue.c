/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/material_issue.h"

#include <stdarg.h>
#include <stdio.h>

void material_issue_add(struct material_issues *issues, const char *key, const char *code,
                        const char *format, ...)
{
    if (issues->count == issues->capacity)
        return;
    struct material_issue *issue = &issues->items[issues->count++];
    (void)snprintf(issue->key, sizeof issue->key, "%s", key);
    (void)snprintf(issue->code, sizeof issue->code, "%s", code);
    va_list arguments;
    va_start(arguments, format);
    /* NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is one line up */
    (void)vsnprintf(issue->text, sizeof issue->text, format, arguments);
    va_end(arguments);
}
