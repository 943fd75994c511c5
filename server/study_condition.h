/* SPDX-License-Identifier: Apache-2.0 */
/* "METRIC < NUMBER && METRIC >= NUMBER": comparisons of metrics of a job, joined by "and". */
#ifndef TALUS_STUDY_CONDITION_H
#define TALUS_STUDY_CONDITION_H

#include "expression.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

enum { CONDITION_TERM_MAX = 16, CONDITION_METRIC_SIZE = 192 };

enum comparison { COMPARE_LESS, COMPARE_LESS_EQUAL, COMPARE_GREATER, COMPARE_GREATER_EQUAL };

struct condition {
    size_t term_count;
    struct condition_term {
        char metric[CONDITION_METRIC_SIZE];
        enum comparison comparison;
        double number;
    } terms[CONDITION_TERM_MAX];
};

/* Reads a condition; false with the place and the text of the mistake. */
bool condition_read(const char *text, struct condition *condition,
                    struct expression_mistake *mistake);

enum condition_answer { CONDITION_MET, CONDITION_NOT_MET, CONDITION_NO_METRIC };

/* Evaluates the condition with the metrics of a job that succeeded: an object of numbers. A metric
 * that is null (not a number) meets nothing. CONDITION_NO_METRIC, with *missing (borrowed from the
 * condition), where a metric is not there at all: the condition asks for what the scene does not
 * measure. */
enum condition_answer condition_evaluate(const struct condition *condition, const json_t *metrics,
                                         const char **missing);

#endif
