/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes in 3D whose bodies are balls and cylinders about one line along the grid, whole or cut in
 * halves and quarters by smooth planes through that line. */
#include "scene/scene_advice.h"
#include "scene/scene_geometry.h"

#include "seeding/seeding_lattice.h"

#include <math.h>
#include <stdio.h>

struct revolution {
    const struct talus_scene *scene;
    size_t axis;
    double centre[3]; /* [m] of the line, across it */
    int side[3];      /* across it: 0 the whole is there; 1, -1 the half beyond or before it */
};

static bool near(const struct revolution *line, size_t k, double a, double b)
{
    return scene_near(a, b, line->scene->grid.cell[k]);
}

/* Which half of a body about the line is there: 2 if it is something else. */
static int side_of(const struct revolution *line, const struct seeding_shape *shape, size_t k)
{
    const double radius = shape->body->radius, centre = line->centre[k];
    const bool low = near(line, k, shape->min[k], centre - radius);
    const bool high = near(line, k, shape->max[k], centre + radius);
    if (low && high)
        return 0;
    if (high && near(line, k, shape->min[k], centre))
        return 1;
    return low && near(line, k, shape->max[k], centre) ? -1 : 2;
}

static bool loads_revolve(const struct talus_body *body)
{
    bool revolve = true;
    for (size_t index = 0; index < body->traction_count; index++)
        revolve = revolve && body->tractions[index].is_pressure;
    return revolve;
}

/* True if the body is one of revolution about the line, and moves along it only; the first one says
 * where the line is and which part is there. */
static bool body_revolves(struct revolution *line, const struct talus_body *body, bool first)
{
    struct seeding_shape shape;
    seeding_shape_init(&shape, line->scene, body);
    const bool cylinder = body->shape == TALUS_BODY_CYLINDER;
    if ((!cylinder && body->shape != TALUS_BODY_SPHERE) || shape.turned ||
        body->velocity_field != TALUS_VELOCITY_UNIFORM || !loads_revolve(body) ||
        body->initial_stress == TALUS_INITIAL_GIVEN)
        return false;
    const double *place = cylinder ? body->from : body->centre;
    for (size_t k = 0; k < 3; k++) {
        if (k == line->axis)
            continue;
        if (first)
            line->centre[k] = place[k];
        const int side = side_of(line, &shape, k);
        if (first)
            line->side[k] = side;
        if (side == 2 || side != line->side[k] || !near(line, k, place[k], line->centre[k]) ||
            body->velocity[k] != 0.0 || (cylinder && !near(line, k, body->to[k], place[k])))
            return false;
    }
    return true;
}

/* Planes across the line that do not move along themselves; smooth ones through it where the bodies
 * are cut. */
static bool boundary_revolves(const struct revolution *line, const struct talus_boundary *boundary)
{
    bool across =
        boundary->shape == TALUS_BOUNDARY_PLANE && fabs(boundary->normal[line->axis]) > 1.0 - 1e-9;
    for (size_t k = 0; k < 3; k++) {
        if (k == line->axis)
            continue;
        across = across && boundary->velocity[k] == 0.0 && boundary->velocity_tables[k].count == 0;
        if (line->side[k] != 0 &&
            scene_mirror_is_at(line->scene, boundary, k, line->centre[k], line->side[k]))
            return true;
    }
    return across;
}

static bool cuts_are_held(const struct revolution *line)
{
    bool all = true;
    for (size_t k = 0; k < 3; k++) {
        bool held = k == line->axis || line->side[k] == 0;
        for (size_t index = 0; index < line->scene->boundary_count && !held; index++)
            held = scene_mirror_is_at(line->scene, &line->scene->boundaries[index], k,
                                      line->centre[k], line->side[k]);
        all = all && held;
    }
    return all;
}

static bool scene_revolves(struct revolution *line)
{
    const struct talus_scene *scene = line->scene;
    bool revolves = scene->slope_count == 0 && scene->body_count > 0;
    for (size_t k = 0; k < 3; k++)
        revolves = revolves && (k == line->axis ||
                                (scene->gravity[k] == 0.0 && scene->gravity_table[k].count == 0));
    for (size_t index = 0; index < scene->body_count && revolves; index++)
        revolves = body_revolves(line, &scene->bodies[index], index == 0);
    for (size_t index = 0; index < scene->boundary_count && revolves; index++)
        revolves = boundary_revolves(line, &scene->boundaries[index]);
    return revolves && cuts_are_held(line);
}

/* Particles of half a section through the line, with the spacing that the bodies have. */
static double section_particles(const struct revolution *line)
{
    const double quarter = 3.14159265358979323846 / 4.0;
    const struct talus_scene *scene = line->scene;
    const size_t across = (line->axis + 1) % 3;
    double particles = 0.0;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        struct seeding_lattice lattice;
        seeding_lattice_init(&lattice, scene, body);
        double area =
            body->radius * (lattice.shape.max[line->axis] - lattice.shape.min[line->axis]);
        if (body->shape == TALUS_BODY_SPHERE)
            area *= quarter;
        particles += area / (lattice.spacing[line->axis] * lattice.spacing[across]);
    }
    return particles;
}

void scene_advise_revolution(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    for (size_t axis = 0; axis < 3 && scene->dimension == TALUS_SOLID; axis++) {
        struct revolution line = {.scene = scene, .axis = axis};
        if (!scene_revolves(&line) || advice->estimate == NULL)
            continue;
        char detail[128], saves[160];
        const double factor =
            (double)advice->estimate->particle_count / fmax(1.0, section_particles(&line));
        (void)snprintf(detail, sizeof detail,
                       "everything in this scene is a body of revolution about a line along %c",
                       "xyz"[axis]);
        (void)snprintf(
            saves, sizeof saves,
            "a factor of about %.2g in particles, twice that in the time of long runs (extensive "
            "results are then those of the whole circle)",
            factor);
        advice->settled_axes |= 7u & ~(1u << axis);
        scene_advise(advice, &(struct scene_advice_item){
                                 .pointer = "/dimension",
                                 .code = "body_of_revolution",
                                 .detail = detail,
                                 .change = "\"dimension\": \"axisymmetric\", with the distance "
                                           "from that line as x and the way along it as y",
                                 .saves = saves,
                                 .quantity = "particle_steps",
                                 .factor = factor,
                             });
        return;
    }
}
