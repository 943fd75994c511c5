/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_LENIENT_TEXT_H
#define TALUS_LENIENT_TEXT_H

#include <jansson.h>

/* The text as a JSON string, whatever its bytes: where it is not UTF-8 (a path, a name cut in the
 * middle of a character) bytes beyond ASCII become '?'. New reference; NULL when memory ran out. */
json_t *lenient_text_json(const char *text);

#endif
