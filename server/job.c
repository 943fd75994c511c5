/* SPDX-License-Identifier: Apache-2.0 */
#include "job.h"

#include "json_text.h"

#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    bool final;
} states[JOB_STATE_COUNT] = {
#define JOB_STATE(ENUM, name, final) [JOB_##ENUM] = {#name, final},
#include "job_states.def"
#undef JOB_STATE
};

const char *const job_state_words[] = {
#define JOB_STATE(ENUM, name, final) #name,
#include "job_states.def"
#undef JOB_STATE
    NULL,
};

const char *job_state_name(enum job_state state)
{
    return states[state].name;
}

enum job_state job_state_find(const char *name)
{
    for (size_t index = 0; index < JOB_STATE_COUNT; index++) {
        if (strcmp(states[index].name, name) == 0)
            return (enum job_state)index;
    }
    return JOB_STATE_COUNT;
}

bool job_state_final(enum job_state state)
{
    return states[state].final;
}

void job_release(struct job *job)
{
    free(job->id);
#define JOB_TEXT(name) free(job->name);
#define JOB_INTEGER(name)
#define JOB_REAL(name)
#include "job_columns.def"
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL
    memset(job, 0, sizeof *job);
}

json_t *job_limits_json(const struct job *job)
{
    json_t *limits = json_object();
    if (job->wall_limit > 0)
        (void)json_object_set_new(limits, "wall_seconds", json_real(job->wall_limit));
    if (job->memory_limit > 0)
        (void)json_object_set_new(limits, "memory_bytes", json_integer(job->memory_limit));
    if (job->disk_limit > 0)
        (void)json_object_set_new(limits, "disk_bytes", json_integer(job->disk_limit));
    return limits;
}

enum talus_status job_text_set(char **text, const char *value, struct talus_error *error)
{
    char *copy = value == NULL ? NULL : strdup(value);
    if (value != NULL && copy == NULL)
        return talus_error_memory(error);
    free(*text);
    *text = copy;
    return TALUS_OK;
}

enum talus_status job_json_set(char **text, const json_t *value, struct talus_error *error)
{
    char *dump = value == NULL ? NULL : json_text(value, 0);
    if (value != NULL && dump == NULL)
        return talus_error_memory(error);
    free(*text);
    *text = dump;
    return TALUS_OK;
}
