/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_lattice.h"

#include <math.h>

void seeding_lattice_init(struct seeding_lattice *lattice, const struct talus_scene *scene,
                          const struct talus_body *body)
{
    seeding_shape_init(&lattice->shape, scene, body);
    for (size_t k = 0; k < 3; k++) {
        lattice->count[k] = lattice->spacing[k] = 1.0;
        if (k >= scene->axis_count)
            continue;
        double size = fmax(0.0, lattice->shape.max[k] - lattice->shape.min[k]);
        double count = body->lattice_value[k];
        if (body->lattice == TALUS_LATTICE_PER_CELL)
            count *= size / scene->grid.cell[k];
        else if (body->lattice == TALUS_LATTICE_SPACING)
            count = size / body->lattice_value[k];
        lattice->count[k] = fmax(1.0, round(count));
        lattice->spacing[k] = size / lattice->count[k];
    }
}

double seeding_lattice_point_count(const struct seeding_lattice *lattice)
{
    return lattice->count[0] * lattice->count[1] * lattice->count[2];
}

void seeding_lattice_position(const struct seeding_lattice *lattice, const uint64_t index[3],
                              double position[3])
{
    const struct seeding_shape *shape = &lattice->shape;
    for (size_t k = 0; k < 3; k++) {
        double share = ((double)index[k] + 0.5) / lattice->count[k];
        position[k] =
            k < shape->axis_count ? shape->min[k] + share * (shape->max[k] - shape->min[k]) : 0.0;
    }
}

void seeding_lattice_row(const struct seeding_lattice *lattice, uint64_t row[3], uint64_t *first,
                         uint64_t *end)
{
    double position[3], interval[2];
    row[0] = 0;
    seeding_lattice_position(lattice, row, position);
    *first = *end = 0;
    if (!seeding_shape_interval(&lattice->shape, position, TALUS_X, interval))
        return;
    /* Point i lies at min + (i + 1/2) spacing; a hair outside the surface still counts. */
    const double slack = 1e-9, min = lattice->shape.min[0], spacing = lattice->spacing[0];
    double begin = ceil((interval[0] - min) / spacing - 0.5 - slack);
    double last = floor((interval[1] - min) / spacing - 0.5 + slack);
    begin = fmax(begin, 0.0);
    last = fmin(last, lattice->count[0] - 1.0);
    if (!(begin <= last))
        return;
    *first = (uint64_t)begin;
    *end = (uint64_t)last + 1;
}

uint64_t seeding_lattice_kept(const struct seeding_lattice *lattice)
{
    uint64_t kept = 0, first, end, row[3];
    for (row[2] = 0; row[2] < (uint64_t)lattice->count[2]; row[2]++) {
        for (row[1] = 0; row[1] < (uint64_t)lattice->count[1]; row[1]++) {
            seeding_lattice_row(lattice, row, &first, &end);
            kept += end - first;
        }
    }
    return kept;
}

double seeding_lattice_factor(const struct seeding_lattice *lattice, uint64_t kept)
{
    if (lattice->shape.body->shape == TALUS_BODY_BOX)
        return 1.0;
    double cell = 1.0;
    for (size_t k = 0; k < lattice->shape.axis_count; k++)
        cell *= lattice->spacing[k];
    return seeding_shape_volume(&lattice->shape) / (cell * (double)kept);
}
