/* SPDX-License-Identifier: Apache-2.0 */
/* What the faces at one node do to its velocity, and the impulse that each of them exerts. */
#ifndef TALUS_CONTACT_H
#define TALUS_CONTACT_H

#include "boundaries/boundary.h"

struct contact {
    /* in */
    const struct wall_face *faces; /* wall_set.faces */
    const struct node_faces *node;
    double mass;             /* [kg] */
    double time_step;        /* [s] */
    double density;          /* [kg/m^3] of material that fills the half cell at a wall */
    double gravity;          /* [m/s^2] magnitude */
    double free_velocity[3]; /* [m/s] w: after the whole force of the step, without walls */
    double acceleration_increment[3]; /* [m/s] dt f/m, without walls */
    bool at_rest;                     /* takes the walls as if they stood still */
    bool constraints_only; /* leave out friction, which is an impulse of the step; one-sided faces
                              hold where they pushed in the step before */
    double pushed[3];      /* constraints_only: impulse of the step before [N s] */
    /* out */
    double velocity[3];               /* that strains and moves the material */
    double handed_velocity[3];        /* that the particles' increment must lead to; differs from
                                         `velocity` only along the normal of walls that `keep` */
    double impulse[NODE_FACE_MAX][3]; /* [N s] of each face on the material */
    double frame[3]; /* [m/s] velocity of the walls, in the directions in which they hold or rub */
};

/* Solves the contact: what the faces prescribe by the subspace it spans, one-sided faces by an
 * active set, friction on what remains (Mast 2013, sec. B.2.5; Andersen and Andersen 2012, eq.
 * 53-55, corrected to the free velocity).
 * sum of impulses = mass (handed_velocity - free_velocity). */
void contact_solve(struct contact *contact);

/* The part of dt f/m that a node with these faces passes to its particles before the walls are
 * applied: the velocity that the walls, standing still, would leave a node at rest under it.
 * Constrained components, and what friction can hold, are held back: a stiff body on a floor stays
 * calm, and nodes may pass from sticking to sliding and back without a jump that would feed energy
 * to the particles. Reads faces to gravity of `contact`, uses the rest. */
void contact_hold_back(struct contact *contact, double increment[3]);

#endif
