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
    double free_velocity[3]; /* [m/s] w: after the whole force of the step, without walls */
    double acceleration_increment[3]; /* [m/s] dt f/m, without walls */
    /* out */
    double velocity[3];               /* that strains and moves the material */
    double handed_velocity[3];        /* that the particles' increment must lead to; differs from
                                         `velocity` only along the normal of walls that `keep` */
    double impulse[NODE_FACE_MAX][3]; /* [N s] of each face on the material */
};

/* Solves the contact: normals by the subspace they span, one-sided faces by an active set, friction
 * on what remains (Mast 2013, sec. B.2.5; Andersen and Andersen 2012, eq. 53-55, corrected to the
 * free velocity). sum of impulses = mass (handed_velocity - free_velocity). */
void contact_solve(struct contact *contact);

/* The part of dt f/m that a node with these faces passes to its particles before the walls are
 * applied: the velocity that the walls would leave a node at rest under it. Constrained components,
 * and what friction can hold, are held back: a stiff body on a floor stays calm, and nodes may pass
 * from sticking to sliding and back without a jump that would feed energy to the particles. */
void contact_hold_back(const struct wall_face *faces, const struct node_faces *node, double mass,
                       double time_step, double increment[3]);

#endif
