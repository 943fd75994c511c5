/* SPDX-License-Identifier: Apache-2.0 */
#include "checksum.h"

#include <math.h>
#include <openssl/evp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void checksum_print(const unsigned char *hash, unsigned int length,
                           char checksum[CHECKSUM_SIZE])
{
    for (unsigned int index = 0; index < length && 2 * index + 2 < CHECKSUM_SIZE; index++)
        (void)snprintf(checksum + 2 * index, 3, "%02x", hash[index]);
}

enum talus_status checksum_memory(const void *data, size_t length, char checksum[CHECKSUM_SIZE],
                                  struct talus_error *error)
{
    unsigned char hash[EVP_MAX_MD_SIZE];
    unsigned int hash_length = 0;
    if (EVP_Digest(data, length, hash, &hash_length, EVP_sha256(), NULL) != 1)
        return talus_error_set(error, TALUS_INTERNAL, "digest", "", "SHA-256 failed");
    checksum_print(hash, hash_length, checksum);
    return TALUS_OK;
}

enum talus_status checksum_descriptor(int descriptor, char checksum[CHECKSUM_SIZE],
                                      struct talus_error *error)
{
    unsigned char buffer[65536], hash[EVP_MAX_MD_SIZE];
    unsigned int hash_length = 0;
    EVP_MD_CTX *context = EVP_MD_CTX_new();
    off_t offset = 0;
    ssize_t length = -1;
    if (context != NULL && EVP_DigestInit_ex(context, EVP_sha256(), NULL) == 1) {
        while ((length = pread(descriptor, buffer, sizeof buffer, offset)) > 0) {
            offset += length;
            if (EVP_DigestUpdate(context, buffer, (size_t)length) != 1) {
                length = -1;
                break;
            }
        }
    }
    if (length == 0 && EVP_DigestFinal_ex(context, hash, &hash_length) != 1)
        length = -1;
    EVP_MD_CTX_free(context);
    if (length < 0)
        return talus_error_set(error, TALUS_IO, "digest", "", "cannot hash a file");
    checksum_print(hash, hash_length, checksum);
    return TALUS_OK;
}

/* A copy in which numbers that are whole are integers, so that 1 and 1.0 compare equal. */
static json_t *json_normalised(const json_t *value)
{
    const double exact = 9007199254740992.0; /* 2^53: beyond it a double skips integers */
    if (json_is_real(value)) {
        double number = json_real_value(value);
        return fabs(number) < exact && floor(number) == number ? json_integer((json_int_t)number)
                                                               : json_real(number);
    }
    if (json_is_array(value)) {
        json_t *copy = json_array();
        for (size_t index = 0; index < json_array_size(value); index++) {
            if (json_array_append_new(copy, json_normalised(json_array_get(value, index))) != 0) {
                json_decref(copy);
                return NULL;
            }
        }
        return copy;
    }
    if (json_is_object(value)) {
        json_t *copy = json_object();
        const char *key;
        json_t *member;
        json_object_foreach((json_t *)value, key, member)
        {
            if (json_object_set_new(copy, key, json_normalised(member)) != 0) {
                json_decref(copy);
                return NULL;
            }
        }
        return copy;
    }
    return json_deep_copy(value);
}

enum talus_status checksum_json(const json_t *value, char checksum[CHECKSUM_SIZE],
                                struct talus_error *error)
{
    json_t *normalised = json_normalised(value);
    char *text = normalised == NULL
                     ? NULL
                     : json_dumps(normalised, JSON_COMPACT | JSON_SORT_KEYS | JSON_ENCODE_ANY);
    enum talus_status status = text == NULL ? talus_error_memory(error)
                                            : checksum_memory(text, strlen(text), checksum, error);
    free(text);
    json_decref(normalised);
    return status;
}
