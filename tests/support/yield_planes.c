/* SPDX-License-Identifier: Apache-2.0 */
#include "yield_planes.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static double slope_of(double angle_deg)
{
    double sine = sin(angle_deg * M_PI / 180.0);
    return (1.0 + sine) / (1.0 - sine);
}

struct yield_planes yield_planes_of(double bulk, double shear, double friction_deg,
                                    double dilation_deg, double cohesion, double tension)
{
    struct yield_planes planes = {.bulk = bulk, .shear = shear};
    const double k = slope_of(friction_deg);
    for (int high = 0; high < 3; high++) {
        for (int low = 0; low < 3; low++) {
            if (low == high)
                continue;
            struct yield_plane *at = &planes.plane[planes.count++];
            at->normal[high] = k;
            at->flow[high] = slope_of(dilation_deg);
            at->normal[low] = at->flow[low] = -1.0;
            at->bound = 2.0 * cohesion * sqrt(k);
        }
    }
    for (int axis = 0; axis < 3 && tension < INFINITY; axis++) {
        struct yield_plane *at = &planes.plane[planes.count++];
        at->normal[axis] = at->flow[axis] = 1.0;
        at->bound = tension;
    }
    return planes;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* C a */
static void stiffen(const struct yield_planes *planes, const double a[3], double out[3])
{
    double trace = a[0] + a[1] + a[2];
    for (int axis = 0; axis < 3; axis++)
        out[axis] =
            (planes->bulk - 2.0 / 3.0 * planes->shear) * trace + 2.0 * planes->shear * a[axis];
}

/* Gauss with pivots; false if singular. */
static bool solve(size_t count, double matrix[3][3], double right[3])
{
    for (size_t column = 0; column < count; column++) {
        size_t pivot = column;
        for (size_t row = column + 1; row < count; row++) {
            if (fabs(matrix[row][column]) > fabs(matrix[pivot][column]))
                pivot = row;
        }
        if (fabs(matrix[pivot][column]) < 1e-6)
            return false; /* the rows have the size of the stiffness over itself */
        for (size_t other = 0; other < count; other++) {
            double kept = matrix[pivot][other];
            matrix[pivot][other] = matrix[column][other];
            matrix[column][other] = kept;
        }
        double kept = right[pivot];
        right[pivot] = right[column];
        right[column] = kept;
        for (size_t row = 0; row < count; row++) {
            double factor = row == column ? 0.0 : matrix[row][column] / matrix[column][column];
            for (size_t other = column; other < count; other++)
                matrix[row][other] -= factor * matrix[column][other];
            right[row] -= factor * right[column];
        }
    }
    for (size_t row = 0; row < count; row++)
        right[row] /= matrix[row][row];
    return true;
}

bool yield_planes_return_to(const struct yield_planes *planes, unsigned subset,
                            const double trial[3], double stress[3], double multipliers[3])
{
    const struct yield_plane *active[3];
    double relief[3][3];
    double matrix[3][3];
    size_t count = 0;
    if (__builtin_popcount(subset) > 3)
        return false;
    for (unsigned plane = 0; plane < YIELD_PLANES; plane++) {
        if ((subset >> plane & 1) != 0)
            active[count++] = &planes->plane[plane];
    }
    for (size_t index = 0; index < count; index++)
        stiffen(planes, active[index]->flow, relief[index]);
    for (size_t row = 0; row < count; row++) {
        double scale = 1.0 / (planes->shear * dot(active[row]->normal, active[row]->normal));
        multipliers[row] = scale * (dot(active[row]->normal, trial) - active[row]->bound);
        for (size_t column = 0; column < count; column++)
            matrix[row][column] = scale * dot(active[row]->normal, relief[column]);
    }
    if (!solve(count, matrix, multipliers))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        stress[axis] = trial[axis];
        for (size_t index = 0; index < count; index++)
            stress[axis] -= multipliers[index] * relief[index][axis];
    }
    return true;
}

double yield_planes_excess(const struct yield_planes *planes, const double stress[3])
{
    double largest = -INFINITY;
    for (int index = 0; index < planes->count; index++) {
        const struct yield_plane *at = &planes->plane[index];
        largest = fmax(largest,
                       (dot(at->normal, stress) - at->bound) / sqrt(dot(at->normal, at->normal)));
    }
    return largest;
}

bool yield_planes_return(const struct yield_planes *planes, double stress[3])
{
    const double trial[3] = {stress[0], stress[1], stress[2]};
    double least = INFINITY;
    if (yield_planes_excess(planes, trial) <= 0.0)
        return false;
    for (unsigned subset = 1; subset < 1u << planes->count; subset++) {
        double result[3], multipliers[3];
        if (!yield_planes_return_to(planes, subset, trial, result, multipliers))
            continue;
        double excess = fmax(yield_planes_excess(planes, result), 0.0);
        for (int index = 0; index < __builtin_popcount(subset); index++) {
            if (multipliers[index] < 0.0)
                excess = INFINITY;
        }
        if (excess < least) {
            least = excess;
            memcpy(stress, result, sizeof result);
        }
    }
    return true;
}
