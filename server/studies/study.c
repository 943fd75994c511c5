/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study.h"

#include "json_text.h"

#include <stdlib.h>
#include <string.h>

const char *const study_state_words[] = {
#define STUDY_STATE(ENUM, name) [STUDY_##ENUM] = #name,
#include "study_states.def"
#undef STUDY_STATE
    [STUDY_STATE_COUNT] = NULL,
};

const char *const row_state_words[] = {
#define ROW_STATE(ENUM, name) [ROW_##ENUM] = #name,
#include "row_states.def"
#undef ROW_STATE
    [ROW_STATE_COUNT] = NULL,
};

const char *study_state_name(enum study_state state)
{
    return study_state_words[state];
}

enum study_state study_state_find(const char *name)
{
    for (size_t index = 0; index < STUDY_STATE_COUNT; index++) {
        if (strcmp(study_state_words[index], name) == 0)
            return (enum study_state)index;
    }
    return STUDY_STATE_COUNT;
}

const char *study_kind_name(enum study_kind kind)
{
    static const char *const names[] = {
        [STUDY_GRID] = "grid",     [STUDY_LIST] = "list",
        [STUDY_SAMPLE] = "sample", [STUDY_WORK_PRECISION] = "work_precision",
        [STUDY_BISECT] = "bisect",
    };
    return names[kind];
}

const char *row_state_name(enum row_state state)
{
    return row_state_words[state];
}

enum row_state row_state_of_job(enum job_state state)
{
    static const enum row_state states[JOB_STATE_COUNT] = {
        [JOB_QUEUED] = ROW_QUEUED, [JOB_RUNNING] = ROW_RUNNING,     [JOB_SUCCEEDED] = ROW_SUCCEEDED,
        [JOB_FAILED] = ROW_FAILED, [JOB_CANCELLED] = ROW_CANCELLED,
    };
    return states[state];
}

int64_t study_active_count(const struct study *study)
{
    return study->counts[ROW_QUEUED] + study->counts[ROW_RUNNING];
}

int64_t study_ended_count(const struct study *study)
{
    return study->counts[ROW_SUCCEEDED] + study->counts[ROW_FAILED] + study->counts[ROW_CANCELLED];
}

void study_release(struct study *study)
{
    free(study->id);
#define STUDY_TEXT(name) free(study->name);
#define STUDY_LONG_TEXT(name) free(study->name);
#define STUDY_INTEGER(name)
#include "study_columns.def"
#undef STUDY_TEXT
#undef STUDY_LONG_TEXT
#undef STUDY_INTEGER
    memset(study, 0, sizeof *study);
}

char *study_metrics_pick(const char *wanted, const char *metrics)
{
    json_t *names = wanted == NULL ? NULL : json_loads(wanted, 0, NULL);
    json_t *all = metrics == NULL ? NULL : json_loads(metrics, 0, NULL);
    json_t *picked = all == NULL ? NULL : json_object();
    size_t index;
    const json_t *name;
    json_array_foreach(names, index, name)
    {
        json_t *value = json_object_get(all, json_string_value(name));
        if (picked != NULL && value != NULL)
            (void)json_object_set(picked, json_string_value(name), value);
    }
    char *text = picked == NULL ? NULL : json_text(picked, 0);
    json_decref(picked);
    json_decref(all);
    json_decref(names);
    return text;
}
