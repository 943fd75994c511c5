/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_mirror.h"

#include "seeding/seeding_shape.h"

#include <math.h>
#include <string.h>

bool scene_mirror_near(const struct scene_mirror *mirror, size_t k, double a, double b)
{
    const double image = k == mirror->axis ? 2.0 * mirror->centre - b : b;
    return scene_near(a, image, mirror->scene->grid.cell[k]);
}

static bool points_mirror(const struct scene_mirror *mirror, const double a[3], const double b[3])
{
    bool same = true;
    for (size_t k = 0; k < mirror->scene->axis_count; k++)
        same = same && scene_mirror_near(mirror, k, a[k], b[k]);
    return same;
}

static bool boxes_mirror(const struct scene_mirror *mirror, const double min_a[3],
                         const double max_a[3], const double min_b[3], const double max_b[3])
{
    bool same = true;
    for (size_t k = 0; k < mirror->scene->axis_count; k++) {
        const bool turned = k == mirror->axis;
        same = same && scene_mirror_near(mirror, k, min_a[k], turned ? max_b[k] : min_b[k]) &&
               scene_mirror_near(mirror, k, max_a[k], turned ? min_b[k] : max_b[k]);
    }
    return same;
}

/* Vectors that point somewhere: velocities, normals, loads. */
static bool vectors_mirror(const struct scene_mirror *mirror, const double a[3], const double b[3])
{
    bool same = true;
    for (size_t k = 0; k < 3; k++) {
        const double image = k == mirror->axis ? -b[k] : b[k];
        same = same && scene_near(a[k], image, fabs(image));
    }
    return same;
}

/* Sides in the other sense, from any vertex on. */
static bool polygons_mirror(const struct scene_mirror *mirror, const struct talus_body *a,
                            const struct talus_body *b)
{
    const size_t count = a->vertex_count;
    for (size_t first = 0; first < count; first++) {
        bool same = true;
        for (size_t vertex = 0; vertex < count && same; vertex++)
            same = points_mirror(mirror, a->vertices + 2 * vertex,
                                 b->vertices + 2 * ((first + count - vertex) % count));
        if (same)
            return true;
    }
    return false;
}

static bool shapes_mirror(const struct scene_mirror *mirror, const struct talus_body *a,
                          const struct talus_body *b)
{
    enum { VERTEX_MAX = 64 }; /* every vertex is compared with every other */
    struct seeding_shape first, second;
    if (a->shape != b->shape || a->shape == TALUS_BODY_POINTS ||
        a->vertex_count != b->vertex_count || a->vertex_count > VERTEX_MAX)
        return false;
    seeding_shape_init(&first, mirror->scene, a);
    seeding_shape_init(&second, mirror->scene, b);
    if (first.turned || second.turned ||
        !boxes_mirror(mirror, first.min, first.max, second.min, second.max))
        return false;
    switch (a->shape) {
    case TALUS_BODY_SPHERE:
        return a->radius == b->radius && points_mirror(mirror, a->centre, b->centre);
    case TALUS_BODY_CYLINDER:
        return a->radius == b->radius &&
               ((points_mirror(mirror, a->from, b->from) && points_mirror(mirror, a->to, b->to)) ||
                (points_mirror(mirror, a->from, b->to) && points_mirror(mirror, a->to, b->from)));
    case TALUS_BODY_POLYGON:
        return polygons_mirror(mirror, a, b);
    case TALUS_BODY_BOX:
    case TALUS_BODY_POINTS:
        break;
    }
    return true;
}

/* Of the faces of boxes and the one of a sphere; others are not followed. */
static bool tractions_mirror(const struct scene_mirror *mirror, const struct talus_body *a,
                             const struct talus_body *b)
{
    const bool box = a->shape == TALUS_BODY_BOX;
    if (a->traction_count != b->traction_count ||
        (a->traction_count > 0 && !box && a->shape != TALUS_BODY_SPHERE))
        return false;
    for (size_t index = 0; index < a->traction_count; index++) {
        const struct talus_traction *load = &a->tractions[index];
        const size_t face = box && load->face / 2 == mirror->axis ? load->face ^ 1u : load->face;
        bool found = false;
        for (size_t other = 0; other < b->traction_count && !found; other++) {
            const struct talus_traction *image = &b->tractions[other];
            const bool tables = load->table[0].count + load->table[1].count + load->table[2].count +
                                    image->table[0].count + image->table[1].count +
                                    image->table[2].count >
                                0;
            found = image->face == face && image->kind == load->kind &&
                    image->is_pressure == load->is_pressure &&
                    (load->is_pressure ? load->value[0] == image->value[0]
                                       : vectors_mirror(mirror, load->value, image->value)) &&
                    (!tables || (load == image &&
                                 (load->is_pressure || load->table[mirror->axis].count == 0)));
        }
        if (!found)
            return false;
    }
    return true;
}

static bool stresses_mirror(const struct scene_mirror *mirror, const struct talus_body *a,
                            const struct talus_body *b)
{
    /* Shears with the axis change their sign: components xx yy zz xy yz xz. */
    static const unsigned shears[3] = {1u << 3 | 1u << 5, 1u << 3 | 1u << 4, 1u << 4 | 1u << 5};
    if (a->initial_stress != b->initial_stress)
        return false;
    for (size_t k = 0; k < 6 && a->initial_stress == TALUS_INITIAL_GIVEN; k++) {
        const bool turns = (shears[mirror->axis] >> k & 1u) != 0;
        if (a->stress[k] != (turns ? -b->stress[k] : b->stress[k]))
            return false;
    }
    if (a->initial_stress == TALUS_INITIAL_HYDROSTATIC)
        return a->surface == b->surface || (isnan(a->surface) && isnan(b->surface));
    return a->initial_stress != TALUS_INITIAL_GEOSTATIC ||
           (a->k0_rule == b->k0_rule && a->surcharge == b->surcharge &&
            (a->k0_rule != TALUS_K0_GIVEN || a->k0 == b->k0));
}

bool scene_mirror_bodies(const struct scene_mirror *mirror, const struct talus_body *a,
                         const struct talus_body *b)
{
    return a->material_index == b->material_index && shapes_mirror(mirror, a, b) &&
           a->velocity_field == TALUS_VELOCITY_UNIFORM &&
           b->velocity_field == TALUS_VELOCITY_UNIFORM &&
           vectors_mirror(mirror, a->velocity, b->velocity) && stresses_mirror(mirror, a, b) &&
           tractions_mirror(mirror, a, b);
}

static bool conditions_mirror(const struct scene_mirror *mirror, const struct talus_boundary *a,
                              const struct talus_boundary *b)
{
    bool same = a->face_count == b->face_count;
    for (size_t face = 0; face < a->face_count && same; face++) {
        const bool turned = a->shape == TALUS_BOUNDARY_BOX && face / 2 == mirror->axis;
        const struct talus_boundary_face *one = &a->faces[face];
        const struct talus_boundary_face *other = &b->faces[turned ? face ^ 1u : face];
        same = one->condition_index == other->condition_index &&
               one->friction_coefficient == other->friction_coefficient &&
               one->adhesion == other->adhesion && one->turbulence == other->turbulence;
    }
    return same;
}

/* Velocities that are prescribed; tables only where nothing has to be turned. */
static bool motions_mirror(const struct scene_mirror *mirror, const struct talus_boundary *a,
                           const struct talus_boundary *b)
{
    bool tables = false;
    for (size_t k = 0; k < 3; k++)
        tables |= a->velocity_tables[k].count > 0 || b->velocity_tables[k].count > 0;
    return a->prescribed == b->prescribed && a->stays == b->stays &&
           vectors_mirror(mirror, a->velocity, b->velocity) &&
           (!tables || (a == b && a->velocity_tables[mirror->axis].count == 0));
}

/* Only a filter for what all bodies of one boundary share: without one, or over a body that is its
 * own image. */
static bool filters_mirror(const struct scene_mirror *mirror, const struct talus_boundary *a,
                           const struct talus_boundary *b)
{
    const struct talus_scene *scene = mirror->scene;
    if (a->body_index < 0 || b->body_index < 0)
        return a->body_index < 0 && b->body_index < 0;
    return scene_mirror_bodies(mirror, &scene->bodies[a->body_index],
                               &scene->bodies[b->body_index]);
}

static bool places_mirror(const struct scene_mirror *mirror, const struct talus_boundary *a,
                          const struct talus_boundary *b)
{
    double offset = 0.0;
    if (a->shape != b->shape)
        return false;
    if (a->shape == TALUS_BOUNDARY_BOX)
        return boxes_mirror(mirror, a->box_min, a->box_max, b->box_min, b->box_max);
    if (!vectors_mirror(mirror, a->normal, b->normal))
        return false;
    if (a->shape == TALUS_BOUNDARY_FACE) { /* flat on an axis only */
        bool same = points_mirror(mirror, a->point, b->point);
        double largest = 0.0;
        for (size_t k = 0; k < mirror->scene->axis_count; k++) {
            largest = fmax(largest, fabs(a->normal[k]));
            same = same && scene_near(scene_face_half(a, k), scene_face_half(b, k),
                                      mirror->scene->grid.cell[k]);
        }
        return same && largest > 1.0 - 1e-9;
    }
    for (size_t k = 0; k < mirror->scene->axis_count; k++) {
        const double image = k == mirror->axis ? 2.0 * mirror->centre - b->point[k] : b->point[k];
        offset += a->normal[k] * (image - a->point[k]);
    }
    return fabs(offset) <= 1e-9 * mirror->scene->grid.cell[mirror->axis];
}

bool scene_mirror_boundaries(const struct scene_mirror *mirror, const struct talus_boundary *a,
                             const struct talus_boundary *b)
{
    return a->wall == b->wall && a->tension_release == b->tension_release &&
           a->tension_force == b->tension_force && a->timed == b->timed && a->from == b->from &&
           a->until == b->until && places_mirror(mirror, a, b) && conditions_mirror(mirror, a, b) &&
           motions_mirror(mirror, a, b) && filters_mirror(mirror, a, b);
}
