/* SPDX-License-Identifier: Apache-2.0 */
/* The largest Courant number c dt / h at which a method is stable, as measured. */
#ifndef TALUS_COURANT_LIMIT_H
#define TALUS_COURANT_LIMIT_H

#include "talus/scene.h"

/* Of the shape functions, transfer, ordering and anti-locking of a scene: what the stability map
 * has found, and never more than the spectral radius of the step allows for the shape functions
 * with any arrangement of particles. */
double courant_limit_of(const struct talus_solver_options *solver);

#endif
