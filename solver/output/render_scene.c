/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_scene.h"

#include <jansson.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fills out[3] from an array of up to three numbers, or from one number for all axes; what is not
 * a number (null: open) leaves out[] as it is. */
static void read_vector(const json_t *value, double out[3])
{
    for (size_t axis = 0; axis < 3; axis++) {
        const json_t *item = json_is_array(value) ? json_array_get(value, axis) : value;
        if (json_is_number(item))
            out[axis] = json_number_value(item);
    }
}

static bool normalise(double vector[3])
{
    const double length =
        sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
    for (int axis = 0; axis < 3; axis++)
        vector[axis] /= length;
    return length > 0.0;
}

static void read_up(const json_t *gravity, struct render_scene *scene)
{
    double up[3] = {0.0, 0.0, 0.0};
    if (json_is_object(gravity)) {
        read_vector(json_object_get(gravity, "up"), up);
    } else {
        read_vector(gravity, up);
        for (int axis = 0; axis < 3; axis++)
            up[axis] = -up[axis];
    }
    scene->up_axis = 1;
    for (int axis = 0; axis < scene->axis_count; axis++) {
        if (fabs(up[axis]) > fabs(up[scene->up_axis]))
            scene->up_axis = axis;
    }
    scene->up_sign = up[scene->up_axis] < 0.0 ? -1.0 : 1.0;
}

/* The distance of particles along an axis that a body's lattice asks for, or the size of the first
 * of a list; cell if it does not say. */
static double lattice_spacing(const json_t *body, const double cell[3], int axis_count, int axis)
{
    double value[3] = {0.0, 0.0, 0.0};
    read_vector(json_object_get(body, "spacing"), value);
    if (value[axis] > 0.0)
        return value[axis];
    read_vector(json_object_get(body, "particles_per_cell"), value);
    if (value[axis] > 0.0)
        return cell[axis] / value[axis];
    read_vector(json_object_get(body, "count"), value);
    double low[3] = {0.0, 0.0, 0.0}, high[3] = {0.0, 0.0, 0.0};
    const json_t *box = json_object_get(body, "box");
    read_vector(json_object_get(box, "min"), low);
    read_vector(json_object_get(box, "max"), high);
    if (value[axis] > 0.0 && high[axis] > low[axis])
        return (high[axis] - low[axis]) / value[axis];
    const json_t *volumes = json_object_get(json_object_get(body, "points"), "volumes");
    if (json_array_size(volumes) > 0)
        return pow(json_number_value(json_array_get(volumes, 0)), 1.0 / (double)axis_count);
    return cell[axis];
}

static void read_spacing(const json_t *bodies, struct render_scene *scene)
{
    size_t index;
    json_t *body;
    scene->spacing = INFINITY;
    json_array_foreach(bodies, index, body)
    {
        for (int axis = 0; axis < scene->axis_count; axis++)
            scene->spacing =
                fmin(scene->spacing, lattice_spacing(body, scene->cell, scene->axis_count, axis));
    }
    if (!(scene->spacing > 0.0) || isinf(scene->spacing))
        scene->spacing = scene->cell[0];
}

/* A face is an extent that is flat along its normal, or a centre with a normal and full lengths. */
static void read_face(const json_t *face, struct render_boundary *boundary)
{
    for (int axis = 0; axis < 3; axis++) {
        boundary->min[axis] = -INFINITY;
        boundary->max[axis] = INFINITY;
    }
    read_vector(json_object_get(face, "min"), boundary->min);
    read_vector(json_object_get(face, "max"), boundary->max);
    for (int axis = 0; axis < 3; axis++) {
        if (isfinite(boundary->min[axis]))
            boundary->point[axis] = boundary->min[axis];
    }
    read_vector(json_object_get(face, "point"), boundary->point);
    double size[3] = {INFINITY, INFINITY, INFINITY};
    read_vector(json_object_get(face, "size"), size);
    /* For a picture the longer length in every direction is enough of an oblique face. */
    const double half =
        isfinite(size[0]) ? fmax(size[0], isfinite(size[1]) ? size[1] : 0.0) / 2.0 : INFINITY;
    for (int axis = 0; isfinite(half) && axis < 3; axis++) {
        boundary->min[axis] = boundary->point[axis] - half;
        boundary->max[axis] = boundary->point[axis] + half;
    }
}

static bool read_boundary(const json_t *item, struct render_boundary *boundary)
{
    *boundary = (struct render_boundary){0};
    const json_t *box = json_object_get(item, "box");
    if (json_is_object(box)) {
        boundary->kind = RENDER_BOX;
        read_vector(json_object_get(box, "min"), boundary->min);
        read_vector(json_object_get(box, "max"), boundary->max);
        return true;
    }
    const json_t *face = json_object_get(item, "face");
    boundary->kind = json_is_object(face) ? RENDER_FACE : RENDER_PLANE;
    const json_t *surface = json_is_object(face) ? face : json_object_get(item, "plane");
    if (!json_is_object(surface))
        return false;
    read_vector(json_object_get(surface, "point"), boundary->point);
    read_vector(json_object_get(surface, "normal"), boundary->normal);
    if (boundary->kind == RENDER_FACE)
        read_face(surface, boundary);
    return normalise(boundary->normal);
}

static enum talus_status read_boundaries(const json_t *items, struct render_scene *scene,
                                         struct talus_error *error)
{
    size_t index;
    json_t *item;
    scene->boundaries = calloc(json_array_size(items) + 1, sizeof *scene->boundaries);
    if (scene->boundaries == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a picture");
    json_array_foreach(items, index, item)
    {
        if (read_boundary(item, &scene->boundaries[scene->boundary_count]))
            scene->boundary_count++;
    }
    return TALUS_OK;
}

static int axis_count_of(const json_t *dimension)
{
    const char *name = json_string_value(dimension);
    if (name == NULL)
        return 0;
    return strcmp(name, "line") == 0 ? 1 : strcmp(name, "solid") == 0 ? 3 : 2;
}

static enum talus_status read_root(const json_t *root, struct render_scene *scene,
                                   struct talus_error *error)
{
    const json_t *grid = json_object_get(root, "grid");
    const char *title = json_string_value(json_object_get(root, "title"));
    (void)snprintf(scene->title, sizeof scene->title, "%s", title == NULL ? "" : title);
    const json_t *dimension = json_object_get(root, "dimension");
    scene->axis_count = axis_count_of(dimension);
    scene->revolves =
        scene->axis_count == 2 && strcmp(json_string_value(dimension), "axisymmetric") == 0;
    read_vector(json_object_get(grid, "cell"), scene->cell);
    read_vector(json_object_get(grid, "min"), scene->grid_min);
    read_vector(json_object_get(grid, "max"), scene->grid_max);
    for (int axis = 0; axis < scene->axis_count; axis++) {
        if (!(scene->cell[axis] > 0.0) || !(scene->grid_max[axis] > scene->grid_min[axis]))
            return talus_error_set(error, TALUS_IO, "scene", "", "scene.json has no usable grid");
    }
    for (int axis = scene->axis_count; axis < 3; axis++)
        scene->cell[axis] = scene->grid_min[axis] = scene->grid_max[axis] = 0.0;
    if (scene->axis_count == 0)
        return talus_error_set(error, TALUS_IO, "scene", "", "scene.json has no dimension");
    read_up(json_object_get(root, "gravity"), scene);
    read_spacing(json_object_get(root, "bodies"), scene);
    return read_boundaries(json_object_get(root, "boundaries"), scene, error);
}

enum talus_status render_scene_read(struct render_scene *scene, const char *path,
                                    struct talus_error *error)
{
    json_error_t mistake;
    *scene = (struct render_scene){0};
    json_t *root = json_load_file(path, 0, &mistake);
    if (root == NULL)
        return talus_error_set(error, TALUS_IO, "scene", "", "cannot read %s: %s", path,
                               mistake.text);
    enum talus_status status = read_root(root, scene, error);
    json_decref(root);
    return status;
}

void render_scene_release(struct render_scene *scene)
{
    free(scene->boundaries);
    memset(scene, 0, sizeof *scene);
}
