/* SPDX-License-Identifier: Apache-2.0 */
/* The scene of a measurement, read by the reader of scenes, so with everybody's defaults. */
#ifndef BENCHMARK_SCENE_H
#define BENCHMARK_SCENE_H

#include "benchmark_case.h"
#include "talus/scene.h"

struct benchmark_scene {
    struct talus_scene scene;
    double develop_time; /* [s] to run up before the measurement */
};

/* On failure prints why and returns false; otherwise the caller releases it. */
bool benchmark_scene_create(const struct benchmark_setup *setup, struct benchmark_scene *made);
void benchmark_scene_release(struct benchmark_scene *made);

#endif
