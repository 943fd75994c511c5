/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/contact_directions.h"

#include <math.h>
#include <string.h>

static void add_axes(const struct contact *contact, size_t place, struct directions *directions)
{
    const struct wall_face *face = contact_face(contact, place);
    for (size_t axis = 0; axis < 3; axis++) {
        if ((face->prescribed >> axis & 1) == 0)
            continue;
        struct direction *direction = &directions->items[directions->count++];
        *direction =
            (struct direction){.place = place, .speed = contact_face_speed(contact, face, axis)};
        direction->vector[axis] = 1.0;
    }
}

static void add_normal(const struct contact *contact, size_t place, struct directions *directions)
{
    const struct wall_face *face = contact_face(contact, place);
    struct direction *direction = &directions->items[directions->count++];
    direction->place = place;
    memcpy(direction->vector, face->normal, sizeof direction->vector);
    direction->speed = 0;
    for (size_t axis = 0; axis < 3; axis++)
        direction->speed += face->normal[axis] * contact_face_speed(contact, face, axis);
}

void directions_list(const struct contact *contact, struct directions *directions)
{
    directions->count = 0;
    for (size_t place = 0; place < contact->node->count; place++) {
        if (contact_face(contact, place)->prescribed != 0)
            add_axes(contact, place, directions);
    }
    for (size_t place = 0; place < contact->node->count; place++) {
        if (contact_face(contact, place)->prescribed == 0)
            add_normal(contact, place, directions);
    }
}

void directions_span(const struct directions *directions, const bool active[NODE_FACE_MAX],
                     struct span *span)
{
    span->rank = 0;
    for (size_t index = 0; index < directions->count && span->rank < 3; index++) {
        const struct direction *direction = &directions->items[index];
        double vector[3], speed = direction->speed;
        if (!active[direction->place])
            continue;
        memcpy(vector, direction->vector, sizeof vector);
        for (size_t known = 0; known < span->rank; known++) {
            const double part = vector_dot(vector, span->basis[known]);
            for (size_t axis = 0; axis < 3; axis++)
                vector[axis] -= part * span->basis[known][axis];
            speed -= part * span->speed[known];
        }
        const double length = sqrt(vector_dot(vector, vector));
        if (length < 1e-6)
            continue;
        for (size_t axis = 0; axis < 3; axis++)
            span->basis[span->rank][axis] = vector[axis] / length;
        span->speed[span->rank++] = speed / length;
    }
}

void span_excess(const struct span *span, const double vector[3], double excess[3])
{
    memset(excess, 0, 3 * sizeof *excess);
    for (size_t index = 0; index < span->rank; index++) {
        const double part = vector_dot(vector, span->basis[index]) - span->speed[index];
        for (size_t axis = 0; axis < 3; axis++)
            excess[axis] += part * span->basis[index][axis];
    }
}

/* Gauss elimination with partial pivoting, count <= DIRECTION_MAX. */
static void solve_dense(double matrix[DIRECTION_MAX][DIRECTION_MAX], double vector[DIRECTION_MAX],
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
 * squares of least norm, so that equal directions share. Its small regulariser leaves an error; run
 * twice, the impulses of nearly parallel faces add up as well. */
static void refine_split(const double gram[DIRECTION_MAX][DIRECTION_MAX],
                         const double right[DIRECTION_MAX], size_t count,
                         double share[DIRECTION_MAX])
{
    double matrix[DIRECTION_MAX][DIRECTION_MAX], residual[DIRECTION_MAX];
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

void directions_split(const struct directions *directions, const bool active[NODE_FACE_MAX],
                      const double whole[3], double impulse[NODE_FACE_MAX][3])
{
    double gram[DIRECTION_MAX][DIRECTION_MAX], right[DIRECTION_MAX], share[DIRECTION_MAX];
    const struct direction *used[DIRECTION_MAX];
    size_t count = 0;
    bool orthogonal = true;
    memset(impulse, 0, NODE_FACE_MAX * sizeof *impulse);
    for (size_t index = 0; index < directions->count; index++) {
        if (active[directions->items[index].place])
            used[count++] = &directions->items[index];
    }
    for (size_t row = 0; row < count; row++) {
        right[row] = vector_dot(used[row]->vector, whole);
        share[row] = 0;
        for (size_t column = 0; column < count; column++) {
            gram[row][column] = vector_dot(used[row]->vector, used[column]->vector);
            orthogonal = orthogonal && (row == column || gram[row][column] == 0);
        }
    }
    for (int pass = 0; pass < 2 && !orthogonal; pass++)
        refine_split((const double(*)[DIRECTION_MAX])gram, right, count, share);
    for (size_t row = 0; row < count; row++) {
        const double part = orthogonal ? right[row] : share[row];
        for (size_t axis = 0; axis < 3; axis++)
            impulse[used[row]->place][axis] += part * used[row]->vector[axis];
    }
}
