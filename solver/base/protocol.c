/* SPDX-License-Identifier: Apache-2.0 */
#include "base/protocol.h"

#include <stddef.h>
#include <string.h>

static const char *const message_names[PROTOCOL_MESSAGE_COUNT] = {
#define MESSAGE(ENUM, name) [PROTOCOL_##ENUM] = #name,
#include "base/messages.def"
#undef MESSAGE
};

const char *protocol_message_name(enum protocol_message message)
{
    return message_names[message];
}

enum protocol_message protocol_message_find(const char *name)
{
    for (size_t index = 0; index < PROTOCOL_MESSAGE_COUNT; index++) {
        if (strcmp(message_names[index], name) == 0)
            return (enum protocol_message)index;
    }
    return PROTOCOL_MESSAGE_COUNT;
}
