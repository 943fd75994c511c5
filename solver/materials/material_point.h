/* SPDX-License-Identifier: Apache-2.0 */
/* Drives one material point along a path with mixed strain and stress control: what `talus-worker
 * point` and the material tests run. */
#ifndef TALUS_MATERIAL_POINT_H
#define TALUS_MATERIAL_POINT_H

#include "materials/material.h"

/* Values are reached at the end of the segment, linearly from where it starts; a component given in
 * neither keeps its strain. */
struct material_point_segment {
    bool strain_given[SYM3_COMPONENTS];
    bool stress_given[SYM3_COMPONENTS];
    double strain[SYM3_COMPONENTS]; /* total strain [1] */
    double stress[SYM3_COMPONENTS]; /* Cauchy [Pa] */
    bool gradient_given;            /* finite strain only; excludes all of the above */
    double gradient[9];             /* F, row-major */
    double duration;                /* [s], above 0; counts for viscous models only */
    size_t step_count;              /* at least 1 */
};

struct material_point_step {        /* what one step gives to `emit` */
    size_t step;                    /* over the whole path; 0: the initial state */
    double strain[SYM3_COMPONENTS]; /* total strain; finite: integrated stretching */
    double stress[SYM3_COMPONENTS]; /* Cauchy [Pa] */
    double p, q;                    /* mean stress, sqrt(3/2)|s| [Pa] */
    double volumetric_strain;
    double plastic_strain; /* accumulated norm of the increments */
    double dissipation;    /* accumulated, per initial volume [J/m^3] */
    double strain_energy;  /* per initial volume [J/m^3] */
    const double *history; /* [state_count] */
    int iterations;        /* of the mixed control; 0 where only strain is given */
};

struct material_point_path { /* borrows its segments */
    bool finite_strain;
    double initial_stress[SYM3_COMPONENTS]; /* [Pa] */
    const struct material_point_segment *segments;
    size_t segment_count;
};

/* Runs the path; emit() is called once for the initial state (step 0) and after each step; what it
 * is given lives until it returns. At finite strain a segment without `gradient` deforms without
 * spin: F <- exp(strain increment) F. `values` have passed the model's check.
 * TALUS_UNSTABLE if the stress control does not converge (pointer "/path/N"), TALUS_INVALID for a
 * gradient with det F <= 0 (pointer "/path/N/deformation_gradient"), TALUS_MEMORY. */
TALUS_MUST_CHECK enum talus_status
material_point_run(const struct material *material, const double *values,
                   const struct material_point_path *path,
                   void (*emit)(void *context, const struct material_point_step *step),
                   void *context, struct talus_error *error);

#endif
