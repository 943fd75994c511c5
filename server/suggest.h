/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_SUGGEST_H
#define TALUS_SUGGEST_H

/* The name of a NULL-terminated list that is nearest to a misspelt one, or NULL if none is near. */
const char *suggest(const char *given, const char *const *names);

#endif
