/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/single_precision.h"

#include "seeding/seeding.h"
#include "seeding/seeding_shape.h"
#include "state/time_table.h"

#include <math.h>

/* Half a unit in the last place of a number in 1/2..1, relative to 1; of a position in the outer
 * half of a cell (1/4..1/2), in cells. */
#define ROUNDING 0x1p-24
#define POSITION_ROUNDING 0x1p-26
#define MOTION_LIMIT 0.1
#define NOISE_LIMIT 0.3
/* A sum of more equal parts than this has lost the last of them. */
#define STEP_LIMIT 0x1p24
/* Kernels form cubes of stresses, and nodes a millionth of a particle's mass. */
#define STIFFNESS_LIMIT 1e12
#define MASS_LIMIT 1e-28

static double length_of(const double vector[3])
{
    return sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
}

/* Extent along gravity [m]; 0 without gravity. */
static double body_height(const struct talus_scene *scene, size_t index)
{
    const enum talus_axis vertical = seeding_vertical_axis(scene);
    struct seeding_shape shape;
    if (vertical == TALUS_NO_AXIS)
        return 0;
    seeding_shape_init(&shape, scene, &scene->bodies[index]);
    double low[3], high[3];
    seeding_shape_bounds(&shape, low, high);
    return fmax(0, high[vertical] - low[vertical]);
}

/* Speed [m/s] at which a body moves where it moves slowest: as thrown; falling by its height; or,
 * if it starts without stress, settling under its weight (at once, or as gravity grows). */
static double body_speed(const struct run *run, size_t index, double gravity)
{
    const struct talus_body *body = &run->scene.bodies[index];
    const double wave = run->materials[body->material_index].wave_speed;
    const double height = body_height(&run->scene, index);
    const double ramp = run->scene.solver.force_ramp;
    double fall = sqrt(2 * gravity * height);
    if (body->initial_stress == TALUS_INITIAL_NONE && height > 0) {
        fall = fmin(fall, (1 - run->scene.solver.local_damping) * gravity * height / wave);
        if (ramp > height / wave)
            fall = fmin(fall, gravity * height * height / (2 * wave * wave * ramp));
    }
    return fmax(seeding_largest_speed(&run->scene, body), fall);
}

static double motion_error(const struct run *run, double time_step, double gravity)
{
    double worst = 0;
    for (size_t index = 0; index < run->scene.body_count; index++) {
        const double way =
            body_speed(run, index, gravity) * time_step / domain_smallest_cell(&run->grid.domain);
        if (way > 0)
            worst = fmax(worst, POSITION_ROUNDING / way);
    }
    return worst;
}

/* Rounding a velocity v makes a wave of stress rho c (rounding v); those of all steps add up like a
 * random walk. */
static double force_noise(const struct run *run, double time_step, double gravity)
{
    const double walk = ROUNDING * sqrt(fmax(1, run->scene.duration / time_step));
    double worst = 0;
    for (size_t index = 0; index < run->scene.body_count; index++) {
        const struct talus_body *body = &run->scene.bodies[index];
        const double wave = run->materials[body->material_index].wave_speed;
        const double height = body_height(&run->scene, index);
        const double speed =
            fmax(seeding_largest_speed(&run->scene, body), sqrt(2 * gravity * height));
        /* Over the density: the weight's stress, or that of an impact at this speed. */
        const double stress = gravity * height > 0 ? gravity * height : wave * speed;
        if (speed > 0)
            worst = fmax(worst, walk * wave * speed / stress);
    }
    return worst;
}

struct single_precision single_precision_estimate(const struct run *run, double time_step)
{
    double largest[3];
    for (size_t axis = 0; axis < 3; axis++)
        largest[axis] =
            time_table_largest(&run->scene.gravity_table[axis], run->scene.gravity[axis]);
    const double gravity = length_of(largest);
    return (struct single_precision){.motion_error = motion_error(run, time_step, gravity),
                                     .force_noise = force_noise(run, time_step, gravity)};
}

static enum talus_status refuse(struct talus_error *error, const char *what, double value,
                                const char *change)
{
    return talus_error_set(error, TALUS_INVALID, "precision", "/solver/precision",
                           "single precision is not safe here: %s (%.2g); use \"double\"%s", what,
                           value, change);
}

/* What floats can hold at all. */
static enum talus_status check_range(const struct run *run, struct talus_error *error)
{
    for (size_t index = 0; index < run->scene.body_count; index++) {
        const struct talus_body *body = &run->scene.bodies[index];
        const struct run_material *material = &run->materials[body->material_index];
        const double stiffness = material->density * material->wave_speed * material->wave_speed;
        struct seeding_report report;
        if (stiffness > STIFFNESS_LIMIT)
            return refuse(error, "the stiffness [Pa] leaves no room for its powers", stiffness, "");
        seeding_report(&run->scene, index, &report);
        const double mass =
            material->density * report.volume / fmax(1, (double)report.particle_count);
        if (mass < MASS_LIMIT)
            return refuse(error, "particles are too light [kg]", mass,
                          " or larger units of length and mass");
    }
    return TALUS_OK;
}

enum talus_status single_precision_check(const struct run *run, double time_step,
                                         struct talus_error *error)
{
    if (run->scene.solver.precision != TALUS_PRECISION_SINGLE)
        return TALUS_OK;
    const struct single_precision estimate = single_precision_estimate(run, time_step);
    if (run->node_fit.linear_count > 0)
        return refuse(error,
                      "linear fits over nodes take differences of squared coordinates [cells]",
                      (double)run->node_fit.origin[0], " or the field \"volumetric\"");
    if (estimate.motion_error > MOTION_LIMIT)
        return refuse(
            error,
            "bodies move so slowly for the time step that the rounding of positions takes "
            "too large a share of their motion",
            estimate.motion_error,
            ", a larger time_step, a softer material, or an initial_stress "
            "instead of settling");
    if (estimate.force_noise > NOISE_LIMIT)
        return refuse(error,
                      "the material is so stiff for its weight and speed that rounding makes too "
                      "large a share of the stress noise",
                      estimate.force_noise, ", a softer material or a shorter duration");
    if (run->scene.duration / time_step > STEP_LIMIT)
        return refuse(error, "so many steps add up to nothing", run->scene.duration / time_step,
                      ", a larger time_step or a shorter duration");
    return check_range(run, error);
}
