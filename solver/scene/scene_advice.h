/* SPDX-License-Identifier: Apache-2.0 */
/* Advice is a list of small functions that each look for one thing. Their codes are documented in
 * docs/scene.md. An item that is wrong is worse than one that is missing: what cannot be judged
 * from the scene alone is left alone. */
#ifndef TALUS_SCENE_ADVICE_H
#define TALUS_SCENE_ADVICE_H

#include "scene/scene_json.h"
#include "talus/simulation.h"

#include <stdbool.h>

struct scene_advice {
    const struct talus_scene *scene;
    const struct talus_estimate *estimate; /* NULL where the scene cannot be estimated */
    unsigned settled_axes; /* bit set of the axes that an item has already told to leave out */
    json_t *list;
};

/* Texts are for people; what follows them is for programs. */
struct scene_advice_item {
    const char *pointer, *code;
    const char *detail; /* what was found */
    const char *change; /* what to do */
    const char *saves;  /* what that gains */
    json_t *set;        /* {JSON Pointer into the effective scene: value} that does it; stolen; NULL
                           where it takes more than values */
    const char *quantity; /* of what it saves: "particle_steps", "disk_bytes"; NULL: not a cost */
    double factor;        /* by which that shrinks */
};

/* Appends one item. */
void scene_advise(struct scene_advice *advice, const struct scene_advice_item *item);

/* Where the scene models more than it needs. Uniform and revolution before mirror. */
void scene_advise_uniform(struct scene_advice *advice);
void scene_advise_revolution(struct scene_advice *advice);
void scene_advise_mirror(struct scene_advice *advice);
void scene_advise_quasi_static(struct scene_advice *advice);
void scene_advise_time_step(struct scene_advice *advice);
void scene_advise_frames(struct scene_advice *advice);
void scene_advise_history(struct scene_advice *advice);
void scene_advise_checkpoints(struct scene_advice *advice);
void scene_advise_superfluous(struct scene_advice *advice);
void scene_advise_fine_grid(struct scene_advice *advice);
/* Where it models too little, or wrongly. */
void scene_advise_locking(struct scene_advice *advice);
void scene_advise_averaging(struct scene_advice *advice);
void scene_advise_particles(struct scene_advice *advice);
void scene_advise_coarse_grid(struct scene_advice *advice);

#endif
