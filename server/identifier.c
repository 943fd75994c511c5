/* SPDX-License-Identifier: Apache-2.0 */
#include "identifier.h"

#include "moment.h"

#include <string.h>
#include <sys/random.h>

static const char alphabet[] = "0123456789abcdefghjkmnpqrstvwxyz";

enum talus_status identifier_source_init(struct identifier_source *source,
                                         struct talus_error *error)
{
    memset(source, 0, sizeof *source);
    if (pthread_mutex_init(&source->mutex, NULL) != 0)
        return talus_error_set(error, TALUS_INTERNAL, "mutex", "", "cannot make a mutex");
    return TALUS_OK;
}

void identifier_source_release(struct identifier_source *source)
{
    (void)pthread_mutex_destroy(&source->mutex);
}

static void random_increment(uint8_t random[10])
{
    for (int index = 9; index >= 0; index--) {
        random[index]++;
        if (random[index] != 0)
            return;
    }
}

static void identifier_encode(int64_t milliseconds, const uint8_t random[10],
                              char identifier[IDENTIFIER_LENGTH + 1])
{
    for (int index = 9; index >= 0; index--) {
        identifier[index] = alphabet[milliseconds & 31];
        milliseconds >>= 5;
    }
    unsigned int bits = 0, bit_count = 0;
    size_t length = 10;
    for (size_t index = 0; index < 10; index++) {
        bits = (bits << 8) | random[index];
        bit_count += 8;
        while (bit_count >= 5) {
            bit_count -= 5;
            identifier[length++] = alphabet[(bits >> bit_count) & 31U];
        }
    }
    identifier[length] = '\0';
}

enum talus_status identifier_next(struct identifier_source *source,
                                  char identifier[IDENTIFIER_LENGTH + 1], struct talus_error *error)
{
    uint8_t random[10];
    if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random)
        return talus_error_set(error, TALUS_IO, "random", "", "no random bytes");
    int64_t now = moment_now_milliseconds();
    (void)pthread_mutex_lock(&source->mutex);
    if (now > source->last_milliseconds) {
        source->last_milliseconds = now;
        memcpy(source->random, random, sizeof random);
        source->random[8] &= 0xBF; /* the last 15 bits begin in their lower half */
    } else {
        random_increment(source->random);
    }
    identifier_encode(source->last_milliseconds, source->random, identifier);
    (void)pthread_mutex_unlock(&source->mutex);
    return TALUS_OK;
}

bool identifier_valid(const char *text)
{
    return strlen(text) == IDENTIFIER_LENGTH && strspn(text, alphabet) == IDENTIFIER_LENGTH;
}
