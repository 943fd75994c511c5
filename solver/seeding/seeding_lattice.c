/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_lattice.h"

#include <math.h>
#include <string.h>

void seeding_lattice_init(struct seeding_lattice *lattice, const struct talus_scene *scene,
                          const struct talus_body *body)
{
    seeding_shape_init(&lattice->shape, scene, body);
    const bool listed = body->shape == TALUS_BODY_POINTS;
    for (size_t k = 0; k < 3; k++) {
        lattice->count[k] = lattice->spacing[k] = 1.0;
        if (k >= scene->axis_count || listed)
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
    if (listed)
        lattice->count[0] = (double)body->point_count;
}

bool seeding_lattice_selects(const struct seeding_lattice *lattice)
{
    return lattice->shape.body->shape != TALUS_BODY_BOX &&
           lattice->shape.body->shape != TALUS_BODY_POINTS;
}

double seeding_lattice_point_count(const struct seeding_lattice *lattice)
{
    return lattice->count[0] * lattice->count[1] * lattice->count[2];
}

void seeding_lattice_position(const struct seeding_lattice *lattice, const uint64_t index[3],
                              double position[3])
{
    const struct seeding_shape *shape = &lattice->shape;
    if (shape->body->shape == TALUS_BODY_POINTS) {
        memcpy(position, shape->body->point_positions + 3 * index[0], 3 * sizeof *position);
        return;
    }
    for (size_t k = 0; k < 3; k++) {
        double share = ((double)index[k] + 0.5) / lattice->count[k];
        position[k] =
            k < shape->axis_count ? shape->min[k] + share * (shape->max[k] - shape->min[k]) : 0.0;
    }
}

void seeding_lattice_world(const struct seeding_lattice *lattice, const uint64_t index[3],
                           double position[3])
{
    double point[3];
    seeding_lattice_position(lattice, index, point);
    seeding_shape_to_world(&lattice->shape, point, position);
}

/* Adds the lattice points of an interval of x, in the order of their first points. */
static void add_range(const struct seeding_lattice *lattice, double from, double to,
                      struct seeding_row *row)
{
    /* Point i lies at min + (i + 1/2) spacing; a hair outside the surface still counts. */
    const double slack = 1e-9, min = lattice->shape.min[0], spacing = lattice->spacing[0];
    const double begin = fmax(ceil((from - min) / spacing - 0.5 - slack), 0.0);
    const double last = fmin(floor((to - min) / spacing - 0.5 + slack), lattice->count[0] - 1.0);
    if (!(begin <= last))
        return;
    size_t slot = row->count++;
    for (; slot > 0 && row->first[slot - 1] > (uint64_t)begin; slot--) {
        row->first[slot] = row->first[slot - 1];
        row->end[slot] = row->end[slot - 1];
    }
    row->first[slot] = (uint64_t)begin;
    row->end[slot] = (uint64_t)last + 1;
}

static void add_line(const struct seeding_lattice *lattice, const double point[3],
                     struct seeding_row *row)
{
    static const double along[3] = {1.0, 0.0, 0.0};
    struct seeding_line line;
    seeding_shape_line(&lattice->shape, point, along, &line);
    for (size_t k = 0; k < line.count; k++)
        add_range(lattice, point[0] + line.offset[k][0], point[0] + line.offset[k][1], row);
}

/* Ranges that share points become one. */
static void merge_ranges(struct seeding_row *row)
{
    size_t kept = 0;
    for (size_t k = 1; k < row->count; k++) {
        if (row->first[k] > row->end[kept]) {
            kept++;
            row->first[kept] = row->first[k];
            row->end[kept] = row->end[k];
        } else if (row->end[k] > row->end[kept]) {
            row->end[kept] = row->end[k];
        }
    }
    row->count = row->count > 0 ? kept + 1 : 0;
}

void seeding_lattice_row(const struct seeding_lattice *lattice, uint64_t index[3],
                         struct seeding_row *row)
{
    const enum talus_body_shape shape = lattice->shape.body->shape;
    double point[3];
    row->count = 0;
    index[0] = 0;
    if (shape == TALUS_BODY_POINTS) {
        row->count = 1;
        row->first[0] = 0;
        row->end[0] = (uint64_t)lattice->count[0];
        return;
    }
    seeding_lattice_position(lattice, index, point);
    if (shape != TALUS_BODY_POLYGON) {
        add_line(lattice, point, row);
        return;
    }
    const double hair = 1e-9 * lattice->spacing[1], y = point[1];
    for (int side = -1; side <= 1; side += 2) {
        point[1] = y + side * hair;
        add_line(lattice, point, row);
    }
    merge_ranges(row);
}

uint64_t seeding_lattice_kept(const struct seeding_lattice *lattice)
{
    uint64_t kept = 0, index[3];
    struct seeding_row row;
    for (index[2] = 0; index[2] < (uint64_t)lattice->count[2]; index[2]++) {
        for (index[1] = 0; index[1] < (uint64_t)lattice->count[1]; index[1]++) {
            seeding_lattice_row(lattice, index, &row);
            for (size_t k = 0; k < row.count; k++)
                kept += row.end[k] - row.first[k];
        }
    }
    return kept;
}

double seeding_lattice_factor(const struct seeding_lattice *lattice, uint64_t kept)
{
    if (!seeding_lattice_selects(lattice))
        return 1.0;
    double cell = 1.0;
    for (size_t k = 0; k < lattice->shape.axis_count; k++)
        cell *= lattice->spacing[k];
    const double circles =
        lattice->shape.revolves ? seeding_lattice_circles(lattice) : (double)kept;
    return seeding_shape_volume(&lattice->shape) / (cell * circles);
}
