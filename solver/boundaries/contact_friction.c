/* SPDX-License-Identifier: Apache-2.0 */
/* Friction at one node: what the faces can do against sliding, shared among them in proportion. */
#include "boundaries/contact_directions.h"

#include <math.h>
#include <string.h>

/* What the condition of a face may know of the node that it holds. */
static struct wall_grip grip_of(const struct contact *contact, size_t place)
{
    const struct wall_face *face = contact_face(contact, place);
    const double area = contact->node->area[place];
    const double full = contact->density * area * face->half_cell;
    const double share = full > contact->mass ? contact->mass / full : 1.0;
    return (struct wall_grip){
        .push = fmax(0, vector_dot(contact->impulse[place], face->normal)),
        .area = share * area,
        .density = area > 0 ? contact->mass / (share * area * face->half_cell) : 0.0,
        .gravity = contact->gravity,
        .time_step = contact->time_step,
    };
}

/* What the active faces can do against sliding. Of the faces, those of the node are filled in. */
struct resistance {
    double limit[NODE_FACE_MAX], drag[NODE_FACE_MAX]; /* [N s], [N s / (m/s)^2] */
    double limit_sum, drag_sum;
    size_t unlimited;
};

static void find_resistance(const struct contact *contact, const bool active[NODE_FACE_MAX],
                            struct resistance *resistance)
{
    resistance->limit_sum = resistance->drag_sum = 0;
    resistance->unlimited = 0;
    for (size_t place = 0; place < contact->node->count; place++) {
        const struct boundary_condition *condition = contact_face(contact, place)->condition;
        resistance->limit[place] = resistance->drag[place] = 0;
        if (!active[place] || condition->tangential_limit == NULL)
            continue;
        const struct wall_face *face = contact_face(contact, place);
        const struct wall_grip grip = grip_of(contact, place);
        const double limit = condition->tangential_limit(face, &grip);
        if (contact->constraints_only && !isinf(limit))
            continue;
        resistance->limit[place] = limit;
        if (condition->tangential_drag != NULL)
            resistance->drag[place] = condition->tangential_drag(face, &grip);
        if (isinf(limit))
            resistance->unlimited++;
        else
            resistance->limit_sum += limit;
        resistance->drag_sum += resistance->drag[place];
    }
}

/* Share of the tangential momentum that a face takes. */
static double part_of(const struct resistance *resistance, size_t place, double square)
{
    if (resistance->unlimited > 0)
        return isinf(resistance->limit[place]) ? 1.0 / (double)resistance->unlimited : 0.0;
    return (resistance->limit[place] + resistance->drag[place] * square) /
           (resistance->limit_sum + resistance->drag_sum * square);
}

/* Speed that is left of `speed`: m v + drag v^2 = m speed - limit, or 0 where the limit is not
 * reached. Drag at the end of the step never reverses the motion. */
static double speed_left(const struct resistance *resistance, double mass, double speed)
{
    const double beyond = mass * speed - resistance->limit_sum;
    if (resistance->unlimited > 0 || beyond <= 0)
        return 0.0;
    return 2 * beyond / (mass + sqrt(mass * mass + 4 * resistance->drag_sum * beyond));
}

/* Velocity, within what the walls leave free, of the faces that resist: their mean by limit. */
static void find_frame(const struct contact *contact, const struct resistance *resistance,
                       const struct span *span, double frame[3])
{
    double mean[3] = {0, 0, 0};
    bool moves = false;
    memset(frame, 0, 3 * sizeof *frame);
    for (size_t place = 0; place < contact->node->count; place++) {
        const struct wall_face *face = contact_face(contact, place);
        if (!face->moves)
            continue;
        const double part = part_of(resistance, place, 1.0);
        moves = true;
        for (size_t axis = 0; axis < 3; axis++)
            mean[axis] += part * contact_face_speed(contact, face, axis);
    }
    for (size_t axis = 0; axis < 3 && moves; axis++) {
        frame[axis] = mean[axis];
        for (size_t index = 0; index < span->rank; index++)
            frame[axis] -= vector_dot(mean, span->basis[index]) * span->basis[index][axis];
    }
}

static bool any_rubs(const struct contact *contact, const bool active[NODE_FACE_MAX])
{
    bool rubs = false;
    for (size_t place = 0; place < contact->node->count; place++)
        rubs = rubs ||
               (active[place] && contact_face(contact, place)->condition->tangential_limit != NULL);
    return rubs;
}

void contact_apply_friction(struct contact *contact, const bool active[NODE_FACE_MAX],
                            const struct span *span, const double tangent[3])
{
    struct resistance resistance;
    double frame[3], sliding[3];
    if (!any_rubs(contact, active))
        return;
    find_resistance(contact, active, &resistance);
    if (resistance.limit_sum == 0 && resistance.drag_sum == 0 && resistance.unlimited == 0)
        return;
    find_frame(contact, &resistance, span, frame);
    for (size_t axis = 0; axis < 3; axis++) {
        sliding[axis] = tangent[axis] - frame[axis];
        contact->frame[axis] += frame[axis];
    }
    const double speed = sqrt(vector_dot(sliding, sliding));
    if (speed == 0)
        return;
    const double left = speed_left(&resistance, contact->mass, speed);
    const double taken = left == 0 ? 1.0
                                   : (resistance.limit_sum + resistance.drag_sum * left * left) /
                                         (contact->mass * speed);
    for (size_t place = 0; place < contact->node->count; place++) {
        const double part = part_of(&resistance, place, left * left);
        for (size_t axis = 0; axis < 3; axis++)
            contact->impulse[place][axis] -= part * taken * contact->mass * sliding[axis];
    }
    for (size_t axis = 0; axis < 3; axis++) {
        /* Exactly zero when it sticks, so that a block at rest does not creep. */
        const double removed = left == 0 ? sliding[axis] : taken * sliding[axis];
        contact->velocity[axis] -= removed;
        contact->handed_velocity[axis] -= removed;
    }
}
