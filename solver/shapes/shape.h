/* SPDX-License-Identifier: Apache-2.0 */
/* The seam for shape functions: one file per shape, one line in shapes.def.
 *
 * Kernels work on one block at a time and are instantiated per dimension. Linear ones turn node
 * values into polynomial coefficients local to the cells once per block, and accumulate moments
 * that are expanded to nodes once per block (linear_kernel.h); those of shapes that reach further
 * sum over a window of nodes (wide_kernel.h). */
#ifndef TALUS_SHAPE_H
#define TALUS_SHAPE_H

#include "base/parameter.h"
#include "state/nodes.h"
#include "state/particles.h"
#include "state/scratch.h"
#include "talus/scene.h"

#include <stdbool.h>
#include <stddef.h>

struct sparse_grid;

/* What every kernel call needs; read-only. */
struct shape_context {
    const struct particle_layout *particles;
    struct node_blocks *nodes;
    real inverse_cell[3];  /* [1/m] */
    real displacement[3];  /* time step / cell width: a velocity's way in a step [s/m] */
    real cell_ratio[3][3]; /* cell width of axis a / that of axis b; exactly 1 for equal cells */
    /* Where a shape chooses by what is around a particle (shape_domain.chooses), else unset. */
    const struct sparse_grid *grid;
    double hybrid_scale; /* of the domains in the search */
    double hybrid_count; /* cells with at most so many particles are at the edge */
};

static inline void shape_context_set_step(struct shape_context *context, const double cell[3],
                                          double time_step)
{
    for (size_t axis = 0; axis < 3; axis++)
        context->displacement[axis] = (real)(time_step / cell[axis]);
}

static inline struct shape_context shape_context_make(const struct particle_layout *particles,
                                                      struct node_blocks *nodes,
                                                      const double cell[3], double time_step)
{
    struct shape_context context = {.particles = particles, .nodes = nodes};
    for (size_t axis = 0; axis < 3; axis++) {
        context.inverse_cell[axis] = (real)(1.0 / cell[axis]);
        for (size_t along = 0; along < 3; along++)
            context.cell_ratio[axis][along] = (real)(cell[axis] / cell[along]);
    }
    shape_context_set_step(&context, cell, time_step);
    return context;
}

/* What the particles of a block scatter; slot i of every array belongs to slot i of the block. */
struct scatter_source {
    const real *mass;      /* [kg]; 0: takes no part */
    const real *volume;    /* V0 [m^3]; 0: takes no part */
    const real *stress[6]; /* Kirchhoff stress [Pa] */
};

/* What a pass asks of a kernel; flags may be combined. */
enum {
    GATHER_DISPLACEMENT = 1, /* way of the step in cell widths, from the nodes' motion */
    GATHER_GRADIENT = 2,     /* displacement gradient dt L, from the nodes' velocity */
    GATHER_CORRECTION = 4,   /* v_p += sum N correction_i */
    GATHER_AFFINE = 8,       /* PARTICLE_AFFINE, from the nodes' velocity */
};
enum {
    SCATTER_MASS = 1,     /* mass_i += sum N m */
    SCATTER_MOMENTUM = 2, /* momentum_i += sum N m v, with the affine part if particles have one */
    SCATTER_FORCE = 4,    /* force_i -= sum (V0 tau) . grad N */
};

struct shape_kernels {
    /* First pass of `modified_last`: v_p += sum N kick_i, then SCATTER_MOMENTUM; where particles
     * have an affine part it is kicked too. */
    void (*kick)(const struct shape_context *context, struct particle_block *block);
    /* Into scratch->displacement and scratch->gradient, or into the particles. */
    void (*gather)(const struct shape_context *context, const struct particle_block *block,
                   unsigned what, struct block_scratch *scratch);
    void (*scatter)(const struct shape_context *context, const struct particle_block *block,
                    const struct scatter_source *source, unsigned what);
    /* The same for one slot of a block, given its V0 tau. */
    void (*scatter_one)(const struct shape_context *context, const struct particle_block *block,
                        size_t slot, const real force_stress[6], unsigned what);
    /* Node component first + k += sum N weight values_k for k < count; values_k NULL: 1. Arrays
     * over the slots; weight 0 in slots that take no part. */
    void (*scatter_values)(const struct shape_context *context, const struct particle_block *block,
                           const real *weight, size_t count, const real *const *values,
                           uint32_t first);
    /* values_k = sum N node_(first + k); 0 in empty slots. */
    void (*gather_values)(const struct shape_context *context, const struct particle_block *block,
                          size_t count, real *const *values, uint32_t first);
};

/* Particles whose extent a shape cannot follow. */
struct domain_findings {
    uint64_t capped;    /* longer than the shape can be, and taken as if they were just as long */
    uint64_t stretched; /* beyond what the rule that scales them is made for */
    uint32_t capped_particle; /* id of one of them, if there are any */
    uint32_t stretched_particle;
};

/* Shapes that know the extent of their particles, PARTICLE_DOMAIN. */
struct shape_domain {
    uint32_t (*component_count)(size_t axis_count);
    bool needs_gradient; /* particles must store PARTICLE_GRADIENT */
    bool chooses;        /* resize also sets PARTICLE_CONVECTED, out of what is around */
    /* PARTICLE_DOMAIN of a particle of that size along the axes, in cell widths. */
    void (*initialise)(size_t axis_count, const double size[3], real *domain);
    /* Once the particles of a block have been strained, before they scatter at their new places;
     * also at the start. Per rule (index: enum talus_gimp_scaling). Adds to the findings. */
    void (*resize[2])(const struct shape_context *context, const struct particle_block *block,
                      struct domain_findings *findings);
};

struct shape {
    const char *name, *reference, *summary;
    /* Largest stable Courant number c dt / h with full cells, per stress ordering (index: enum
     * talus_stress_update); the smallest over the dimensions and particle arrangements known. */
    double courant_limit[TALUS_STRESS_UPDATE_COUNT];
    /* G^2/N of a node has no bound: a particle that has just entered a cell pulls at nodes that
     * carry hardly any mass. */
    bool light_nodes;
    /* Made of hat functions: where material keeps its volume it is too stiff without averages. */
    bool locks;
    /* Cells beyond its own that a particle can reach, at most REACH_MAX (state/sparse_grid.h). */
    uint32_t reach;
    const struct shape_domain *domain; /* NULL: particles are points */
    bool halves_cells; /* the solver's cells are half as wide as the scene's, two are an element */
    bool may_lump_negative; /* weights are negative in places, and lumped masses can be */
    const struct shape_kernels *kernels[3]; /* per dimension: 1, 2, 3 axes */
};

extern const struct shape *const shape_table[];
extern const size_t shape_count;
const struct shape *shape_find(const char *name);

#endif
