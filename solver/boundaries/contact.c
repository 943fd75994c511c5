/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/contact_directions.h"

#include <string.h>

/* A face that may let go at all. */
static bool may_release(const struct contact *contact, const struct wall_face *face)
{
    return face->release &&
           !(contact->constraints_only && vector_dot(contact->pushed, face->normal) > 0);
}

/* The active face that pushes least beyond what it needs to stay; node count if all do. */
static size_t find_released(const struct contact *contact, const bool active[NODE_FACE_MAX])
{
    size_t worst = contact->node->count;
    double least = 0;
    for (size_t place = 0; place < contact->node->count; place++) {
        const struct wall_face *face = contact_face(contact, place);
        if (!active[place] || !may_release(contact, face))
            continue;
        const double excess = vector_dot(contact->impulse[place], face->normal) -
                              face->tension_force * contact->time_step;
        if (excess <= 0 && (worst == contact->node->count || excess < least)) {
            worst = place;
            least = excess;
        }
    }
    return worst;
}

/* Finds the faces in contact, and their normal impulses for a given free increment. `reach` is the
 * velocity whose excess in the span the walls take away: `taken`. */
static void find_active(struct contact *contact, const double reach[3], bool active[NODE_FACE_MAX],
                        struct span *span, double taken[3])
{
    struct directions directions;
    directions_list(contact, &directions);
    for (size_t place = 0; place < contact->node->count; place++)
        active[place] = true;
    for (;;) {
        double impulse[3];
        directions_span(&directions, active, span);
        span_excess(span, reach, taken);
        for (size_t axis = 0; axis < 3; axis++)
            impulse[axis] = -contact->mass * taken[axis];
        directions_split(&directions, active, impulse, contact->impulse);
        const size_t released = find_released(contact, active);
        if (released == contact->node->count)
            return;
        active[released] = false;
    }
}

/* The same for the one face of most wall nodes, whose normal is all that it prescribes. */
static void find_alone(struct contact *contact, const double reach[3], bool *active,
                       struct span *span, double taken[3])
{
    const struct wall_face *face = contact_face(contact, 0);
    const double *normal = face->normal;
    double speed = 0;
    for (size_t axis = 0; axis < 3 && face->moves; axis++)
        speed += normal[axis] * contact_face_speed(contact, face, axis);
    const double excess = vector_dot(reach, normal) - speed;
    *active = !may_release(contact, face) ||
              -contact->mass * excess > face->tension_force * contact->time_step;
    span->rank = *active ? 1 : 0;
    span->speed[0] = speed;
    for (size_t axis = 0; axis < 3; axis++) {
        span->basis[0][axis] = normal[axis];
        taken[axis] = *active ? excess * normal[axis] : 0.0;
        contact->impulse[0][axis] = -contact->mass * taken[axis];
    }
}

/* True if a node inside a box is held as a whole. */
static bool is_held(const struct contact *contact, size_t *held)
{
    for (size_t place = 0; place < contact->node->count; place++) {
        if (contact_face(contact, place)->face_index < 0) {
            *held = place;
            return true;
        }
    }
    return false;
}

static void hold(struct contact *contact, size_t held)
{
    const struct wall_face *face = contact_face(contact, held);
    for (size_t axis = 0; axis < 3; axis++) {
        const double speed = contact_face_speed(contact, face, axis);
        contact->velocity[axis] = contact->handed_velocity[axis] = contact->frame[axis] = speed;
        contact->impulse[held][axis] = -contact->mass * (contact->free_velocity[axis] - speed);
    }
}

/* True if some wall leaves the velocity of the particles to stress, and none prescribes it. */
static bool keeps_velocity(const struct contact *contact)
{
    bool keeps = false;
    for (size_t place = 0; place < contact->node->count; place++) {
        const struct wall_face *face = contact_face(contact, place);
        keeps = keeps || face->wall == TALUS_WALL_KEEP;
        if (face->moves)
            return false;
    }
    return keeps;
}

void contact_solve(struct contact *contact)
{
    const double *w = contact->free_velocity;
    size_t held = 0;
    memset(contact->frame, 0, sizeof contact->frame);
    if (is_held(contact, &held)) {
        memset(contact->impulse, 0, sizeof contact->impulse);
        hold(contact, held);
        return;
    }
    const bool keep = keeps_velocity(contact);
    const double *reach = keep ? contact->acceleration_increment : w;
    struct span span;
    bool active[NODE_FACE_MAX] = {false};
    double taken[3], excess[3], tangent[3];
    if (contact->node->count == 1 && contact_face(contact, 0)->prescribed == 0)
        find_alone(contact, reach, active, &span, taken);
    else
        find_active(contact, reach, active, &span, taken);
    span_excess(&span, w, excess);
    for (size_t axis = 0; axis < 3; axis++) {
        for (size_t index = 0; index < span.rank; index++)
            contact->frame[axis] += span.speed[index] * span.basis[index][axis];
        contact->velocity[axis] = w[axis] - excess[axis];
        contact->handed_velocity[axis] = w[axis] - taken[axis];
        tangent[axis] = contact->velocity[axis] - contact->frame[axis];
    }
    contact_apply_friction(contact, active, &span, tangent);
}

void contact_hold_back(struct contact *contact, double increment[3])
{
    contact->at_rest = true;
    memcpy(contact->free_velocity, increment, sizeof contact->free_velocity);
    memcpy(contact->acceleration_increment, increment, sizeof contact->acceleration_increment);
    contact_solve(contact);
    memcpy(increment, contact->velocity, sizeof contact->velocity);
}
