/* SPDX-License-Identifier: Apache-2.0 */
/* The audit log: who did what, one JSON object a line in audit.ndjson of the state folder. A line
 * of a change is with the operating system before its answer goes out, so a killed daemon loses
 * none; it is on the disk a second later at most. Full files are renamed to audit.ndjson.1, .2, ...
 */
#ifndef TALUS_AUDIT_H
#define TALUS_AUDIT_H

#include "config.h"
#include "request.h"

#include <sys/types.h>

struct audit;

/* Opens or makes the log in a folder; a line that a crash has torn is cut off. *config is borrowed.
 */
TALUS_MUST_CHECK enum talus_status audit_create(struct audit **audit, const char *folder,
                                                const struct config *config,
                                                struct talus_error *error);
/* Writes what waits and flushes it. NULL is fine. */
void audit_destroy(struct audit *audit);
/* Notes a request that has its reply; waits for the disk at worst. */
void audit_request(struct audit *audit, const struct request *request);
/* Notes one that was refused before a handler saw it; never waits. Beyond 10 a second they are only
 * counted, in `suppressed` of the next line. */
void audit_refusal(struct audit *audit, const struct request *request);
/* Notes that the tokens were read again, asked for by a process of this user. */
void audit_reload(struct audit *audit, uid_t user, bool good, size_t token_count);
/* Lines that could not be written since the start. */
uint64_t audit_lost_count(struct audit *audit);

#endif
