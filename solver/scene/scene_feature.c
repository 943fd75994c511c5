/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_feature.h"
#include "scene/scene_geometry.h"

#include "seeding/seeding_lattice.h"

#include <math.h>

static const double too_few = 1.5;

struct extent {
    double min[3], max[3];
};

static void keep_smaller(struct scene_feature *smallest, const struct scene_feature *one)
{
    if (one->cells * smallest->least < smallest->cells * one->least)
        *smallest = *one;
}

/* A grid of one or two cells is thin on purpose. */
static bool is_channel(const struct talus_scene *scene, size_t axis)
{
    return scene->grid.cell_count[axis] <= 2;
}

static bool overlap(const struct talus_scene *scene, const struct extent *a, const struct extent *b,
                    size_t except)
{
    for (size_t k = 0; k < scene->axis_count; k++) {
        if (k != except && (a->max[k] <= b->min[k] || b->max[k] <= a->min[k]))
            return false;
    }
    return true;
}

/* True if another body goes on where this one ends: they are parts of one feature. `extents` are
 * those of all bodies. */
static bool goes_on(const struct talus_scene *scene, size_t index, const struct extent *extents,
                    size_t axis)
{
    const double reach = 0.5 * scene->grid.cell[axis];
    const struct extent *own = &extents[index];
    for (size_t other = 0; other < scene->body_count; other++) {
        const struct extent *next = &extents[other];
        if (other != index && overlap(scene, own, next, axis) &&
            next->min[axis] <= own->max[axis] + reach && next->max[axis] >= own->min[axis] - reach)
            return true;
    }
    return false;
}

/* Between walls on both sides a body is one sample of a uniform state. */
static bool is_confined(const struct talus_scene *scene, const struct extent *own, size_t axis)
{
    bool low = false, high = false;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        low |= scene_plane_is_at(scene, &scene->boundaries[index], axis, own->min[axis], 1);
        high |= scene_plane_is_at(scene, &scene->boundaries[index], axis, own->max[axis], -1);
    }
    return low && high;
}

static void look_at_bodies(const struct talus_scene *scene, struct scene_feature *smallest)
{
    enum { COMPARED_MAX = 100 }; /* pairs are compared: larger scenes are left alone */
    struct extent extents[COMPARED_MAX];
    if (scene->body_count > COMPARED_MAX)
        return;
    for (size_t index = 0; index < scene->body_count; index++)
        scene_body_bounds(scene, &scene->bodies[index], extents[index].min, extents[index].max);
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        const struct extent *own = &extents[index];
        struct seeding_lattice lattice;
        if (body->shape == TALUS_BODY_POINTS)
            continue;
        seeding_lattice_init(&lattice, scene, body);
        if (seeding_lattice_point_count(&lattice) < 2.0)
            continue;
        for (size_t k = 0; k < scene->axis_count; k++) {
            if (!is_channel(scene, k) && !goes_on(scene, index, extents, k) &&
                !is_confined(scene, own, k))
                keep_smaller(smallest,
                             &(struct scene_feature){.cells = (own->max[k] - own->min[k]) /
                                                              scene->grid.cell[k],
                                                     .least = too_few,
                                                     .axis = k,
                                                     .kind = "body",
                                                     .name = body->name,
                                                     .consequence = "it cannot bend or shear"});
        }
    }
}

/* Faces are held or moved as a whole: one cell of them is a point. */
static void look_at_face(const struct talus_scene *scene, const struct talus_boundary *face,
                         struct scene_feature *smallest)
{
    for (size_t k = 0; k < scene->axis_count; k++) {
        const double width = 2.0 * scene_face_half(face, k);
        if (fabs(face->normal[k]) < 1e-9 && width > 0.0 && !is_channel(scene, k))
            keep_smaller(smallest,
                         &(struct scene_feature){.cells = width / scene->grid.cell[k],
                                                 .least = too_few,
                                                 .axis = k,
                                                 .kind = "face",
                                                 .name = face->name,
                                                 .consequence = "it acts like a single point"});
    }
}

static void extent_of(const struct talus_boundary *box, struct extent *extent)
{
    for (size_t k = 0; k < 3; k++) {
        extent->min[k] = box->box_min[k];
        extent->max[k] = box->box_max[k];
    }
}

/* Both faces of an obstacle need nodes of their own. */
static void look_at_obstacle(const struct talus_scene *scene, const struct talus_boundary *box,
                             struct scene_feature *smallest)
{
    const double own_nodes = 1.0 - 1e-6;
    for (size_t k = 0; k < scene->axis_count; k++) {
        const double cells = (box->box_max[k] - box->box_min[k]) / scene->grid.cell[k];
        keep_smaller(smallest, &(struct scene_feature){
                                   .cells = cells,
                                   .least = own_nodes,
                                   .axis = k,
                                   .kind = "obstacle",
                                   .name = box->name,
                                   .consequence = "material on both sides shares its nodes"});
    }
}

/* Openings from the box to boxes beyond it, and to planes on either side. */
static void look_at_openings(const struct talus_scene *scene, const struct talus_boundary *box,
                             struct scene_feature *smallest)
{
    struct extent own, other;
    extent_of(box, &own);
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        extent_of(boundary, &other);
        for (size_t k = 0; k < scene->axis_count; k++) {
            double gap = -1.0;
            if (boundary->shape == TALUS_BOUNDARY_BOX && overlap(scene, &own, &other, k))
                gap = other.min[k] - own.max[k];
            else if (boundary->shape == TALUS_BOUNDARY_PLANE && boundary->normal[k] > 1.0 - 1e-9)
                gap = own.min[k] - boundary->point[k];
            else if (boundary->shape == TALUS_BOUNDARY_PLANE && boundary->normal[k] < -1.0 + 1e-9)
                gap = boundary->point[k] - own.max[k];
            if (gap > 1e-9 * scene->grid.cell[k])
                keep_smaller(smallest,
                             &(struct scene_feature){.cells = gap / scene->grid.cell[k],
                                                     .least = too_few,
                                                     .axis = k,
                                                     .kind = "opening at",
                                                     .name = box->name,
                                                     .consequence = "nothing can flow through it"});
        }
    }
}

struct scene_feature scene_smallest_feature(const struct talus_scene *scene)
{
    struct scene_feature smallest = {
        .cells = INFINITY, .least = 1.0, .kind = "body", .name = "", .consequence = ""};
    look_at_bodies(scene, &smallest);
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        if (boundary->shape == TALUS_BOUNDARY_FACE)
            look_at_face(scene, boundary, &smallest);
        if (boundary->shape == TALUS_BOUNDARY_BOX) {
            look_at_obstacle(scene, boundary, &smallest);
            look_at_openings(scene, boundary, &smallest);
        }
    }
    return smallest;
}
