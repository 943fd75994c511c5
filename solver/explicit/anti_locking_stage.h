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
    const real *weight;    /* mass of the slots of the material, else 0 */
    size_t count;          /* slots */
    bool whole;            /* all components are fitted, not only the trace */
    struct cell_fit cells; /* where `whole` */
};

/* Prepares the fits. weight: mass of the slots of the material, else 0; not used without
 * anti-locking. */
void anti_locking_begin(const struct run *run, const struct particle_block *block,
                        const struct material *model, const real *weight, struct anti_locking *fit);
/* Fits the strains in scratch. A volumetric part goes into the stored strain too,
 * b <- exp(2 shift) b at finite strain (eq. 4.40); true: the stored strain has to be made anew
 * from the one in scratch. */
bool anti_locking_strain(const struct run *run, const struct particle_block *block,
                         const struct anti_locking *fit, struct block_scratch *scratch);
/* Fits the stresses in scratch, if the scene wants it. */
void anti_locking_stress(const struct run *run, const struct anti_locking *fit,
                         struct block_scratch *scratch);

#endif
