/* SPDX-License-Identifier: Apache-2.0 */
/* Numbers with the fewest digits, quickly: histories are told as text, millions of numbers. */
#ifndef TALUS_NUMBER_TEXT_H
#define TALUS_NUMBER_TEXT_H

#include <stddef.h>

enum { NUMBER_TEXT_SIZE = 32 };

/* Writes a finite number as "%.15g" does, or with 16 or 17 digits if fewer would not read back to
 * the same double. Returns the length. */
size_t number_text(double value, char text[NUMBER_TEXT_SIZE]);

#endif
