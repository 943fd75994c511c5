/* SPDX-License-Identifier: Apache-2.0 */
/* Processor and wall time of a run by a table of rates (cost_rates.def), measured once on one
 * machine; scene_calibration.h corrects it by what this machine has been seen to take. */
#ifndef TALUS_SCENE_COST_H
#define TALUS_SCENE_COST_H

#include "scene/scene_output_size.h"

/* Processor time is fixed + steps x step + particle steps x particle_step, all threads together. */
struct scene_cost {
    double fixed;         /* [s]: start, frames, rows, tables */
    double step;          /* [s] */
    double particle_step; /* [s] */
    double threads;       /* that the steps use */
    double background;    /* [s] part of `fixed` that goes on beside the steps */
    double files;         /* that are written and flushed */
};

struct scene_cost scene_cost_make(const struct talus_scene *scene,
                                  const struct talus_estimate *estimate,
                                  const struct scene_output_size *output, int threads);
/* Of the whole run [s]. */
double scene_cost_cpu(const struct scene_cost *cost, double steps, double particle_steps);
/* The same by the clock, where nobody else wants a core. */
double scene_cost_wall(const struct scene_cost *cost, double steps, double particle_steps);

/* Whether the run, with so many steps, does little but write files, each of which waits for the
 * disk. */
bool scene_cost_is_files(const struct scene_cost *cost, double steps, double particle_steps);

/* What a scene is called where costs are learned, from the very method to all runs of a processor:
 * the same name, the same cost but for what the rates know. */
enum { COST_LEVEL_COUNT = 3, COST_KEY_SIZE = 200 };
struct scene_cost_keys {
    char level[COST_LEVEL_COUNT][COST_KEY_SIZE]; /* the most special one first */
};
void scene_cost_keys_make(const struct talus_scene *scene, int threads,
                          struct scene_cost_keys *keys);

/* A line of cost_rates.def by kind and name, or that kind's DEFAULT; false if it is the latter. */
bool scene_cost_rate_known(const char *kind, const char *name);

#endif
