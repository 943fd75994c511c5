/* SPDX-License-Identifier: Apache-2.0 */
/* The background grid as geometry: a box of equal cells. Costs nothing where there is no material.
 */
#ifndef TALUS_DOMAIN_H
#define TALUS_DOMAIN_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct domain {
    size_t axis_count; /* 1, 2 or 3 */
    double cell[3];    /* [m]; 1 beyond the dimension */
    double inverse_cell[3];
    double min[3];         /* [m] */
    int32_t cell_count[3]; /* 1 beyond the dimension */
    bool revolves;         /* axisymmetric: x is the distance from the axis */
};

/* Smallest cell edge [m]. */
static inline double domain_smallest_cell(const struct domain *domain)
{
    double smallest = domain->cell[0];
    for (size_t axis = 1; axis < domain->axis_count; axis++)
        smallest = fmin(smallest, domain->cell[axis]);
    return smallest;
}

/* Volume of a cell [m^3, m^2, m]. */
static inline double domain_cell_volume(const struct domain *domain)
{
    return domain->cell[0] * domain->cell[1] * domain->cell[2];
}

/* Length of the circle that a point at this distance from the axis stands for [m]; 1 in bodies that
 * are no bodies of revolution. */
static inline double domain_circle(const struct domain *domain, double radius)
{
    static const double two_pi = 6.28318530717958647693;
    return domain->revolves ? two_pi * radius : 1.0;
}

/* World coordinate of a cell-relative position on one axis. */
static inline double domain_position(const struct domain *domain, size_t axis, int32_t cell,
                                     double relative)
{
    return domain->min[axis] + ((double)cell + 0.5 + relative) * domain->cell[axis];
}

static inline double domain_node_position(const struct domain *domain, size_t axis, int32_t node)
{
    return domain->min[axis] + (double)node * domain->cell[axis];
}

/* The grid line nearest to a coordinate, kept within what fits. */
static inline int32_t domain_nearest_line(const struct domain *domain, size_t axis,
                                          double coordinate)
{
    const double line = (coordinate - domain->min[axis]) * domain->inverse_cell[axis];
    return (int32_t)lround(fmin(fmax(line, -1e6), 2e6));
}

#endif
