/* SPDX-License-Identifier: Apache-2.0 */
/* The seam for shape functions: one file per shape, one line in shapes.def.
 *
 * Kernels work on one block at a time and are instantiated per dimension. They turn node values
 * into polynomial coefficients local to the cells once per block, and accumulate moments that are
 * expanded to nodes once per block. */
#ifndef TALUS_SHAPE_H
#define TALUS_SHAPE_H

#include "base/parameter.h"
#include "state/nodes.h"
#include "state/particles.h"
#include "state/scratch.h"

#include <stdbool.h>
#include <stddef.h>

/* What every kernel call needs; read-only. */
struct shape_context {
    const struct particle_layout *particles;
    struct node_blocks *nodes;
    real inverse_cell[3];  /* [1/m] */
    real displacement[3];  /* time step / cell width: a velocity's way in a step [s/m] */
    real cell_ratio[3][3]; /* cell width of axis a / that of axis b; exactly 1 for equal cells */
};

static inline struct shape_context shape_context_make(const struct particle_layout *particles,
                                                      struct node_blocks *nodes,
                                                      const double cell[3], double time_step)
{
    struct shape_context context = {.particles = particles, .nodes = nodes};
    for (size_t axis = 0; axis < 3; axis++) {
        context.inverse_cell[axis] = (real)(1.0 / cell[axis]);
        context.displacement[axis] = (real)(time_step / cell[axis]);
        for (size_t along = 0; along < 3; along++)
            context.cell_ratio[axis][along] = (real)(cell[axis] / cell[along]);
    }
    return context;
}

/* What the particles of a block scatter; slot i of every array belongs to slot i of the block. */
struct scatter_source {
    const real *mass;      /* [kg]; 0: takes no part */
    const real *volume;    /* V0 [m^3]; 0: takes no part */
    const real *stress[6]; /* Kirchhoff stress [Pa] */
};

struct shape_kernels {
    /* First pass of `modified_last`: v_p += sum N kick_i, then momentum_i += sum N m v_p. */
    void (*kick)(const struct shape_context *context, struct particle_block *block);
    /* The way of a step in cell widths and the displacement gradient dt L into scratch, from the
     * grid velocity; with `correct` v_p += sum N correction_i. */
    void (*gather)(const struct shape_context *context, const struct particle_block *block,
                   bool correct, struct block_scratch *scratch);
    /* mass_i += sum N m, force_i -= sum (V0 tau) . grad N; with `momentum` also
     * momentum_i += sum N m v. */
    void (*scatter)(const struct shape_context *context, const struct particle_block *block,
                    const struct scatter_source *source, bool momentum);
    /* The same for one slot of a block, given its V0 tau. */
    void (*scatter_one)(const struct shape_context *context, const struct particle_block *block,
                        size_t slot, const real force_stress[6], bool momentum);
};

struct shape {
    const char *name, *reference, *summary;
    /* Largest stable Courant number c dt / h with full cells, per stress ordering (index: enum
     * talus_stress_update); the smallest over the dimensions and particle arrangements known. */
    double courant_limit[2];
    const struct shape_kernels *kernels[3]; /* per dimension: 1, 2, 3 axes */
};

extern const struct shape *const shape_table[];
extern const size_t shape_count;
const struct shape *shape_find(const char *name);

#endif
