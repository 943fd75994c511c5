/* SPDX-License-Identifier: Apache-2.0 */
/* Loads on faces of bodies. The particles of the outermost layer share the area of the face at
 * t = 0; each gives its nodes N A t (Mast 2013, sec. B.2.9, which leaves open how the direction
 * follows the deformation: the three kinds of enum talus_traction_kind). */
#include "explicit/run.h"
#include "state/time_table.h"
#include "state/traction_layout.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* A traction at one time, and where its areas stand in a block. */
struct load {
    const struct talus_traction *traction;
    uint32_t first; /* component of PARTICLE_TRACTION */
    double value[3];
};

/* Deformation gradient of a slot; the identity beyond the axes, but for the stretch along zz where
 * bodies have one. */
static void gradient_of(const struct run *run, const struct particle_block *block, size_t slot,
                        double gradient[3][3])
{
    const struct particle_layout *layout = &run->grid.layout;
    const uint32_t axes = (uint32_t)run->grid.domain.axis_count;
    for (uint32_t row = 0; row < 3; row++) {
        for (uint32_t column = 0; column < 3; column++) {
            gradient[row][column] = row == column;
            if (row < axes && column < axes)
                gradient[row][column] += (double)particle_values(layout, block, PARTICLE_GRADIENT,
                                                                 row * axes + column)[slot];
        }
    }
    if (layout->component_count[PARTICLE_GRADIENT] > axes * axes)
        gradient[2][2] +=
            (double)particle_values(layout, block, PARTICLE_GRADIENT, axes * axes)[slot];
}

/* |n| F n / |F n|: a vector that goes along with its fibre and keeps its length. */
static void follow_fibre(const double gradient[3][3], double vector[3])
{
    double turned[3] = {0, 0, 0}, square = 0, turned_square = 0;
    for (size_t row = 0; row < 3; row++) {
        for (size_t column = 0; column < 3; column++)
            turned[row] += gradient[row][column] * vector[column];
        square += vector[row] * vector[row];
        turned_square += turned[row] * turned[row];
    }
    const double scale = turned_square > 0 ? sqrt(square / turned_square) : 0;
    for (size_t row = 0; row < 3; row++)
        vector[row] = scale * turned[row];
}

/* J F^-T a (Nanson): a times the cofactors of F. */
static void follow_surface(const double gradient[3][3], double area[3])
{
    double turned[3] = {0, 0, 0};
    for (size_t row = 0; row < 3; row++) {
        const double *a = gradient[(row + 1) % 3], *b = gradient[(row + 2) % 3];
        for (size_t column = 0; column < 3; column++) {
            const size_t next = (column + 1) % 3, last = (column + 2) % 3;
            turned[row] += (a[next] * b[last] - a[last] * b[next]) * area[column];
        }
    }
    memcpy(area, turned, sizeof turned);
}

/* The force [N] of a traction on one particle; false if it carries none of the face. */
static bool force_on(const struct run *run, const struct particle_block *block, size_t slot,
                     const struct load *load, double force[3])
{
    const struct talus_traction *traction = load->traction;
    const uint32_t axes = (uint32_t)run->grid.domain.axis_count;
    double area[3] = {0, 0, 0}, gradient[3][3];
    bool loaded = false;
    for (uint32_t axis = 0; axis < (traction->is_pressure ? axes : 1); axis++) {
        area[axis] = (double)particle_values(&run->grid.layout, block, PARTICLE_TRACTION,
                                             load->first + axis)[slot];
        loaded |= area[axis] != 0;
    }
    if (!loaded)
        return false;
    for (size_t axis = 0; axis < 3; axis++)
        force[axis] =
            traction->is_pressure ? -load->value[0] * area[axis] : area[0] * load->value[axis];
    if (traction->kind == TALUS_TRACTION_DEAD)
        return true;
    gradient_of(run, block, slot, gradient);
    if (traction->kind == TALUS_TRACTION_FIBRE)
        follow_fibre(gradient, force);
    else
        follow_surface(gradient, force);
    return true;
}

static void add_load(const struct run *run, const struct particle_block *block, size_t begin,
                     size_t end, size_t body, const struct load *load, real *const acceleration[3])
{
    const real *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
    const size_t axes = run->grid.domain.axis_count;
    assert(axes <= 3);
    for (size_t slot = begin; slot < end; slot++) {
        double force[3];
        if (!(mass[slot] > 0) || (block->body != NULL && block->body[slot] != body) ||
            !force_on(run, block, slot, load, force))
            continue;
        for (size_t axis = 0; axis < axes; axis++)
            acceleration[axis][slot] += (real)(force[axis] / (double)mass[slot]);
    }
}

/* True if a particle of the block carries a part of a loaded face. */
static bool is_loaded(const struct run *run, const struct particle_block *block, size_t begin,
                      size_t end)
{
    const uint32_t count = run->grid.layout.component_count[PARTICLE_TRACTION];
    for (uint32_t component = 0; component < count; component++) {
        const real *area = particle_values(&run->grid.layout, block, PARTICLE_TRACTION, component);
        for (size_t slot = begin; slot < end; slot++) {
            if (area[slot] != 0)
                return true;
        }
    }
    return false;
}

static void add_tractions(const void *source, const struct run *run,
                          const struct particle_block *block, size_t begin, size_t end, double time,
                          real *const acceleration[3])
{
    const struct talus_scene *scene = source;
    if (!is_loaded(run, block, begin, end))
        return;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        for (size_t entry = 0; entry < body->traction_count; entry++) {
            struct load load = {.traction = &body->tractions[entry],
                                .first = (uint32_t)traction_offset(scene, body, entry)};
            time_table_vector(load.traction->table, load.traction->value, time, load.value);
            add_load(run, block, begin, end, index, &load, acceleration);
        }
    }
}

void run_add_tractions(struct run *run)
{
    if (run->grid.layout.component_count[PARTICLE_TRACTION] > 0)
        run_add_force(run, (struct particle_force){add_tractions, &run->scene});
}
