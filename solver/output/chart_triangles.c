/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_mesh.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A triangle with its circumscribed circle. */
struct face {
    size_t corners[3];
    double x, y, square; /* centre, radius squared */
};

struct edge {
    size_t from, to;
};

struct triangulation {
    double (*places)[2]; /* of the vertices, slightly moved, and of three far ones */
    size_t count;        /* of vertices */
    struct face *faces;
    size_t face_count, face_capacity;
    struct edge *edges; /* around the hole that a vertex makes */
    size_t edge_count, edge_capacity;
};

/* A movement of 1e-7 that follows from the index: no four points lie on a circle any more. */
static double jitter(uint64_t index)
{
    index = (index + 1) * UINT64_C(0x9e3779b97f4a7c15);
    index ^= index >> 29;
    index *= UINT64_C(0xbf58476d1ce4e5b9);
    return 1e-7 * ((double)(index >> 11) * 0x1p-53 - 0.5);
}

static double area_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool grow(void **items, size_t *capacity, size_t count, size_t size)
{
    if (count < *capacity)
        return true;
    const size_t wanted = 2 * *capacity + 64;
    void *grown = realloc(*items, wanted * size);
    if (grown == NULL)
        return false;
    *items = grown;
    *capacity = wanted;
    return true;
}

static bool add_face(struct triangulation *all, size_t a, size_t b, size_t c)
{
    const double *p = all->places[a], *q = all->places[b], *r = all->places[c];
    const double area = area_of(p, q, r);
    if (!grow((void **)&all->faces, &all->face_capacity, all->face_count, sizeof *all->faces))
        return false;
    struct face *face = &all->faces[all->face_count];
    *face = (struct face){.corners = {a, area > 0.0 ? b : c, area > 0.0 ? c : b}};
    const double qx = q[0] - p[0], qy = q[1] - p[1], rx = r[0] - p[0], ry = r[1] - p[1];
    const double q_square = qx * qx + qy * qy, r_square = rx * rx + ry * ry;
    if (fabs(area) < 1e-30)
        return true; /* no area: it is left out */
    const double x = (ry * q_square - qy * r_square) / (2.0 * area);
    const double y = (qx * r_square - rx * q_square) / (2.0 * area);
    face->x = p[0] + x;
    face->y = p[1] + y;
    face->square = x * x + y * y;
    all->face_count++;
    return true;
}

/* An edge that two faces of the hole share is inside of it and goes. */
static bool toggle_edge(struct triangulation *all, size_t from, size_t to)
{
    for (size_t index = 0; index < all->edge_count; index++) {
        if (all->edges[index].from == to && all->edges[index].to == from) {
            all->edges[index] = all->edges[--all->edge_count];
            return true;
        }
    }
    if (!grow((void **)&all->edges, &all->edge_capacity, all->edge_count, sizeof *all->edges))
        return false;
    all->edges[all->edge_count++] = (struct edge){from, to};
    return true;
}

/* Removes the faces whose circles hold a vertex, and joins it with the edge of the hole. */
static bool insert_vertex(struct triangulation *all, size_t vertex)
{
    const double *place = all->places[vertex];
    all->edge_count = 0;
    for (size_t index = 0; index < all->face_count;) {
        const struct face face = all->faces[index];
        const double x = place[0] - face.x, y = place[1] - face.y;
        if (x * x + y * y >= face.square) {
            index++;
            continue;
        }
        for (int corner = 0; corner < 3; corner++) {
            if (!toggle_edge(all, face.corners[corner], face.corners[(corner + 1) % 3]))
                return false;
        }
        all->faces[index] = all->faces[--all->face_count];
    }
    for (size_t index = 0; index < all->edge_count; index++) {
        if (!add_face(all, all->edges[index].from, all->edges[index].to, vertex))
            return false;
    }
    return true;
}

static bool triangulate(struct triangulation *all, const struct chart_vertex *vertices)
{
    static const double far[3][2] = {{-1e4, -1e4}, {2e4, -1e4}, {0.0, 2e4}};
    const size_t count = all->count;
    for (size_t index = 0; index < count; index++) {
        all->places[index][0] = vertices[index].x + jitter(2 * index);
        all->places[index][1] = vertices[index].y + jitter(2 * index + 1);
    }
    memcpy(all->places + count, far, sizeof far);
    bool good = add_face(all, count, count + 1, count + 2);
    for (size_t index = 0; good && index < count; index++)
        good = insert_vertex(all, index);
    return good;
}

/* Long thin triangles along the hull come from the jitter of points on a line. */
static bool is_worth_drawing(const struct triangulation *all, const struct face *face)
{
    double longest = 0.0;
    for (int corner = 0; corner < 3; corner++) {
        const double *a = all->places[face->corners[corner]];
        const double *b = all->places[face->corners[(corner + 1) % 3]];
        if (face->corners[corner] >= all->count)
            return false;
        longest = fmax(longest, hypot(a[0] - b[0], a[1] - b[1]));
    }
    return area_of(all->places[face->corners[0]], all->places[face->corners[1]],
                   all->places[face->corners[2]]) > 1e-5 * longest;
}

size_t chart_triangulate(const struct chart_vertex *vertices, size_t count, size_t (*triangles)[3])
{
    struct triangulation all = {.count = count};
    size_t kept = 0;
    all.places = malloc((count + 3) * sizeof *all.places);
    if (all.places == NULL || !triangulate(&all, vertices))
        kept = SIZE_MAX;
    for (size_t index = 0; kept != SIZE_MAX && index < all.face_count; index++) {
        if (is_worth_drawing(&all, &all.faces[index]) && kept < 2 * count + 8)
            memcpy(triangles[kept++], all.faces[index].corners, sizeof *triangles);
    }
    free(all.places);
    free(all.faces);
    free(all.edges);
    return kept;
}
