/* SPDX-License-Identifier: Apache-2.0 */
/* What the material tests share: models by their keys, batches of any size, paths of a point. */
#ifndef MATERIAL_FIXTURE_H
#define MATERIAL_FIXTURE_H

#include "materials/material.h"
#include "materials/material_point.h"
#include "math/tensor.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct setting {
    const char *key;
    double value;
};

struct fixture { /* a prepared model */
    const struct material *material;
    double values[MATERIAL_PARAMETER_MAX];
    void *constants;
};

/* Defaults, then the settings; a default gives way to an alternative that is set. Fails the test if
 * a key is unknown. */
void values_set(const struct material *material, const struct setting *settings, size_t count,
                double values[MATERIAL_PARAMETER_MAX]);
/* The model by name, checked and prepared. */
void fixture_init(struct fixture *fixture, const char *name, const struct setting *settings,
                  size_t count);
/* A model of the table with parameters that bring all of it into play (K = 5e6, G = 3e6 Pa and
 * strengths of a few kPa); fails the test for a model that it does not know. */
void fixture_init_sample(struct fixture *fixture, const struct material *material);
void fixture_release(struct fixture *fixture);

struct slots { /* a batch and its arrays, zeroed with volume_ratio 1 */
    struct material_batch batch;
    real *memory;
    real *rate[SYM3_COMPONENTS];
    real *spin[3];
    real *volume_ratio;
    real *history[16];
};

void slots_init(struct slots *slots, size_t count, size_t component_count);
void slots_release(struct slots *slots);

/* Uniform in [-1, 1). */
double random_value(uint64_t *state);

/* I1 and |s| of a tensor in the arrays. */
double slots_trace(real *const arrays[SYM3_COMPONENTS], size_t slot, size_t component_count);
double slots_deviator_norm(real *const arrays[SYM3_COMPONENTS], size_t slot,
                           size_t component_count);

/* A tensor of one slot of component arrays (all six). */
struct sym3 slots_get(real *const arrays[SYM3_COMPONENTS], size_t slot);
void slots_set(real *const arrays[SYM3_COMPONENTS], size_t slot, struct sym3 tensor);
/* Index of the first component of a symmetric tensor in the history of a model, or -1. */
int find_tensor_state(const struct material *material);
struct mat3 random_rotation(uint64_t *state);

struct record { /* the steps of a path */
    struct material_point_step *steps;
    double (*history)[16];
    size_t count, capacity;
    size_t state_count;
};

/* Runs a path and keeps every step; fails the test if it does not converge. */
void record_run(struct record *record, const struct fixture *fixture, bool finite_strain,
                const double initial_stress[SYM3_COMPONENTS],
                const struct material_point_segment *path, size_t segment_count);
void record_release(struct record *record);

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

#endif
