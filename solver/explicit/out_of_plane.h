/* SPDX-License-Identifier: Apache-2.0 */
/* Plane bodies that strain along zz.
 *
 * Axisymmetric: x is the distance from the axis, zz the hoop direction, g_zz = dr / r of the
 * particle: exact at finite strain too. Masses, volumes and forces are those of the whole circle.
 * The hoop stress pulls towards the axis: force_i,x -= sum V0 tau_zz N_i / r.
 *
 * Plane stress of linear elastic materials: e_zz = -nu / (1 - nu) (e_xx + e_yy), in Hencky strain
 * too (Mast 2013, sec. B.2.2 allows it for these only); hence f_zz = (det f)^(-nu / (1 - nu)) with
 * the determinant in the plane. */
#ifndef TALUS_OUT_OF_PLANE_H
#define TALUS_OUT_OF_PLANE_H

#include "explicit/run.h"

/* scratch->gradient[GRADIENT_ZZ]: out of the other components, or of the nodes' velocity. */
void out_of_plane_increment(struct run *run, const struct particle_block *block,
                            struct block_scratch *scratch, size_t count, double time_step);

/* Plane stress: scratch->strain[2] out of the strains in the plane, whatever happened to them. */
void out_of_plane_strain(const struct run *run, const struct particle_block *block,
                         struct block_scratch *scratch, size_t count);

/* Axisymmetric: the nodal forces of the hoop stress of a block, at the present positions; and of
 * one slot, given its V0 tau_zz. Both return the sum of the forces [N]. */
double hoop_scatter(struct run *run, const struct particle_block *block,
                    const struct scatter_source *source, struct block_scratch *scratch);
double hoop_scatter_one(struct run *run, const struct particle_block *block, size_t slot,
                        real hoop);

#endif
