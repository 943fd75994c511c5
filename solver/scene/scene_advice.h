/* SPDX-License-Identifier: Apache-2.0 */
/* Advice is a list of small functions that each look for one thing. */
#ifndef TALUS_SCENE_ADVICE_H
#define TALUS_SCENE_ADVICE_H

#include "scene/scene_json.h"
#include "talus/simulation.h"

#include <stdbool.h>

struct scene_advice {
    const struct talus_scene *scene;
    const struct talus_estimate *estimate; /* NULL where the scene cannot be estimated */
    json_t *list;
};

/* Appends one item; texts are for people. `change` says what to do, `saves` what it gains. */
void scene_advise(struct scene_advice *advice, const char *pointer, const char *code,
                  const char *detail, const char *change, const char *saves);

/* Where the scene models more than it needs. */
void scene_advise_uniform(struct scene_advice *advice);
void scene_advise_revolution(struct scene_advice *advice);
void scene_advise_mirror(struct scene_advice *advice);
void scene_advise_time_step(struct scene_advice *advice);
void scene_advise_output(struct scene_advice *advice);
void scene_advise_superfluous(struct scene_advice *advice);
void scene_advise_fine_grid(struct scene_advice *advice);
/* Where it models too little. */
void scene_advise_locking(struct scene_advice *advice);
void scene_advise_particles(struct scene_advice *advice);
void scene_advise_features(struct scene_advice *advice);

#endif
