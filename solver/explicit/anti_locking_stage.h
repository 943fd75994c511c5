/* SPDX-License-Identifier: Apache-2.0 */
/* Anti-locking of one material in one block (Mast 2013, Table 4.1): fits of the trial elastic
 * strain before the constitutive update, and of the stress after it. Elastic trial strains are
 * fitted, never total ones (sec. 4.4.5); plastic variables stay as they are. */
#ifndef TALUS_ANTI_LOCKING_STAGE_H
#define TALUS_ANTI_LOCKING_STAGE_H

#include "antilocking/cell_fit.h"
#include "explicit/run.h"

struct anti_locking {
    const struct material *model;
    size_t material;       /* its index, that of its sums at the nodes too */
    const real *weight;    /* mass of the slots of the material, else 0 */
    size_t count;          /* slots */
    bool fits_cells;       /* all components, or their deviatoric part, are fitted over cells */
    struct cell_fit cells; /* where `fits_cells` */
};

/* Prepares the fits. weight: mass of the slots of the material, else 0; not used without
 * anti-locking. */
void anti_locking_begin(const struct run *run, const struct particle_block *block, size_t material,
                        const real *weight, struct anti_locking *fit);
/* Fits the strains in scratch, with the values at the nodes if there are. A volumetric part goes
 * into the stored strain too, b <- exp(2 shift) b at finite strain (eq. 4.40); true: the stored
 * strain has to be made anew from the one in scratch. */
bool anti_locking_strain(struct run *run, const struct particle_block *block,
                         const struct anti_locking *fit, struct block_scratch *scratch);
/* Fits the stresses in scratch over cells, or adds them to the nodes, if the scene wants it. */
void anti_locking_stress(struct run *run, const struct particle_block *block,
                         const struct anti_locking *fit, struct block_scratch *scratch);

/* Fits over nodes: adds the trial strains of a block, and the divergence of its motion if it is
 * damped. `still`: there is no mass at the nodes yet. */
void anti_locking_scatter_strain(struct run *run, const struct particle_block *block,
                                 struct block_scratch *scratch, bool still);
/* Fits over nodes: replaces the stresses of a block in scratch. */
void anti_locking_gather_stress(struct run *run, const struct particle_block *block,
                                struct block_scratch *scratch);
/* divergence[slots] <- what it is for the nodal forces of bulk damping. */
void anti_locking_divergence(struct run *run, const struct particle_block *block,
                             struct block_scratch *scratch, real *divergence);

#endif
