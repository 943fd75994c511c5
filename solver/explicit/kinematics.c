/* SPDX-License-Identifier: Apache-2.0 */
/* Finite strain: the elastic left Cauchy-Green tensor is pushed forward, b_tr = f b f^T with
 * f = 1 + dt L (Mast 2013, eq. 3.26-3.37, with b^e), stored as e = (b - 1)/2, which keeps all
 * digits of small strains:  e_tr = f e f^T + sym(g) + g g^T / 2,  g = dt L. Materials see its
 * logarithm. Small strain: e += dt sym(L). Volumetric materials: ln J += ln det f. */
#include "explicit/kinematics.h"

#include "math/log1p_series.h"
#include "math/log_strain.h"
#include "math/sticky.h"

#include <assert.h>
#include <string.h>

/* det(1 + g) - 1 without cancellation. */
static inline double determinant_increment(const double g[9], size_t axis_count)
{
    if (axis_count == 1)
        return g[0];
    const double minor_z = g[0] * g[4] - g[1] * g[3];
    if (axis_count == 2)
        return g[0] + g[4] + minor_z;
    const double minor_x = g[4] * g[8] - g[5] * g[7];
    const double minor_y = g[0] * g[8] - g[2] * g[6];
    return g[0] + g[4] + g[8] + minor_x + minor_y + minor_z + g[0] * minor_x -
           g[1] * (g[3] * g[8] - g[5] * g[6]) + g[2] * (g[3] * g[7] - g[4] * g[6]);
}

/* det(1 + dt L) - 1 into increment[count]; axis_count is a constant where this is inlined. */
static inline void fill_determinants(size_t count, size_t axis_count, double *const gradient[9],
                                     double time_step, double *restrict increment)
{
    for (size_t i = 0; i < count; i++) {
        double g[9] = {0};
        for (size_t row = 0; row < axis_count; row++) {
            for (size_t column = 0; column < axis_count; column++)
                g[3 * row + column] = time_step * gradient[3 * row + column][i];
        }
        increment[i] = determinant_increment(g, axis_count);
    }
}

static void determinants(size_t count, size_t axis_count, double *const gradient[9],
                         double time_step, double *restrict increment)
{
    if (axis_count == 3)
        fill_determinants(count, 3, gradient, time_step, increment);
    else if (axis_count == 2)
        fill_determinants(count, 2, gradient, time_step, increment);
    else
        fill_determinants(count, 1, gradient, time_step, increment);
}

/* e_tr for three axes; tensors in the order xx yy zz xy yz xz. */
static void push_forward_3(size_t count, double *const L[9], double dt, double *const e[6],
                           double *const out[6])
{
    double *const *o = out;
    assert(e[0] != NULL && e[3] != NULL && e[4] != NULL && e[5] != NULL);
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        const double xx = dt * L[0][i], xy = dt * L[1][i], xz = dt * L[2][i];
        const double yx = dt * L[3][i], yy = dt * L[4][i], yz = dt * L[5][i];
        const double zx = dt * L[6][i], zy = dt * L[7][i], zz = dt * L[8][i];
        const double exx = e[0][i], eyy = e[1][i], ezz = e[2][i];
        const double exy = e[3][i], eyz = e[4][i], exz = e[5][i];
        /* a = (1 + g) e */
        const double axx = exx + xx * exx + xy * exy + xz * exz;
        const double axy = exy + xx * exy + xy * eyy + xz * eyz;
        const double axz = exz + xx * exz + xy * eyz + xz * ezz;
        const double ayx = exy + yx * exx + yy * exy + yz * exz;
        const double ayy = eyy + yx * exy + yy * eyy + yz * eyz;
        const double ayz = eyz + yx * exz + yy * eyz + yz * ezz;
        const double azx = exz + zx * exx + zy * exy + zz * exz;
        const double azy = eyz + zx * exy + zy * eyy + zz * eyz;
        const double azz = ezz + zx * exz + zy * eyz + zz * ezz;
        o[0][i] = axx + axx * xx + axy * xy + axz * xz + xx + 0.5 * (xx * xx + xy * xy + xz * xz);
        o[1][i] = ayy + ayx * yx + ayy * yy + ayz * yz + yy + 0.5 * (yx * yx + yy * yy + yz * yz);
        o[2][i] = azz + azx * zx + azy * zy + azz * zz + zz + 0.5 * (zx * zx + zy * zy + zz * zz);
        o[3][i] =
            axy + axx * yx + axy * yy + axz * yz + 0.5 * (xy + yx + xx * yx + xy * yy + xz * yz);
        o[4][i] =
            ayz + ayx * zx + ayy * zy + ayz * zz + 0.5 * (yz + zy + yx * zx + yy * zy + yz * zz);
        o[5][i] =
            axz + axx * zx + axy * zy + axz * zz + 0.5 * (xz + zx + xx * zx + xy * zy + xz * zz);
    }
}

static void push_forward_2(size_t count, double *const L[9], double dt, double *const e[6],
                           double *const out[6])
{
    assert(e[0] != NULL && e[1] != NULL && e[2] != NULL && e[3] != NULL);
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        const double xx = dt * L[0][i], xy = dt * L[1][i];
        const double yx = dt * L[3][i], yy = dt * L[4][i];
        const double exx = e[0][i], eyy = e[1][i], exy = e[3][i];
        const double axx = exx + xx * exx + xy * exy, axy = exy + xx * exy + xy * eyy;
        const double ayx = exy + yx * exx + yy * exy, ayy = eyy + yx * exy + yy * eyy;
        out[0][i] = axx + axx * xx + axy * xy + xx + 0.5 * (xx * xx + xy * xy);
        out[1][i] = ayy + ayx * yx + ayy * yy + yy + 0.5 * (yx * yx + yy * yy);
        out[2][i] = e[2][i];
        out[3][i] = axy + axx * yx + axy * yy + 0.5 * (xy + yx + xx * yx + xy * yy);
    }
}

static void push_forward_1(size_t count, double *const L[9], double dt, double *const e[6],
                           double *const out[6])
{
    assert(e[0] != NULL && e[1] != NULL && e[2] != NULL);
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        const double g = dt * L[0][i], f = 1.0 + g;
        out[0][i] = f * e[0][i] * f + g + 0.5 * g * g;
        out[1][i] = e[1][i];
        out[2][i] = e[2][i];
    }
}

static void symmetric_rate(size_t count, size_t axis_count, double *const L[9],
                           double *const rate[6])
{
    static const unsigned char row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    for (size_t component = 0; component < 6; component++) {
        if (row[component] >= axis_count || column[component] >= axis_count)
            continue; /* stays zero */
        const double *a = L[3 * row[component] + column[component]];
        const double *b = L[3 * column[component] + row[component]];
        double *restrict out = rate[component];
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            out[i] = 0.5 * (a[i] + b[i]);
    }
}

static void spin_rate(size_t count, size_t axis_count, double *const L[9], double *const spin[3])
{
    static const unsigned char row[3] = {0, 1, 0}, column[3] = {1, 2, 2};
    for (size_t component = 0; component < 3; component++) {
        if (column[component] >= axis_count)
            continue; /* stays zero */
        const double *a = L[3 * row[component] + column[component]];
        const double *b = L[3 * column[component] + row[component]];
        double *restrict out = spin[component];
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            out[i] = 0.5 * (a[i] - b[i]);
    }
}

/* Which material a slot belongs to. */
static const struct run_material *material_of(const struct run *run,
                                              const struct particle_block *block, size_t slot)
{
    const size_t body = block->body == NULL ? 0 : block->body[slot];
    return &run->materials[run->body_material[body]];
}

static void reference_volumes(const struct run *run, const struct particle_block *block,
                              struct block_scratch *scratch, size_t count)
{
    const double *mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0);
    memcpy(scratch->weight, mass, count * sizeof *mass);
    if (block->body == NULL) {
        const double inverse = 1.0 / material_of(run, block, 0)->density;
        for (size_t i = 0; i < count; i++)
            scratch->reference_volume[i] = mass[i] * inverse;
        return;
    }
    for (size_t i = 0; i < count; i++)
        scratch->reference_volume[i] = mass[i] / material_of(run, block, i)->density;
}

/* Updates volume, J and ln J; returns the smallest det f. */
static double advance_volume(struct run *run, struct particle_block *block,
                             struct block_scratch *scratch, size_t count, double time_step)
{
    double *increment = scratch->dissipation; /* free until the material runs */
    determinants(count, run->grid.domain.axis_count, scratch->gradient, time_step, increment);
    double *restrict volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    double least = 0;
    for (size_t i = 0; i < count; i++) {
        least = sticky_minimum(least, increment[i]);
        volume[i] = run->finite_strain ? volume[i] * (1.0 + increment[i]) : volume[i];
        const double v0 = scratch->reference_volume[i];
        scratch->volume_ratio[i] = run->finite_strain && v0 > 0 ? volume[i] / v0 : 1.0;
    }
    for (size_t i = 0; !(1.0 + least > 0) && i < count; i++) {
        if (!(1.0 + increment[i] > 0)) {
            scratch->bad_slot = i;
            break;
        }
    }
    return 1.0 + least;
}

/* strain[0] = stored[0] = ln J (small strain: trace) for the slots of volumetric materials. */
static void advance_volumetric(const struct run *run, const struct particle_block *block,
                               struct block_scratch *scratch, size_t count, double time_step)
{
    const double *old = particle_values(&run->grid.layout, block, PARTICLE_STRAIN, 0);
    double *increment = scratch->dissipation;
    if (run->finite_strain) {
        log1p_array(count, increment, increment);
    } else {
        for (size_t i = 0; i < count; i++)
            increment[i] =
                time_step * (scratch->rate[0][i] + scratch->rate[1][i] + scratch->rate[2][i]);
    }
    for (size_t i = 0; i < count; i++) {
        if (run->any_tensor && !material_of(run, block, i)->model->volumetric)
            continue;
        scratch->stored[0][i] = scratch->strain[0][i] = old[i] + increment[i];
        for (size_t component = 1; component < run->strain_components; component++)
            scratch->stored[component][i] = scratch->strain[component][i] = 0;
    }
}

static void advance_tensor(const struct run *run, const struct particle_block *block,
                           struct block_scratch *scratch, size_t count, double time_step)
{
    double *old[6] = {NULL};
    assert(run->stored_components <= 6 && run->strain_components == run->stored_components);
    for (uint32_t component = 0; component < run->stored_components; component++)
        old[component] = particle_values(&run->grid.layout, block, PARTICLE_STRAIN, component);
    if (!run->finite_strain) {
        for (size_t component = 0; component < run->strain_components; component++) {
            for (size_t i = 0; i < count; i++)
                scratch->stored[component][i] = scratch->strain[component][i] =
                    old[component][i] + time_step * scratch->rate[component][i];
        }
        return;
    }
    if (run->grid.domain.axis_count == 3)
        push_forward_3(count, scratch->gradient, time_step, old, scratch->stored);
    else if (run->grid.domain.axis_count == 2)
        push_forward_2(count, scratch->gradient, time_step, old, scratch->stored);
    else
        push_forward_1(count, scratch->gradient, time_step, old, scratch->stored);
    /* Slots without a positive definite b come out as NAN and are found by health. */
    (void)log_strain_batch(count, run->strain_components, scratch->stored, scratch->strain);
}

/* F - 1 <- g + (1 + g)(F - 1), row-major; only where it is stored. */
static void advance_tracked(const struct run *run, const struct particle_block *block,
                            const struct block_scratch *scratch, size_t count, double time_step)
{
    const struct particle_layout *layout = &run->grid.layout;
    const size_t axes = run->grid.domain.axis_count;
    for (size_t i = 0; layout->component_count[PARTICLE_GRADIENT] > 0 && i < count; i++) {
        double old[3][3], g[3][3];
        for (size_t row = 0; row < axes; row++) {
            for (size_t column = 0; column < axes; column++) {
                g[row][column] = time_step * scratch->gradient[3 * row + column][i];
                old[row][column] = particle_values(layout, block, PARTICLE_GRADIENT,
                                                   (uint32_t)(axes * row + column))[i];
            }
        }
        for (size_t row = 0; row < axes; row++) {
            for (size_t column = 0; column < axes; column++) {
                double sum = old[row][column] + g[row][column];
                for (size_t k = 0; k < axes; k++)
                    sum += g[row][k] * old[k][column];
                particle_values(layout, block, PARTICLE_GRADIENT,
                                (uint32_t)(axes * row + column))[i] = sum;
            }
        }
    }
    for (uint32_t component = 0; component < layout->component_count[PARTICLE_TOTAL_STRAIN];
         component++) {
        double *total = particle_values(layout, block, PARTICLE_TOTAL_STRAIN, component);
        for (size_t i = 0; i < count; i++)
            total[i] += time_step * scratch->rate[component][i];
    }
}

double kinematics_advance(struct run *run, struct particle_block *block,
                          struct block_scratch *scratch, double time_step)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    reference_volumes(run, block, scratch, count);
    symmetric_rate(count, run->grid.domain.axis_count, scratch->gradient, scratch->rate);
    if (run->any_spin && run->finite_strain)
        spin_rate(count, run->grid.domain.axis_count, scratch->gradient, scratch->spin);
    const double least = advance_volume(run, block, scratch, count, time_step);
    if (run->any_tensor)
        advance_tensor(run, block, scratch, count, time_step);
    if (run->any_volumetric)
        advance_volumetric(run, block, scratch, count, time_step);
    advance_tracked(run, block, scratch, count, time_step);
    for (size_t i = 0; i < count; i++)
        scratch->divergence[i] = scratch->rate[0][i] + scratch->rate[1][i] + scratch->rate[2][i];
    return least;
}

void kinematics_store(struct run *run, const struct particle_block *block,
                      struct block_scratch *scratch)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    bool changed = false;
    if (run->any_plastic) {
        for (size_t i = 0; i < count; i++)
            changed = changed || scratch->plastic_strain[i] > 0;
    }
    if (changed) {
        double *fresh[6];
        memcpy(fresh, scratch->gradient, sizeof fresh); /* free by now */
        if (run->finite_strain)
            exp_strain_batch(count, run->strain_components, scratch->strain, fresh);
        else
            memcpy(fresh, scratch->strain, sizeof fresh);
        for (size_t component = 0; component < run->strain_components; component++) {
            double *restrict stored = scratch->stored[component];
            const double *restrict value = fresh[component];
#pragma omp simd
            for (size_t i = 0; i < count; i++)
                stored[i] = scratch->plastic_strain[i] > 0 ? value[i] : stored[i];
        }
    }
    for (uint32_t component = 0; component < run->stored_components; component++)
        memcpy(particle_values(&run->grid.layout, block, PARTICLE_STRAIN, component),
               scratch->stored[component], count * sizeof(double));
}

void kinematics_load(const struct run *run, const struct particle_block *block,
                     struct block_scratch *scratch)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const double *volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    reference_volumes(run, block, scratch, count);
    double *stored[6] = {NULL};
    assert(run->stored_components >= 1 && run->stored_components <= 6);
    for (uint32_t component = 0; component < run->stored_components; component++) {
        stored[component] = particle_values(&run->grid.layout, block, PARTICLE_STRAIN, component);
        memcpy(scratch->strain[component], stored[component], count * sizeof(double));
    }
    if (run->any_tensor && run->finite_strain)
        (void)log_strain_batch(count, run->strain_components, stored, scratch->strain);
    for (size_t i = 0; i < count; i++) {
        const double v0 = scratch->reference_volume[i];
        scratch->volume_ratio[i] = run->finite_strain && v0 > 0 ? volume[i] / v0 : 1.0;
        if (run->any_tensor && run->any_volumetric && material_of(run, block, i)->model->volumetric)
            scratch->strain[0][i] = stored[0][i];
    }
}
