/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_PROBLEM_TEXT_H
#define TALUS_PROBLEM_TEXT_H

#include <stddef.h>
#include <stdio.h>

/* Prints a problem document (RFC 9457) for people: what is wrong, and each error with its pointer,
 * what was given and what is allowed. A body that is no such document is quoted. */
void problem_print(FILE *stream, long status, const char *body, size_t length);

#endif
