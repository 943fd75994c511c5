/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_face.h"

#include "seeding/seeding_polygon.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

struct visitor {
    void (*visit)(void *context, const struct face_piece *piece);
    void *context;
};

static double smallest_spacing(const struct seeding_lattice *lattice)
{
    double smallest = lattice->spacing[0];
    for (size_t k = 1; k < lattice->shape.axis_count; k++)
        smallest = fmin(smallest, lattice->spacing[k]);
    return smallest;
}

/* Number of equal pieces of a length, each at most half as long as the lattice is wide. */
static size_t piece_count(const struct seeding_lattice *lattice, double length, size_t least)
{
    const double count = ceil(length / (0.5 * smallest_spacing(lattice)) - 1e-9);
    return count > (double)least ? (size_t)count : least;
}

/* One piece for each outermost point of the lattice. */
static void visit_box(const struct seeding_lattice *lattice, size_t face,
                      const struct visitor *visitor)
{
    const size_t axis = face / 2;
    const bool upper = face % 2 == 1;
    double count[3] = {lattice->count[0], lattice->count[1], lattice->count[2]};
    struct face_piece piece = {.area = 1.0};
    count[axis] = 1.0;
    piece.normal[axis] = upper ? 1.0 : -1.0;
    for (size_t k = 0; k < lattice->shape.axis_count; k++)
        piece.area *= k == axis ? 1.0 : lattice->spacing[k];
    uint64_t index[3];
    for (index[2] = 0; index[2] < (uint64_t)count[2]; index[2]++) {
        for (index[1] = 0; index[1] < (uint64_t)count[1]; index[1]++) {
            for (index[0] = 0; index[0] < (uint64_t)count[0]; index[0]++) {
                seeding_lattice_position(lattice, index, piece.centre);
                piece.centre[axis] = upper ? lattice->shape.max[axis] : lattice->shape.min[axis];
                visitor->visit(visitor->context, &piece);
            }
        }
    }
}

static void visit_side(const struct seeding_lattice *lattice, const double *from, const double *to,
                       double orientation, const struct visitor *visitor)
{
    const double way[2] = {to[0] - from[0], to[1] - from[1]}, length = hypot(way[0], way[1]);
    const size_t count = piece_count(lattice, length, 1);
    const struct face_piece side = {
        .area = length / (double)count,
        .normal = {orientation * way[1] / length, -orientation * way[0] / length, 0.0}};
    for (size_t index = 0; index < count; index++) {
        struct face_piece piece = side;
        const double share = ((double)index + 0.5) / (double)count;
        for (size_t k = 0; k < 2; k++)
            piece.centre[k] = from[k] + share * way[k];
        visitor->visit(visitor->context, &piece);
    }
}

static void visit_polygon(const struct seeding_lattice *lattice,
                          const struct talus_traction *traction, const struct visitor *visitor)
{
    const struct talus_body *body = lattice->shape.body;
    const size_t count = body->vertex_count;
    const double area = polygon_area(body->vertices, count, lattice->shape.min, lattice->shape.max);
    for (size_t side = traction->face;; side = (side + 1) % count) {
        visit_side(lattice, body->vertices + 2 * side, body->vertices + 2 * ((side + 1) % count),
                   area > 0.0 ? 1.0 : -1.0, visitor);
        if (side == traction->last_face)
            return;
    }
}

/* Around a circle whose plane is spanned by u and v: pieces of one ring. `radius` and `height`
 * (along n) are those of the centres, `out` and `along` the parts of the normal. */
struct ring {
    const double *origin, *u, *v, *n;
    double radius, height, out, along, area;
    size_t count;
};

static void visit_ring(const struct ring *ring, size_t axis_count, const struct visitor *visitor)
{
    for (size_t index = 0; index < ring->count; index++) {
        struct face_piece piece = {.area = ring->area / (double)ring->count};
        const double angle = 2.0 * pi * ((double)index + 0.5) / (double)ring->count;
        for (size_t k = 0; k < axis_count; k++) {
            const double arm = cos(angle) * ring->u[k] + sin(angle) * ring->v[k];
            piece.centre[k] = ring->origin[k] + ring->radius * arm + ring->height * ring->n[k];
            piece.normal[k] = ring->out * arm + ring->along * ring->n[k];
        }
        visitor->visit(visitor->context, &piece);
    }
}

/* A disc is one ring; a sphere rings between circles of latitude, of exact area. */
static void visit_sphere(const struct seeding_lattice *lattice, const struct visitor *visitor)
{
    static const double u[3] = {1.0, 0.0, 0.0}, v[3] = {0.0, 1.0, 0.0}, n[3] = {0.0, 0.0, 1.0};
    const double radius = lattice->shape.body->radius;
    const size_t axes = lattice->shape.axis_count;
    struct ring ring = {.origin = lattice->shape.body->centre, .u = u, .v = v, .n = n};
    const size_t bands = axes == 2 ? 1 : piece_count(lattice, pi * radius, 4);
    for (size_t band = 0; band < bands; band++) {
        const double low = pi * (double)band / (double)bands;
        const double high = pi * ((double)band + 1.0) / (double)bands, middle = 0.5 * (low + high);
        ring.out = axes == 2 ? 1.0 : sin(middle);
        ring.along = axes == 2 ? 0.0 : cos(middle);
        ring.radius = radius * ring.out;
        ring.height = radius * ring.along;
        ring.area = 2.0 * pi * radius * (axes == 2 ? 1.0 : radius * (cos(low) - cos(high)));
        ring.count = piece_count(lattice, 2.0 * pi * ring.radius, 4);
        visit_ring(&ring, axes, visitor);
    }
}

static void visit_cylinder(const struct seeding_lattice *lattice, size_t face,
                           const struct visitor *visitor)
{
    const struct talus_body *body = lattice->shape.body;
    double n[3], u[3], v[3];
    const double length = seeding_cylinder_axis(body, n);
    seeding_perpendicular(n, u, v);
    struct ring ring = {.origin = face == 2 ? body->to : body->from, .u = u, .v = v, .n = n};
    const double extent = face == 0 ? length : body->radius;
    const size_t rings = piece_count(lattice, extent, 1);
    ring.out = face == 0 ? 1.0 : 0.0;
    ring.along = face == 0 ? 0.0 : face == 1 ? -1.0 : 1.0;
    for (size_t index = 0; index < rings; index++) {
        const double width = extent / (double)rings, middle = ((double)index + 0.5) * width;
        ring.radius = face == 0 ? body->radius : middle;
        ring.height = face == 0 ? middle : 0.0;
        ring.area = 2.0 * pi * ring.radius * width;
        ring.count = piece_count(lattice, 2.0 * pi * ring.radius, 4);
        visit_ring(&ring, 3, visitor);
    }
}

void seeding_visit_face(const struct seeding_lattice *lattice,
                        const struct talus_traction *traction,
                        void (*visit)(void *context, const struct face_piece *piece), void *context)
{
    const struct visitor visitor = {visit, context};
    const enum talus_body_shape shape = lattice->shape.body->shape;
    if (shape == TALUS_BODY_BOX)
        visit_box(lattice, traction->face, &visitor);
    else if (shape == TALUS_BODY_POLYGON)
        visit_polygon(lattice, traction, &visitor);
    else if (shape == TALUS_BODY_SPHERE)
        visit_sphere(lattice, &visitor);
    else if (shape == TALUS_BODY_CYLINDER)
        visit_cylinder(lattice, traction->face, &visitor);
}
