/* SPDX-License-Identifier: Apache-2.0 */
/* Walls of the reference code: axis-aligned planes on grid lines, at most one an axis and node. */
#ifndef REFERENCE_WALL_H
#define REFERENCE_WALL_H

#include "talus/scene.h"

#include <stdbool.h>

enum { REFERENCE_WALL_MAX = 8 };

struct reference_wall {
    int axis, line;
    double normal;   /* +1 or -1 along the axis */
    double friction; /* coefficient; 0: slip, INFINITY: stick */
    bool keeps, releases;
    double tension_force;
};

struct reference_contact {
    double free_velocity[3], increment[3]; /* in: w, and dt f/m */
    const double *pushed; /* in: impulse of the step before, for velocities that no force changes:
                             no friction, and what pushed still holds; else NULL */
    double velocity[3], handed[3];         /* out */
    double impulse[REFERENCE_WALL_MAX][3]; /* out: on the material */
};

struct reference_wall reference_wall_read(const struct talus_scene *scene, size_t boundary_index);
bool reference_wall_holds(const struct reference_wall *wall, const int node[3]);
/* Walls `active[]` of the node act. */
void reference_contact_solve(const struct reference_wall *walls, int wall_count, const bool *active,
                             double mass, double time_step, struct reference_contact *contact);
/* What of dt f/m the particles get before the walls are applied. */
void reference_hold_back(const struct reference_wall *walls, int wall_count, const bool *active,
                         double mass, double time_step, double increment[3]);

#endif
