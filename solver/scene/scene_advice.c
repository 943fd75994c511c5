/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_advice.h"

void scene_advise(struct scene_advice *advice, const struct scene_advice_item *item)
{
    json_t *entry =
        json_pack("{s:s, s:s, s:s, s:s, s:s}", "pointer", item->pointer, "code", item->code,
                  "detail", item->detail, "change", item->change, "saves", item->saves);
    if (item->set != NULL)
        (void)json_object_set_new(entry, "set", item->set);
    if (item->quantity != NULL)
        (void)json_object_set_new(entry, "saving",
                                  json_pack("{s:f}", item->quantity, item->factor));
    (void)json_array_append_new(advice->list, entry);
}

json_t *scene_advice(const struct talus_scene *scene)
{
    static void (*const advisers[])(struct scene_advice *) = {
        scene_advise_uniform,   scene_advise_revolution,   scene_advise_mirror,
        scene_advise_time_step, scene_advise_quasi_static, scene_advise_frames,
        scene_advise_history,   scene_advise_checkpoints,  scene_advise_superfluous,
        scene_advise_fine_grid, scene_advise_locking,      scene_advise_averaging,
        scene_advise_particles, scene_advise_coarse_grid,
    };
    struct talus_estimate estimate;
    struct talus_error error = {.status = TALUS_OK};
    bool estimated = talus_simulation_estimate(scene, &estimate, &error) == TALUS_OK;
    struct scene_advice advice = {
        .scene = scene, .estimate = estimated ? &estimate : NULL, .list = json_array()};
    for (size_t index = 0; index < sizeof advisers / sizeof advisers[0]; index++)
        advisers[index](&advice);
    return advice.list;
}
