/* SPDX-License-Identifier: Apache-2.0 */
#include "reference_wall.h"

#include "boundaries/boundary.h"

#include <math.h>
#include <string.h>

struct reference_wall reference_wall_read(const struct talus_scene *scene, size_t boundary_index)
{
    const struct talus_boundary *boundary = &scene->boundaries[boundary_index];
    const char *condition = boundary_table[boundary->faces[0].condition_index]->name;
    struct reference_wall wall = {.keeps = boundary->wall == TALUS_WALL_KEEP,
                                  .releases = boundary->tension_release,
                                  .tension_force = boundary->tension_force};
    while (boundary->normal[wall.axis] == 0)
        wall.axis++;
    wall.normal = boundary->normal[wall.axis];
    wall.line = (int)lround((boundary->point[wall.axis] - scene->grid.min[wall.axis]) /
                            scene->grid.cell[wall.axis]);
    if (strcmp(condition, "stick") == 0)
        wall.friction = INFINITY;
    else if (strcmp(condition, "friction") == 0)
        wall.friction = boundary->faces[0].friction_coefficient;
    return wall;
}

bool reference_wall_holds(const struct reference_wall *wall, const int node[3])
{
    return wall->normal > 0 ? node[wall->axis] <= wall->line : node[wall->axis] >= wall->line;
}

void reference_contact_solve(const struct reference_wall *walls, int wall_count, const bool *active,
                             double mass, double time_step, struct reference_contact *contact)
{
    bool keeps = false;
    double limit[REFERENCE_WALL_MAX] = {0}, total = 0, tangent[3], speed = 0;
    int sticking = 0;
    memset(contact->impulse, 0, sizeof contact->impulse);
    for (int k = 0; k < wall_count; k++)
        keeps = keeps || (active[k] && walls[k].keeps);
    const double *reach = keeps ? contact->increment : contact->free_velocity;
    memcpy(contact->velocity, contact->free_velocity, sizeof contact->velocity);
    memcpy(contact->handed, contact->free_velocity, sizeof contact->handed);
    for (int k = 0; k < wall_count; k++) {
        const int axis = walls[k].axis;
        const double push = -mass * reach[axis] * walls[k].normal;
        const bool held = contact->pushed != NULL && contact->pushed[axis] * walls[k].normal > 0;
        if (!active[k] ||
            (walls[k].releases && !held && push <= walls[k].tension_force * time_step))
            continue;
        contact->velocity[axis] = 0;
        contact->handed[axis] = contact->free_velocity[axis] - reach[axis];
        contact->impulse[k][axis] = push * walls[k].normal;
        if (isinf(walls[k].friction))
            sticking++;
        else if (contact->pushed == NULL)
            total += limit[k] = walls[k].friction * fmax(push, 0);
    }
    memcpy(tangent, contact->velocity, sizeof tangent);
    for (int axis = 0; axis < 3; axis++)
        speed += tangent[axis] * tangent[axis];
    speed = sqrt(speed);
    if (speed == 0 || (total == 0 && sticking == 0))
        return;
    const double share = sticking > 0 ? 1.0 : fmin(1.0, total / (mass * speed));
    for (int axis = 0; axis < 3; axis++) {
        contact->velocity[axis] -= share * tangent[axis];
        contact->handed[axis] -= share * tangent[axis];
        for (int k = 0; k < wall_count; k++) {
            const bool sticks = isinf(walls[k].friction);
            if (active[k] && (sticking > 0 ? sticks : limit[k] > 0))
                contact->impulse[k][axis] -=
                    mass * share * tangent[axis] * (sticks ? 1.0 / sticking : limit[k] / total);
        }
    }
}

void reference_hold_back(const struct reference_wall *walls, int wall_count, const bool *active,
                         double mass, double time_step, double increment[3])
{
    /* A node at rest under this increment alone: what it cannot follow is held back. */
    struct reference_contact contact = {.pushed = NULL};
    memcpy(contact.free_velocity, increment, sizeof contact.free_velocity);
    memcpy(contact.increment, increment, sizeof contact.increment);
    reference_contact_solve(walls, wall_count, active, mass, time_step, &contact);
    memcpy(increment, contact.velocity, sizeof contact.velocity);
}
