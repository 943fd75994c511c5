/* SPDX-License-Identifier: Apache-2.0 */
#include "json_field.h"
#include "reply.h"
#include "study_set.h"

bool study_value_check(struct study_reader *reader, const json_t *given, const char *pointer)
{
    static const char *const known[] = {"label", "value", NULL};
    char own[JSON_POINTER_SIZE];
    size_t before = json_array_size(reader->errors);
    if (json_is_number(given))
        return true;
    if (json_is_string(given) && json_string_length(given) <= STUDY_TEXT_MAX)
        return true;
    if (!json_is_object(given)) {
        issue_add(reader->errors, pointer, "type", given, NULL,
                  "a number, a text of at most %d bytes or {\"label\", \"value\"} is wanted",
                  STUDY_TEXT_MAX);
        return false;
    }
    json_keys_check(given, pointer, known, reader->errors);
    (void)study_text(reader, given, "label", pointer);
    json_pointer_join(own, pointer, "value");
    if (json_object_get(given, "value") == NULL)
        issue_add(reader->errors, own, "required", NULL, NULL, "'value' is required");
    return study_good(reader, before);
}

json_t *study_value_shown(const json_t *given)
{
    return json_is_object(given) ? json_object_get(given, "label") : (json_t *)(uintptr_t)given;
}

json_t *study_value_set(const json_t *given)
{
    return json_is_object(given) ? json_object_get(given, "value") : (json_t *)(uintptr_t)given;
}
