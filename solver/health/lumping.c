/* SPDX-License-Identifier: Apache-2.0 */
/* Where weights can be negative, the lumped mass of a node of a partly filled element can be too,
 * and the node would move against its forces (Mast 2013, sec. B.2.2, restricts such elements to
 * small displacements). */
#include "health/health.h"

/* Masses below this share of the lightest particle count as none: corners of bodies of full
 * elements with two particles an axis in 3D have 1/64. */
#define LEAST_SHARE 1e-3

static bool is_pushed(const struct run *run, size_t block, size_t lane)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    bool pushed = false;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        pushed = pushed || node_values(nodes, block, nodes->layout.force + axis)[lane] != 0;
    return pushed;
}

static enum talus_status report(const struct run *run, size_t block, size_t lane, double mass,
                                struct talus_error *error)
{
    double position[3] = {0, 0, 0};
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        position[axis] = domain_node_position(&run->grid.domain, axis,
                                              run->grid.nodes.place[block][axis] +
                                                  (axis == 0 ? (int32_t)lane : 0));
    return talus_error_set(
        error, run->step == 0 ? TALUS_INVALID : TALUS_UNSTABLE, "negative_mass", "/solver/shape",
        "the node at (%.6g, %.6g, %.6g) has %.3g times the mass of the lightest particle at "
        "t = %.6g s, step %llu: shape \"%s\" is negative in places and needs cells full of "
        "particles "
        "that move little; try \"bspline2\"",
        position[0], position[1], position[2], mass / run->least_mass, run->time,
        (unsigned long long)run->step, run->shape->name);
}

enum talus_status health_check_lumping(const struct run *run, struct talus_error *error)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    if (!run->shape->may_lump_negative)
        return TALUS_OK;
    for (size_t block = 0; block < nodes->count; block++) {
        const real *mass = node_values(nodes, block, nodes->layout.mass);
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            if (mass[lane] > LEAST_SHARE * run->least_mass ||
                (mass[lane] == 0 && !is_pushed(run, block, lane)))
                continue;
            return report(run, block, lane, (double)mass[lane], error);
        }
    }
    return TALUS_OK;
}
