/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_view.h"

#include "output/render_vector.h"

#include <assert.h>
#include <math.h>

/* The eye of a solid scene: to the left of the front, and above. Flows usually run along the first
 * axis, so this looks after them, onto the faces that they hit. */
static const double eye_azimuth_deg = -32.0, eye_elevation_deg = 30.0;

static void grow_to(struct box3 *box, const double *positions, size_t count)
{
    for (size_t index = 0; index < count; index++) {
        for (int axis = 0; axis < 3; axis++) {
            const double value = positions[3 * index + (size_t)axis];
            if (isfinite(value)) {
                box->min[axis] = fmin(box->min[axis], value);
                box->max[axis] = fmax(box->max[axis], value);
            }
        }
    }
}

/* Steps of a tenth of the extent, rounded up to 1, 2 or 5 times a power of ten: frames of one run
 * then mostly share one view. */
static double round_step(double extent)
{
    const double rough = extent / 10.0, power = pow(10.0, floor(log10(rough)));
    const double digit = rough / power;
    return power * (digit <= 1.0 ? 1.0 : digit <= 2.0 ? 2.0 : digit <= 5.0 ? 5.0 : 10.0);
}

static void grow_to_obstacles(const struct render_scene *scene, struct box3 *box)
{
    assert(scene->axis_count >= 1 && scene->axis_count <= 3);
    const int up = scene->up_axis;
    const double height = box->max[up] - box->min[up];
    const struct box3 material = *box;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct render_boundary *boundary = &scene->boundaries[index];
        if (boundary->kind != RENDER_BOX)
            continue;
        for (int axis = 0; axis < scene->axis_count; axis++) {
            double low = boundary->min[axis], high = boundary->max[axis];
            if (axis == up) {
                low = fmax(low, material.min[axis] - 0.5 * height);
                high = fmin(high, material.max[axis] + 0.5 * height);
            }
            box->min[axis] = fmin(box->min[axis], low);
            box->max[axis] = fmax(box->max[axis], high);
        }
    }
}

struct box3 view_find_box(const struct render_scene *scene, const double *positions, size_t count,
                          const double *before, size_t before_count)
{
    struct box3 box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    assert(scene->axis_count >= 1 && scene->axis_count <= 3);
    grow_to(&box, positions, count);
    if (before != NULL)
        grow_to(&box, before, before_count);
    for (int axis = 0; axis < 3; axis++) {
        if (box.min[axis] > box.max[axis]) { /* no particle is left */
            box.min[axis] = scene->grid_min[axis];
            box.max[axis] = scene->grid_max[axis];
        }
    }
    grow_to_obstacles(scene, &box);
    double extent = scene->cell[0];
    for (int axis = 0; axis < scene->axis_count; axis++)
        extent = fmax(extent, box.max[axis] - box.min[axis]);
    const double step = round_step(extent);
    for (int axis = 0; axis < scene->axis_count; axis++) {
        const double low = floor((box.min[axis] - 0.5 * scene->spacing) / step + 1e-9) * step;
        const double high = ceil((box.max[axis] + 0.5 * scene->spacing) / step - 1e-9) * step;
        box.min[axis] = fmin(fmax(low, scene->grid_min[axis]), box.min[axis]);
        box.max[axis] = fmax(fmin(high, scene->grid_max[axis]), box.max[axis]);
    }
    if (scene->axis_count == 1) { /* a strip, so that a line can be seen */
        box.min[1] = -0.05 * extent;
        box.max[1] = 0.05 * extent;
    }
    return box;
}

static void look_at_solid(struct view *view, const struct render_scene *scene)
{
    const double azimuth = eye_azimuth_deg * M_PI / 180.0;
    const double elevation = eye_elevation_deg * M_PI / 180.0;
    double vertical[3] = {0.0, 0.0, 0.0}, first[3] = {0.0, 0.0, 0.0}, front[3];
    vertical[scene->up_axis] = scene->up_sign;
    first[scene->up_axis == 0 ? 1 : 0] = 1.0;
    vector_cross(first, vertical, front);
    for (int axis = 0; axis < 3; axis++) {
        const double ahead = sin(azimuth) * first[axis] + cos(azimuth) * front[axis];
        view->toward[axis] = cos(elevation) * ahead + sin(elevation) * vertical[axis];
        view->right[axis] = cos(azimuth) * first[axis] - sin(azimuth) * front[axis];
    }
    vector_cross(view->toward, view->right, view->up);
}

void view_init(struct view *view, const struct render_scene *scene, struct box3 box)
{
    *view = (struct view){.solid = scene->axis_count == 3, .box = box, .scale = 1.0};
    if (view->solid) {
        look_at_solid(view, scene);
        return;
    }
    view->right[0] = view->up[1] = view->toward[2] = 1.0;
}

/* Extent of the box on the screen, relative to the projected origin of space. */
static struct rectangle projected_extent(const struct view *view)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int corner = 0; corner < 8; corner++) {
        double position[3];
        for (int axis = 0; axis < 3; axis++)
            position[axis] = (corner >> axis & 1) != 0 ? view->box.max[axis] : view->box.min[axis];
        const double x = vector_dot(position, view->right), y = -vector_dot(position, view->up);
        low[0] = fmin(low[0], x);
        high[0] = fmax(high[0], x);
        low[1] = fmin(low[1], y);
        high[1] = fmax(high[1], y);
    }
    return (struct rectangle){low[0], low[1], high[0] - low[0], high[1] - low[1]};
}

double view_aspect(const struct view *view)
{
    const struct rectangle extent = projected_extent(view);
    return extent.height / extent.width;
}

void view_fit(struct view *view, struct rectangle area)
{
    const struct rectangle extent = projected_extent(view);
    view->scale = fmin(area.width / extent.width, area.height / extent.height);
    view->left =
        area.left + (area.width - extent.width * view->scale) / 2.0 - extent.left * view->scale;
    view->top =
        area.top + (area.height - extent.height * view->scale) / 2.0 - extent.top * view->scale;
}

struct screen_point view_project(const struct view *view, const double position[3])
{
    return (struct screen_point){view->left + view->scale * vector_dot(position, view->right),
                                 view->top - view->scale * vector_dot(position, view->up),
                                 -view->scale * vector_dot(position, view->toward)};
}

double view_light(const struct view *view, const double normal[3])
{
    /* From the upper left, in front: along right, up and toward; unit length. */
    static const double light[3] = {-0.41, 0.57, 0.71};
    const double facing = light[0] * vector_dot(normal, view->right) +
                          light[1] * vector_dot(normal, view->up) +
                          light[2] * vector_dot(normal, view->toward);
    return 0.68 + 0.32 * fmax(facing / sqrt(vector_dot(normal, normal)), 0.0);
}
