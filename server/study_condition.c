/* SPDX-License-Identifier: Apache-2.0 */
#include "study_condition.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBER_LENGTH_MAX = 63 };

static bool refuse(struct expression_mistake *mistake, size_t position, const char *text)
{
    mistake->position = position;
    mistake->name[0] = '\0';
    (void)snprintf(mistake->text, sizeof mistake->text, "%s", text);
    return false;
}

static size_t blanks_skip(const char *text, size_t position)
{
    return position + strspn(text + position, " \t\r\n");
}

/* The metric's name: what stands before the comparison, without blanks at its ends. */
static bool metric_read(const char *text, size_t *position, struct condition_term *term,
                        struct expression_mistake *mistake)
{
    size_t first = blanks_skip(text, *position);
    size_t behind = first + strcspn(text + first, "<>=&");
    size_t length = behind - first;
    while (length > 0 && strchr(" \t\r\n", text[first + length - 1]) != NULL)
        length--;
    if (length == 0)
        return refuse(mistake, first, "the name of a metric is wanted");
    if (length >= sizeof term->metric)
        return refuse(mistake, first, "the name of the metric is too long");
    if (text[behind] != '<' && text[behind] != '>')
        return refuse(mistake, behind, "one of < <= > >= is wanted behind the metric");
    memcpy(term->metric, text + first, length);
    term->metric[length] = '\0';
    bool less = text[behind] == '<', equal = text[behind + 1] == '=';
    term->comparison = less ? (equal ? COMPARE_LESS_EQUAL : COMPARE_LESS)
                            : (equal ? COMPARE_GREATER_EQUAL : COMPARE_GREATER);
    *position = behind + 1 + equal;
    return true;
}

static bool number_read(const char *text, size_t *position, struct condition_term *term,
                        struct expression_mistake *mistake)
{
    char number[NUMBER_LENGTH_MAX + 1], *end;
    size_t first = blanks_skip(text, *position);
    size_t length = strspn(text + first, "+-.0123456789eE");
    if (length == 0 || length > NUMBER_LENGTH_MAX)
        return refuse(mistake, first, "a number is wanted behind the comparison");
    memcpy(number, text + first, length);
    number[length] = '\0';
    term->number = strtod(number, &end);
    if (*end != '\0' || !isfinite(term->number))
        return refuse(mistake, first, "a finite number is wanted behind the comparison");
    *position = blanks_skip(text, first + length);
    return true;
}

bool condition_read(const char *text, struct condition *condition,
                    struct expression_mistake *mistake)
{
    size_t position = 0;
    memset(condition, 0, sizeof *condition);
    for (;;) {
        struct condition_term *term = &condition->terms[condition->term_count++];
        if (!metric_read(text, &position, term, mistake) ||
            !number_read(text, &position, term, mistake))
            return false;
        if (text[position] == '\0')
            return true;
        if (strncmp(text + position, "&&", 2) != 0)
            return refuse(mistake, position, "&& or the end is wanted");
        position += 2;
        if (condition->term_count == CONDITION_TERM_MAX)
            return refuse(mistake, position, "there are too many comparisons");
    }
}

static bool term_is_met(const struct condition_term *term, const json_t *metric)
{
    double value = json_number_value(metric);
    if (!json_is_number(metric))
        return false;
    switch (term->comparison) {
    case COMPARE_LESS:
        return value < term->number;
    case COMPARE_LESS_EQUAL:
        return value <= term->number;
    case COMPARE_GREATER:
        return value > term->number;
    default:
        return value >= term->number;
    }
}

enum condition_answer condition_evaluate(const struct condition *condition, const json_t *metrics,
                                         const char **missing)
{
    enum condition_answer answer = CONDITION_MET;
    for (size_t index = 0; index < condition->term_count; index++) {
        const struct condition_term *term = &condition->terms[index];
        const json_t *metric = json_object_get(metrics, term->metric);
        if (metric == NULL) {
            *missing = term->metric;
            return CONDITION_NO_METRIC;
        }
        if (!term_is_met(term, metric))
            answer = CONDITION_NOT_MET;
    }
    return answer;
}
