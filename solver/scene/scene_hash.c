/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_json.h"

#include <openssl/evp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void scene_hash(const json_t *effective, char hash[65])
{
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int length = 0;
    char *text = NULL;
    memset(hash, 0, 65);
    json_t *copy = json_copy((json_t *)effective); /* shallow: only the title is taken out */
    (void)json_object_del(copy, "title");
    if (copy != NULL)
        text = json_dumps(copy, JSON_SORT_KEYS | JSON_COMPACT);
    if (text != NULL && EVP_Digest(text, strlen(text), digest, &length, EVP_sha256(), NULL) == 1) {
        for (unsigned int index = 0; index < length && index < 32; index++)
            (void)snprintf(hash + 2 * index, 3, "%02x", digest[index]);
    }
    free(text);
    json_decref(copy);
}
