/* SPDX-License-Identifier: Apache-2.0 */
#include "output/lenient_text.h"

#include <stdlib.h>
#include <string.h>

json_t *lenient_text_json(const char *text)
{
    json_t *string = json_string(text);
    if (string != NULL)
        return string;
    char *plain = strdup(text);
    if (plain == NULL)
        return NULL;
    for (char *next = plain; *next != '\0'; next++) {
        if ((unsigned char)*next > 0x7f)
            *next = '?';
    }
    string = json_string(plain);
    free(plain);
    return string;
}
