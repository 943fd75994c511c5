/* SPDX-License-Identifier: Apache-2.0 */
/* What is measured: the cases, and the scene of one measurement. */
#ifndef BENCHMARK_CASE_H
#define BENCHMARK_CASE_H

#include "talus/scene.h"

#include <stdbool.h>
#include <stddef.h>

/* Bodies of one measurement. Cells are cubes of 1/16 m, so that bodies lie on grid lines. */
enum benchmark_body {
    BENCHMARK_COMPACT, /* a free box, strained by a smooth field of velocities (benchmark_motion.h)
                        */
    BENCHMARK_FLOW,    /* a column that has collapsed under gravity and is still flowing */
    BENCHMARK_BODY_COUNT
};

struct benchmark_case {
    const char *name;
    size_t axis_count;
    const char *material;      /* JSON of the material of the compact body */
    const char *flow_material; /* the same, weak enough to flow */
    size_t per_axis;           /* particles per cell and axis */
    bool plastic;              /* must dissipate */
};

extern const struct benchmark_case benchmark_cases[];
extern const size_t benchmark_case_count;
/* The case of that name, or NULL. */
const struct benchmark_case *benchmark_case_find(const char *name);
const char *benchmark_body_name(enum benchmark_body body);

/* One measurement. */
struct benchmark_setup {
    const struct benchmark_case *subject;
    enum benchmark_body body;
    size_t particles; /* about so many: whole cells, a multiple of the lane count along x */
    size_t per_axis;  /* particles per cell and axis */
    int threads;
    bool last;            /* stress_update "last", otherwise "modified_last" */
    bool cell;            /* cell volumetric anti-locking */
    double domain_factor; /* cells of the grid over cells of the body, at least */
    bool tracked;         /* also stores total and plastic strain, to look at them */
};

/* The scene of a setup, through the reader of scenes, with its defaults. On failure prints why and
 * returns false; otherwise the caller releases the scene. */
bool benchmark_scene(const struct benchmark_setup *setup, struct talus_scene *scene);

#endif
