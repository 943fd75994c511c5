/* SPDX-License-Identifier: Apache-2.0 */
/* Simple polygons in the plane, convex or not, given by their vertices either way round. Arrays are
 * borrowed: [count][2] m. */
#ifndef TALUS_SEEDING_POLYGON_H
#define TALUS_SEEDING_POLYGON_H

#include <stdbool.h>
#include <stddef.h>

/* Signed area [m^2] of the part inside a box; positive counterclockwise. */
double polygon_area(const double *vertices, size_t count, const double min[2], const double max[2]);

/* Finds two sides that touch or cross other than as neighbours at their common vertex, and sides
 * without length; side k runs from vertex k to the next. False if the polygon is simple. */
bool polygon_crosses_itself(const double *vertices, size_t count, size_t *first, size_t *second);

/* Where the line through `point` along `direction` crosses the sides: distances along it, growing;
 * an even number. `crossing` has room for `count` of them. */
size_t polygon_crossings(const double *vertices, size_t count, const double point[2],
                         const double direction[2], double *crossing);

#endif
