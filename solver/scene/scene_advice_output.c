/* SPDX-License-Identifier: Apache-2.0 */
/* Outputs finer than the eye, the time step or the disk. */
#include "scene/scene_advice.h"
#include "scene/scene_output_size.h"

#include <math.h>
#include <stdio.h>

static const double large = 10e9;    /* [bytes] that nobody moves or opens without need */
static const double moderate = 1e9;  /* [bytes] that are still handy */
static const double notable = 100e6; /* [bytes] below which the form of numbers does not matter */

/* Fewer frames, `every` seconds. */
static void advise_frames(struct scene_advice *advice, const char *code, const char *detail,
                          double every)
{
    const struct talus_scene *scene = advice->scene;
    const double count = scene->duration / scene->output.frames_every + 1.0;
    const double factor = count / (scene->duration / every + 1.0);
    char change[96], saves[96];
    (void)snprintf(change, sizeof change, "\"every\": %.3g", every);
    (void)snprintf(saves, sizeof saves, "%.3g %% of the disk space of frames",
                   100.0 * (1.0 - 1.0 / factor));
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/output/frames/every",
                             .code = code,
                             .detail = detail,
                             .change = change,
                             .saves = saves,
                             .set = json_pack("{s:f}", "/output/frames/every", every),
                             .quantity = "frames",
                             .factor = factor,
                         });
}

static void advise_double(struct scene_advice *advice, double bytes)
{
    struct talus_scene single = *advice->scene;
    single.output.frame_double = false;
    const double factor = bytes / scene_output_size(&single, advice->estimate).frame_bytes;
    char detail[160], saves[96];
    (void)snprintf(detail, sizeof detail,
                   "frames of %.2g GB in double precision: pictures need six digits at most",
                   1e-9 * bytes);
    (void)snprintf(saves, sizeof saves, "%.2g %% of the disk space of frames",
                   100.0 * (1.0 - 1.0 / factor));
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/output/frames/precision",
                             .code = "double_frames",
                             .detail = detail,
                             .change = "\"precision\": \"single\"",
                             .saves = saves,
                             .set = json_pack("{s:s}", "/output/frames/precision", "single"),
                             .quantity = "disk_bytes",
                             .factor = factor,
                         });
}

void scene_advise_frames(struct scene_advice *advice)
{
    const double most = 500.0, enough = 100.0;
    const struct talus_scene *scene = advice->scene;
    const double every = scene->output.frames_every;
    char detail[160];
    if (advice->estimate == NULL)
        return;
    const double count = every > 0.0 ? scene->duration / every + 1.0 : 2.0;
    const double bytes = scene_output_size(scene, advice->estimate).frame_bytes;
    if (count > most) {
        (void)snprintf(detail, sizeof detail, "%.0f frames are more than anyone looks at", count);
        advise_frames(advice, "many_frames", detail, scene->duration / enough);
    } else if (bytes > large && count > 12.0) {
        (void)snprintf(detail, sizeof detail, "%.0f frames of %.2g GB together", count,
                       1e-9 * bytes);
        advise_frames(advice, "large_frames", detail,
                      scene->duration / fmax(10.0, floor(count * moderate / bytes)));
    }
    if (scene->output.frame_double && bytes > notable)
        advise_double(advice, bytes);
}

void scene_advise_history(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    const double few = 1000.0; /* rows that cost nothing */
    const double every = scene->output.history_every;
    double larger = every;
    char detail[160], change[96], saves[96];
    if (advice->estimate == NULL || (double)advice->estimate->step_count < few)
        return;
    const double step = advice->estimate->time_step;
    const double bytes = scene_output_size(scene, advice->estimate).history_bytes;
    if (every < step) {
        (void)snprintf(detail, sizeof detail,
                       "samples every %.3g s are closer than the time step of %.3g s", every, step);
        larger = 10.0 * step;
    } else if (bytes > moderate) {
        (void)snprintf(detail, sizeof detail, "%.3g rows of %.2g GB together",
                       scene->duration / every, 1e-9 * bytes);
        larger = every * bytes / notable;
    }
    if (larger <= every)
        return;
    const double factor = larger / fmax(every, step);
    (void)snprintf(change, sizeof change, "\"every\": %.3g", larger);
    (void)snprintf(saves, sizeof saves,
                   "%.3g %% of the rows (forces are means over the interval: no impulse is lost)",
                   100.0 * (1.0 - 1.0 / factor));
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/output/history/every",
                             .code = "fine_history",
                             .detail = detail,
                             .change = change,
                             .saves = saves,
                             .set = json_pack("{s:f}", "/output/history/every", larger),
                             .quantity = "history_rows",
                             .factor = factor,
                         });
}

void scene_advise_checkpoints(struct scene_advice *advice)
{
    const double byte_rate = 50e6; /* [bytes/s] written, compressed and synchronised */
    const double most = 0.1;       /* of the time of the run */
    const double seconds = 60.0;   /* the default */
    const double every = advice->scene->output.checkpoint_every;
    char detail[160];
    if (advice->estimate == NULL || every <= 0.0 || every >= seconds)
        return;
    const double bytes =
        (double)advice->estimate->particle_count * (double)advice->estimate->bytes_per_particle;
    if (bytes / byte_rate <= most * every)
        return;
    (void)snprintf(detail, sizeof detail,
                   "restart points of %.2g GB every %.2g s are written for %.0f %% of the run",
                   1e-9 * bytes, every, fmin(100.0, 100.0 * bytes / byte_rate / every));
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/output/checkpoints/every",
                             .code = "frequent_checkpoints",
                             .detail = detail,
                             .change = "\"every\": 60",
                             .saves = "a disk that is busy; a crash costs a minute at most",
                             .set = json_pack("{s:f}", "/output/checkpoints/every", seconds),
                             .quantity = "checkpoints",
                             .factor = seconds / every,
                         });
}
