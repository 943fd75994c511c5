/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_velocity.h"

#include "seeding/seeding.h"
#include "seeding/seeding_shape.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

double seeding_beam_root(double mode)
{
    enum { ITERATION_MAX = 20 };
    double root = (mode - 0.5) * pi; /* within 0.31 of the root, closer for every further mode */
    for (int iteration = 0; iteration < ITERATION_MAX; iteration++) {
        /* f = cos b + 1 / cosh b, without overflow */
        const double change =
            (cos(root) + 1.0 / cosh(root)) / (-sin(root) - tanh(root) / cosh(root));
        root -= change;
        if (fabs(change) < 1e-15 * root)
            break;
    }
    return root;
}

/* phi = cosh z - cos z - s (sinh z - sin z), z = b x / L, s = (cosh b + cos b) / (sinh b + sin b).
 * cosh z - s sinh z = (1 - s)/2 e^z + (1 + s)/2 e^-z with 1 - s = 2 (sin b - cos b - e^-b) /
 * (e^b - e^-b + 2 sin b): in this form nothing cancels. phi(L) = 2 (-1)^(n+1). */
void seeding_beam_shape(double mode, double place, double *shape, double *slope)
{
    const double b = seeding_beam_root(mode), z = b * place, decay = exp(-b);
    const double rest = 2.0 * decay * (sin(b) - cos(b) - decay) /
                        (1.0 - decay * decay + 2.0 * decay * sin(b)); /* 1 - s */
    const double s = 1.0 - rest;
    const double rising = 0.5 * rest * exp(z), falling = 0.5 * (1.0 + s) * exp(-z);
    const double tip = 2.0 * (fmod(mode, 2.0) == 1.0 ? 1.0 : -1.0);
    *shape = (rising + falling - cos(z) + s * sin(z)) / tip;
    *slope = b * (rising - falling + sin(z) + s * cos(z)) / tip;
}

static void beam_velocity(const struct talus_body *body, const double position[3],
                          double velocity[3])
{
    double axis[3], square = 0.0, along = 0.0, offset = 0.0, shape, slope;
    for (size_t k = 0; k < 3; k++) {
        axis[k] = body->beam_to[k] - body->beam_from[k];
        square += axis[k] * axis[k];
        along += axis[k] * (position[k] - body->beam_from[k]);
    }
    const double share = along / square, place = fmin(fmax(share, 0.0), 1.0);
    seeding_beam_shape(body->beam_mode, place, &shape, &slope);
    shape += slope * (share - place) * (share > 1.0);
    for (size_t k = 0; k < 3; k++)
        offset += body->beam_tip[k] * (position[k] - body->beam_from[k] - share * axis[k]);
    for (size_t k = 0; k < 3; k++)
        velocity[k] = shape * body->beam_tip[k] - offset * slope * axis[k] / square;
}

void seeding_velocity_at(const struct talus_body *body, const double position[3],
                         double velocity[3])
{
    if (body->velocity_field == TALUS_VELOCITY_BEAM_MODE) {
        beam_velocity(body, position, velocity);
        return;
    }
    memcpy(velocity, body->velocity, 3 * sizeof *velocity);
    if (body->velocity_field == TALUS_VELOCITY_UNIFORM)
        return;
    double arm[3];
    const double *rate = body->rotation_rate;
    for (size_t k = 0; k < 3; k++)
        arm[k] = position[k] - body->rotation_about[k];
    velocity[0] = rate[1] * arm[2] - rate[2] * arm[1];
    velocity[1] = rate[2] * arm[0] - rate[0] * arm[2];
    velocity[2] = rate[0] * arm[1] - rate[1] * arm[0];
}

static double speed_at(const struct talus_body *body, const double position[3])
{
    double v[3];
    seeding_velocity_at(body, position, v);
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double seeding_largest_speed(const struct talus_scene *scene, const struct talus_body *body)
{
    struct seeding_shape shape;
    double largest = 0.0, low[3], high[3];
    seeding_shape_init(&shape, scene, body);
    seeding_shape_bounds(&shape, low, high);
    for (unsigned corner = 0; corner < 1u << scene->axis_count; corner++) {
        double position[3];
        for (size_t k = 0; k < 3; k++)
            position[k] = (corner >> k & 1u) != 0 ? high[k] : low[k];
        largest = fmax(largest, speed_at(body, position));
    }
    if (body->velocity_field == TALUS_VELOCITY_BEAM_MODE)
        largest = fmax(largest, speed_at(body, body->beam_to));
    return largest;
}
