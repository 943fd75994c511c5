/* SPDX-License-Identifier: Apache-2.0 */
/* Generalised vortex (after Kamojjala, Brannon, Sadeghirad and Guilkey 2015), here for a Hencky
 * solid and with a smoother profile: every circle of radius R turns by alpha(R, t) = g(t) h(R), h =
 * (1 - 16 (R - 1)^2)^3 for |R - 1| < 1/4, g = G sin(pi t / T)^2. Each ring shears by gamma = R h' g
 * at constant volume: in the frame that turns along, b = [1 gamma; gamma 1 + gamma^2],
 * ln V = (k / 2) (b - m I) with m = 1 + gamma^2 / 2, k = acosh(m) / sqrt(m^2 - 1), tau = 2 G ln V,
 * and rho b_r = rho a_r - d tau_rr/dR - (tau_rr - tau_tt)/R, rho b_t = rho a_t - d tau_rt/dR - 2
 * tau_rt/R. */
#include "manufactured.h"

#include <math.h>

#define PI 3.14159265358979323846
#define ANGLE 0.1    /* G [rad] */
#define DURATION 2.0 /* T [s] */

/* h and its first two derivatives. */
static void profile(double radius, double h[3])
{
    const double from = radius - 1, inside = 1 - 16 * from * from;
    h[0] = h[1] = h[2] = 0;
    if (inside <= 0)
        return;
    h[0] = inside * inside * inside;
    h[1] = -96 * from * inside * inside;
    h[2] = -96 * inside * inside + 96 * 64 * from * from * inside;
}

/* g and its first two derivatives. */
static void course(double time, double g[3])
{
    const double rate = 2 * PI / DURATION;
    g[0] = 0.5 * ANGLE * (1 - cos(rate * time));
    g[1] = 0.5 * ANGLE * rate * sin(rate * time);
    g[2] = 0.5 * ANGLE * rate * rate * cos(rate * time);
}

static double turn(const double reference[2], double angle, double out[2])
{
    const double radius = hypot(reference[0], reference[1]);
    out[0] = reference[0] * cos(angle) - reference[1] * sin(angle);
    out[1] = reference[0] * sin(angle) + reference[1] * cos(angle);
    return radius;
}

static void displacement(const double reference[2], double time, double out[2])
{
    double h[3], g[3], place[2];
    course(time, g);
    profile(hypot(reference[0], reference[1]), h);
    (void)turn(reference, g[0] * h[0], place);
    for (size_t axis = 0; axis < 2; axis++)
        out[axis] = place[axis] - reference[axis];
}

static void velocity(const double reference[2], double time, double out[2])
{
    double h[3], g[3], place[2];
    course(time, g);
    profile(hypot(reference[0], reference[1]), h);
    (void)turn(reference, g[0] * h[0], place);
    out[0] = -place[1] * g[1] * h[0];
    out[1] = place[0] * g[1] * h[0];
}

/* k of the shear and its derivative; their series where the closed form loses digits. */
static void shear_factor(double gamma, double *k, double *slope)
{
    if (fabs(gamma) < 1e-3) {
        *k = 1 - gamma * gamma / 6;
        *slope = -gamma / 3;
        return;
    }
    const double m = 1 + gamma * gamma / 2, root = gamma * sqrt(1 + gamma * gamma / 4);
    *k = 2 * asinh(gamma / 2) / root;
    *slope = gamma * (1 - *k * m) / (root * root);
}

static void body_force(const struct elastic *elastic, const double reference[2], double time,
                       double out[2])
{
    double h[3], g[3], place[2], k, slope;
    course(time, g);
    profile(hypot(reference[0], reference[1]), h);
    const double radius = turn(reference, g[0] * h[0], place);
    out[0] = out[1] = 0;
    if (radius == 0)
        return;
    const double gamma = radius * h[1] * g[0], gradient = (h[1] + radius * h[2]) * g[0];
    shear_factor(gamma, &k, &slope);
    const double G = elastic->shear;
    const double normal = G * k * gamma * gamma / 2; /* tau_tt = -tau_rr */
    const double normal_slope = G * (slope * gamma * gamma / 2 + k * gamma) * gradient;
    const double shear_slope = G * (slope * gamma + k) * gradient;
    const double radial = -radius * g[1] * g[1] * h[0] * h[0] -
                          (-normal_slope - 2 * normal / radius) / elastic->density;
    const double tangential =
        radius * g[2] * h[0] - (shear_slope + 2 * G * k * gamma / radius) / elastic->density;
    out[0] = (radial * place[0] - tangential * place[1]) / radius;
    out[1] = (radial * place[1] + tangential * place[0]) / radius;
}

static bool counts(const double reference[2])
{
    return fabs(hypot(reference[0], reference[1]) - 1) < 0.25;
}

const struct manufactured vortex = {
    .name = "vortex",
    .what = "a ring whose circles turn by different angles and back",
    .displacement = displacement,
    .velocity = velocity,
    .body_force = body_force,
    .counts = counts,
    .amplitude = 2 * 0.04997916927067833, /* 2 sin(ANGLE / 2) at R = 1 */
};
