/* SPDX-License-Identifier: Apache-2.0 */
/* Axis-aligned displacement in the unit square (after Wallstedt and Guilkey 2008), here for a
 * Hencky solid: u_a = A sin(2 pi X_a) sin(pi c t + a pi). F is diagonal, F_a = 1 + 2 pi A cos(2 pi
 * X_a) S_a, P_a = (lambda ln(F_x F_y) + 2 G ln F_a) / F_a, and rho b = rho u'' - dP_a/dX_a. The
 * sides of the square neither move nor feel shear: smooth walls. */
#include "manufactured.h"

#include <math.h>

#define PI 3.14159265358979323846
#define AMPLITUDE 0.05
#define RATE 100.0 /* c [1/s] */

static double wave(size_t axis, double time)
{
    return sin(PI * RATE * time + (double)axis * PI);
}

static void displacement(const double reference[2], double time, double out[2])
{
    for (size_t axis = 0; axis < 2; axis++)
        out[axis] = AMPLITUDE * sin(2 * PI * reference[axis]) * wave(axis, time);
}

static void velocity(const double reference[2], double time, double out[2])
{
    for (size_t axis = 0; axis < 2; axis++)
        out[axis] = AMPLITUDE * sin(2 * PI * reference[axis]) * PI * RATE *
                    cos(PI * RATE * time + (double)axis * PI);
}

static void body_force(const struct elastic *elastic, const double reference[2], double time,
                       double out[2])
{
    double stretch[2], slope[2];
    for (size_t axis = 0; axis < 2; axis++) {
        const double whole = 2 * PI * AMPLITUDE * wave(axis, time);
        stretch[axis] = 1 + whole * cos(2 * PI * reference[axis]);
        slope[axis] = -2 * PI * whole * sin(2 * PI * reference[axis]);
    }
    const double volume = log(stretch[0]) + log(stretch[1]);
    for (size_t axis = 0; axis < 2; axis++) {
        const double u = AMPLITUDE * sin(2 * PI * reference[axis]) * wave(axis, time);
        const double tau = elastic->lambda * volume + 2 * elastic->shear * log(stretch[axis]);
        const double divergence = slope[axis] * (elastic->lambda + 2 * elastic->shear - tau) /
                                  (stretch[axis] * stretch[axis]);
        out[axis] = -(PI * RATE) * (PI * RATE) * u - divergence / elastic->density;
    }
}

static bool counts(const double reference[2])
{
    (void)reference;
    return true;
}

const struct manufactured axis_aligned = {
    .name = "axis-aligned",
    .what = "displacements along the axes in a square with smooth walls",
    .displacement = displacement,
    .velocity = velocity,
    .body_force = body_force,
    .counts = counts,
    .amplitude = AMPLITUDE,
};
