/* SPDX-License-Identifier: Apache-2.0 */
/* Fits over the supports of nodes (Mast 2013, sec. 4.4.2 and 4.4.3, eq. 4.29-4.35): sums over the
 * particles are scattered to nodes, each node takes the value of its fit at its own place, and
 * particles get the weighted mean of their nodes. Each material has a set of sums of its own, so
 * that nothing is averaged across materials. */
#ifndef TALUS_NODE_FIT_H
#define TALUS_NODE_FIT_H

#include "shapes/shape.h"
#include "talus/scene.h"

/* Which sums a node holds, and where. A set: mass; with linear quantities sum m x (axis_count) and
 * sum m x x (upper triangle); then the strain's quantities and the stress's, each sum m q and, if
 * it is linear, sum m x q (axis_count). */
struct node_fit {
    bool active;
    enum talus_anti_locking_averaging averaging;
    bool trace_only;     /* one quantity, the trace; else the components of the tensor */
    bool constant_trace; /* of the normal components only the mean of the trace is left */
    bool shares_mass;    /* the sum of the only set is the mass at the nodes */
    bool wants_divergence;
    size_t axis_count;
    size_t normal_count;   /* components that make up the trace: 3, or 2 in plane stress */
    size_t quantity_count; /* 1, or the components */
    size_t linear_count;   /* the first so many are linear, the rest constant */
    size_t set_count;
    uint32_t first;           /* node component of the first set */
    uint32_t set_stride;      /* components of a set */
    uint32_t quantity_stride; /* components of the strain's, or the stress's, quantities */
    uint32_t divergence;      /* node component of the mean divergence, after the sets, if wanted */
    uint32_t component_count; /* all of them */
    int32_t origin[3];        /* cell in the middle of the grid: coordinates count from there */
};

enum node_fit_what { NODE_FIT_STRAIN, NODE_FIT_STRESS };

/* Fills in what the scene asks for; `active` false and no components without node averaging.
 * component_count: of the tensors that materials see. The caller puts the components at
 * fit->first. */
void node_fit_init(struct node_fit *fit, const struct talus_scene *scene, size_t component_count);
void node_fit_place(struct node_fit *fit, uint32_t first);

/* One block with its kernels; arrays of the thread over the slots. */
struct node_fit_block {
    const struct shape_context *context;
    const struct shape_kernels *kernels;
    const struct particle_block *block;
    real *product, *coordinate[3]; /* free */
};

/* Coordinates of the particles, where linear quantities need them. */
void node_fit_locate(const struct node_fit *fit, const struct node_fit_block *at);
/* Adds the masses of a set, but for ones that node_fit_take_mass has taken (`taken`), and their
 * moments. weight: mass of the slots of the material, else 0. */
void node_fit_scatter_masses(const struct node_fit *fit, const struct node_fit_block *at,
                             size_t set, const real *weight, bool taken);
/* Adds quantities[quantity_count]. */
void node_fit_scatter(const struct node_fit *fit, const struct node_fit_block *at, size_t set,
                      enum node_fit_what what, const real *weight, real *const *quantities);
/* Adds m x divergence. */
void node_fit_scatter_divergence(const struct node_fit *fit, const struct node_fit_block *at,
                                 const real *mass, const real *divergence);
/* quantities[quantity_count] <- values of the fits at the particles. After node_fit_solve. */
void node_fit_gather(const struct node_fit *fit, const struct node_fit_block *at, size_t set,
                     enum node_fit_what what, real *const *quantities);
void node_fit_gather_divergence(const struct node_fit *fit, const struct node_fit_block *at,
                                real *divergence);

/* Node blocks; independent of each other. */
void node_fit_clear(const struct node_fit *fit, const struct node_blocks *nodes, size_t block);
/* Takes the mass at the nodes, of the present positions, if the set has the same (`shares_mass`).
 */
void node_fit_take_mass(const struct node_fit *fit, const struct node_blocks *nodes, size_t block);
/* Sums -> values at the nodes; with the strain the divergence too. Returns the number of nodes with
 * mass and without a linear fit that was wanted: these take the constant one. */
size_t node_fit_solve(const struct node_fit *fit, const struct node_blocks *nodes, size_t block,
                      enum node_fit_what what);

#endif
