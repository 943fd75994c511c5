/* SPDX-License-Identifier: Apache-2.0 */
/* Time steps that are far under the critical one, above it, or will be above it. */
#include "scene/scene_advice.h"
#include "scene/scene_geometry.h"

#include "seeding/seeding.h"
#include "shapes/shape.h"

#include <math.h>
#include <stdio.h>

static double speed_of(const double velocity[3])
{
    return sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2]);
}

/* Largest speed [m/s] of any boundary, now or by its tables. */
static double boundary_speed(const struct talus_scene *scene)
{
    double fastest = 0.0;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        double largest[3];
        for (size_t k = 0; k < 3; k++) {
            const struct talus_time_table *table = &boundary->velocity_tables[k];
            largest[k] = boundary->velocity[k];
            for (size_t point = 0; point < table->count; point++)
                largest[k] = fmax(fabs(largest[k]), fabs(table->value[point]));
        }
        fastest = fmax(fastest, speed_of(largest));
    }
    return fastest;
}

/* Speed [m/s] that a fall to the end of the grid gives to what starts at `speed`, in the time of
 * the run; gravity at t = 0. */
static double fallen_speed(const struct talus_scene *scene, const struct talus_body *body,
                           double speed)
{
    double low[3], high[3], twice_work = 0.0, gravity = speed_of(scene->gravity);
    scene_body_bounds(scene, body, low, high);
    for (size_t k = 0; k < scene->axis_count; k++) {
        const double bottom = scene->grid.min[k];
        const double top = bottom + scene->grid.cell[k] * (double)scene->grid.cell_count[k];
        const double way = scene->gravity[k] < 0.0 ? high[k] - bottom : top - low[k];
        twice_work += 2.0 * fabs(scene->gravity[k]) * fmax(way, 0.0);
    }
    return fmin(sqrt(speed * speed + twice_work), speed + gravity * scene->duration);
}

/* Speed of signals now over the one when everything falls or is pushed as fast as it can be. */
static double slowest_share(const struct talus_scene *scene)
{
    double now = 0.0, later = 0.0, pushed = boundary_speed(scene);
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        const double wave = scene_wave_speed(&scene->materials[body->material_index]);
        const double speed = seeding_largest_speed(scene, body);
        now = fmax(now, wave + speed);
        later = fmax(later, wave + fmax(pushed, fallen_speed(scene, body, speed)));
    }
    return later > 0.0 ? now / later : 1.0;
}

static void advise_smaller(struct scene_advice *advice, const char *code, const char *detail)
{
    const bool fixed = advice->scene->solver.time_step > 0.0;
    const double automatic = fmin(advice->scene->solver.courant, 0.4);
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = fixed ? "/solver/time_step" : "/solver/courant",
                             .code = code,
                             .detail = detail,
                             .change = fixed ? "\"time_step\": \"auto\", or a smaller one"
                                             : "\"courant\": 0.4",
                             .saves = "a run that does not blow up",
                             .set = fixed ? json_pack("{s:s, s:f}", "/solver/time_step", "auto",
                                                      "/solver/courant", automatic)
                                          : json_pack("{s:f}", "/solver/courant", automatic),
                         });
}

static void advise_larger(struct scene_advice *advice, double share, double automatic)
{
    const struct talus_solver_options *solver = &advice->scene->solver;
    const bool fixed = solver->time_step > 0.0;
    /* A share of FLIP per step damps by the step: it would have to change with it. */
    const bool per_step = !isnan(solver->flip_ratio) && solver->flip_ratio < 1.0;
    char detail[160], change[160], saves[96];
    (void)snprintf(detail, sizeof detail, "the step is %.2g of the critical one, %.3g s", share,
                   advice->estimate->critical_time_step);
    (void)snprintf(change, sizeof change, "%s%s",
                   fixed ? "\"time_step\": \"auto\"" : "\"courant\": 0.4",
                   per_step ? ", and a pic_rate of -ln(flip_ratio) / time_step in the place of "
                              "flip_ratio"
                            : "");
    (void)snprintf(saves, sizeof saves, "a factor of %.2g in steps and wall time",
                   automatic / share);
    json_t *set = fixed ? json_pack("{s:s}", "/solver/time_step", "auto")
                        : json_pack("{s:f}", "/solver/courant", automatic);
    if (per_step) {
        json_decref(set);
        set = NULL;
    }
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = fixed ? "/solver/time_step" : "/solver/courant",
                             .code = "small_time_step",
                             .detail = detail,
                             .change = change,
                             .saves = saves,
                             .set = set,
                             .quantity = "particle_steps",
                             .factor = automatic / share,
                         });
}

void scene_advise_time_step(struct scene_advice *advice)
{
    const double enough = 0.4;      /* the default */
    const double least_steps = 100; /* fewer do not show how something moves, stable or not */
    const struct talus_estimate *estimate = advice->estimate;
    if (estimate == NULL)
        return;
    const struct talus_solver_options *solver = &advice->scene->solver;
    const bool fixed = solver->time_step > 0.0;
    const double share = estimate->time_step / estimate->critical_time_step;
    const double automatic = fixed ? solver->courant : enough;
    char detail[160];
    if (share > 1.0) {
        (void)snprintf(detail, sizeof detail,
                       "the step is %.3g times the critical one: sound outruns it", share);
        advise_smaller(advice, "over_critical", detail);
    } else if (fixed && share > slowest_share(advice->scene)) {
        (void)snprintf(detail, sizeof detail,
                       "the step is %.3g of the critical one now, and above it when the material "
                       "is as fast as its fall or its push can make it",
                       share);
        advise_smaller(advice, "critical_in_motion", detail);
    } else if (share < 0.5 * automatic * (1.0 - 1e-9) &&
               advice->scene->duration > least_steps * automatic * estimate->critical_time_step &&
               /* There the critical step itself falls with the mass of nodes that hardly carry
                * any, and the forecast does not know how far. */
               !(solver->stress_update == TALUS_STRESS_LAST &&
                 shape_table[solver->shape_index]->light_nodes)) {
        advise_larger(advice, share, automatic);
    }
}
