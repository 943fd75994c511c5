/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/speed_forecast.h"

#include "seeding/seeding.h"
#include "seeding/seeding_shape.h"
#include "state/time_table.h"

#include <math.h>

/* Of what gravity could give the fastest particle, over the run: it falls late, or lands early. */
#define SHARE_OF_FALL 0.5
/* Planes within some 45 degrees of level are floors. */
#define FLOOR_NORMAL 0.7

/* Largest magnitude of three components at any time. */
static double largest_of(const struct talus_time_table tables[3], const double constant[3])
{
    double square = 0;
    for (size_t axis = 0; axis < 3; axis++) {
        const double largest = time_table_largest(&tables[axis], constant[axis]);
        square += largest * largest;
    }
    return sqrt(square);
}

static size_t steepest_axis(const struct talus_scene *scene)
{
    size_t found = 0;
    double largest = 0;
    for (size_t axis = 0; axis < scene->axis_count; axis++) {
        const double size = time_table_largest(&scene->gravity_table[axis], scene->gravity[axis]);
        if (size > largest) {
            largest = size;
            found = axis;
        }
    }
    return found;
}

/* Way [m] along `axis` that the highest particle between `low` and `high` can fall. */
static double drop_height(const struct talus_scene *scene, size_t axis, double low, double high)
{
    const struct talus_grid *grid = &scene->grid;
    const double bottom = grid->min[axis];
    const double top = bottom + grid->cell[axis] * (double)grid->cell_count[axis];
    if (scene->gravity_table[axis].count > 0)
        return top - bottom;
    const double down = scene->gravity[axis] > 0 ? 1 : -1;
    const double start = down > 0 ? low : high;
    double height = down > 0 ? top - start : start - bottom;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        const double below = down * (boundary->point[axis] - start);
        if (boundary->shape == TALUS_BOUNDARY_PLANE && !boundary->timed && below > 0 &&
            -down * boundary->normal[axis] > FLOOR_NORMAL)
            height = fmin(height, below);
    }
    return fmax(height, 0);
}

/* Mean over `duration` of a speed that grows from `start` by `gravity` until it reaches `most`. */
static double mean_of_fall(double start, double gravity, double most, double duration)
{
    const double until = gravity > 0 ? (most - start) / gravity : 0;
    if (until >= duration)
        return start + 0.5 * gravity * duration;
    return most - 0.5 * (most - start) * until / duration;
}

static double fastest_wall(const struct talus_scene *scene)
{
    double fastest = 0;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        if (boundary->prescribed != 0)
            fastest = fmax(fastest, largest_of(boundary->velocity_tables, boundary->velocity));
    }
    return fastest;
}

/* Speed [m/s] of material behind the wave of the strongest traction on a body. */
static double pushed_speed(const struct talus_body *body, double impedance)
{
    double pressure = 0;
    for (size_t index = 0; index < body->traction_count; index++)
        pressure =
            fmax(pressure, largest_of(body->tractions[index].table, body->tractions[index].value));
    return pressure / impedance;
}

/* Mean speed [m/s] of the fastest particle in free fall, and the speed of a front that all the
 * weight behind it drives: 2 sqrt(g H) (Ritter 1892, of a dam that breaks). */
struct fall {
    double free, driven;
};

static struct fall fall_of(const struct talus_scene *scene, const struct talus_body *body,
                           double start)
{
    struct seeding_shape shape;
    double low[3], high[3];
    const size_t axis = steepest_axis(scene);
    const double gravity = largest_of(scene->gravity_table, scene->gravity);
    seeding_shape_init(&shape, scene, body);
    seeding_shape_bounds(&shape, low, high);
    const double height = drop_height(scene, axis, low[axis], high[axis]);
    const double most = sqrt(start * start + 2 * gravity * height);
    return (struct fall){mean_of_fall(start, gravity, most, scene->duration),
                         sqrt(start * start + 4 * gravity * height)};
}

struct speed_forecast speed_forecast_make(const struct run *run)
{
    const struct talus_scene *scene = &run->scene;
    const double wall = fastest_wall(scene);
    struct speed_forecast forecast = {.start = 0};
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        const struct run_material *material = &run->materials[run->body_material[index]];
        const double wave = material->wave_speed;
        const double start = seeding_largest_speed(scene, body);
        const struct fall fall = fall_of(scene, body, start);
        const double push = pushed_speed(body, material->density * wave);
        const double motion = fmax(start + SHARE_OF_FALL * (fall.free - start) + push, wall);
        forecast.start = fmax(forecast.start, wave + start);
        forecast.low = fmax(forecast.low, wave);
        forecast.expected = fmax(forecast.expected, wave + motion);
        forecast.high = fmax(forecast.high, wave + fall.driven + 2 * push + wall);
        forecast.motion = fmax(forecast.motion, motion);
    }
    return forecast;
}
