/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_mesh.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static double z_of(const struct chart *chart, const struct chart_point *point)
{
    return chart->z.logarithmic ? log10(point->z) : point->z;
}

/* The index of a value among the values of a parameter, which are sorted. */
static size_t value_place(const struct chart_words *words, double value)
{
    size_t low = 0, high = words->count - 1;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (words->items[middle].number < value)
            low = middle + 1;
        else
            high = middle;
    }
    /* Values that read alike are one word, whose number is the first's. */
    if (low > 0 &&
        fabs(words->items[low - 1].number - value) < fabs(words->items[low].number - value))
        low--;
    return low;
}

/* The means of the points of a series at each node of the grid of all values: z, NAN where there is
 * none. NULL without memory. */
static double *grid_means(const struct chart *chart, size_t series)
{
    const size_t columns = chart->x.words.count, nodes = columns * chart->y.words.count;
    double *means = calloc(nodes, sizeof *means);
    size_t *counts = calloc(nodes, sizeof *counts);
    for (size_t index = 0; means != NULL && counts != NULL && index < chart->count; index++) {
        const struct chart_point *point = &chart->points[index];
        if (point->series != series)
            continue;
        const size_t node = value_place(&chart->y.words, point->y) * columns +
                            value_place(&chart->x.words, point->x);
        means[node] += z_of(chart, point);
        counts[node]++;
    }
    for (size_t node = 0; means != NULL && counts != NULL && node < nodes; node++) {
        means[node] = counts[node] > 0 ? means[node] / (double)counts[node] : NAN;
    }
    if (counts == NULL) {
        free(means);
        means = NULL;
    }
    free(counts);
    return means;
}

/* Adds an anticlockwise triangle unless a corner has no value. */
static void add_triangle(struct chart_mesh *mesh, size_t a, size_t b, size_t c)
{
    if (isnan(mesh->vertices[a].z + mesh->vertices[b].z + mesh->vertices[c].z))
        return;
    size_t *triangle = mesh->triangles[mesh->triangle_count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

/* The triangles of a cell whose lower left node is `node`. */
static void add_cell(struct chart_mesh *mesh, size_t node, size_t columns)
{
    const size_t corners[4] = {node, node + 1, node + columns + 1, node + columns};
    struct chart_vertex *centre = &mesh->vertices[mesh->vertex_count];
    *centre = (struct chart_vertex){0};
    for (int corner = 0; corner < 4; corner++) {
        centre->x += 0.25 * mesh->vertices[corners[corner]].x;
        centre->y += 0.25 * mesh->vertices[corners[corner]].y;
        centre->z += 0.25 * mesh->vertices[corners[corner]].z;
    }
    if (isnan(centre->z)) {
        for (int left_out = 0; left_out < 4; left_out++) {
            if (isnan(mesh->vertices[corners[left_out]].z))
                add_triangle(mesh, corners[(left_out + 1) % 4], corners[(left_out + 2) % 4],
                             corners[(left_out + 3) % 4]);
        }
        return;
    }
    for (int corner = 0; corner < 4; corner++)
        add_triangle(mesh, corners[corner], corners[(corner + 1) % 4], mesh->vertex_count);
    mesh->vertex_count++;
}

static void fill_grid(struct chart_mesh *mesh, const struct chart *chart,
                      const struct chart_frame *frame, const double *means)
{
    const size_t columns = chart->x.words.count, rows = chart->y.words.count;
    for (size_t node = 0; node < columns * rows; node++)
        mesh->vertices[node] = (struct chart_vertex){
            .x = chart_scale_share(&frame->x_scale, chart->x.words.items[node % columns].number),
            .y = chart_scale_share(&frame->y_scale, chart->y.words.items[node / columns].number),
            .z = means[node]};
    mesh->vertex_count = columns * rows;
    for (size_t row = 0; row + 1 < rows; row++) {
        for (size_t column = 0; column + 1 < columns; column++)
            add_cell(mesh, row * columns + column, columns);
    }
}

static bool init_grid(struct chart_mesh *mesh, const struct chart *chart, size_t series,
                      const struct chart_frame *frame)
{
    const size_t nodes = chart->x.words.count * chart->y.words.count;
    double *means = grid_means(chart, series);
    mesh->vertices = calloc(2 * nodes + 1, sizeof *mesh->vertices);
    mesh->triangles = calloc(4 * nodes + 1, sizeof *mesh->triangles);
    const bool good = means != NULL && mesh->vertices != NULL && mesh->triangles != NULL;
    if (good)
        fill_grid(mesh, chart, frame, means);
    free(means);
    return good;
}

static int compare_places(const void *left, const void *right)
{
    const struct chart_vertex *a = left, *b = right;
    if (a->x < b->x || a->x > b->x)
        return a->x < b->x ? -1 : 1;
    return (a->y > b->y) - (a->y < b->y);
}

/* Replaces vertices at the same place, which are neighbours, by one with their mean. */
static void merge_places(struct chart_mesh *mesh)
{
    size_t kept = 0;
    for (size_t first = 0, behind; first < mesh->vertex_count; first = behind) {
        double sum = 0.0;
        for (behind = first; behind < mesh->vertex_count &&
                             mesh->vertices[behind].x - mesh->vertices[first].x < 1e-6 &&
                             fabs(mesh->vertices[behind].y - mesh->vertices[first].y) < 1e-6;
             behind++)
            sum += mesh->vertices[behind].z;
        mesh->vertices[kept] = mesh->vertices[first];
        mesh->vertices[kept++].z = sum / (double)(behind - first);
    }
    mesh->vertex_count = kept;
}

static bool init_scatter(struct chart_mesh *mesh, const struct chart *chart, size_t series,
                         const struct chart_frame *frame)
{
    mesh->vertices = calloc(chart->count + 1, sizeof *mesh->vertices);
    mesh->triangles = calloc(2 * chart->count + 8, sizeof *mesh->triangles);
    if (mesh->vertices == NULL || mesh->triangles == NULL)
        return false;
    for (size_t index = 0; index < chart->count; index++) {
        const struct chart_point *point = &chart->points[index];
        if (point->series == series)
            mesh->vertices[mesh->vertex_count++] =
                (struct chart_vertex){.x = chart_scale_share(&frame->x_scale, point->x),
                                      .y = chart_scale_share(&frame->y_scale, point->y),
                                      .z = z_of(chart, point)};
    }
    qsort(mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices, compare_places);
    merge_places(mesh);
    if (mesh->vertex_count < 3 || mesh->vertex_count > CHART_SCATTER_MAX)
        return true;
    mesh->triangle_count = chart_triangulate(mesh->vertices, mesh->vertex_count, mesh->triangles);
    if (mesh->triangle_count != SIZE_MAX)
        return true;
    mesh->triangle_count = 0;
    return false;
}

bool chart_mesh_init(struct chart_mesh *mesh, const struct chart *chart, size_t series,
                     const struct chart_frame *frame)
{
    *mesh = (struct chart_mesh){0};
    return chart->gridded ? init_grid(mesh, chart, series, frame)
                          : init_scatter(mesh, chart, series, frame);
}

void chart_mesh_release(struct chart_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->triangles);
    *mesh = (struct chart_mesh){0};
}

static void add_point(const struct chart_frame *frame, double x, double y, cairo_t *context)
{
    cairo_line_to(context, frame->plot.left + frame->plot.width * x,
                  frame->plot.top + frame->plot.height * (1.0 - y));
}

/* Where an edge crosses a level. */
static void add_crossing(const struct chart_frame *frame, const struct chart_vertex *from,
                         const struct chart_vertex *to, double level, cairo_t *context)
{
    const double share = (level - from->z) / (to->z - from->z);
    add_point(frame, from->x + share * (to->x - from->x), from->y + share * (to->y - from->y),
              context);
}

void chart_mesh_above(const struct chart_mesh *mesh, const struct chart_frame *frame, double level,
                      double covered, cairo_t *context)
{
    for (size_t index = 0; index < mesh->triangle_count; index++) {
        const size_t *corners = mesh->triangles[index];
        bool any = false;
        if (fmin(fmin(mesh->vertices[corners[0]].z, mesh->vertices[corners[1]].z),
                 mesh->vertices[corners[2]].z) >= covered)
            continue;
        for (int corner = 0; corner < 3; corner++) {
            const struct chart_vertex *vertex = &mesh->vertices[mesh->triangles[index][corner]];
            const struct chart_vertex *next =
                &mesh->vertices[mesh->triangles[index][(corner + 1) % 3]];
            const bool above = vertex->z >= level;
            if (above)
                add_point(frame, vertex->x, vertex->y, context);
            if (above != (next->z >= level))
                add_crossing(frame, vertex, next, level, context);
            any = any || above;
        }
        if (any)
            cairo_close_path(context);
        cairo_new_sub_path(context);
    }
}

void chart_mesh_line(const struct chart_mesh *mesh, const struct chart_frame *frame, double level,
                     cairo_t *context)
{
    for (size_t index = 0; index < mesh->triangle_count; index++) {
        cairo_new_sub_path(context);
        for (int corner = 0; corner < 3; corner++) {
            const struct chart_vertex *vertex = &mesh->vertices[mesh->triangles[index][corner]];
            const struct chart_vertex *next =
                &mesh->vertices[mesh->triangles[index][(corner + 1) % 3]];
            if ((vertex->z >= level) != (next->z >= level))
                add_crossing(frame, vertex, next, level, context);
        }
    }
}
