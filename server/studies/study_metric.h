/* SPDX-License-Identifier: Apache-2.0 */
/* Names of metrics, so that a misspelt one is refused instead of leaving a column empty. */
#ifndef TALUS_STUDY_METRIC_H
#define TALUS_STUDY_METRIC_H

#include <jansson.h>
#include <stdbool.h>

/* Whether a name has the form of a metric, whatever the scene. */
bool study_metric_like(const char *name);
/* Checks a name against an effective scene, and adds an issue at `pointer` if no job of that scene
 * has such a metric. Without a scene (NULL) only the form is checked. */
void study_metric_check(const char *name, const json_t *effective, const char *pointer,
                        json_t *errors);

#endif
