/* SPDX-License-Identifier: Apache-2.0 */
#include "explicit/anti_locking_stage.h"

#include "antilocking/anti_locking.h"
#include "explicit/kinematics.h"
#include "explicit/material_stage.h"
#include "math/log1p_series.h"

#include <assert.h>
#include <string.h>

TALUS_INLINE lanes trace_at(size_t normals, real *const tensor[6], size_t slot)
{
    const lanes sum = lanes_load(tensor[0] + slot) + lanes_load(tensor[1] + slot);
    return normals == 2 ? sum : sum + lanes_load(tensor[2] + slot);
}

/* Mean trace of each cell. */
TALUS_INLINE lanes mean_trace(size_t normals, size_t count, const real *weight,
                              real *const tensor[6])
{
    lanes total = {0}, sum = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes trace = trace_at(normals, tensor, slot);
        const lanes w = lanes_load(weight + slot);
        total += w;
        sum += w * trace;
    }
    return sum / lanes_select(total > 0, total, lanes_splat(1));
}

/* Share of each normal component in what brings the trace of a row to its target: that of the slot,
 * or the mean of the cell; 0 where the slot takes no part. */
TALUS_INLINE lanes shift_at(size_t normals, const real *weight, real *const tensor[6], size_t slot,
                            lanes mean, const real *target)
{
    const lanes wanted = target == NULL ? mean : lanes_load(target + slot);
    return lanes_keep(lanes_load(weight + slot) > 0,
                      (real)(1.0 / (double)normals) * (wanted - trace_at(normals, tensor, slot)));
}

/* Adds the shifts to the normal components; factor x shift into shifts[count] if that is given. */
TALUS_INLINE void shift_trace(size_t normals, size_t count, const real *weight,
                              real *const tensor[6], const real *target, real factor, real *shifts)
{
    lanes mean = {0};
    if (target == NULL)
        mean = mean_trace(normals, count, weight, tensor);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes shift = shift_at(normals, weight, tensor, slot, mean, target);
        if (shifts != NULL)
            lanes_store(shifts + slot, factor * shift);
        for (size_t component = 0; component < normals; component++)
            lanes_store(tensor[component] + slot, lanes_load(tensor[component] + slot) + shift);
    }
}

/* Brings the trace of the logarithmic strain to its target, and the stored form with it:
 * b <- exp(2 shift) b, e <- e + s e + s/2; with two normal components in their plane only.
 * `normals` and `components` are constants where this is inlined; stretch [count] is free. */
TALUS_INLINE void shift_finite(size_t normals, size_t count, size_t components, const real *weight,
                               real *const strain[6], real *const stored[6], const real *target,
                               real *stretch)
{
    shift_trace(normals, count, weight, strain, target, 2, stretch);
    expm1_array(count, stretch, stretch);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes s = lanes_load(stretch + slot);
        for (size_t component = 0; component < components; component++) {
            if (component == 2 && normals == 2)
                continue;
            const lanes e = lanes_load(stored[component] + slot);
            const lanes half = lanes_splat(component < 3 ? (real)0.5 : 0);
            lanes_store(stored[component] + slot, e + s * (e + half));
        }
    }
}

static void shift_small(size_t normals, size_t count, const real *weight, real *const strain[6],
                        real *const stored[6], const real *target, real *shifts)
{
    if (normals == 2)
        shift_trace(2, count, weight, strain, target, 1, shifts);
    else
        shift_trace(3, count, weight, strain, target, 1, shifts);
    assert(normals <= 3 && stored[0] != NULL && stored[1] != NULL && stored[2] != NULL);
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        for (size_t component = 0; component < normals; component++)
            lanes_store(stored[component] + slot,
                        lanes_load(stored[component] + slot) + lanes_load(shifts + slot));
    }
}

/* Brings the trace of the strains, and of their stored form, to the target, or the cell's mean. */
static void shift_strain(const struct run *run, const struct particle_block *block,
                         struct block_scratch *scratch, const struct anti_locking *fit,
                         const real *target)
{
    real *stored[6] = {NULL};
    real *const *strain = scratch->strain;
    const size_t count = fit->count;
    assert(run->strain_components >= 3 && run->strain_components <= 6);
    for (uint32_t component = 0; component < run->strain_components; component++)
        stored[component] = particle_values(&run->grid.layout, block, PARTICLE_STRAIN, component);
    if (!run->finite_strain)
        shift_small(run->normal_components, count, fit->weight, strain, stored, target,
                    scratch->mean);
    else if (run->strain_components == 6)
        shift_finite(3, count, 6, fit->weight, strain, stored, target, scratch->mean);
    else if (run->strain_components == 3)
        shift_finite(3, count, 3, fit->weight, strain, stored, target, scratch->mean);
    else if (run->normal_components == 3)
        shift_finite(3, count, 4, fit->weight, strain, stored, target, scratch->mean);
    else
        shift_finite(2, count, 4, fit->weight, strain, stored, target, scratch->mean);
}

/* values <- source where the slots take part. */
static void replace(const struct anti_locking *fit, const real *source, real *values)
{
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT)
        lanes_store(values + slot,
                    lanes_select(lanes_load(fit->weight + slot) > 0, lanes_load(source + slot),
                                 lanes_load(values + slot)));
}

static bool takes_nodes(const struct run *run)
{
    return run->node_fit.active;
}

static bool constant_trace(const struct run *run)
{
    return run->scene.solver.anti_locking_field == TALUS_FIT_FULL_CONSTANT_VOLUME;
}

static bool fits_stress(const struct run *run)
{
    return run->scene.solver.anti_locking != TALUS_CONTROL_NONE &&
           run->scene.solver.anti_locking_apply == TALUS_APPLY_STRAIN_AND_STRESS;
}

/* All components over cells; with `trace` given from the nodes. */
static void fit_over_cells(const struct run *run, const struct anti_locking *fit, const real *trace,
                           real *const tensor[6])
{
    cell_fit_tensor(&fit->cells, run->strain_components, run->normal_components,
                    constant_trace(run), trace, tensor);
}

/* All components from the nodes; zz stays in plane stress. */
static void take_components(const struct run *run, const struct anti_locking *fit,
                            real *const source[6], real *const tensor[6])
{
    for (size_t component = 0; component < run->strain_components; component++) {
        if (component < run->normal_components || component > 2)
            replace(fit, source[component], tensor[component]);
    }
}

void anti_locking_begin(const struct run *run, const struct particle_block *block, size_t material,
                        const real *weight, struct anti_locking *fit)
{
    const struct talus_solver_options *solver = &run->scene.solver;
    const bool cells =
        solver->anti_locking == TALUS_CONTROL_CELL || solver->anti_locking == TALUS_CONTROL_HYBRID;
    fit->model = run->materials[material].model;
    fit->material = material;
    fit->weight = weight;
    fit->count = (size_t)block->row_count * LANE_COUNT;
    fit->fits_cells = cells && solver->anti_locking_field != TALUS_FIT_VOLUMETRIC;
    fit->cells.fall_backs = 0; /* the rest is large, and cell_fit_init's */
    if (!fit->fits_cells)
        return;
    const real *position[3] = {NULL};
    const size_t axes = run->grid.domain.axis_count;
    assert(axes <= 3);
    for (uint32_t axis = 0; axis < axes; axis++)
        position[axis] = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis);
    cell_fit_init(&fit->cells, fit->count, axes, weight, position);
}

/* scratch->fit <- values from the nodes. */
static void gather(struct run *run, const struct particle_block *block,
                   const struct anti_locking *fit, enum node_fit_what what,
                   struct block_scratch *scratch)
{
    const struct shape_context context = run_shape_context(run, run->time_step);
    const struct node_fit_block at = {.context = &context, .kernels = run->kernels, .block = block};
    node_fit_gather(&run->node_fit, &at, fit->material, what, scratch->fit);
}

/* ln J of fluids: out of all that is fitted only the trace. */
static void fit_volumetric_strain(const struct run *run, const struct particle_block *block,
                                  const struct anti_locking *fit, struct block_scratch *scratch)
{
    real *strain = scratch->strain[0];
    if (takes_nodes(run)) {
        real *trace = scratch->fit[0];
        for (size_t slot = 0; !run->node_fit.trace_only && slot < fit->count; slot += LANE_COUNT)
            lanes_store(trace + slot, trace_at(run->normal_components, scratch->fit, slot));
        replace(fit, trace, strain);
    } else if (fit->fits_cells && !constant_trace(run)) {
        cell_fit_scalar(&fit->cells, strain);
    } else {
        cell_average(fit->count, fit->weight, strain);
    }
    replace(fit, strain, particle_values(&run->grid.layout, block, PARTICLE_STRAIN, 0));
}

bool anti_locking_strain(struct run *run, const struct particle_block *block,
                         const struct anti_locking *fit, struct block_scratch *scratch)
{
    const real *trace = NULL;
    if (run->scene.solver.anti_locking == TALUS_CONTROL_NONE)
        return false;
    if (takes_nodes(run)) {
        gather(run, block, fit, NODE_FIT_STRAIN, scratch);
        trace = scratch->fit[0];
    }
    if (fit->model->volumetric) {
        fit_volumetric_strain(run, block, fit, scratch);
        return false;
    }
    if (takes_nodes(run) && !run->node_fit.trace_only)
        take_components(run, fit, scratch->fit, scratch->strain);
    else if (fit->fits_cells)
        fit_over_cells(run, fit, trace, scratch->strain);
    else
        shift_strain(run, block, scratch, fit, trace);
    return fit->fits_cells || (takes_nodes(run) && !run->node_fit.trace_only);
}

/* Brings the trace of the stress to the target, or the cell's mean. */
static void shift_stress(const struct run *run, const struct anti_locking *fit, const real *target,
                         real *const stress[6])
{
    if (run->normal_components == 3)
        shift_trace(3, fit->count, fit->weight, stress, target, 1, NULL);
    else
        shift_trace(2, fit->count, fit->weight, stress, target, 1, NULL);
}

/* What is fitted over nodes of a tensor: its trace, or all of it. */
static real *const *quantities_of(const struct run *run, struct block_scratch *scratch,
                                  size_t count, real *const tensor[6])
{
    if (!run->node_fit.trace_only)
        return tensor;
    for (size_t slot = 0; slot < count; slot += LANE_COUNT)
        lanes_store(scratch->fit[0] + slot, trace_at(run->normal_components, tensor, slot));
    return scratch->fit;
}

static struct node_fit_block make_block(const struct run *run, const struct particle_block *block,
                                        const struct shape_context *context,
                                        struct block_scratch *scratch)
{
    struct node_fit_block at = {
        .context = context, .kernels = run->kernels, .block = block, .product = scratch->product};
    memcpy(at.coordinate, scratch->coordinate, sizeof at.coordinate);
    node_fit_locate(&run->node_fit, &at);
    return at;
}

void anti_locking_stress(struct run *run, const struct particle_block *block,
                         const struct anti_locking *fit, struct block_scratch *scratch)
{
    if (!fits_stress(run))
        return;
    if (takes_nodes(run)) {
        const struct shape_context context = run_shape_context(run, run->time_step);
        const struct node_fit_block at = make_block(run, block, &context, scratch);
        node_fit_scatter(&run->node_fit, &at, fit->material, NODE_FIT_STRESS, fit->weight,
                         quantities_of(run, scratch, fit->count, scratch->stress));
    } else if (fit->fits_cells) {
        fit_over_cells(run, fit, NULL, scratch->stress);
    } else {
        shift_stress(run, fit, NULL, scratch->stress);
    }
}

void anti_locking_gather_stress(struct run *run, const struct particle_block *block,
                                struct block_scratch *scratch)
{
    const uint64_t present = scratch->materials;
    for (size_t material = 0; material < run->scene.material_count; material++) {
        if ((present >> material & 1) == 0)
            continue;
        struct anti_locking fit;
        anti_locking_begin(run, block, material,
                           material_stage_weights(run, block, scratch, material, present), &fit);
        gather(run, block, &fit, NODE_FIT_STRESS, scratch);
        if (!run->node_fit.trace_only)
            take_components(run, &fit, scratch->fit, scratch->stress);
        else if (fit.fits_cells)
            fit_over_cells(run, &fit, scratch->fit[0], scratch->stress);
        else
            shift_stress(run, &fit, scratch->fit[0], scratch->stress);
    }
}

static void sum_rates(const struct block_scratch *scratch, size_t count, real *divergence)
{
    for (size_t slot = 0; slot < count; slot++)
        divergence[slot] = scratch->rate[0][slot] + scratch->rate[1][slot] + scratch->rate[2][slot];
}

void anti_locking_scatter_strain(struct run *run, const struct particle_block *block,
                                 struct block_scratch *scratch, bool still)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const uint64_t present = material_stage_present(run, block);
    const struct shape_context context = run_shape_context(run, run->time_step);
    const struct node_fit_block at = make_block(run, block, &context, scratch);
    real *const *quantities = quantities_of(run, scratch, count, scratch->strain);
    for (size_t material = 0; material < run->scene.material_count; material++) {
        if ((present >> material & 1) == 0)
            continue;
        const real *weight = material_stage_weights(run, block, scratch, material, present);
        node_fit_scatter_masses(&run->node_fit, &at, material, weight, !still);
        node_fit_scatter(&run->node_fit, &at, material, NODE_FIT_STRAIN, weight, quantities);
    }
    if (!run->node_fit.wants_divergence)
        return;
    sum_rates(scratch, count, scratch->mean);
    node_fit_scatter_divergence(&run->node_fit, &at,
                                particle_values(&run->grid.layout, block, PARTICLE_MASS, 0),
                                scratch->mean);
}

void anti_locking_divergence(struct run *run, const struct particle_block *block,
                             struct block_scratch *scratch, real *divergence)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    if (takes_nodes(run)) {
        const struct shape_context context = run_shape_context(run, run->time_step);
        const struct node_fit_block at = {
            .context = &context, .kernels = run->kernels, .block = block};
        node_fit_gather_divergence(&run->node_fit, &at, divergence);
        return;
    }
    sum_rates(scratch, count, divergence);
    if (run->scene.solver.anti_locking == TALUS_CONTROL_CELL)
        cell_average(count, particle_values(&run->grid.layout, block, PARTICLE_MASS, 0),
                     divergence);
}
