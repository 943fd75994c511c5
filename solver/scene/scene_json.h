/* SPDX-License-Identifier: Apache-2.0 */
/* Between a scene as JSON and a scene as C data; with solver/output's metadata and the worker the
 * only place that knows jansson. */
#ifndef TALUS_SCENE_JSON_H
#define TALUS_SCENE_JSON_H

#include "talus/scene.h"
#include "talus/status.h"

#include <jansson.h>

/* One mistake in a scene. `given` and `allowed` are owned references or NULL. */
struct scene_issue {
    char pointer[256]; /* JSON Pointer into the scene; names the key even when it is missing */
    char code[32]; /* type, range, required, unknown_key, unknown_value, contradiction, unsupported,
                      ... */
    char detail[512];
    json_t *given, *allowed;
};
struct scene_issues {
    struct scene_issue *items;
    size_t count, capacity;
};
enum { SCENE_ISSUE_MAX = 50 };
void scene_issues_release(struct scene_issues *issues);
/* [{"pointer","code","detail","given","allowed"}]; new reference. */
json_t *scene_issues_json(const struct scene_issues *issues);

/* Reads and validates a scene, all mistakes at once. On TALUS_OK *scene is filled (release it) and
 * *effective is a new reference: the scene with every default filled in. Warnings (snapped
 * boundaries, inadmissible K0, ...) go to *warnings in the same form. */
TALUS_MUST_CHECK enum talus_status scene_read(const json_t *root, struct talus_scene *scene,
                                              json_t **effective, struct scene_issues *issues,
                                              struct scene_issues *warnings);
/* The same from a file; a text that is not JSON is one issue with line and column. */
TALUS_MUST_CHECK enum talus_status scene_read_file(const char *path, struct talus_scene *scene,
                                                   json_t **effective, struct scene_issues *issues,
                                                   struct scene_issues *warnings);

/* {"particles","active_cells","critical_time_step","time_step","steps","memory_bytes","bytes_per_particle",
 *  "disk_bytes","bodies":[{"name","particles","volume","volume_factor"}],"threads",
 *  "wall_seconds":{"low","expected","high"},"cpu_seconds",
 *  "intervals":{"steps"|"memory_bytes"|"disk_bytes":{"low","expected","high"}},
 *  "learn":{"names":[],"cpu_seconds":{"fixed","steps","particle_steps"},"wall_name","wall_over_cpu"}};
 * `disk_bytes` is what the folder does not exceed while the run lasts, its restart point included;
 * the interval is of the finished run's. `calibration` (or NULL) as in scene_calibration.h.
 * NULL with *error set (over-critical step, ...). */
json_t *scene_forecast(const struct talus_scene *scene, int threads, const json_t *calibration,
                       struct talus_error *error);
/* [{"pointer","code","detail","change","saves"}]. */
json_t *scene_advice(const struct talus_scene *scene);
/* Every model, shape, boundary, probe, field and parameter with units and bounds. */
json_t *scene_describe(void);
/* JSON Schema (2020-12) of a scene, generated from the same tables. */
json_t *scene_schema(void);
/* SHA-256 (hex, 64 characters and NUL) of the canonical effective scene without its title. */
void scene_hash(const json_t *effective, char hash[65]);

#endif
