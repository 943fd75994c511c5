/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes built by hand, for tests of the solver without the JSON reader. */
#ifndef SIMULATION_FIXTURE_H
#define SIMULATION_FIXTURE_H

#include "material_fixture.h"
#include "talus/simulation.h"

enum { SIMULATION_FIXTURE_MATERIALS = 4, SIMULATION_FIXTURE_BODIES = 4 };
enum { SIMULATION_FIXTURE_BOUNDARIES = 8, SIMULATION_FIXTURE_PROBES = 24 };

/* The scene and everything that it points to; lives as long as its scene is used, must not be
 * copied or moved, and is never given to talus_scene_release. */
struct simulation_fixture {
    struct talus_scene scene;
    struct talus_material materials[SIMULATION_FIXTURE_MATERIALS];
    double values[SIMULATION_FIXTURE_MATERIALS][MATERIAL_PARAMETER_MAX];
    struct talus_body bodies[SIMULATION_FIXTURE_BODIES];
    struct talus_boundary boundaries[SIMULATION_FIXTURE_BOUNDARIES];
    struct talus_probe probes[SIMULATION_FIXTURE_PROBES];
};

/* An empty scene on a grid of cubes of edge `cell` with `count` cells an axis from the origin on;
 * modified_last, finite strain, automatic step, one second, no gravity. */
void simulation_fixture_init(struct simulation_fixture *fixture, size_t axis_count, double cell,
                             const int64_t count[3]);
/* Adds a material; returns its index. */
size_t simulation_fixture_add_material(struct simulation_fixture *fixture, const char *model,
                                       const struct setting *settings, size_t count);
/* Adds a model of the table with the parameters of fixture_init_sample. */
size_t simulation_fixture_add_sample(struct simulation_fixture *fixture,
                                     const struct material *material);
/* Index of a shape; fails the test if there is none. */
size_t simulation_fixture_shape(const char *name);
/* Adds a box of material with so many particles a cell and axis. */
struct talus_body *simulation_fixture_add_box(struct simulation_fixture *fixture, size_t material,
                                              const double min[3], const double max[3],
                                              double per_cell);
/* Adds an axis-aligned plane whose normal points to larger (`direction` 1) or smaller (-1)
 * coordinates. */
struct talus_boundary *simulation_fixture_add_plane(struct simulation_fixture *fixture,
                                                    const char *name, size_t axis,
                                                    double coordinate, double direction,
                                                    const char *condition, double friction);
/* Adds a box obstacle, the same condition on all faces. */
struct talus_boundary *simulation_fixture_add_obstacle(struct simulation_fixture *fixture,
                                                       const char *name, const double min[3],
                                                       const double max[3], const char *condition,
                                                       double friction);
struct talus_probe *simulation_fixture_add_probe(struct simulation_fixture *fixture,
                                                 const char *name, enum talus_probe_kind kind);

/* Creates a simulation; fails the test if that fails. */
struct talus_simulation *simulation_fixture_start(const struct simulation_fixture *fixture,
                                                  int threads);
/* Takes steps; fails the test if one fails. */
void simulation_run_steps(struct talus_simulation *simulation, size_t count);
/* Index of a history column; fails the test if there is none. */
size_t simulation_column(const struct talus_simulation *simulation, const char *name);
/* A metric by name; fails the test if there is none. */
double simulation_metric(struct talus_simulation *simulation, const char *name);
/* A field of all particles in order of id; the caller frees it. */
double *simulation_field(const struct talus_simulation *simulation, enum talus_field field,
                         size_t components);
size_t simulation_particle_count(const struct talus_simulation *simulation);

/* Fails the test unless |actual - expected| <= tolerance * scale. */
void assert_close(double actual, double expected, double tolerance, double scale);

#endif
