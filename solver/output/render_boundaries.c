/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_drawing.h"
#include "output/render_vector.h"

#include <math.h>
#include <stdbool.h>

static const struct colour edge_colour = {0.20, 0.22, 0.26};
static const struct colour solid_colour = {0.80, 0.78, 0.75};
static const struct colour floor_colour = {0.93, 0.93, 0.92};
static const struct colour outline_colour = {0.80, 0.82, 0.85};

enum { POLYGON_MAX = 12 }; /* a plane cuts at most six edges of a box; twelve is a safe bound */

struct polygon {
    double corners[POLYGON_MAX][3];
    int count;
};

/* Corner `number` (0..7) of a box. */
static void box_corner(const struct box3 *box, int number, double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (number >> axis & 1) != 0 ? box->max[axis] : box->min[axis];
}

/* Where the 12 edges of the box cross the plane. An edge that lies in it counts as behind, so a
 * plane along a face of the box gives that face. */
static void cut_box(const struct box3 *box, const double point[3], const double normal[3],
                    struct polygon *polygon)
{
    const double tolerance = 1e-9 * (box->max[0] - box->min[0]);
    polygon->count = 0;
    for (int edge = 0; edge < 12; edge++) {
        const int axis = edge / 4;
        const int low = edge % 4, first = (low & ((1 << axis) - 1)) | (low >> axis << (axis + 1));
        double from[3], to[3];
        box_corner(box, first, from);
        box_corner(box, first | 1 << axis, to);
        const double from_distance =
            vector_dot(from, normal) - vector_dot(point, normal) - tolerance;
        const double to_distance = vector_dot(to, normal) - vector_dot(point, normal) - tolerance;
        if ((from_distance > 0.0) == (to_distance > 0.0))
            continue;
        const double share = from_distance / (from_distance - to_distance);
        for (int k = 0; k < 3; k++)
            polygon->corners[polygon->count][k] = from[k] + share * (to[k] - from[k]);
        polygon->count++;
    }
}

/* Orders the corners around their centre, seen along the normal. */
static void sort_polygon(struct polygon *polygon, const double normal[3])
{
    double centre[3] = {0.0, 0.0, 0.0}, angle[POLYGON_MAX];
    double across[3], along[3], helper[3] = {0.0, 0.0, 0.0};
    helper[fabs(normal[0]) < 0.7 ? 0 : 1] = 1.0;
    vector_cross(normal, helper, across);
    vector_cross(across, normal, along);
    for (int corner = 0; corner < polygon->count; corner++) {
        for (int axis = 0; axis < 3; axis++)
            centre[axis] += polygon->corners[corner][axis] / polygon->count;
    }
    for (int corner = 0; corner < polygon->count; corner++) {
        double position[3], offset[3];
        for (int axis = 0; axis < 3; axis++) {
            position[axis] = polygon->corners[corner][axis];
            offset[axis] = position[axis] - centre[axis];
        }
        const double own = atan2(vector_dot(offset, across), vector_dot(offset, along));
        int place = corner;
        for (; place > 0 && angle[place - 1] > own; place--) {
            angle[place] = angle[place - 1];
            for (int axis = 0; axis < 3; axis++)
                polygon->corners[place][axis] = polygon->corners[place - 1][axis];
        }
        angle[place] = own;
        for (int axis = 0; axis < 3; axis++)
            polygon->corners[place][axis] = position[axis];
    }
}

static void fill_polygon(struct raster *raster, const struct view *view,
                         const struct polygon *polygon, struct colour colour)
{
    for (int corner = 1; corner + 1 < polygon->count; corner++) {
        const struct screen_point third = view_project(view, polygon->corners[corner + 1]);
        const struct screen_point corners[4] = {view_project(view, polygon->corners[0]),
                                                view_project(view, polygon->corners[corner]), third,
                                                third};
        raster_draw_quad(raster, corners, colour);
    }
}

static void outline_polygon(struct raster *raster, const struct view *view,
                            const struct polygon *polygon, double width, struct colour colour)
{
    for (int corner = 0; corner < polygon->count; corner++)
        raster_draw_line(raster, view_project(view, polygon->corners[corner]),
                         view_project(view, polygon->corners[(corner + 1) % polygon->count]), width,
                         colour);
}

/* The part of the view's box that a boundary takes up; false if there is none. */
static bool clip_to_view(const struct view *view, const struct render_boundary *boundary,
                         struct box3 *box)
{
    *box = view->box;
    if (boundary->kind == RENDER_PLANE)
        return true;
    const double thickness = 1e-6 * (view->box.max[0] - view->box.min[0]);
    for (int axis = 0; axis < 3; axis++) {
        /* A face is flat along an axis: it needs some thickness to be cut by its own plane. */
        const double room = boundary->kind == RENDER_FACE ? thickness : 0.0;
        box->min[axis] = fmax(box->min[axis], boundary->min[axis] - room);
        box->max[axis] = fmin(box->max[axis], boundary->max[axis] + room);
        if ((view->solid || axis < 2) && box->min[axis] >= box->max[axis])
            return false;
    }
    return true;
}

static void draw_obstacle(struct raster *raster, const struct view *view, const struct box3 *box,
                          double line_width)
{
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2;
        double normal[3] = {0.0, 0.0, 0.0}, point[3];
        normal[axis] = face % 2 == 0 ? 1.0 : -1.0;
        if (vector_dot(normal, view->toward) <= 1e-9)
            continue;
        box_corner(box, face % 2 == 0 ? 7 : 0, point);
        struct polygon polygon = {.count = 4};
        for (int corner = 0; corner < 4; corner++) {
            const int first = corner == 1 || corner == 2, second = corner >= 2;
            const int number = (face % 2 == 0 ? 1 << axis : 0) | first << (axis + 1) % 3 |
                               second << (axis + 2) % 3;
            box_corner(box, number, polygon.corners[corner]);
        }
        fill_polygon(raster, view, &polygon, colour_shade(solid_colour, view_light(view, normal)));
        outline_polygon(raster, view, &polygon, line_width, edge_colour);
    }
}

/* A plane or face: what material rests on is filled, everything else is an outline. */
static void draw_surface(struct raster *raster, const struct view *view,
                         const struct render_scene *scene, const struct render_boundary *boundary,
                         const struct box3 *box, double line_width)
{
    struct polygon polygon;
    cut_box(box, boundary->point, boundary->normal, &polygon);
    if (polygon.count < 3)
        return;
    sort_polygon(&polygon, boundary->normal);
    if (boundary->normal[scene->up_axis] * scene->up_sign > 0.5)
        fill_polygon(raster, view, &polygon, floor_colour);
    outline_polygon(raster, view, &polygon, line_width, outline_colour);
}

/* In the plane of a 2D scene a surface is a line: where it crosses the sides of the view. */
static void draw_surface_line(struct raster *raster, const struct view *view,
                              const struct render_boundary *boundary, const struct box3 *box,
                              double line_width)
{
    struct box3 slab = *box;
    struct polygon polygon;
    slab.min[2] = 0.0;
    slab.max[2] = 1.0;
    cut_box(&slab, boundary->point, boundary->normal, &polygon);
    double ends[2][3];
    int count = 0;
    for (int corner = 0; corner < polygon.count && count < 2; corner++) {
        if (polygon.corners[corner][2] > 0.5)
            continue;
        for (int axis = 0; axis < 3; axis++)
            ends[count][axis] = polygon.corners[corner][axis];
        count++;
    }
    if (count == 2)
        raster_draw_line(raster, view_project(view, ends[0]), view_project(view, ends[1]),
                         2.0 * line_width, edge_colour);
}

void draw_boundaries(struct raster *raster, const struct view *view,
                     const struct render_scene *scene, double line_width)
{
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct render_boundary *boundary = &scene->boundaries[index];
        struct box3 box;
        if (!clip_to_view(view, boundary, &box))
            continue;
        if (boundary->kind == RENDER_BOX)
            draw_obstacle(raster, view, &box, line_width);
        else if (view->solid)
            draw_surface(raster, view, scene, boundary, &box, line_width);
        else
            draw_surface_line(raster, view, boundary, &box, line_width);
    }
}
