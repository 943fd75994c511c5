/* SPDX-License-Identifier: Apache-2.0 */
#include "explicit/anti_locking_stage.h"

#include "antilocking/anti_locking.h"
#include "math/log1p_series.h"

#include <assert.h>

/* Normal components that are fitted: in plane stress zz follows from those in the plane. */
static size_t normal_count(const struct run *run)
{
    return run->scene.dimension == TALUS_PLANE_STRESS ? 2 : 3;
}

/* `normals` is a constant where these are inlined. */
TALUS_INLINE lanes trace_at(real *const tensor[6], size_t slot, size_t normals)
{
    const lanes plane = lanes_load(tensor[0] + slot) + lanes_load(tensor[1] + slot);
    return normals == 2 ? plane : plane + lanes_load(tensor[2] + slot);
}

/* Mean trace of each cell. */
TALUS_INLINE lanes mean_trace(size_t count, const real *weight, real *const tensor[6],
                              size_t normals)
{
    lanes total = {0}, sum = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes trace = trace_at(tensor, slot, normals);
        const lanes w = lanes_load(weight + slot);
        total += w;
        sum += w * trace;
    }
    return sum / lanes_select(total > 0, total, lanes_splat(1));
}

/* For each normal component, what brings the trace of a row to the mean; 0 where the slot takes no
 * part. */
TALUS_INLINE lanes shift_at(const real *weight, real *const tensor[6], size_t slot, lanes mean,
                            size_t normals)
{
    const real part = normals == 2 ? (real)0.5 : (real)(1.0 / 3.0);
    return lanes_keep(lanes_load(weight + slot) > 0,
                      part * (mean - trace_at(tensor, slot, normals)));
}

/* Brings the trace of the logarithmic strain to the mean of the cell, and the stored form with it:
 * b <- exp(2 shift) b, e <- e + s e + s/2; in plane stress the stored zz is never read.
 * `components` is a constant where this is inlined; stretch [count] is free. */
TALUS_INLINE void shift_finite(size_t count, size_t components, size_t normals, const real *weight,
                               real *const strain[6], real *const stored[6], real *stretch)
{
    const lanes mean = mean_trace(count, weight, strain, normals);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes shift = shift_at(weight, strain, slot, mean, normals);
        lanes_store(stretch + slot, 2 * shift);
        for (size_t component = 0; component < normals; component++)
            lanes_store(strain[component] + slot, lanes_load(strain[component] + slot) + shift);
    }
    expm1_array(count, stretch, stretch);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes s = lanes_load(stretch + slot);
        for (size_t component = 0; component < components; component++) {
            const lanes e = lanes_load(stored[component] + slot);
            const lanes half = lanes_splat(component < 3 ? (real)0.5 : 0);
            lanes_store(stored[component] + slot, e + s * (e + half));
        }
    }
}

TALUS_INLINE void shift_small(size_t count, size_t normals, const real *weight,
                              real *const strain[6], real *const stored[6])
{
    const lanes mean = mean_trace(count, weight, strain, normals);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes shift = shift_at(weight, strain, slot, mean, normals);
        for (size_t component = 0; component < normals; component++) {
            lanes_store(strain[component] + slot, lanes_load(strain[component] + slot) + shift);
            lanes_store(stored[component] + slot, lanes_load(stored[component] + slot) + shift);
        }
    }
}

static void shift_strain(const struct run *run, const struct particle_block *block,
                         struct block_scratch *scratch, size_t count, const real *weight)
{
    real *stored[6] = {NULL};
    assert(run->strain_components >= 3 && run->strain_components <= 6);
    for (uint32_t component = 0; component < run->strain_components; component++)
        stored[component] = particle_values(&run->grid.layout, block, PARTICLE_STRAIN, component);
    if (normal_count(run) == 2 && !run->finite_strain)
        shift_small(count, 2, weight, scratch->strain, stored);
    else if (normal_count(run) == 2)
        shift_finite(count, 4, 2, weight, scratch->strain, stored, scratch->mean);
    else if (!run->finite_strain)
        shift_small(count, 3, weight, scratch->strain, stored);
    else if (run->strain_components == 6)
        shift_finite(count, 6, 3, weight, scratch->strain, stored, scratch->mean);
    else if (run->strain_components == 4)
        shift_finite(count, 4, 3, weight, scratch->strain, stored, scratch->mean);
    else
        shift_finite(count, 3, 3, weight, scratch->strain, stored, scratch->mean);
}

/* Replaces the volumetric trial strain by its cell average: strain and stored form. */
static void average_trace(const struct run *run, const struct particle_block *block,
                          const struct anti_locking *fit, struct block_scratch *scratch)
{
    if (fit->model->volumetric)
        cell_average(fit->count, fit->weight, scratch->strain[0]);
    else
        shift_strain(run, block, scratch, fit->count, fit->weight);
}

/* The strain of volumetric materials is stored as it is. */
static void store_volumetric(const struct run *run, const struct particle_block *block,
                             const struct anti_locking *fit, const real *strain)
{
    real *stored = particle_values(&run->grid.layout, block, PARTICLE_STRAIN, 0);
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT)
        lanes_store(stored + slot,
                    lanes_select(lanes_load(fit->weight + slot) > 0, lanes_load(strain + slot),
                                 lanes_load(stored + slot)));
}

/* Replaces the mean stress by its cell average. */
TALUS_INLINE void average_stress(struct block_scratch *scratch, size_t count, size_t normals,
                                 const real *weight)
{
    const lanes mean = mean_trace(count, weight, scratch->stress, normals);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes shift = shift_at(weight, scratch->stress, slot, mean, normals);
        for (size_t component = 0; component < normals; component++)
            lanes_store(scratch->stress[component] + slot,
                        lanes_load(scratch->stress[component] + slot) + shift);
    }
}

static bool constant_trace(const struct run *run)
{
    return run->scene.solver.anti_locking_field == TALUS_FIT_FULL_CONSTANT_VOLUME;
}

void anti_locking_begin(const struct run *run, const struct particle_block *block,
                        const struct material *model, const real *weight, struct anti_locking *fit)
{
    const struct talus_solver_options *solver = &run->scene.solver;
    *fit = (struct anti_locking){.model = model,
                                 .weight = weight,
                                 .count = (size_t)block->row_count * LANE_COUNT,
                                 .whole = solver->anti_locking != TALUS_CONTROL_NONE &&
                                          solver->anti_locking_field != TALUS_FIT_VOLUMETRIC};
    if (!fit->whole)
        return;
    const real *position[3] = {NULL};
    const size_t axes = run->grid.domain.axis_count;
    assert(axes <= 3);
    for (uint32_t axis = 0; axis < axes; axis++)
        position[axis] = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis);
    cell_fit_init(&fit->cells, fit->count, axes, weight, position);
}

bool anti_locking_strain(const struct run *run, const struct particle_block *block,
                         const struct anti_locking *fit, struct block_scratch *scratch)
{
    if (run->scene.solver.anti_locking == TALUS_CONTROL_NONE)
        return false;
    if (!fit->whole)
        average_trace(run, block, fit, scratch);
    else if (!fit->model->volumetric)
        cell_fit_tensor(&fit->cells, run->strain_components, normal_count(run), constant_trace(run),
                        NULL, scratch->strain);
    else if (constant_trace(run))
        cell_average(fit->count, fit->weight, scratch->strain[0]);
    else
        cell_fit_scalar(&fit->cells, scratch->strain[0]);
    if (fit->model->volumetric)
        store_volumetric(run, block, fit, scratch->strain[0]);
    return fit->whole && !fit->model->volumetric;
}

void anti_locking_stress(const struct run *run, const struct anti_locking *fit,
                         struct block_scratch *scratch)
{
    const struct talus_solver_options *solver = &run->scene.solver;
    if (solver->anti_locking == TALUS_CONTROL_NONE ||
        solver->anti_locking_apply != TALUS_APPLY_STRAIN_AND_STRESS)
        return;
    if (fit->whole)
        cell_fit_tensor(&fit->cells, run->strain_components, normal_count(run), constant_trace(run),
                        NULL, scratch->stress);
    else if (normal_count(run) == 2)
        average_stress(scratch, fit->count, 2, fit->weight);
    else
        average_stress(scratch, fit->count, 3, fit->weight);
}
