/* SPDX-License-Identifier: Apache-2.0 */
#include "suggest.h"

#include <stddef.h>
#include <string.h>

enum { NAME_MAX_LENGTH = 48 };

/* Edit distance (Levenshtein 1966). */
static size_t edit_distance(const char *a, const char *b)
{
    size_t row[NAME_MAX_LENGTH + 1];
    size_t a_length = strlen(a), b_length = strlen(b);
    if (a_length > NAME_MAX_LENGTH || b_length > NAME_MAX_LENGTH)
        return NAME_MAX_LENGTH;
    for (size_t j = 0; j <= b_length; j++)
        row[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t best = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            row[j] = best;
        }
    }
    return row[b_length];
}

const char *suggest(const char *given, const char *const *names)
{
    const char *best = NULL;
    size_t best_distance = strlen(given) / 2 + 1;
    if (best_distance > 4)
        best_distance = 4;
    for (size_t index = 0; names[index] != NULL; index++) {
        size_t distance = edit_distance(given, names[index]);
        if (distance < best_distance) {
            best_distance = distance;
            best = names[index];
        }
    }
    return best;
}
