/* SPDX-License-Identifier: Apache-2.0 */
/* What the faces at one node prescribe: directions, the space that they span, and how an impulse in
 * it is split among them. Shared by the parts of contact.c. */
#ifndef TALUS_CONTACT_DIRECTIONS_H
#define TALUS_CONTACT_DIRECTIONS_H

#include "boundaries/contact.h"

/* A face prescribes the velocity along its normal, or along up to three axes. */
enum { DIRECTION_MAX = 3 * NODE_FACE_MAX };

struct direction {
    size_t place; /* of the face in node_faces */
    double vector[3], speed;
};

struct directions {
    size_t count;
    struct direction items[DIRECTION_MAX];
};

/* Orthonormal basis of what the walls prescribe, with the speed along each of its vectors. */
struct span {
    size_t rank;
    double basis[3][3], speed[3];
};

static inline double vector_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline const struct wall_face *contact_face(const struct contact *contact, size_t place)
{
    return &contact->faces[contact->node->face[place]];
}

/* Velocity of a face as this contact sees it [m/s]. */
static inline double contact_face_speed(const struct contact *contact, const struct wall_face *face,
                                        size_t axis)
{
    return contact->at_rest ? 0.0 : face->velocity[axis];
}

/* The directions of all faces. Prescribed velocities come first: where faces contradict each other,
 * they win. */
void directions_list(const struct contact *contact, struct directions *directions);
/* Spans the directions of the active faces; residuals below 1e-6 are dropped. */
void directions_span(const struct directions *directions, const bool active[NODE_FACE_MAX],
                     struct span *span);
/* What a vector has in the span beyond the speeds that are prescribed there. */
void span_excess(const struct span *span, const double vector[3], double excess[3]);
/* Splits an impulse in the span of the active directions among their faces. */
void directions_split(const struct directions *directions, const bool active[NODE_FACE_MAX],
                      const double whole[3], double impulse[NODE_FACE_MAX][3]);

/* Friction on what the span leaves of the velocity, `tangent` relative to it; contact_friction.c */
void contact_apply_friction(struct contact *contact, const bool active[NODE_FACE_MAX],
                            const struct span *span, const double tangent[3]);

#endif
