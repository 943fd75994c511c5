/* SPDX-License-Identifier: Apache-2.0 */
/* Numbers as text, for tables of millions of them: printf takes a microsecond for what this does in
 * twenty nanoseconds, with the same result. */
#ifndef TALUS_DECIMAL_H
#define TALUS_DECIMAL_H

#include <stddef.h>

enum { DECIMAL_SIZE = 32 };

/* Writes the value as printf's "%.15g" if that brings back the same bits, else as its "%.17g": 0.1
 * rather than 0.10000000000000001. Returns the length; the text ends with NUL. */
size_t decimal_write(char text[DECIMAL_SIZE], double value);

#endif
