/* SPDX-License-Identifier: Apache-2.0 */
/* Small scenes, filled by hand. */
#ifndef TALUS_SEEDING_FIXTURE_H
#define TALUS_SEEDING_FIXTURE_H

#include "materials/material.h"
#include "seeding/seeding.h"

enum { FIXTURE_BODY_MAX = 2 };

struct seeding_fixture {
    struct talus_scene scene;
    struct talus_body bodies[FIXTURE_BODY_MAX];
    struct talus_boundary boundary;
    struct talus_material material;
    double values[MATERIAL_PARAMETER_MAX];
};

/* A scene of `axis_count` dimensions with one unit box at the origin, cells of 0.25 m from -10 to
 * 10 m, 2 particles per cell, and a material of that model with density 2000 and nu = 0.25. */
void fixture_init(struct seeding_fixture *fixture, size_t axis_count, const char *model);
void fixture_set(struct seeding_fixture *fixture, const char *key, double value);

#endif
