/* SPDX-License-Identifier: Apache-2.0 */
/* Studies as the server describes them, in words. */
#ifndef TALUS_STUDY_TEXT_H
#define TALUS_STUDY_TEXT_H

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

/* "running  12 of 60 rows (1 failed, 3 reused), 2 run, 4 min 10 s left" */
void study_format(const json_t *study, char *text, size_t size);
/* One line of a list. */
void study_print_line(FILE *stream, const json_t *study);
/* Everything about one study, over several lines. */
void study_print(FILE *stream, const json_t *study);
/* What a study would take, from a study or a forecast. */
void study_print_forecast(FILE *stream, const json_t *study);
/* What is left to say when it has ended. */
void study_print_result(FILE *stream, const json_t *study);
/* The table of results, in columns. */
void study_print_table(FILE *stream, const json_t *results);
/* EXIT_DONE for `finished`, else EXIT_JOB_FAILED. */
int study_exit_code(const json_t *study);

#endif
