/* SPDX-License-Identifier: Apache-2.0 */
/* From bodies (shape, lattice, initial stress) to particles, as flat arrays. No JSON, no files. */
#ifndef TALUS_SEEDING_H
#define TALUS_SEEDING_H

#include "talus/scene.h"
#include "talus/status.h"

/* Particles of all bodies in the order of the scene; within a body in lattice order (x fastest).
 * The id of a particle is its index here. Arrays are owned by the seed. */
struct particle_seed {
    size_t count;
    double *position[3]; /* [count] m; components beyond the dimension 0 */
    double *velocity[3]; /* [count] m/s */
    double *volume;      /* [count] current volume, m^3 (per metre / m^2) */
    double *mass;        /* [count] kg = density x volume */
    double *stress[6];   /* [count] initial Cauchy stress [Pa]; NULL if no body has any */
    double **traction;   /* [traction_components][count] m^2, see state/traction_layout.h */
    size_t traction_components;
    uint16_t *body;        /* [count] index of the body */
    double (*spacing)[3];  /* [body_count] of the particles along the axes of the body's lattice,
                              with  which they fill their volume [m]; 0: a list of points */
    double *volume_factor; /* [body_count] common factor that makes the volume of a body exact */
};

/* Seeds all bodies. TALUS_INVALID with a pointer into the scene ("/bodies/0/...") for a body
 * without particles, a volume factor outside 0.9..1.1, material outside the grid or inside a box
 * obstacle. */
TALUS_MUST_CHECK enum talus_status seeding_create(const struct talus_scene *scene,
                                                  struct particle_seed *seed,
                                                  struct talus_error *error);
void seeding_release(struct particle_seed *seed);

/* Bodies with more lattice points than this in all are refused before anything is allocated. */
enum { SEEDING_PARTICLE_MAX = 200000000 };

/* Checks one body without allocating: empty shape, no particles, volume factor, particle limit,
 * material outside the grid or inside a box obstacle. Errors as in seeding_create. A body whose
 * lattice has more than 2^20 rows (shared by all bodies) is not counted out: its volume factor is
 * left to seeding_create. */
TALUS_MUST_CHECK enum talus_status seeding_check(const struct talus_scene *scene, size_t body_index,
                                                 struct talus_error *error);

/* Without allocating particles, in microseconds to milliseconds: how many particles the bodies get
 * (exact for boxes and up to 2^16 lattice rows, otherwise body volume over lattice cell
 * volume) and how many cells their bounding boxes touch (exact for boxes; cells that bodies share
 * count twice). Never overflows: saturates at UINT64_MAX. */
void seeding_count(const struct talus_scene *scene, uint64_t *particle_count, uint64_t *cell_count);

/* What one body gets, without allocating its particles. */
struct seeding_report {
    uint64_t particle_count; /* as in seeding_count */
    double volume;           /* as seeding_body_volume */
    double volume_factor;    /* [-] as in struct particle_seed */
};
void seeding_report(const struct talus_scene *scene, size_t body_index,
                    struct seeding_report *report);

/* Volume of a body's shape after clipping [m^3, m^2 x 1 m, m x 1 m^2]. */
double seeding_body_volume(const struct talus_scene *scene, const struct talus_body *body);

/* Ratio of horizontal to vertical initial stress [-] that a body's K0 rule gives: as given; elastic
 * nu/(1-nu); Jaky 1-sin(phi) (Andersen 2012, eq. 51); auto: the larger of nu/(1-nu) and the active
 * coefficient (1-sin(phi))/(1+sin(phi)). */
double seeding_k0(const struct talus_scene *scene, const struct talus_body *body);

/* Largest speed [m/s] of a body at the start: over the corners of its bounding box, and at the free
 * end of a beam. */
double seeding_largest_speed(const struct talus_scene *scene, const struct talus_body *body);

/* Axis on which gravity is largest (depth runs along it), or TALUS_NO_AXIS without gravity. */
enum talus_axis seeding_vertical_axis(const struct talus_scene *scene);

#endif
