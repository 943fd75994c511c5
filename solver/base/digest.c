/* SPDX-License-Identifier: Apache-2.0 */
#include "base/digest.h"

#include <errno.h>
#include <openssl/evp.h>
#include <stdio.h>
#include <string.h>

static enum talus_status digest_stream(FILE *stream, EVP_MD_CTX *context, const char *path,
                                       char hexadecimal[65], struct talus_error *error)
{
    unsigned char buffer[65536];
    unsigned char hash[EVP_MAX_MD_SIZE];
    unsigned int hash_length = 0;
    if (EVP_DigestInit_ex(context, EVP_sha256(), NULL) != 1)
        return talus_error_set(error, TALUS_INTERNAL, "digest", "", "SHA-256 is not available");
    size_t length;
    while ((length = fread(buffer, 1, sizeof buffer, stream)) > 0) {
        if (EVP_DigestUpdate(context, buffer, length) != 1)
            return talus_error_set(error, TALUS_INTERNAL, "digest", "", "SHA-256 failed");
    }
    if (ferror(stream) || EVP_DigestFinal_ex(context, hash, &hash_length) != 1)
        return talus_error_set(error, TALUS_IO, "read", "", "cannot read %s: %s", path,
                               strerror(errno));
    for (unsigned int index = 0; index < hash_length; index++)
        (void)snprintf(hexadecimal + 2 * index, 3, "%02x", hash[index]);
    return TALUS_OK;
}

enum talus_status digest_file(const char *path, char hexadecimal[65], struct talus_error *error)
{
    FILE *stream = fopen(path, "rb");
    if (stream == NULL)
        return talus_error_set(error, TALUS_IO, "open", "", "cannot open %s: %s", path,
                               strerror(errno));
    EVP_MD_CTX *context = EVP_MD_CTX_new();
    enum talus_status status = context == NULL
                                   ? talus_error_memory(error)
                                   : digest_stream(stream, context, path, hexadecimal, error);
    EVP_MD_CTX_free(context);
    (void)fclose(stream);
    return status;
}
