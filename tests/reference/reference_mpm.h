/* SPDX-License-Identifier: Apache-2.0 */
/* A textbook material point method: an array of particles, a dense grid, hat functions by their
 * formula. As slow and as plain as the equations; what the core is compared with. */
#ifndef REFERENCE_MPM_H
#define REFERENCE_MPM_H

#include "reference_material.h"
#include "reference_wall.h"
#include "talus/simulation.h"

#include <stddef.h>

struct reference_particle {
    double position[3], velocity[3];
    double mass, reference_volume, volume_ratio;
    struct tensor elastic; /* b^e at finite strain, e at small; fluid: ln J in [0][0] */
    struct reference_history history;
    size_t material;
    double plastic;
    /* of the present step */
    struct tensor gradient, force_stress;
    struct tensor affine; /* slope of the velocity, apic [1/s] */
    double grid_velocity[3], divergence;
    struct reference_update update;
    int cell;
    double gathered[3]; /* where it was when the step gathered: in that cell, before the move */
};

struct reference_node {
    double position[3];
    double mass, force[3], momentum[3];
    double before[3]; /* velocity before the forces */
    double passed[3]; /* what the walls let pass of the forces */
    double kick[3], velocity[3], correction[3];
    double motion[3], straining[3]; /* velocities between start and end of the step */
    double wall_impulse[3];         /* on the material, in the last step */
};

struct reference {
    const struct talus_scene *scene;
    struct reference_particle *particles; /* owned */
    struct reference_node *nodes;         /* owned, dense */
    size_t particle_count, node_count;
    int node_line[3]; /* nodes an axis */
    struct reference_wall walls[REFERENCE_WALL_MAX];
    int wall_count;
    double time, time_step, mass_cutoff;
    double external_energy; /* work of the force ramp so far [J] */
    double plastic_energy, viscous_energy, damping_energy, wall_energy; /* dissipated so far [J] */
    double wall_impulse[REFERENCE_WALL_MAX][3]; /* of the last step, on the walls [N s] */
};

struct reference_energy {
    double kinetic, strain, potential, dissipated, external;
};

/* From the particles of a simulation at t = 0 (positions, velocities, masses, volumes). */
void reference_start(struct reference *reference, const struct talus_scene *scene,
                     const struct talus_simulation *simulation);
void reference_step(struct reference *reference);
void reference_release(struct reference *reference);
struct reference_energy reference_energies(const struct reference *reference);
void reference_momentum(const struct reference *reference, double momentum[3]);

/* ---- reference_stress.c: strain, anti-locking, stress; with a zero step only stress ---- */
void reference_update_stress(struct reference *reference, double time_step);

/* ---- reference_fit.c: anti-locking as the scene asks for it ---- */
enum reference_fitted { REFERENCE_STRAIN, REFERENCE_STRESS, REFERENCE_DIVERGENCE };
void reference_fit(struct reference *reference, enum reference_fitted what);

/* Weight and gradient of the hat function of a node at a point (Mast 2013, sec. 2.4.1). */
double reference_hat(const struct reference *reference, const int node[3], const double position[3],
                     double gradient[3]);

#endif
