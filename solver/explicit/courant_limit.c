/* SPDX-License-Identifier: Apache-2.0 */
/* courant_limits.def is written by tests/stability/map/stability_map.py out of its map: the
 * smallest of the limits of the map's bodies, without that of the body whose edge nodes carry a
 * thousandth of a particle where the method has no stable step there at all (`last`: sqrt(2 m_i /
 * m_p), as small as the mass). */
#include "explicit/courant_limit.h"

#include "shapes/shape.h"
#include "transfers/velocity_transfer.h"

#include <math.h>
#include <string.h>

enum { CONTROL_COUNT = TALUS_CONTROL_HYBRID + 1 };

struct courant_limit {
    const char *shape, *transfer;
    enum talus_stress_update stress_update;
    double limit[CONTROL_COUNT]; /* by enum talus_anti_locking_control; least of their fields */
};

static const struct courant_limit limits[] = {
#define COURANT_LIMIT(shape, transfer, ordering, none, cell, node, hybrid)                         \
    {#shape, #transfer, TALUS_STRESS_##ordering, {none, cell, node, hybrid}},
#include "explicit/courant_limits.def"
#undef COURANT_LIMIT
};

double courant_limit_of(const struct talus_solver_options *solver)
{
    const struct shape *shape = shape_table[solver->shape_index];
    const double spectral = shape->courant_limit[solver->stress_update];
    const char *transfer = transfer_of(solver)->name;
    for (size_t index = 0; index < sizeof limits / sizeof limits[0]; index++) {
        const struct courant_limit *row = &limits[index];
        if (row->stress_update == solver->stress_update && strcmp(row->shape, shape->name) == 0 &&
            strcmp(row->transfer, transfer) == 0)
            return fmin(spectral, row->limit[solver->anti_locking]);
    }
    return spectral;
}
