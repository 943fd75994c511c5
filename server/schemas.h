/* SPDX-License-Identifier: Apache-2.0 */
/* The bodies that operations take and answer, by name. Answers are only described here; the
 * contract tests hold what the handlers write against it. */
#ifndef TALUS_SCHEMAS_H
#define TALUS_SCHEMAS_H

#include "json_field.h"

/* low, expected, high [s] */
extern const struct json_field schema_seconds_interval[];
extern const struct json_field schema_any_object;
extern const struct json_field schema_forecast;
extern const struct json_field schema_forecast_answer;
extern const struct json_field schema_forecast_question;
extern const struct json_field schema_advice;
extern const struct json_field schema_file_list;
extern const struct json_field schema_frame_list;
extern const struct json_field schema_issue; /* a mistake, or a warning */
extern const struct json_field schema_job;
extern const struct json_field schema_job_list;
extern const struct json_field schema_job_patch;
extern const struct json_field schema_problem;
extern const struct json_field schema_series;
extern const struct json_field schema_series_list;
extern const struct json_field schema_status;
extern const struct json_field schema_readiness;
extern const struct json_field schema_study;
extern const struct json_field schema_study_forecast;
extern const struct json_field schema_study_list;
extern const struct json_field schema_study_results;
extern const struct json_field schema_study_submission;
extern const struct json_field schema_submission;
extern const struct json_field schema_version;

/* Members of answers. */
#define MEMBER(KIND, KEY, MEANING)                                                                 \
    {                                                                                              \
        .key = KEY, .kind = FIELD_##KIND, .meaning = MEANING                                       \
    }
#define MEMBER_OR_NULL(KIND, KEY, MEANING)                                                         \
    {                                                                                              \
        .key = KEY, .kind = FIELD_##KIND, .nullable = true, .meaning = MEANING                     \
    }
#define MEMBER_SOMETIMES(KIND, KEY, MEANING)                                                       \
    {                                                                                              \
        .key = KEY, .kind = FIELD_##KIND, .optional = true, .meaning = MEANING                     \
    }
#define MEMBER_END                                                                                 \
    {                                                                                              \
        .key = NULL                                                                                \
    }

#endif
