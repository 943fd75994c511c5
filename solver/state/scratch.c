/* SPDX-License-Identifier: Apache-2.0 */
#include "state/scratch.h"

#include <stdlib.h>
#include <string.h>

/* Everything behind `memory` is a pointer to an array of `capacity` numbers. */
enum {
    ARRAY_COUNT =
        (sizeof(struct block_scratch) - offsetof(struct block_scratch, gradient)) / sizeof(real *)
};

size_t block_scratch_bytes(size_t slots, size_t number)
{
    return ARRAY_COUNT * slots * number;
}

int block_scratch_reserve(struct block_scratch *scratch, size_t slots)
{
    if (slots <= scratch->capacity)
        return 0;
    /* An odd number of cache lines between arrays, so that they do not share cache sets. */
    const size_t capacity = ((slots + slots / 2) / 16 * 2 + 3) * 8;
    const size_t bytes = block_scratch_bytes(capacity, sizeof(real));
    real *memory = aligned_alloc(64, bytes);
    if (memory == NULL)
        return -1;
    memset(memory, 0, bytes);
    free(scratch->memory);
    scratch->memory = memory;
    scratch->capacity = capacity;
    char *arrays = (char *)scratch + offsetof(struct block_scratch, gradient);
    for (size_t index = 0; index < ARRAY_COUNT; index++) {
        real *array = memory + index * capacity;
        memcpy(arrays + index * sizeof array, &array, sizeof array);
    }
    return 0;
}

void block_scratch_release(struct block_scratch *scratch)
{
    free(scratch->memory);
    memset(scratch, 0, sizeof *scratch);
}
