/* SPDX-License-Identifier: Apache-2.0 */
/* Single values: numbers within bounds, vectors, words, names of other entries. */
#include "scene/scene_field.h"

#include <stdio.h>
#include <string.h>

/* No quantity of a scene is larger: sums and products of a few stay finite. */
static const double largest = 1e30;

void scene_bounds_read(const struct scene_field *field, double *minimum, double *maximum)
{
    bool open = field->minimum == 0.0 && field->maximum == 0.0;
    bool positive = open && field->above_minimum;
    *minimum = positive ? 0.0 : (open ? -largest : fmax(field->minimum, -largest));
    *maximum = open ? largest : fmin(field->maximum, largest);
}

static bool in_bounds(const struct scene_field *field, double value)
{
    double minimum, maximum;
    scene_bounds_read(field, &minimum, &maximum);
    bool low = field->above_minimum ? value > minimum : value >= minimum;
    bool high = field->below_maximum ? value < maximum : value <= maximum;
    return low && high;
}

static json_t *allowed_range(const struct scene_field *field)
{
    double minimum, maximum;
    scene_bounds_read(field, &minimum, &maximum);
    return json_pack("{s:f, s:f}", field->above_minimum ? "above" : "minimum", minimum,
                     field->below_maximum ? "below" : "maximum", maximum);
}

static void print_range(const struct scene_field *field, char text[96])
{
    double minimum, maximum;
    scene_bounds_read(field, &minimum, &maximum);
    const char *low = field->above_minimum ? "above" : "at least";
    const char *high = field->below_maximum ? "below" : "at most";
    if (maximum >= largest)
        (void)snprintf(text, 96, "%s %g", low, minimum);
    else if (minimum <= -largest)
        (void)snprintf(text, 96, "%s %g", high, maximum);
    else
        (void)snprintf(text, 96, "%s %g and %s %g", low, minimum, high, maximum);
}

static void report_range(struct scene_reader *reader, const struct scene_path *path,
                         const struct scene_field *field, const json_t *given, double value)
{
    char range[96];
    print_range(field, range);
    const double *lacking = field->lacking_bounds;
    if ((lacking[0] != 0.0 || lacking[1] != 0.0) && value >= lacking[0] && value <= lacking[1])
        scene_mistake(reader, path, "unsupported", given, allowed_range(field),
                      "%g is not supported by this build: must be %s", value, range);
    else
        scene_mistake(reader, path, "range", given, allowed_range(field), "%g must be %s%s%s",
                      value, range, field->unit[0] == '1' ? "" : " ",
                      field->unit[0] == '1' ? "" : field->unit);
}

bool scene_number_read(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *field, const json_t *given, double *value)
{
    if (json_is_string(given) && field->word != NULL) {
        if (strcmp(json_string_value(given), field->word) == 0) {
            *value = field->word_value;
            return true;
        }
        scene_mistake(reader, path, "unknown_value", given, json_pack("[s]", field->word),
                      "expected a number or \"%s\"", field->word);
        return false;
    }
    if (!json_is_number(given)) {
        scene_mistake(reader, path, "type", given, json_string("number"),
                      "expected a number, not %s", scene_type_word(given));
        return false;
    }
    double number = json_number_value(given);
    if (!isfinite(number)) {
        scene_mistake(reader, path, "non_finite", NULL, NULL, "expected a finite number");
        return false;
    }
    if (!in_bounds(field, number)) {
        report_range(reader, path, field, given, number);
        return false;
    }
    if (field->whole && number != floor(number)) {
        scene_mistake(reader, path, "type", given, json_string("integer"),
                      "expected a whole number, not %g", number);
        return false;
    }
    *value = number;
    return true;
}

static json_t *effective_part(const struct scene_field *field, double value)
{
    if (!isfinite(value))
        return json_null();
    return field->whole ? json_integer((json_int_t)value) : json_real(value);
}

bool scene_vector_length_check(struct scene_reader *reader, const struct scene_path *path,
                               const struct scene_field *field, const json_t *given)
{
    if (!json_is_array(given)) {
        scene_mistake(reader, path, "type", given,
                      json_string(field->scalar ? "number or array" : "array"),
                      "expected an array of numbers, not %s", scene_type_word(given));
        return false;
    }
    size_t length = json_array_size(given), axis_count = reader->axis_count;
    if (axis_count == 0 ? length >= 1 && length <= 3 : length == axis_count)
        return true;
    scene_mistake(reader, path, "length", given,
                  json_integer(axis_count == 0 ? 3 : (json_int_t)axis_count),
                  "a vector of this dimension has %zu components, not %zu",
                  axis_count == 0 ? (size_t)3 : axis_count, length);
    return false;
}

bool scene_vector_read(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *field, const json_t *given, double value[3],
                       json_t **effective)
{
    size_t count = json_is_array(given) ? json_array_size(given) : reader->axis_count;
    bool scalar = field->scalar && json_is_number(given);
    if (!scalar && !scene_vector_length_check(reader, path, field, given))
        return false;
    *effective = json_array();
    bool valid = true;
    for (size_t k = 0; k < count && k < 3; k++) {
        struct scene_path part = {.parent = path, .index = k};
        const json_t *entry = scalar ? given : json_array_get(given, k);
        value[k] = field->default_value;
        if (!(field->open && json_is_null(entry)) &&
            !scene_number_read(reader, scalar ? path : &part, field, entry, &value[k]))
            valid = false;
        if (valid && json_array_append_new(*effective, effective_part(field, value[k])) != 0)
            reader->out_of_memory = true;
        if (scalar && !valid)
            break;
    }
    if (!valid) {
        json_decref(*effective);
        *effective = NULL;
    }
    return valid;
}

json_t *scene_zero_vector(struct scene_reader *reader)
{
    json_t *vector = json_array();
    for (size_t k = 0; k < reader->axis_count; k++) {
        if (json_array_append_new(vector, json_real(0.0)) != 0)
            reader->out_of_memory = true;
    }
    return vector;
}

static int find_word(const char *word, const char *const *words)
{
    for (int index = 0; words != NULL && words[index] != NULL; index++) {
        if (strcmp(words[index], word) == 0)
            return index;
    }
    return -1;
}

int scene_choice_read(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, const char *const *choices, const char *const *lacking)
{
    const char *word = json_string_value(given);
    if (word == NULL) {
        scene_mistake(reader, path, "type", given, scene_word_list(choices),
                      "expected a string, not %s", scene_type_word(given));
        return -1;
    }
    int index = find_word(word, choices);
    const char *nearest = scene_suggest(word, choices);
    if (index >= 0)
        return index;
    if (find_word(word, lacking) >= 0)
        scene_mistake(reader, path, "unsupported", given, scene_word_list(choices),
                      "\"%.60s\" is not supported by this build", word);
    else if (nearest != NULL)
        scene_mistake(reader, path, "unknown_value", given, scene_word_list(choices),
                      "unknown word \"%.60s\": did you mean \"%s\"?", word, nearest);
    else
        scene_mistake(reader, path, "unknown_value", given, scene_word_list(choices),
                      "unknown word \"%.60s\"", word);
    return -1;
}

int scene_name_find(struct scene_reader *reader, const struct scene_path *path, const char *what,
                    const json_t *given, const char *const *names, size_t count)
{
    enum { SHOWN_MAX = 32 };
    const char *shown[SHOWN_MAX + 1] = {NULL};
    const char *word = json_string_value(given);
    if (word == NULL) {
        scene_mistake(reader, path, "type", given, json_string("string"),
                      "expected the name of a %s, not %s", what, scene_type_word(given));
        return -1;
    }
    size_t shown_count = 0;
    for (size_t index = 0; index < count; index++) {
        if (names[index] != NULL && strcmp(names[index], word) == 0)
            return (int)index;
        if (names[index] != NULL && shown_count < SHOWN_MAX)
            shown[shown_count++] = names[index];
    }
    const char *nearest = scene_suggest(word, shown);
    if (nearest != NULL)
        scene_mistake(reader, path, "unknown_name", given, scene_word_list(shown),
                      "there is no %s \"%.60s\": did you mean \"%s\"?", what, word, nearest);
    else
        scene_mistake(reader, path, "unknown_name", given, scene_word_list(shown),
                      "there is no %s \"%.60s\"", what, word);
    return -1;
}
