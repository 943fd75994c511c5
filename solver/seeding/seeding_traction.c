/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_traction.h"

#include "seeding/seeding_face.h"
#include "state/traction_layout.h"

#include <math.h>
#include <stdlib.h>

struct loading {
    const struct seeding_lattice *lattice;
    size_t *row_first; /* [count[1] x count[2]] first particle of each row of the lattice */
    struct particle_seed *seed;
    size_t component; /* of the traction at hand */
    bool is_pressure;
};

struct nearest {
    double square; /* [m^2] */
    size_t particle;
};

/* The nearest kept point of a row; ranges grow, so the first of equals has the smallest number. */
static void search_row(const struct loading *loading, const double point[3], uint64_t y, uint64_t z,
                       struct nearest *nearest)
{
    const struct seeding_lattice *lattice = loading->lattice;
    struct seeding_row row;
    uint64_t index[3] = {0, y, z};
    size_t passed = 0;
    seeding_lattice_row(lattice, index, &row);
    const double place = round((point[0] - lattice->shape.min[0]) / lattice->spacing[0] - 0.5);
    for (size_t range = 0; range < row.count; range++) {
        const double limited =
            fmin(fmax(place, (double)row.first[range]), (double)row.end[range] - 1.0);
        double candidate[3], square = 0.0;
        index[0] = (uint64_t)limited;
        seeding_lattice_position(lattice, index, candidate);
        for (size_t k = 0; k < 3; k++)
            square += (candidate[k] - point[k]) * (candidate[k] - point[k]);
        if (square < nearest->square) {
            nearest->square = square;
            nearest->particle = loading->row_first[y + z * (uint64_t)lattice->count[1]] + passed +
                                (size_t)(index[0] - row.first[range]);
        }
        passed += (size_t)(row.end[range] - row.first[range]);
    }
}

/* Rows whose larger distance from the middle one is `ring` (in rows). */
static void search_ring(const struct loading *loading, const double point[3],
                        const int64_t middle[3], int64_t ring, struct nearest *nearest)
{
    const int64_t rows = (int64_t)loading->lattice->count[1];
    const int64_t layers = (int64_t)loading->lattice->count[2];
    for (int64_t z = middle[2] - ring; z <= middle[2] + ring; z++) {
        const bool whole = z == middle[2] - ring || z == middle[2] + ring;
        for (int64_t y = middle[1] - ring; y <= middle[1] + ring;
             y += whole || ring == 0 ? 1 : 2 * ring) {
            if (y >= 0 && y < rows && z >= 0 && z < layers)
                search_row(loading, point, (uint64_t)y, (uint64_t)z, nearest);
        }
    }
}

/* The kept point of the lattice nearest to a place: rows further and further away, until none of
 * them can be nearer. */
static size_t find_nearest(const struct loading *loading, const double point[3])
{
    const struct seeding_lattice *lattice = loading->lattice;
    struct nearest nearest = {.square = INFINITY};
    int64_t middle[3] = {0, 0, 0}, most = 0;
    double width = INFINITY;
    for (size_t k = 1; k < lattice->shape.axis_count; k++) {
        const double place = round((point[k] - lattice->shape.min[k]) / lattice->spacing[k] - 0.5);
        middle[k] = (int64_t)fmin(fmax(place, 0.0), lattice->count[k] - 1.0);
        width = fmin(width, lattice->spacing[k]);
        most = (int64_t)fmax((double)most, lattice->count[k]);
    }
    for (int64_t ring = 0; ring <= most; ring++) {
        const double reach = (double)ring * width; /* of what has been searched */
        search_ring(loading, point, middle, ring, &nearest);
        if (nearest.square <= reach * reach)
            break;
    }
    return nearest.particle;
}

static void give_piece(void *context, const struct face_piece *piece)
{
    struct loading *loading = context;
    const struct seeding_shape *shape = &loading->lattice->shape;
    const size_t particle = find_nearest(loading, piece->centre);
    double world[3];
    seeding_shape_to_world(shape, piece->centre, world);
    const double area = seeding_circle(shape, world[0]) * piece->area;
    if (!loading->is_pressure) {
        loading->seed->traction[loading->component][particle] += area;
        return;
    }
    for (size_t k = 0; k < shape->axis_count; k++) {
        double normal = 0.0;
        for (size_t l = 0; l < 3; l++)
            normal += shape->turn[k][l] * piece->normal[l];
        loading->seed->traction[loading->component + k][particle] += area * normal;
    }
}

static size_t *number_rows(const struct seeding_lattice *lattice, size_t first)
{
    const size_t rows = (size_t)(lattice->count[1] * lattice->count[2]);
    size_t *row_first = malloc(rows * sizeof *row_first);
    struct seeding_row row;
    for (size_t place = 0; row_first != NULL && place < rows; place++) {
        uint64_t index[3] = {0, place % (uint64_t)lattice->count[1],
                             place / (uint64_t)lattice->count[1]};
        row_first[place] = first;
        seeding_lattice_row(lattice, index, &row);
        for (size_t range = 0; range < row.count; range++)
            first += (size_t)(row.end[range] - row.first[range]);
    }
    return row_first;
}

int seeding_write_tractions(const struct talus_scene *scene, const struct seeding_lattice *lattice,
                            size_t first, struct particle_seed *seed)
{
    const struct talus_body *body = lattice->shape.body;
    struct loading loading = {.lattice = lattice, .seed = seed};
    if (body->traction_count == 0)
        return 0;
    loading.row_first = number_rows(lattice, first);
    if (loading.row_first == NULL)
        return -1;
    for (size_t index = 0; index < body->traction_count; index++) {
        loading.component = traction_offset(scene, body, index);
        loading.is_pressure = body->tractions[index].is_pressure;
        seeding_visit_face(lattice, &body->tractions[index], give_piece, &loading);
    }
    free(loading.row_first);
    return 0;
}
