/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/check_answer.h"

#include "talus/version.h"

json_t *check_answer_error(const char *pointer, const char *code, const char *detail)
{
    return json_pack("{s:b, s:[{s:s, s:s, s:s}]}", "ok", 0, "errors", "pointer", pointer, "code",
                     code, "detail", detail);
}

/* The answer for a scene that was read. */
static json_t *answer_for(const struct talus_scene *scene, json_t *effective,
                          const struct scene_issues *warnings, int threads,
                          const json_t *calibration)
{
    struct talus_error error = {.status = TALUS_OK};
    char hash[65];
    json_t *forecast = scene_forecast(scene, threads, calibration, &error);
    if (forecast == NULL)
        return check_answer_error(error.pointer, error.code, error.text);
    scene_hash(effective, hash);
    return json_pack("{s:b, s:O, s:o, s:o, s:o, s:s, s:s}", "ok", 1, "effective", effective,
                     "forecast", forecast, "advice", scene_advice(scene), "warnings",
                     scene_issues_json(warnings), "hash", hash, "build", talus_build());
}

static json_t *finish(enum talus_status status, struct talus_scene *scene, json_t *effective,
                      struct scene_issues *issues, struct scene_issues *warnings, int threads,
                      const json_t *calibration)
{
    json_t *answer;
    if (status == TALUS_OK)
        answer = answer_for(scene, effective, warnings, threads, calibration);
    else if (status == TALUS_MEMORY)
        answer = check_answer_error("", "memory", "out of memory");
    else
        answer = json_pack("{s:b, s:o}", "ok", 0, "errors", scene_issues_json(issues));
    json_decref(effective);
    scene_issues_release(issues);
    scene_issues_release(warnings);
    talus_scene_release(scene);
    return answer;
}

json_t *check_answer(const json_t *root, int threads, const json_t *calibration)
{
    struct talus_scene scene;
    struct scene_issues issues, warnings;
    json_t *effective;
    enum talus_status status = scene_read(root, &scene, &effective, &issues, &warnings);
    return finish(status, &scene, effective, &issues, &warnings, threads, calibration);
}

json_t *check_answer_file(const char *path, int threads, const json_t *calibration)
{
    struct talus_scene scene;
    struct scene_issues issues, warnings;
    json_t *effective;
    enum talus_status status = scene_read_file(path, &scene, &effective, &issues, &warnings);
    return finish(status, &scene, effective, &issues, &warnings, threads, calibration);
}
