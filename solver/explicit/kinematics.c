/* SPDX-License-Identifier: Apache-2.0 */
/* Finite strain: the elastic left Cauchy-Green tensor is pushed forward, b_tr = f b f^T with
 * f = 1 + g, g = dt L (Mast 2013, eq. 3.26-3.37, with b^e), stored as e = (b - 1)/2, which keeps
 * all digits of small strains:  e_tr = f e f^T + sym(g) + g g^T / 2. Materials see its logarithm.
 * Small strain: e += sym(g). Volumetric materials: ln J += ln det f. The trial strain replaces the
 * stored one at once; the material stage corrects it where particles yield.
 * Plane bodies that strain across their plane (out_of_plane.h) have their g_zz in gradient[8]. */
#include "explicit/kinematics.h"

#include "explicit/out_of_plane.h"
#include "math/log1p_series.h"
#include "math/log_strain.h"
#include "math/tensor.h"

#include <assert.h>
#include <string.h>

#ifdef __OPTIMIZE__
#define UNROLL _Pragma("GCC unroll 3")
#else
#define UNROLL
#endif

/* g of one row of slots; `axes` is a constant where this is inlined. */
TALUS_INLINE void load_increment(const struct block_scratch *scratch, size_t slot, size_t axes,
                                 lanes g[3][3])
{
    UNROLL for (size_t row = 0; row < axes; row++)
    {
        UNROLL for (size_t column = 0; column < axes; column++)
        {
            g[row][column] = lanes_load(scratch->gradient[3 * row + column] + slot);
        }
    }
}

/* det(1 + g) - 1 without cancellation. */
TALUS_INLINE lanes determinant_increment(size_t axes, lanes g[3][3])
{
    if (axes == 1)
        return g[0][0];
    const lanes minor_z = g[0][0] * g[1][1] - g[0][1] * g[1][0];
    if (axes == 2)
        return g[0][0] + g[1][1] + minor_z;
    const lanes minor_x = g[1][1] * g[2][2] - g[1][2] * g[2][1];
    const lanes minor_y = g[0][0] * g[2][2] - g[0][2] * g[2][0];
    return g[0][0] + g[1][1] + g[2][2] + minor_x + minor_y + minor_z + g[0][0] * minor_x -
           g[0][1] * (g[1][0] * g[2][2] - g[1][2] * g[2][0]) +
           g[0][2] * (g[1][0] * g[2][1] - g[1][1] * g[2][0]);
}

/* e <- f e f^T + sym(g) + g g^T / 2 for one row of slots, in place. */
TALUS_INLINE void push_forward(size_t axes, lanes g[3][3], real *const e[6], size_t slot)
{
    lanes old[3][3], half[3][3]; /* half = f e + g / 2 */
    UNROLL for (size_t row = 0; row < axes; row++)
    {
        UNROLL for (size_t column = 0; column < axes; column++)
        {
            old[row][column] = lanes_load(e[sym3_component[row][column]] + slot);
        }
    }
    UNROLL for (size_t row = 0; row < axes; row++)
    {
        UNROLL for (size_t column = 0; column < axes; column++)
        {
            half[row][column] = old[row][column] + (real)0.5 * g[row][column];
            UNROLL for (size_t k = 0; k < axes; k++)
            {
                half[row][column] += g[row][k] * old[k][column];
            }
        }
    }
    UNROLL for (size_t row = 0; row < axes; row++)
    {
        UNROLL for (size_t column = row; column < axes; column++)
        {
            lanes sum = half[row][column] + (real)0.5 * g[column][row];
            UNROLL for (size_t k = 0; k < axes; k++)
            {
                sum += half[row][k] * g[column][k];
            }
            lanes_store(e[sym3_component[row][column]] + slot, sum);
        }
    }
}

/* Tensors of the whole block, and det(1 + g) - 1. */
TALUS_INLINE void push_block(size_t count, size_t axes, const struct block_scratch *scratch,
                             real *const e[6])
{
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        lanes g[3][3];
        load_increment(scratch, slot, axes, g);
        lanes_store(scratch->volume_increment + slot, determinant_increment(axes, g));
        if (e != NULL)
            push_forward(axes, g, e, slot);
    }
}

/* What the strain across the plane adds: its own component, and a factor of the volume. */
static void push_across(size_t count, const struct block_scratch *scratch, real *e_zz)
{
    const real *across = scratch->gradient[GRADIENT_ZZ];
    real *increment = scratch->volume_increment;
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes g = lanes_load(across + slot);
        const lanes grown = lanes_load(increment + slot);
        lanes_store(increment + slot, grown + g + grown * g);
        if (e_zz != NULL) {
            const lanes old = lanes_load(e_zz + slot);
            lanes_store(e_zz + slot, old + (g + (real)0.5 * g * g) * (1 + 2 * old));
        }
    }
}

static void push(const struct run *run, size_t count, const struct block_scratch *scratch,
                 real *const e[6])
{
    if (run->grid.domain.axis_count == 3)
        push_block(count, 3, scratch, e);
    else if (run->grid.domain.axis_count == 2)
        push_block(count, 2, scratch, e);
    else
        push_block(count, 1, scratch, e);
    if (run->strains_across)
        push_across(count, scratch, e == NULL ? NULL : e[2]);
}

/* tensor += sym(g). */
static void add_symmetric(const struct run *run, const struct block_scratch *scratch, size_t count,
                          real *const tensor[6])
{
    const size_t axes = run->grid.domain.axis_count;
    assert(axes >= 1 && axes <= 3);
    for (size_t row = 0; row < axes; row++) {
        for (size_t column = row; column < axes; column++) {
            const real *a = scratch->gradient[3 * row + column];
            const real *b = scratch->gradient[3 * column + row];
            real *sum = tensor[sym3_component[row][column]];
            assert(sum != NULL);
            for (size_t slot = 0; slot < count; slot += LANE_COUNT)
                lanes_store(sum + slot,
                            lanes_load(sum + slot) +
                                (real)0.5 * (lanes_load(a + slot) + lanes_load(b + slot)));
        }
    }
    const real *across = scratch->gradient[GRADIENT_ZZ];
    for (size_t slot = 0; run->strains_across && slot < count; slot += LANE_COUNT)
        lanes_store(tensor[2] + slot, lanes_load(tensor[2] + slot) + lanes_load(across + slot));
}

/* Normal components of g, at 4 k in the gradient. */
static size_t normal_count(const struct run *run)
{
    return run->strains_across ? 3 : run->grid.domain.axis_count;
}

/* d = sym(g) / dt. */
static void symmetric_rate(size_t count, size_t axes, bool revolves,
                           const struct block_scratch *scratch, real inverse_step)
{
    assert(axes >= 1 && axes <= 3);
    for (size_t row = 0; row < axes; row++) {
        for (size_t column = row; column < axes; column++) {
            const real *a = scratch->gradient[3 * row + column];
            const real *b = scratch->gradient[3 * column + row];
            real *out = scratch->rate[sym3_component[row][column]];
            for (size_t slot = 0; slot < count; slot += LANE_COUNT)
                lanes_store(out + slot, (real)0.5 * inverse_step *
                                            (lanes_load(a + slot) + lanes_load(b + slot)));
        }
    }
    const real *across = scratch->gradient[GRADIENT_ZZ];
    for (size_t slot = 0; revolves && slot < count; slot += LANE_COUNT)
        lanes_store(scratch->rate[2] + slot, inverse_step * lanes_load(across + slot));
}

static void spin_rate(size_t count, size_t axes, const struct block_scratch *scratch,
                      real inverse_step)
{
    static const unsigned char rows[3] = {0, 1, 0}, columns[3] = {1, 2, 2};
    for (size_t component = 0; component < 3; component++) {
        if (columns[component] >= axes)
            continue; /* stays zero */
        const real *a = scratch->gradient[3 * rows[component] + columns[component]];
        const real *b = scratch->gradient[3 * columns[component] + rows[component]];
        real *out = scratch->spin[component];
        for (size_t slot = 0; slot < count; slot += LANE_COUNT)
            lanes_store(out + slot,
                        (real)0.5 * inverse_step * (lanes_load(a + slot) - lanes_load(b + slot)));
    }
}

static const struct run_material *material_of(const struct run *run,
                                              const struct particle_block *block, size_t slot)
{
    return &run->materials[material_of_slot(run, block, slot)];
}

static void reference_volumes(const struct run *run, const struct particle_block *block,
                              struct block_scratch *scratch, size_t count)
{
    const real *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
    if (block->body == NULL) {
        const real inverse = (real)(1.0 / material_of(run, block, 0)->density);
        for (size_t slot = 0; slot < count; slot += LANE_COUNT)
            lanes_store(scratch->reference_volume + slot, inverse * lanes_load(mass + slot));
        return;
    }
    for (size_t slot = 0; slot < count; slot++)
        scratch->reference_volume[slot] = mass[slot] / (real)material_of(run, block, slot)->density;
}

/* Updates volume and J; returns the smallest det f. */
static double advance_volume(const struct run *run, const struct particle_block *block,
                             struct block_scratch *scratch, size_t count)
{
    real *volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    const real *increment = scratch->volume_increment;
    lanes least = {0}, poison = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes grown = lanes_load(increment + slot);
        least = lanes_minimum(least, grown);
        poison += grown * 0; /* the minimum may drop what is not a number */
        if (run->finite_strain)
            lanes_store(volume + slot, lanes_load(volume + slot) * (1 + grown));
    }
    const double smallest = 1.0 - (double)lanes_largest(poison - least);
    for (size_t slot = 0; !(smallest > 0) && slot < count; slot++) {
        if (!(1 + increment[slot] > 0)) {
            scratch->bad_slot = slot;
            break;
        }
    }
    return smallest;
}

static void volume_ratios(const struct run *run, const struct particle_block *block,
                          struct block_scratch *scratch, size_t count)
{
    const real *volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    for (size_t slot = 0; slot < count; slot++) {
        const real initial = scratch->reference_volume[slot];
        scratch->volume_ratio[slot] =
            run->finite_strain && initial > 0 ? volume[slot] / initial : 1;
    }
}

static void strain_arrays(const struct run *run, const struct particle_block *block, real *e[6])
{
    for (uint32_t component = 0; component < 6; component++)
        e[component] = component < run->stored_components
                           ? particle_values(&run->grid.layout, block, PARTICLE_STRAIN, component)
                           : NULL;
}

/* strain[0] = stored[0] = ln J (small strain: trace). */
static void advance_volumetric(const struct run *run, const struct particle_block *block,
                               struct block_scratch *scratch, size_t count)
{
    real *stored = particle_values(&run->grid.layout, block, PARTICLE_STRAIN, 0);
    real *increment = scratch->volume_increment;
    if (run->finite_strain)
        log1p_array(count, increment, increment);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        lanes grown = {0};
        if (run->finite_strain) {
            grown = lanes_load(increment + slot);
        } else {
            for (size_t axis = 0; axis < normal_count(run); axis++)
                grown += lanes_load(scratch->gradient[4 * axis] + slot);
        }
        const lanes sum = lanes_load(stored + slot) + grown;
        lanes_store(stored + slot, sum);
        lanes_store(scratch->strain[0] + slot, sum);
    }
    for (size_t component = 1; component < run->strain_components; component++)
        memset(scratch->strain[component], 0, count * sizeof(real));
}

static void advance_tensor(const struct run *run, struct block_scratch *scratch, size_t count,
                           real *const e[6])
{
    if (run->finite_strain) {
        /* Slots without a positive definite b come out as NAN and are found by health. */
        (void)log_strain_batch(count, run->strain_components, e, scratch->strain);
        return;
    }
    add_symmetric(run, scratch, count, e);
    for (size_t component = 0; component < run->strain_components; component++)
        memcpy(scratch->strain[component], e[component], count * sizeof(real));
}

/* Solids and fluids in one scene: each slot keeps what its own kind makes of the increment. */
static void advance_mixed(const struct run *run, const struct particle_block *block,
                          struct block_scratch *scratch, size_t count, real *const e[6])
{
    real *logarithm = scratch->mean;
    memcpy(logarithm, e[0], count * sizeof(real));
    push(run, count, scratch, run->finite_strain ? e : NULL);
    advance_tensor(run, scratch, count, e);
    for (size_t slot = 0; slot < count; slot++) {
        if (!material_of(run, block, slot)->model->volumetric)
            continue;
        real grown = 0;
        for (size_t axis = 0; axis < normal_count(run); axis++)
            grown += scratch->gradient[4 * axis][slot];
        if (run->finite_strain)
            grown = (real)log1p((double)scratch->volume_increment[slot]);
        for (size_t component = 0; component < run->strain_components; component++)
            e[component][slot] = scratch->strain[component][slot] = 0;
        e[0][slot] = scratch->strain[0][slot] = logarithm[slot] + grown;
    }
}

/* F - 1 <- g + (1 + g)(F - 1), row-major; then what is across the plane. */
static void advance_gradient(const struct run *run, const struct particle_block *block,
                             const struct block_scratch *scratch, size_t count)
{
    const size_t axes = run->grid.domain.axis_count;
    assert(axes >= 1 && axes <= 3);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        lanes old[3][3], g[3][3];
        load_increment(scratch, slot, axes, g);
        for (uint32_t entry = 0; entry < axes * axes; entry++)
            old[entry / axes][entry % axes] = lanes_load(
                particle_values(&run->grid.layout, block, PARTICLE_GRADIENT, entry) + slot);
        for (uint32_t entry = 0; entry < axes * axes; entry++) {
            const size_t row = entry / axes, column = entry % axes;
            lanes sum = old[row][column] + g[row][column];
            for (size_t k = 0; k < axes; k++)
                sum += g[row][k] * old[k][column];
            lanes_store(particle_values(&run->grid.layout, block, PARTICLE_GRADIENT, entry) + slot,
                        sum);
        }
    }
    if (!run->strains_across)
        return;
    real *across = particle_values(&run->grid.layout, block, PARTICLE_GRADIENT, 4);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes g = lanes_load(scratch->gradient[GRADIENT_ZZ] + slot);
        const lanes old = lanes_load(across + slot);
        lanes_store(across + slot, old + g + g * old);
    }
}

static void advance_total_strain(const struct run *run, const struct particle_block *block,
                                 const struct block_scratch *scratch, size_t count)
{
    const struct particle_layout *layout = &run->grid.layout;
    real *total[6] = {NULL};
    for (uint32_t index = 0; index < layout->component_count[PARTICLE_TOTAL_STRAIN]; index++)
        total[index] = particle_values(layout, block, PARTICLE_TOTAL_STRAIN, index);
    add_symmetric(run, scratch, count, total);
}

/* Strains that are kept for output only. */
static void advance_tracked(const struct run *run, const struct particle_block *block,
                            const struct block_scratch *scratch, size_t count)
{
    const struct particle_layout *layout = &run->grid.layout;
    if (layout->component_count[PARTICLE_GRADIENT] > 0)
        advance_gradient(run, block, scratch, count);
    if (layout->component_count[PARTICLE_TOTAL_STRAIN] > 0)
        advance_total_strain(run, block, scratch, count);
}

void kinematics_rates(const struct run *run, struct block_scratch *scratch, size_t count,
                      double time_step)
{
    const size_t axes = run->grid.domain.axis_count;
    const real inverse_step = time_step > 0 ? (real)(1.0 / time_step) : 0;
    if (run->any_rate)
        symmetric_rate(count, axes, run->grid.domain.revolves, scratch, inverse_step);
    if (run->any_spin && run->finite_strain)
        spin_rate(count, axes, scratch, inverse_step);
}

double kinematics_advance(struct run *run, const struct particle_block *block,
                          struct block_scratch *scratch, double time_step)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    real *e[6];
    strain_arrays(run, block, e);
    if (!run->node_fit.active || run->any_rate) /* fits over nodes take them up again */
        reference_volumes(run, block, scratch, count);
    if (run->strains_across)
        out_of_plane_increment(run, block, scratch, count, time_step);
    advance_tracked(run, block, scratch, count);
    const bool mixed = run->any_tensor && run->any_volumetric;
    if (mixed) {
        advance_mixed(run, block, scratch, count, e);
    } else {
        push(run, count, scratch, run->any_tensor && run->finite_strain ? e : NULL);
        if (run->any_tensor)
            advance_tensor(run, scratch, count, e);
    }
    if (run->scene.dimension == TALUS_PLANE_STRESS)
        out_of_plane_strain(run, block, scratch, count);
    const double least = advance_volume(run, block, scratch, count);
    if (run->any_volumetric && !mixed)
        advance_volumetric(run, block, scratch, count);
    kinematics_rates(run, scratch, count, time_step);
    if (run->any_rate)
        volume_ratios(run, block, scratch, count);
    return least;
}

/* 1 in the slots whose strain goes back to its stored form. */
static const real *renewed(const struct run *run, const struct particle_block *block,
                           struct block_scratch *scratch, size_t count, bool all)
{
    if (!all)
        return scratch->plastic_strain;
    for (size_t slot = 0; slot < count; slot++)
        scratch->mean[slot] = !material_of(run, block, slot)->model->volumetric;
    return scratch->mean;
}

void kinematics_store(struct run *run, const struct particle_block *block,
                      struct block_scratch *scratch, bool all)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const real *marks = renewed(run, block, scratch, count, all);
    real *stored[6], *fresh[6];
    strain_arrays(run, block, stored);
    memcpy(fresh, run->finite_strain ? scratch->gradient : scratch->strain, sizeof fresh);
    if (run->finite_strain)
        exp_strain_batch(count, run->strain_components, scratch->strain, fresh);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lane_mask renew = lanes_load(marks + slot) > 0;
        for (size_t component = 0; component < run->stored_components; component++)
            lanes_store(stored[component] + slot,
                        lanes_select(renew, lanes_load(fresh[component] + slot),
                                     lanes_load(stored[component] + slot)));
    }
}

/* Stored form -> strain of the materials. */
static void reload(const struct run *run, const struct particle_block *block,
                   struct block_scratch *scratch)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    real *stored[6];
    reference_volumes(run, block, scratch, count);
    strain_arrays(run, block, stored);
    if (run->any_rate)
        volume_ratios(run, block, scratch, count);
    if (run->any_tensor && run->finite_strain)
        (void)log_strain_batch(count, run->strain_components, stored, scratch->strain);
    for (uint32_t component = 0;
         !(run->any_tensor && run->finite_strain) && component < run->stored_components;
         component++)
        memcpy(scratch->strain[component], stored[component], count * sizeof(real));
    for (size_t slot = 0; run->any_tensor && run->any_volumetric && slot < count; slot++) {
        if (material_of(run, block, slot)->model->volumetric)
            scratch->strain[0][slot] = stored[0][slot];
    }
    if (run->scene.dimension == TALUS_PLANE_STRESS)
        out_of_plane_strain(run, block, scratch, count);
}

bool kinematics_carries(const struct run *run)
{
    return run->node_fit.active && run->any_tensor && run->finite_strain;
}

void kinematics_recall(const struct run *run, const struct particle_block *block,
                       struct block_scratch *scratch)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    if (!kinematics_carries(run)) {
        reload(run, block, scratch);
        return;
    }
    reference_volumes(run, block, scratch, count);
    if (run->any_rate)
        volume_ratios(run, block, scratch, count);
    for (uint32_t component = 0; component < run->strain_components; component++)
        memcpy(scratch->strain[component],
               particle_values(&run->grid.layout, block, PARTICLE_STRESS, component),
               count * sizeof(real));
}

void kinematics_load(const struct run *run, const struct particle_block *block,
                     struct block_scratch *scratch)
{
    reload(run, block, scratch);
    volume_ratios(run, block, scratch, (size_t)block->row_count * LANE_COUNT);
}

void kinematics_volumes(const struct run *run, const struct particle_block *block,
                        struct block_scratch *scratch)
{
    reference_volumes(run, block, scratch, (size_t)block->row_count * LANE_COUNT);
}
