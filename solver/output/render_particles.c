/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_drawing.h"
#include "output/render_vector.h"

#include <math.h>
#include <stdbool.h>

/* Edge of the square or cube that has the particle's volume [m]; of the square that makes it in
 * going around the axis of revolution. */
static double particle_size(const struct render_scene *scene, const struct render_data *data,
                            size_t particle)
{
    static const double two_pi = 6.28318530717958647693;
    if (data->volumes == NULL || !(data->volumes[particle] > 0.0))
        return scene->spacing;
    const double circle = scene->revolves ? two_pi * fabs(data->positions[3 * particle]) : 1.0;
    const double size = data->volumes[particle] / fmax(circle, 1e-300);
    return scene->axis_count == 3 ? cbrt(size) : scene->axis_count == 2 ? sqrt(size) : size;
}

/* The half edges of a particle as columns: F times those of its initial cube (Andersen 2012: the
 * corners of a voxel are x + F dX), or of an undeformed cube if F is not known. */
static void half_edges(const struct render_scene *scene, const struct render_data *data,
                       size_t particle, double edges[3][3])
{
    double size = particle_size(scene, data, particle);
    const double *gradient = data->gradients == NULL ? NULL : data->gradients + 9 * particle;
    if (gradient != NULL) {
        const double *f = gradient;
        const double determinant = f[0] * (f[4] * f[8] - f[5] * f[7]) -
                                   f[1] * (f[3] * f[8] - f[5] * f[6]) +
                                   f[2] * (f[3] * f[7] - f[4] * f[6]);
        if (data->volumes != NULL && determinant > 0.0)
            size /= pow(scene->revolves ? determinant / f[8] : determinant,
                        1.0 / scene->axis_count); /* the square of a section has no hoop */
    }
    for (int edge = 0; edge < 3; edge++) {
        for (int axis = 0; axis < 3; axis++) {
            const double unit =
                gradient != NULL ? gradient[3 * axis + edge] : (double)(axis == edge);
            edges[edge][axis] = 0.5 * size * unit;
        }
    }
}

/* The face spanned by the half edges a and b around `centre`. */
static void draw_face(struct raster *raster, const struct view *view, const double centre[3],
                      const double a[3], const double b[3], struct colour colour)
{
    static const double signs[4][2] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};
    struct screen_point corners[4];
    for (int corner = 0; corner < 4; corner++) {
        double position[3];
        for (int axis = 0; axis < 3; axis++)
            position[axis] = centre[axis] + signs[corner][0] * a[axis] + signs[corner][1] * b[axis];
        corners[corner] = view_project(view, position);
    }
    raster_draw_quad(raster, corners, colour);
}

static void draw_cube(struct raster *raster, const struct view *view, const double position[3],
                      double edges[3][3], struct colour colour)
{
    for (int face = 0; face < 6; face++) {
        const double *out = edges[face / 2], *a = edges[(face / 2 + 1) % 3],
                     *b = edges[(face / 2 + 2) % 3];
        const double sign = face % 2 == 0 ? 1.0 : -1.0;
        double normal[3];
        vector_cross(a, b, normal);
        const double outward = vector_dot(normal, out) * sign < 0.0 ? -1.0 : 1.0;
        double centre[3];
        for (int axis = 0; axis < 3; axis++) {
            normal[axis] *= outward;
            centre[axis] = position[axis] + sign * out[axis];
        }
        if (vector_dot(normal, view->toward) > 0.0)
            draw_face(raster, view, centre, a, b, colour_shade(colour, view_light(view, normal)));
    }
}

void draw_particles(struct raster *raster, const struct view *view,
                    const struct render_scene *scene, const struct render_data *data,
                    const struct colour_range *range, enum render_style style)
{
    /* Spheres of a lattice touch along its diagonals too, so that a body looks closed. */
    const double fill = view->solid ? 0.62 : 0.5;
    for (size_t particle = 0; particle < data->count; particle++) {
        const double *position = data->positions + 3 * particle;
        const struct colour colour =
            data->values == NULL
                ? colour_from_map(0.3)
                : colour_from_map(colour_range_position(range, data->values[particle]));
        if (style == RENDER_POINTS) {
            const double radius = fill * particle_size(scene, data, particle) * view->scale;
            raster_draw_disc(raster, view_project(view, position), radius, colour, view->solid);
            continue;
        }
        double edges[3][3];
        half_edges(scene, data, particle, edges);
        if (view->solid)
            draw_cube(raster, view, position, edges, colour);
        else
            draw_face(raster, view, position, edges[0], edges[1], colour);
    }
}
