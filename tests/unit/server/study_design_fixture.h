/* SPDX-License-Identifier: Apache-2.0 */
/* A scene, designs as texts, and what their readers make of them. */
#ifndef TALUS_STUDY_DESIGN_FIXTURE_H
#define TALUS_STUDY_DESIGN_FIXTURE_H

#include "server_fixture.h"
#include "study_design.h"

/* The scene that designs change. */
extern const char design_scene[];

#define GRID(PARAMETERS, SET) "{\"grid\":{\"parameters\":" PARAMETERS ",\"set\":" SET "}}"

#define SAMPLE(KEYS, RANGE) "{\"sample\":{" KEYS ",\"parameters\":{\"/duration\":{" RANGE "}}}}"
#define SOBOL "\"method\":\"sobol\",\"count\":4"

#define COMPARE(VARIANTS, RESOLUTIONS, MORE)                                                       \
    "{\"work_precision\":{\"variants\":" VARIANTS ",\"resolutions\":" RESOLUTIONS MORE "}}"
#define ONE "[{\"label\":\"a\",\"set\":{\"/duration\":1}}]"
#define OTHER "[{\"label\":\"b\",\"set\":{\"/grid/cell\":1}}]"
#define TIP ",\"error\":\"error.tip\""

#define BISECT(PARAMETER, LOW, HIGH, TOLERANCE, CONDITION)                                         \
    "{\"bisect\":{\"parameter\":" PARAMETER ",\"low\":" LOW ",\"high\":" HIGH                      \
    ",\"tolerance\":" TOLERANCE ",\"condition\":" CONDITION "}}"

/* A JSON text that is one, new reference. */
json_t *design_parse(const char *text);
/* The plan that a good design makes; study_plan_release it. */
struct study_plan design_plan(const char *text);
/* Expects one mistake of a design, with this pointer and code, and a part of its text. */
void design_expect(const char *text, const char *pointer, const char *code, const char *part);
/* Expects a value to be what a text says. */
void design_expect_json(const json_t *value, const char *text);

#endif
