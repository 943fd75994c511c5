/* SPDX-License-Identifier: Apache-2.0 */
/* What a route takes and answers: one `const struct operation operation_HANDLER` beside each
 * handler. The daemon refuses what it does not list, and the OpenAPI document is made of it. */
#ifndef TALUS_OPERATION_H
#define TALUS_OPERATION_H

#include "json_field.h"

/* One answer of a kind that is no problem. */
struct response {
    unsigned int status;             /* 0 ends a list */
    const char *type;                /* media type, NULL: no body */
    const struct json_field *schema; /* NULL: not JSON */
    const char *const *headers;      /* names out of response_headers.def, or NULL */
    const char *meaning;
};

/* Lists end with a key of NULL, a status of 0; NULL is an empty list. */
struct operation {
    const char *summary;
    const struct json_field *path;  /* what the wildcards of the route stand for, in order */
    const struct json_field *query; /* offset is not used; numbers that are missing are `preset` */
    const struct json_field
        *headers;                  /* of the request, beside those that HTTP itself gives sense */
    const struct json_field *body; /* NULL: none, or an empty object */
    const struct response *responses;
    /* Statuses of problems beside those that any call can have: 400, 401, 403, 414, 422, 431, 503;
     * with a path parameter 404; with a body 413, 415. */
    const unsigned int *problems;
};

#define OPERATION_END                                                                              \
    {                                                                                              \
        .key = NULL                                                                                \
    }
#define RESPONSE_END                                                                               \
    {                                                                                              \
        .status = 0                                                                                \
    }

extern const struct json_field operation_job_path[]; /* the path of a job: its id */

#endif
