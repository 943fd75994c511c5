/* SPDX-License-Identifier: Apache-2.0 */
/* Drives one material point along a path with mixed strain and stress control:
 * what `talus-worker point` and the material tests run. */
#ifndef TALUS_MATERIAL_POINT_H
#define TALUS_MATERIAL_POINT_H

#include "materials/material.h"

struct material_point_segment {
    bool strain_given[SYM3_COMPONENTS];
    bool stress_given[SYM3_COMPONENTS];
    double strain[SYM3_COMPONENTS]; /* [1] reached at the end of the segment, linearly */
    double stress[SYM3_COMPONENTS]; /* [Pa] Cauchy */
    bool gradient_given;
    double gradient[9]; /* F at the end, row-major (finite strain) */
    size_t step_count;
};

struct material_point_step { /* what one step gives to `emit` */
    size_t step;
    double strain[SYM3_COMPONENTS]; /* total strain; finite: integrated stretching without spin */
    double stress[SYM3_COMPONENTS]; /* Cauchy [Pa] */
    double p, q;                    /* mean stress, sqrt(3/2)|s| [Pa] */
    double volumetric_strain;
    double plastic_strain; /* accumulated norm */
    const double *history; /* [state_count] */
    int iterations;        /* of the mixed control */
};

/* Runs the path; emit() is called after each step (and once at the start, step 0).
 * TALUS_UNSTABLE if the stress iteration does not converge (pointer "/path/N"). */
TALUS_MUST_CHECK enum talus_status
material_point_run(const struct material *material, const double *values, bool finite_strain,
                   const double initial_stress[SYM3_COMPONENTS],
                   const struct material_point_segment *path, size_t segment_count,
                   void (*emit)(void *context, const struct material_point_step *step),
                   void *context, struct talus_error *error);

#endif
