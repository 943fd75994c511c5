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
    double inverse_cell[3];
};

struct shape_kernels {
    /* First pass of `modified_last`: v_p += sum N kick_i, then momentum_i += sum N m v_p. */
    void (*kick)(const struct shape_context *context, struct particle_block *block);
    /* velocity and gradient of the grid velocity into scratch; with `correct`
     * v_p += sum N correction_i. */
    void (*gather)(const struct shape_context *context, struct particle_block *block, bool correct,
                   struct block_scratch *scratch);
    /* mass_i += sum N m, force_i -= sum (V0 tau) . grad N of the particles with scratch->mass > 0;
     * with `momentum` also momentum_i += sum N m v. */
    void (*scatter)(const struct shape_context *context, const struct particle_block *block,
                    const struct block_scratch *scratch, bool momentum);
    /* The same for one slot of a block. */
    void (*scatter_one)(const struct shape_context *context, const struct particle_block *block,
                        size_t slot, const double force_stress[6], bool momentum);
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
