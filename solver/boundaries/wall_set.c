/* SPDX-License-Identifier: Apache-2.0 */
/* From boundaries in space to conditions at nodes. */
#include "boundaries/boundary.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static int32_t moved_line(const struct domain *domain, size_t axis, double coordinate,
                          const struct wall_motion *motion)
{
    /* A whole number of cells, by which the line has moved. */
    return domain_nearest_line(domain, axis, coordinate) +
           (int32_t)lround(motion->snapped[axis] * domain->inverse_cell[axis]);
}

void wall_shape_place(struct wall_shape *shape, const struct talus_boundary *boundary,
                      const struct domain *domain)
{
    const struct wall_motion *motion = &shape->motion;
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        shape->point[axis] = boundary->point[axis] + motion->moved[axis];
        shape->held_point[axis] = boundary->point[axis] + motion->snapped[axis];
        shape->box_min[axis] = boundary->box_min[axis] + motion->moved[axis];
        shape->box_max[axis] = boundary->box_max[axis] + motion->moved[axis];
        if (boundary->shape == TALUS_BOUNDARY_BOX) {
            shape->box_low[axis] = moved_line(domain, axis, boundary->box_min[axis], motion);
            shape->box_high[axis] = moved_line(domain, axis, boundary->box_max[axis], motion);
            /* No material can be beyond the edge of the grid. */
            shape->face_exists[2 * axis] = shape->box_low[axis] > 0;
            shape->face_exists[2 * axis + 1] = shape->box_high[axis] < domain->cell_count[axis];
        } else if (shape->axis == (int)axis) {
            shape->line = moved_line(domain, axis, boundary->point[axis], motion);
        }
    }
}

static void shape_from_boundary(struct wall_shape *shape, const struct talus_boundary *boundary,
                                const struct domain *domain)
{
    shape->kind = boundary->shape;
    shape->source_rule = boundary->area_source_rule;
    shape->body_index = boundary->body_index;
    shape->axis = -1;
    memcpy(shape->normal, boundary->normal, sizeof shape->normal);
    memcpy(shape->axis_1, boundary->axis_1, sizeof shape->axis_1);
    memcpy(shape->axis_2, boundary->axis_2, sizeof shape->axis_2);
    memcpy(shape->size, boundary->size, sizeof shape->size);
    shape->motion.acts = 1;
    for (size_t axis = 0; axis < domain->axis_count && shape->kind != TALUS_BOUNDARY_BOX; axis++) {
        if (fabs(fabs(boundary->normal[axis]) - 1.0) < 1e-9) {
            shape->axis = (int)axis;
            shape->lower = boundary->normal[axis] > 0;
        }
    }
    wall_shape_place(shape, boundary, domain);
}

static void face_from_boundary(struct wall_face *face, const struct talus_boundary *boundary,
                               const struct domain *domain, size_t boundary_index, int face_index)
{
    const struct talus_boundary_face *source = &boundary->faces[face_index < 0 ? 0 : face_index];
    face->condition = boundary_table[source->condition_index];
    face->friction_coefficient = source->friction_coefficient;
    face->adhesion = source->adhesion;
    face->turbulence = source->turbulence;
    face->prescribed = face->condition->prescribes ? boundary->prescribed : 0;
    face->moves = boundary->prescribed != 0 && (!boundary->stays || face->prescribed != 0);
    face->wall = boundary->wall;
    face->release = boundary->tension_release && face_index >= 0;
    face->tension_force = boundary->tension_force;
    face->boundary_index = (uint16_t)boundary_index;
    face->face_index = (int8_t)face_index;
    memcpy(face->normal, boundary->normal, sizeof face->normal);
    if (boundary->shape == TALUS_BOUNDARY_BOX) {
        memset(face->normal, 0, sizeof face->normal);
        if (face_index >= 0)
            face->normal[face_index / 2] = face_index % 2 == 0 ? -1.0 : 1.0;
        else
            face->condition = boundary_find("stick");
    }
    if (face_index < 0) {
        face->prescribed = 0;
        face->moves = boundary->prescribed != 0 && !boundary->stays;
    }
    for (size_t axis = 0; axis < domain->axis_count; axis++)
        face->half_cell =
            fmax(face->half_cell, 0.5 * fabs(face->normal[axis]) * domain->cell[axis]);
}

int wall_set_create(struct wall_set *walls, const struct talus_scene *scene,
                    const struct domain *domain)
{
    memset(walls, 0, sizeof *walls);
    walls->axis_count = domain->axis_count;
    walls->boundary_count = scene->boundary_count;
    walls->shapes = calloc(scene->boundary_count + 1, sizeof *walls->shapes);
    walls->faces = calloc(7 * scene->boundary_count + 1, sizeof *walls->faces);
    if (walls->shapes == NULL || walls->faces == NULL) {
        wall_set_release(walls);
        return -1;
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        struct wall_shape *shape = &walls->shapes[index];
        shape_from_boundary(shape, boundary, domain);
        walls->timed = walls->timed || boundary->prescribed != 0 || boundary->timed;
        shape->first_face = walls->face_count;
        for (size_t face = 0; face < boundary->face_count; face++) {
            face_from_boundary(&walls->faces[walls->face_count++], boundary, domain, index,
                               (int)face);
            if (walls->faces[walls->face_count - 1].condition->eliminates)
                shape->eliminates = true;
        }
        if (boundary->shape == TALUS_BOUNDARY_BOX)
            face_from_boundary(&walls->faces[walls->face_count++], boundary, domain, index, -1);
    }
    return 0;
}

void wall_set_release(struct wall_set *walls)
{
    free(walls->faces);
    free(walls->shapes);
    memset(walls, 0, sizeof *walls);
}

static void add_face(struct node_faces *faces, size_t face, double area)
{
    if (faces->count == NODE_FACE_MAX)
        return;
    faces->face[faces->count] = (uint16_t)face;
    faces->area[faces->count++] = area;
}

/* Length of the circle through the middle of the stretch that a node stands for along x, of which
 * one half may be missing. */
static double node_circle(const struct domain *domain, int32_t node, bool inner_missing,
                          bool outer_missing)
{
    const double shift = 0.25 * domain->cell[0] * ((int)inner_missing - (int)outer_missing);
    return domain_circle(domain, fmax(0.0, domain_node_position(domain, 0, node) + shift));
}

/* Area that a node represents on a surface normal to `axis` which spans lines low..high. */
static double tributary_area(const struct domain *domain, size_t axis, const int32_t node[3],
                             const int32_t low[3], const int32_t high[3], bool source_rule)
{
    double area = 1.0;
    assert(domain->axis_count >= 1 && domain->axis_count <= 3);
    for (size_t other = 0; other < domain->axis_count; other++) {
        if (other == axis)
            continue;
        area *= domain->cell[other];
        if (!source_rule && (node[other] == low[other] || node[other] == high[other]))
            area *= 0.5;
    }
    const bool cut = axis != 0 && !source_rule;
    return area * node_circle(domain, node[0], cut && node[0] == low[0], cut && node[0] == high[0]);
}

static void box_faces(const struct wall_shape *shape, const struct domain *domain,
                      const int32_t node[3], struct node_faces *faces)
{
    bool inside = true;
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        if (node[axis] < shape->box_low[axis] || node[axis] > shape->box_high[axis])
            return;
        /* The part of a face that is outside of the grid does not make a node less inside. */
        if ((node[axis] == shape->box_low[axis] && shape->face_exists[2 * axis]) ||
            (node[axis] == shape->box_high[axis] && shape->face_exists[2 * axis + 1]))
            inside = false;
    }
    if (inside) {
        add_face(faces, shape->first_face + 2 * domain->axis_count, 0.0);
        return;
    }
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        for (size_t side = 0; side < 2; side++) {
            const int32_t line = side == 0 ? shape->box_low[axis] : shape->box_high[axis];
            if (node[axis] != line || !shape->face_exists[2 * axis + side])
                continue;
            add_face(faces, shape->first_face + 2 * axis + side,
                     tributary_area(domain, axis, node, shape->box_low, shape->box_high,
                                    shape->source_rule));
        }
    }
}

static double along(const double axis[3], const double from[3], const double to[3])
{
    return axis[0] * (to[0] - from[0]) + axis[1] * (to[1] - from[1]) + axis[2] * (to[2] - from[2]);
}

static void plane_faces(const struct wall_shape *shape, const struct domain *domain,
                        const int32_t node[3], struct node_faces *faces)
{
    static const int32_t grid_low[3] = {0, 0, 0};
    if (shape->axis >= 0) {
        const int32_t depth =
            shape->lower ? shape->line - node[shape->axis] : node[shape->axis] - shape->line;
        if (depth < 0)
            return;
        const double area = tributary_area(domain, (size_t)shape->axis, node, grid_low,
                                           domain->cell_count, shape->source_rule);
        add_face(faces, shape->first_face, depth == 0 ? area : 0.0);
        return;
    }
    double position[3] = {0, 0, 0}, width = 0, steepest = 0;
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        position[axis] = domain_node_position(domain, axis, node[axis]);
        width = fmax(width, fabs(shape->normal[axis]) * domain->cell[axis]);
        steepest = fmax(steepest, fabs(shape->normal[axis]));
    }
    const double distance = along(shape->normal, shape->held_point, position);
    if (distance > 0.5 * width)
        return;
    const double area = node_circle(domain, node[0], false, false) * domain_cell_volume(domain) /
                        fmax(width, 1e-300); /* one node per cell width */
    add_face(faces, shape->first_face, distance > -0.5 * width ? area : 0.0);
}

static void rectangle_faces(const struct wall_shape *shape, const struct domain *domain,
                            const int32_t node[3], struct node_faces *faces)
{
    double position[3] = {0, 0, 0}, width = 0;
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        position[axis] = domain_node_position(domain, axis, node[axis]);
        width = fmax(width, fabs(shape->normal[axis]) * domain->cell[axis]);
    }
    if (shape->axis >= 0 ? node[shape->axis] != shape->line
                         : fabs(along(shape->normal, shape->held_point, position)) > 0.5 * width)
        return;
    const double smallest = domain_smallest_cell(domain);
    double area = domain_cell_volume(domain) / fmax(width, 1e-300);
    double missing = 0; /* on this side along x nothing of the face belongs to the node */
    const double *axes[2] = {shape->axis_1, shape->axis_2};
    for (size_t index = 0; index + 1 < domain->axis_count; index++) {
        const double offset = along(axes[index], shape->held_point, position);
        if (fabs(offset) > 0.5 * shape->size[index] + LINE_TOLERANCE * smallest)
            return;
        if (shape->source_rule ||
            fabs(offset) <= 0.5 * shape->size[index] - LINE_TOLERANCE * smallest)
            continue;
        area *= 0.5;
        missing = offset * axes[index][0];
    }
    add_face(faces, shape->first_face, area * node_circle(domain, node[0], missing<0, missing> 0));
}

void wall_set_node_faces(const struct wall_set *walls, const struct domain *domain,
                         const int32_t node[3], struct node_faces *faces)
{
    faces->count = 0;
    for (size_t index = 0; index < walls->boundary_count; index++) {
        const struct wall_shape *shape = &walls->shapes[index];
        if (shape->eliminates || !shape->motion.acts)
            continue;
        if (shape->kind == TALUS_BOUNDARY_BOX)
            box_faces(shape, domain, node, faces);
        else if (shape->kind == TALUS_BOUNDARY_PLANE)
            plane_faces(shape, domain, node, faces);
        else
            rectangle_faces(shape, domain, node, faces);
    }
}
