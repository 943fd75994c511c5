/* SPDX-License-Identifier: Apache-2.0 */
/* Dynamic runs of something quasi-static: solids that are loaded so slowly, or for so long, that
 * inertia plays no part in the answer. What follows a load within its time t does so with kinetic
 * energy of about (T / t)^2 of the strain energy, T being the period of the slowest vibration. */
#include "scene/scene_advice.h"
#include "scene/scene_geometry.h"
#include "scene/scene_loading.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Periods that a load has to take for inertia to be worth less than a hundredth: (1/20)^2 while it
 * grows steadily, 1 / (20 pi) at the kink where it starts. */
static const double slow_periods = 20.0;
static const double gain_min = 4.0; /* below it nobody is told */

/* ---- loads that grow slowly: the same in less time ---- */

/* By how much the process may be faster. */
static double possible_gain(const struct scene_loading *loading)
{
    double gain = loading->load_time / (slow_periods * loading->period);
    if (loading->push_speed > 0.0)
        gain = fmin(gain, loading->push_speed_max / loading->push_speed);
    return gain;
}

/* Velocities that are plain numbers can be scaled for the user; tables cannot. */
static json_t *faster(const struct talus_scene *scene, double gain)
{
    bool plain = scene->reference_count == 0;
    json_t *set = json_pack("{s:f, s:f, s:f}", "/duration", scene->duration / gain,
                            "/output/frames/every", scene->output.frames_every / gain,
                            "/output/history/every", scene->output.history_every / gain);
    for (size_t index = 0; index < scene->probe_count; index++)
        plain = plain && isnan(scene->probes[index].mean_from);
    for (size_t index = 0; index < scene->boundary_count && plain; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        char pointer[64];
        if (boundary->prescribed == 0)
            continue;
        json_t *velocity = json_array();
        for (size_t k = 0; k < scene->axis_count; k++) {
            plain = plain && boundary->velocity_tables[k].count == 0;
            (void)json_array_append_new(velocity, json_real(gain * boundary->velocity[k]));
        }
        (void)snprintf(pointer, sizeof pointer, "/boundaries/%zu/velocity", index);
        (void)json_object_set_new(set, pointer, velocity);
    }
    if (plain && !scene_loading_has_tables(scene) && scene->solver.force_ramp == 0.0)
        return set;
    json_decref(set);
    return NULL;
}

static void advise_faster(struct scene_advice *advice, const struct scene_loading *loading)
{
    const double gain = possible_gain(loading);
    char detail[192], change[192], saves[64];
    if (gain < gain_min)
        return;
    (void)snprintf(
        detail, sizeof detail,
        "loads grow over %.3g s, %.0f periods of the slowest vibration (%.2g s): inertia "
        "plays no part",
        loading->load_time, loading->load_time / loading->period, loading->period);
    (void)snprintf(change, sizeof change,
                   "everything %.2g times as fast: velocities of boundaries, times of tables, "
                   "ramps, \"duration\": %.3g and the intervals of outputs",
                   gain, advice->scene->duration / gain);
    (void)snprintf(saves, sizeof saves, "a factor of %.2g in steps and wall time", gain);
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/duration",
                             .code = "quasi_static",
                             .detail = detail,
                             .change = change,
                             .saves = saves,
                             .set = faster(advice->scene, gain),
                             .quantity = "particle_steps",
                             .factor = gain,
                         });
}

/* ---- loads that are there at once, for long: rest is reached sooner ---- */

/* Twice the angular frequency damps the slowest vibration critically; it falls by exp(-2 pi) a
 * period, and faster ones by the same if the period is taken too long. `local_damping` does as
 * well, but costs a pass over all particles, and goes on after t = 0. */
static const double settle_periods = 5.0;
static const double rest_periods = 1.0;
static const double long_periods = 50.0; /* fewer may be a vibration that is the aim */

static void advise_rest(struct scene_advice *advice, const struct scene_loading *loading)
{
    const double periods = advice->scene->duration / loading->period;
    const double gain = periods / (settle_periods + rest_periods);
    const double settle = settle_periods * loading->period, rest = rest_periods * loading->period;
    const double damping = 4.0 * 3.14159265358979323846 / loading->period;
    char detail[192], change[224], saves[96];
    if (periods < long_periods)
        return;
    (void)snprintf(
        detail, sizeof detail,
        "a constant load for %.0f periods of the slowest vibration (%.2g s), which never "
        "comes to rest",
        periods, loading->period);
    (void)snprintf(change, sizeof change,
                   "if rest is the aim: \"stabilise\": {\"settle\": {\"time\": %.3g, \"damping\": "
                   "%.3g}}, \"duration\": %.3g (displacements count from rest on)",
                   settle, damping, rest);
    (void)snprintf(saves, sizeof saves,
                   "a factor of %.2g in steps and wall time, and forces that do not ring", gain);
    scene_advise(advice,
                 &(struct scene_advice_item){
                     .pointer = "/duration",
                     .code = "quasi_static",
                     .detail = detail,
                     .change = change,
                     .saves = saves,
                     .set = json_pack("{s:f, s:f, s:f, s:f, s:f}", "/duration", rest,
                                      "/solver/stabilise/settle/time", settle,
                                      "/solver/stabilise/settle/damping", damping,
                                      "/output/frames/every", 0.0, "/output/history/every",
                                      fmin(advice->scene->output.history_every, 0.1 * rest)),
                     .quantity = "particle_steps",
                     .factor = gain,
                 });
}

void scene_advise_quasi_static(struct scene_advice *advice)
{
    struct scene_loading loading;
    scene_loading_init(&loading, advice->scene);
    if (loading.kind == SCENE_LOADING_SLOW)
        advise_faster(advice, &loading);
    if (loading.kind == SCENE_LOADING_CONSTANT)
        advise_rest(advice, &loading);
}
