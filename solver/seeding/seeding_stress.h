/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_SEEDING_STRESS_H
#define TALUS_SEEDING_STRESS_H

#include "seeding/seeding_shape.h"
#include "talus/status.h"

/* Everything about the initial stress of one body that does not depend on the particle. */
struct seeding_stress {
    const struct seeding_shape *shape;
    enum talus_axis vertical;
    double weight;  /* [N/m^3] density x |gravity on the vertical axis| */
    double up;      /* +1 or -1: sign of "up" on the vertical axis */
    double lateral; /* horizontal over vertical stress: K0, or 1 for a fluid at rest */
    bool plane;     /* plane stress: none along zz */
};

/* TALUS_INVALID if a depth is needed and there is no gravity. Borrows scene and shape. */
TALUS_MUST_CHECK enum talus_status seeding_stress_init(struct seeding_stress *stress,
                                                       const struct talus_scene *scene,
                                                       size_t body_index,
                                                       const struct seeding_shape *shape,
                                                       struct talus_error *error);

/* Cauchy stress [Pa] (xx, yy, zz, xy, yz, xz) at a point of the body. */
void seeding_stress_at(const struct seeding_stress *stress, const double position[3],
                       double value[6]);

#endif
