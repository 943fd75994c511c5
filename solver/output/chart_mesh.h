/* SPDX-License-Identifier: Apache-2.0 */
/* Triangles between points with a value each, and what lies above a level. Private to chart*.c. */
#ifndef TALUS_CHART_MESH_H
#define TALUS_CHART_MESH_H

#include "output/chart_axis.h"

struct chart_vertex {
    double x, y; /* shares of the axes */
    double z;    /* value, its logarithm on a logarithmic scale */
};

struct chart_mesh {
    struct chart_vertex *vertices;
    size_t vertex_count;
    size_t (*triangles)[3]; /* anticlockwise */
    size_t triangle_count;
};

enum { CHART_SCATTER_MAX = 3000 }; /* points that are triangulated */

/* The mesh of the points of one series of a chart with numeric parameters on both axes: cells of a
 * grid where the points make one (a cell is four triangles around its mean; with a missing corner
 * one), else Delaunay's triangles. Points at the same place count with their mean. No triangles for
 * fewer than three points, points on a line, or more than CHART_SCATTER_MAX that make no grid. */
TALUS_MUST_CHECK bool chart_mesh_init(struct chart_mesh *mesh, const struct chart *chart,
                                      size_t series, const struct chart_frame *frame);
void chart_mesh_release(struct chart_mesh *mesh);

/* Adds to cairo's path the part of a mesh where z is at least `level`, in pixels of the frame; but
 * not triangles where z is at least `covered` everywhere: what is painted later hides them. */
void chart_mesh_above(const struct chart_mesh *mesh, const struct chart_frame *frame, double level,
                      double covered, cairo_t *context);
/* The same for the line where z is `level`. */
void chart_mesh_line(const struct chart_mesh *mesh, const struct chart_frame *frame, double level,
                     cairo_t *context);

/* Delaunay's triangulation of vertices at different places (Bowyer 1981, Watson 1981): fills
 * triangles, of which there must be room for 2 * count + 8, and returns how many. SIZE_MAX without
 * memory. */
size_t chart_triangulate(const struct chart_vertex *vertices, size_t count, size_t (*triangles)[3]);

#endif
