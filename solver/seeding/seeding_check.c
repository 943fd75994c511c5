/* SPDX-License-Identifier: Apache-2.0 */
/* Questions about bodies that are answered without a single particle. */
#include "seeding/seeding.h"
#include "seeding/seeding_lattice.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static const double count_limit = 9007199254740992.0; /* 2^53: whole numbers up to here are exact */

static uint64_t saturate(double count)
{
    return count < count_limit ? (uint64_t)count : UINT64_MAX;
}

static uint64_t add_saturated(uint64_t a, uint64_t b)
{
    return a > UINT64_MAX - b ? UINT64_MAX : a + b;
}

/* Lattice rows that may be counted out per body: a fraction of a second for all bodies. */
static double row_limit(const struct talus_scene *scene)
{
    return fmax(1024.0, 1048576.0 / (double)scene->body_count);
}

static uint64_t count_particles(const struct talus_scene *scene,
                                const struct seeding_lattice *lattice)
{
    double points = seeding_lattice_point_count(lattice);
    if (seeding_shape_is_empty(&lattice->shape))
        return 0;
    if (!seeding_lattice_selects(lattice) || points > count_limit)
        return saturate(points);
    if (lattice->count[1] * lattice->count[2] <= row_limit(scene) / 16.0)
        return seeding_lattice_kept(lattice);
    double cell = 1.0;
    for (size_t k = 0; k < lattice->shape.axis_count; k++)
        cell *= lattice->spacing[k];
    return saturate(fmin(points, round(seeding_shape_measure(&lattice->shape) / cell)));
}

static uint64_t count_cells(const struct talus_scene *scene, const struct seeding_shape *shape)
{
    /* A body that ends on a grid line does not touch the cell behind it. */
    const double slack = 1e-9;
    double cells = 1.0, low[3], high[3];
    if (seeding_shape_is_empty(shape))
        return 0;
    seeding_shape_bounds(shape, low, high);
    for (size_t k = 0; k < shape->axis_count; k++) {
        const struct talus_grid *grid = &scene->grid;
        double begin = floor((low[k] - grid->min[k]) / grid->cell[k] + slack);
        double end = ceil((high[k] - grid->min[k]) / grid->cell[k] - slack);
        begin = fmax(begin, 0.0);
        end = fmin(end, (double)grid->cell_count[k]);
        cells *= fmax(0.0, end - begin);
    }
    if (shape->body->shape == TALUS_BODY_POINTS)
        cells = fmin(cells, (double)shape->body->point_count);
    return saturate(cells);
}

void seeding_count(const struct talus_scene *scene, uint64_t *particle_count, uint64_t *cell_count)
{
    *particle_count = *cell_count = 0;
    for (size_t index = 0; index < scene->body_count; index++) {
        struct seeding_lattice lattice;
        seeding_lattice_init(&lattice, scene, &scene->bodies[index]);
        *particle_count = add_saturated(*particle_count, count_particles(scene, &lattice));
        *cell_count = add_saturated(*cell_count, count_cells(scene, &lattice.shape));
    }
}

void seeding_report(const struct talus_scene *scene, size_t body_index,
                    struct seeding_report *report)
{
    struct seeding_lattice lattice;
    seeding_lattice_init(&lattice, scene, &scene->bodies[body_index]);
    report->particle_count = count_particles(scene, &lattice);
    report->volume = seeding_shape_volume(&lattice.shape);
    report->volume_factor =
        report->particle_count > 0 ? seeding_lattice_factor(&lattice, report->particle_count) : 1.0;
}

double seeding_body_volume(const struct talus_scene *scene, const struct talus_body *body)
{
    struct seeding_shape shape;
    seeding_shape_init(&shape, scene, body);
    return seeding_shape_volume(&shape);
}

static enum talus_status check_inside_grid(const struct talus_scene *scene, size_t body_index,
                                           const struct seeding_shape *shape,
                                           struct talus_error *error)
{
    const struct talus_grid *grid = &scene->grid;
    double low[3], high[3];
    seeding_shape_bounds(shape, low, high);
    for (size_t k = 0; k < shape->axis_count; k++) {
        double slack = 1e-9 * grid->cell[k];
        double end = grid->min[k] + (double)grid->cell_count[k] * grid->cell[k];
        if (low[k] >= grid->min[k] - slack && high[k] <= end + slack)
            continue;
        char pointer[64];
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu", body_index);
        return talus_error_set(
            error, TALUS_INVALID, "outside", pointer,
            "body '%s' reaches from %g to %g m on the %c axis, but the grid from %g to %g m",
            shape->body->name, low[k], high[k], "xyz"[k], grid -> min[k], end);
    }
    return TALUS_OK;
}

/* Particles of a row of the lattice that lie in the box; all of them are added to *count. */
static uint64_t row_in_box(const struct seeding_lattice *lattice, const struct talus_boundary *box,
                           uint64_t index[3], uint64_t *count)
{
    struct seeding_row row;
    uint64_t inside = 0;
    seeding_lattice_row(lattice, index, &row);
    for (size_t range = 0; range < row.count; range++) {
        for (index[0] = row.first[range]; index[0] < row.end[range]; index[0]++) {
            double place[3];
            bool within = true;
            seeding_lattice_world(lattice, index, place);
            for (size_t k = 0; k < lattice->shape.axis_count; k++)
                within &= place[k] > box->box_min[k] && place[k] < box->box_max[k];
            inside += within;
        }
        *count += row.end[range] - row.first[range];
    }
    return inside;
}

/* Share of the particles that lie in the box: of bodies whose volume in it has no simple form. */
static double share_of_particles(const struct talus_scene *scene, size_t body_index,
                                 const struct talus_boundary *box)
{
    struct seeding_lattice lattice;
    uint64_t index[3], inside = 0, count = 0;
    seeding_lattice_init(&lattice, scene, &scene->bodies[body_index]);
    if (seeding_lattice_point_count(&lattice) > 16.0 * row_limit(scene))
        return 0.0;
    for (index[2] = 0; index[2] < (uint64_t)lattice.count[2]; index[2]++) {
        for (index[1] = 0; index[1] < (uint64_t)lattice.count[1]; index[1]++)
            inside += row_in_box(&lattice, box, index, &count);
    }
    return count > 0 ? (double)inside / (double)count : 0.0;
}

static double share_in_box(const struct talus_scene *scene, size_t body_index,
                           const struct seeding_shape *shape, const struct talus_boundary *box)
{
    if (shape->turned || shape->body->shape == TALUS_BODY_POINTS)
        return share_of_particles(scene, body_index, box);
    struct seeding_shape common = *shape;
    seeding_shape_cut(&common, box->box_min, box->box_max);
    return seeding_shape_volume(&common) / seeding_shape_volume(shape);
}

/* Material inside an obstacle. */
static enum talus_status check_obstacles(const struct talus_scene *scene, size_t body_index,
                                         const struct seeding_shape *shape,
                                         struct talus_error *error)
{
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        const bool later = boundary->timed && boundary->from > 0.0;
        if (boundary->shape != TALUS_BOUNDARY_BOX || later ||
            (boundary->body_index >= 0 && (size_t)boundary->body_index != body_index))
            continue;
        const double share = share_in_box(scene, body_index, shape, boundary);
        if (!(share > 1e-9))
            continue;
        char pointer[64];
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu", body_index);
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "body '%s' has %.3g %% of its volume inside the obstacle '%s'",
                               shape->body->name, 100.0 * share, boundary->name);
    }
    return TALUS_OK;
}

static enum talus_status check_lattice(const struct talus_scene *scene, size_t body_index,
                                       struct talus_error *error)
{
    const struct talus_body *body = &scene->bodies[body_index];
    struct seeding_lattice lattice;
    char pointer[64];
    (void)snprintf(pointer, sizeof pointer, "/bodies/%zu", body_index);
    seeding_lattice_init(&lattice, scene, body);
    double points = seeding_lattice_point_count(&lattice);
    if (!(points <= SEEDING_PARTICLE_MAX))
        return talus_error_set(error, TALUS_INVALID, "limit", pointer,
                               "body '%s' asks for about %.3g particles; %d are allowed",
                               body->name, points, SEEDING_PARTICLE_MAX);
    if (!seeding_lattice_selects(&lattice) ||
        lattice.count[1] * lattice.count[2] > row_limit(scene))
        return TALUS_OK;
    uint64_t kept = seeding_lattice_kept(&lattice);
    if (kept == 0)
        return talus_error_set(error, TALUS_INVALID, "empty", pointer,
                               "no lattice point lies inside body '%s': use more particles",
                               body->name);
    double factor = seeding_lattice_factor(&lattice, kept);
    if (factor < 0.9 || factor > 1.1)
        return talus_error_set(error, TALUS_INVALID, "volume_factor", pointer,
                               "the %llu particles of body '%s' stand for 1/%.3f of its volume "
                               "(0.9 to 1.1 is allowed): use more particles",
                               (unsigned long long)kept, body->name, factor);
    return TALUS_OK;
}

enum talus_status seeding_check(const struct talus_scene *scene, size_t body_index,
                                struct talus_error *error)
{
    struct seeding_shape shape;
    seeding_shape_init(&shape, scene, &scene->bodies[body_index]);
    if (seeding_shape_is_empty(&shape)) {
        char pointer[64];
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu", body_index);
        return talus_error_set(error, TALUS_INVALID, "empty", pointer,
                               "nothing is left of body '%s'", scene->bodies[body_index].name);
    }
    enum talus_status status = check_inside_grid(scene, body_index, &shape, error);
    if (status == TALUS_OK)
        status = check_obstacles(scene, body_index, &shape, error);
    if (status == TALUS_OK)
        status = check_lattice(scene, body_index, error);
    return status;
}
