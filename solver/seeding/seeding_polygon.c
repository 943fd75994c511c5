/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_polygon.h"

#include <math.h>

/* Mean over a side of how far it lies above min, at most max - min; y runs linearly from a to b. A
 * sum of parts that are all positive: nothing cancels. */
static double clamped_mean(double a, double b, double min, double max)
{
    const double low = fmin(a, b), high = fmax(a, b);
    const double inside_low = fmax(low, min), inside_high = fmin(high, max);
    if (low == high)
        return fmin(fmax(low, min), max) - min;
    const double inside = fmax(inside_high - inside_low, 0.0);
    const double above = fmax(high - fmax(low, max), 0.0);
    return (inside * (0.5 * (inside_low + inside_high) - min) + above * (max - min)) / (high - low);
}

double polygon_area(const double *vertices, size_t count, const double min[2], const double max[2])
{
    double area = 0.0;
    for (size_t k = 0; k < count; k++) {
        const double *a = vertices + 2 * k, *b = vertices + 2 * ((k + 1) % count);
        const double from = fmin(fmax(a[0], min[0]), max[0]);
        const double to = fmin(fmax(b[0], min[0]), max[0]);
        if (from == to)
            continue;
        const double slope = (b[1] - a[1]) / (b[0] - a[0]);
        area += (from - to) * clamped_mean(a[1] + slope * (from - a[0]), a[1] + slope * (to - a[0]),
                                           min[1], max[1]);
    }
    return area;
}

/* Twice the area of the triangle a b c; exactly 0 for points on a line with exact coordinates. */
static double turning(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* True if c, known to be on the line a b, lies between them. */
static bool between(const double *a, const double *b, const double *c)
{
    return fmin(a[0], b[0]) <= c[0] && c[0] <= fmax(a[0], b[0]) && fmin(a[1], b[1]) <= c[1] &&
           c[1] <= fmax(a[1], b[1]);
}

static bool sides_meet(const double *a, const double *b, const double *c, const double *d)
{
    const double c_side = turning(a, b, c), d_side = turning(a, b, d);
    const double a_side = turning(c, d, a), b_side = turning(c, d, b);
    if (((c_side > 0.0 && d_side < 0.0) || (c_side < 0.0 && d_side > 0.0)) &&
        ((a_side > 0.0 && b_side < 0.0) || (a_side < 0.0 && b_side > 0.0)))
        return true;
    return (c_side == 0.0 && between(a, b, c)) || (d_side == 0.0 && between(a, b, d)) ||
           (a_side == 0.0 && between(c, d, a)) || (b_side == 0.0 && between(c, d, b));
}

/* Neighbours that share vertex b may only meet there: not run back over each other. */
static bool runs_back(const double *a, const double *b, const double *c)
{
    return turning(a, b, c) == 0.0 &&
           (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) > 0.0;
}

bool polygon_crosses_itself(const double *vertices, size_t count, size_t *first, size_t *second)
{
    for (*first = 0; *first < count; (*first)++) {
        const double *a = vertices + 2 * *first, *b = vertices + 2 * ((*first + 1) % count);
        *second = *first;
        if (a[0] == b[0] && a[1] == b[1])
            return true;
        *second = (*first + 1) % count;
        if (runs_back(a, b, vertices + 2 * ((*first + 2) % count)))
            return true;
        for (*second = *first + 2; *second < count; (*second)++) {
            if (*first == 0 && *second == count - 1)
                continue; /* neighbours too */
            if (sides_meet(a, b, vertices + 2 * *second, vertices + 2 * ((*second + 1) % count)))
                return true;
        }
    }
    return false;
}

size_t polygon_crossings(const double *vertices, size_t count, const double point[2],
                         const double direction[2], double *crossing)
{
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        const double *a = vertices + 2 * k, *b = vertices + 2 * ((k + 1) % count);
        const double ax = a[0] - point[0], ay = a[1] - point[1];
        const double bx = b[0] - point[0], by = b[1] - point[1];
        const double a_side = direction[0] * ay - direction[1] * ax;
        const double b_side = direction[0] * by - direction[1] * bx;
        if ((a_side > 0.0) == (b_side > 0.0))
            continue;
        const double share = a_side / (a_side - b_side);
        const double place = (1.0 - share) * (ax * direction[0] + ay * direction[1]) +
                             share * (bx * direction[0] + by * direction[1]);
        size_t slot = found++;
        for (; slot > 0 && crossing[slot - 1] > place; slot--)
            crossing[slot] = crossing[slot - 1];
        crossing[slot] = place;
    }
    return found;
}
