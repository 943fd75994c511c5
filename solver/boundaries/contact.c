/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/contact.h"

#include <string.h>

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Orthonormal basis of the space that the normals of the active faces span; the inside of a box
 * (no normal) spans all. Residuals below 1e-6 are dropped. Returns the rank. */
static size_t span_normals(const struct wall_face *faces, const struct node_faces *node,
                           const bool active[NODE_FACE_MAX], double basis[3][3])
{
    size_t rank = 0;
    for (size_t index = 0; index < node->count; index++) {
        double vector[3];
        memcpy(vector, faces[node->face[index]].normal, sizeof vector);
        if (!active[index] || dot(vector, vector) == 0)
            continue;
        for (size_t known = 0; known < rank; known++) {
            const double part = dot(vector, basis[known]);
            for (size_t axis = 0; axis < 3; axis++)
                vector[axis] -= part * basis[known][axis];
        }
        const double length = sqrt(dot(vector, vector));
        if (length < 1e-6 || rank == 3)
            continue;
        for (size_t axis = 0; axis < 3; axis++)
            basis[rank][axis] = vector[axis] / length;
        rank++;
    }
    return rank;
}

static void project(const double basis[3][3], size_t rank, const double vector[3], double inside[3])
{
    memset(inside, 0, 3 * sizeof *inside);
    for (size_t index = 0; index < rank; index++) {
        const double part = dot(vector, basis[index]);
        for (size_t axis = 0; axis < 3; axis++)
            inside[axis] += part * basis[index][axis];
    }
}

/* Gauss elimination with partial pivoting, count <= NODE_FACE_MAX. */
static void solve_dense(double matrix[NODE_FACE_MAX][NODE_FACE_MAX], double vector[NODE_FACE_MAX],
                        size_t count)
{
    for (size_t column = 0; column < count; column++) {
        size_t pivot = column;
        for (size_t row = column + 1; row < count; row++) {
            if (fabs(matrix[row][column]) > fabs(matrix[pivot][column]))
                pivot = row;
        }
        for (size_t k = 0; k < count; k++) {
            const double swapped = matrix[column][k];
            matrix[column][k] = matrix[pivot][k];
            matrix[pivot][k] = swapped;
        }
        const double swapped = vector[column];
        vector[column] = vector[pivot];
        vector[pivot] = swapped;
        for (size_t row = column + 1; row < count; row++) {
            const double factor = matrix[row][column] / matrix[column][column];
            for (size_t k = column; k < count; k++)
                matrix[row][k] -= factor * matrix[column][k];
            vector[row] -= factor * vector[column];
        }
    }
    for (size_t row = count; row-- > 0;) {
        for (size_t k = row + 1; k < count; k++)
            vector[row] -= matrix[row][k] * vector[k];
        vector[row] /= matrix[row][row];
    }
}

/* Adds to share[] the solution of gram share = right, as far as share[] is not one yet: least
 * squares of least norm, so that equal normals share. Its small regulariser leaves an error; run
 * twice, the impulses of nearly parallel faces add up as well. */
static void refine_split(const double gram[NODE_FACE_MAX][NODE_FACE_MAX],
                         const double right[NODE_FACE_MAX], size_t count,
                         double share[NODE_FACE_MAX])
{
    double matrix[NODE_FACE_MAX][NODE_FACE_MAX], residual[NODE_FACE_MAX];
    for (size_t row = 0; row < count; row++) {
        residual[row] = right[row];
        for (size_t column = 0; column < count; column++) {
            matrix[row][column] = gram[row][column];
            residual[row] -= gram[row][column] * share[column];
        }
        matrix[row][row] += 1e-12;
    }
    solve_dense(matrix, residual, count);
    for (size_t row = 0; row < count; row++)
        share[row] += residual[row];
}

/* Splits an impulse in the span of the active normals among them. */
static void split_normal(const struct wall_face *faces, const struct node_faces *node,
                         const bool active[NODE_FACE_MAX], const double impulse[3],
                         double share[NODE_FACE_MAX])
{
    double gram[NODE_FACE_MAX][NODE_FACE_MAX], right[NODE_FACE_MAX];
    double solution[NODE_FACE_MAX] = {0};
    size_t used[NODE_FACE_MAX], count = 0;
    bool orthogonal = true;
    memset(share, 0, NODE_FACE_MAX * sizeof *share);
    for (size_t index = 0; index < node->count; index++) {
        if (active[index] && faces[node->face[index]].face_index >= 0)
            used[count++] = index;
    }
    for (size_t row = 0; row < count; row++) {
        const double *normal = faces[node->face[used[row]]].normal;
        right[row] = dot(normal, impulse);
        for (size_t column = 0; column < count; column++) {
            gram[row][column] = dot(normal, faces[node->face[used[column]]].normal);
            orthogonal = orthogonal && (row == column || gram[row][column] == 0);
        }
    }
    for (int pass = 0; pass < 2 && !orthogonal; pass++)
        refine_split((const double(*)[NODE_FACE_MAX])gram, right, count, solution);
    for (size_t row = 0; row < count; row++)
        share[used[row]] = orthogonal ? right[row] : solution[row];
}

/* Finds the faces in contact, and the normal impulses for a given free increment. `reach` is the
 * velocity whose normal part the walls take away. */
static size_t find_active(const struct contact *contact, const double reach[3],
                          bool active[NODE_FACE_MAX], double basis[3][3], double normal_part[3],
                          double share[NODE_FACE_MAX])
{
    const struct node_faces *node = contact->node;
    for (size_t index = 0; index < node->count; index++)
        active[index] = true;
    for (;;) {
        const size_t rank = span_normals(contact->faces, node, (const bool *)active, basis);
        double impulse[3];
        project((const double(*)[3])basis, rank, reach, normal_part);
        for (size_t axis = 0; axis < 3; axis++)
            impulse[axis] = -contact->mass * normal_part[axis];
        split_normal(contact->faces, node, active, impulse, share);
        size_t worst = node->count;
        double least = 0;
        for (size_t index = 0; index < node->count; index++) {
            const struct wall_face *face = &contact->faces[node->face[index]];
            if (!active[index] || !face->release)
                continue;
            const double excess = share[index] - face->tension_force * contact->time_step;
            if (excess <= 0 && (worst == node->count || excess < least)) {
                worst = index;
                least = excess;
            }
        }
        if (worst == node->count)
            return rank;
        active[worst] = false;
    }
}

/* True if a node inside a box is held as a whole. */
static bool is_held(const struct contact *contact, size_t *held)
{
    for (size_t index = 0; index < contact->node->count; index++) {
        if (contact->faces[contact->node->face[index]].face_index < 0) {
            *held = index;
            return true;
        }
    }
    return false;
}

/* Friction on the free remainder `tangent`, shared among faces in proportion to their limits. */
static void apply_friction(struct contact *contact, const bool active[NODE_FACE_MAX],
                           const double share[NODE_FACE_MAX], const double tangent[3])
{
    const struct node_faces *node = contact->node;
    double limit[NODE_FACE_MAX] = {0}, total = 0;
    size_t unlimited = 0;
    for (size_t index = 0; index < node->count; index++) {
        const struct wall_face *face = &contact->faces[node->face[index]];
        if (!active[index])
            continue;
        limit[index] =
            face->condition->tangential_limit(face->friction_coefficient, fmax(0, share[index]));
        if (isinf(limit[index]))
            unlimited++;
        else
            total += limit[index];
    }
    const double momentum = contact->mass * sqrt(dot(tangent, tangent));
    if (momentum == 0 || (total == 0 && unlimited == 0))
        return;
    const double taken = unlimited > 0 ? 1.0 : fmin(1.0, total / momentum);
    for (size_t index = 0; index < node->count; index++) {
        const double part = unlimited > 0 ? (isinf(limit[index]) ? 1.0 / (double)unlimited : 0.0)
                                          : limit[index] / total;
        for (size_t axis = 0; axis < 3; axis++)
            contact->impulse[index][axis] -= part * taken * contact->mass * tangent[axis];
    }
    for (size_t axis = 0; axis < 3; axis++) {
        /* Exactly zero when it sticks, so that a block at rest does not creep. */
        const double removed = taken == 1.0 ? tangent[axis] : taken * tangent[axis];
        contact->velocity[axis] -= removed;
        contact->handed_velocity[axis] -= removed;
    }
}

static bool keeps_velocity(const struct contact *contact)
{
    for (size_t index = 0; index < contact->node->count; index++) {
        if (contact->faces[contact->node->face[index]].wall == TALUS_WALL_KEEP)
            return true;
    }
    return false;
}

void contact_solve(struct contact *contact)
{
    const double *w = contact->free_velocity;
    memset(contact->impulse, 0, sizeof contact->impulse);
    size_t held = 0;
    if (is_held(contact, &held)) {
        for (size_t axis = 0; axis < 3; axis++) {
            contact->velocity[axis] = contact->handed_velocity[axis] = 0;
            contact->impulse[held][axis] = -contact->mass * w[axis];
        }
        return;
    }
    const bool keep = keeps_velocity(contact);
    bool active[NODE_FACE_MAX] = {false};
    double basis[3][3], taken[3], share[NODE_FACE_MAX], normal_velocity[3], tangent[3];
    const size_t rank = find_active(contact, keep ? contact->acceleration_increment : w, active,
                                    basis, taken, share);
    project((const double(*)[3])basis, rank, w, normal_velocity);
    for (size_t axis = 0; axis < 3; axis++) {
        tangent[axis] = w[axis] - normal_velocity[axis];
        contact->velocity[axis] = tangent[axis];
        contact->handed_velocity[axis] = w[axis] - taken[axis];
    }
    for (size_t index = 0; index < contact->node->count; index++) {
        const double *normal = contact->faces[contact->node->face[index]].normal;
        for (size_t axis = 0; axis < 3; axis++)
            contact->impulse[index][axis] = share[index] * normal[axis];
    }
    apply_friction(contact, active, share, tangent);
}

void contact_hold_back(const struct wall_face *faces, const struct node_faces *node, double mass,
                       double time_step, double increment[3])
{
    struct contact contact = {.faces = faces, .node = node, .mass = mass, .time_step = time_step};
    memcpy(contact.free_velocity, increment, sizeof contact.free_velocity);
    memcpy(contact.acceleration_increment, increment, sizeof contact.acceleration_increment);
    contact_solve(&contact);
    memcpy(increment, contact.velocity, sizeof contact.velocity);
}
