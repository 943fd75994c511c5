/* SPDX-License-Identifier: Apache-2.0 */
/* Where shape functions that reach beyond their cell must fold back. */
#include "boundaries/boundary.h"

#include <math.h>

/* True if the side of a cell normal to the face's axis lies within the rectangle of the face. */
static bool covers_cell(const struct wall_shape *shape, const struct domain *domain,
                        const int32_t cell[3])
{
    const double *axes[2] = {shape->axis_1, shape->axis_2};
    const double slack = LINE_TOLERANCE * domain_smallest_cell(domain);
    for (size_t index = 0; index + 1 < domain->axis_count; index++) {
        double offset = 0, half = 0;
        for (size_t axis = 0; axis < domain->axis_count; axis++) {
            const double centre = domain_position(domain, axis, cell[axis], 0.0);
            offset += axes[index][axis] * (centre - shape->held_point[axis]);
            half += 0.5 * fabs(axes[index][axis]) * domain->cell[axis];
        }
        if (fabs(offset) + half > 0.5 * shape->size[index] + slack)
            return false;
    }
    return true;
}

static unsigned flat_folds(const struct wall_shape *shape, const struct domain *domain,
                           const int32_t cell[3])
{
    if (shape->axis < 0)
        return 0;
    const size_t axis = (size_t)shape->axis;
    if (shape->line != cell[axis] + (shape->lower ? 0 : 1))
        return 0;
    if (shape->kind == TALUS_BOUNDARY_FACE && !covers_cell(shape, domain, cell))
        return 0;
    return 1u << (2 * axis + (shape->lower ? 0 : 1));
}

/* A box is seen from outside: its lower face is the upper side of a cell. */
static unsigned box_folds(const struct wall_shape *shape, const struct domain *domain,
                          const int32_t cell[3])
{
    unsigned folds = 0;
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        bool beside = true;
        for (size_t other = 0; other < domain->axis_count; other++)
            beside = beside && (other == axis || (cell[other] >= shape->box_low[other] &&
                                                  cell[other] < shape->box_high[other]));
        if (beside && shape->face_exists[2 * axis] && cell[axis] + 1 == shape->box_low[axis])
            folds |= 1u << (2 * axis + 1);
        if (beside && shape->face_exists[2 * axis + 1] && cell[axis] == shape->box_high[axis])
            folds |= 1u << (2 * axis);
    }
    return folds;
}

unsigned wall_set_cell_folds(const struct wall_set *walls, const struct domain *domain,
                             const int32_t cell[3])
{
    unsigned folds = 0;
    for (size_t index = 0; index < walls->boundary_count; index++) {
        const struct wall_shape *shape = &walls->shapes[index];
        if (shape->eliminates || !shape->motion.acts)
            continue;
        folds |= shape->kind == TALUS_BOUNDARY_BOX ? box_folds(shape, domain, cell)
                                                   : flat_folds(shape, domain, cell);
    }
    return folds;
}
