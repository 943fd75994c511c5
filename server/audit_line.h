/* SPDX-License-Identifier: Apache-2.0 */
/* What the audit log says of a request. */
#ifndef TALUS_AUDIT_LINE_H
#define TALUS_AUDIT_LINE_H

#include "request.h"
#include "text.h"

/* Appends one line: at, who, role, from, uid of a Unix socket's other end, forwarded_for, method,
 * target without its query, status, job or study. Never a secret. */
void audit_line_request(struct text *line, const struct request *request, uint64_t suppressed);

#endif
