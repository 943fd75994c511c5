/* SPDX-License-Identifier: Apache-2.0 */
#include "antilocking/cell_fit.h"

#include "base/inline.h"

#include <assert.h>

/* Lanes in which C - least x unit is positive definite: all pivots are positive. */
static lane_mask spread_enough(size_t axis_count, lanes C[3][3])
{
    const real least = (real)LINEAR_FIT_LEAST_SPREAD;
    const lanes first = C[0][0] - least;
    lane_mask enough = first > 0;
    if (axis_count == 1)
        return enough;
    const lanes factor = C[0][1] / first;
    const lanes second = C[1][1] - least - factor * C[0][1];
    enough &= second > 0;
    if (axis_count == 2)
        return enough;
    const lanes coupled = C[1][2] - factor * C[0][2];
    const lanes third = C[2][2] - least - C[0][2] * C[0][2] / first - coupled * coupled / second;
    return enough & (third > 0);
}

/* Cofactors of a symmetric matrix; returns its determinant. */
static lanes cofactors(size_t axis_count, lanes C[3][3], lanes out[3][3])
{
    if (axis_count == 1) {
        out[0][0] = lanes_splat(1);
        return C[0][0];
    }
    if (axis_count == 2) {
        out[0][0] = C[1][1];
        out[1][1] = C[0][0];
        out[0][1] = out[1][0] = -C[0][1];
        return C[0][0] * C[1][1] - C[0][1] * C[0][1];
    }
    for (size_t row = 0; row < 3; row++) {
        for (size_t column = 0; column < 3; column++) {
            const size_t a = (row + 1) % 3, b = (row + 2) % 3;
            const size_t c = (column + 1) % 3, d = (column + 2) % 3;
            out[row][column] = C[a][c] * C[b][d] - C[a][d] * C[b][c];
        }
    }
    return C[0][0] * out[0][0] + C[0][1] * out[0][1] + C[0][2] * out[0][2];
}

lane_mask fit_inverse(size_t axis_count, lanes C[3][3], lanes inverse[3][3])
{
    const lane_mask enough = spread_enough(axis_count, C);
    const lanes determinant = cofactors(axis_count, C, inverse);
    const lanes scale = lanes_keep(enough, 1 / determinant);
    assert(axis_count <= 3);
    for (size_t row = 0; row < axis_count; row++) {
        for (size_t column = 0; column < axis_count; column++)
            inverse[row][column] = lanes_keep(enough, scale * inverse[row][column]);
    }
    return ~enough;
}

static void sum_first_moments(struct cell_fit *fit)
{
    lanes mass = {0}, moment[3] = {{0}};
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT) {
        const lanes w = lanes_load(fit->weight + slot);
        mass += w;
        for (size_t axis = 0; axis < fit->axis_count; axis++)
            moment[axis] += w * lanes_load(fit->position[axis] + slot);
    }
    fit->inverse_mass = 1 / lanes_select(mass > 0, mass, lanes_splat(1));
    for (size_t axis = 0; axis < fit->axis_count; axis++)
        fit->centroid[axis] = moment[axis] * fit->inverse_mass;
    for (size_t lane = 0; lane < LANE_COUNT; lane++)
        fit->fall_backs += mass[lane] > 0;
}

TALUS_INLINE void load_offset(const struct cell_fit *fit, size_t axes, size_t slot, lanes offset[3])
{
    for (size_t axis = 0; axis < axes; axis++)
        offset[axis] = lanes_load(fit->position[axis] + slot) - fit->centroid[axis];
}

void cell_fit_init(struct cell_fit *fit, size_t count, size_t axis_count, const real *weight,
                   const real *const position[3])
{
    assert(axis_count >= 1 && axis_count <= 3);
    *fit = (struct cell_fit){.count = count, .axis_count = axis_count, .weight = weight};
    for (size_t axis = 0; axis < axis_count; axis++)
        fit->position[axis] = position[axis];
    sum_first_moments(fit);
    lanes C[3][3] = {{{0}}};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        lanes offset[3];
        load_offset(fit, axis_count, slot, offset);
        const lanes share = fit->inverse_mass * lanes_load(weight + slot);
        for (size_t row = 0; row < axis_count; row++) {
            for (size_t column = row; column < axis_count; column++)
                C[row][column] += share * offset[row] * offset[column];
        }
    }
    for (size_t row = 1; row < axis_count; row++) {
        for (size_t column = 0; column < row; column++)
            C[row][column] = C[column][row];
    }
    fit->singular = fit_inverse(axis_count, C, fit->inverse);
    for (size_t lane = 0; lane < LANE_COUNT; lane++)
        fit->fall_backs -= fit->singular[lane] == 0;
}

/* qbar + slope . (x - xbar) */
struct lane_line {
    lanes mean, slope[3];
};

TALUS_INLINE lanes line_at(const struct lane_line *line, size_t axes, const lanes offset[3])
{
    lanes value = line->mean;
    for (size_t axis = 0; axis < axes; axis++)
        value += line->slope[axis] * offset[axis];
    return value;
}

/* Lines through `arrays` components; axes and arrays are constants where this is inlined. */
TALUS_INLINE void fit_lines(const struct cell_fit *fit, size_t axes, size_t arrays,
                            real *const *values, struct lane_line *lines)
{
    lanes moment[3][3] = {{{0}}};
    for (size_t index = 0; index < arrays; index++)
        lines[index] = (struct lane_line){.mean = {0}};
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT) {
        lanes offset[3];
        load_offset(fit, axes, slot, offset);
        const lanes share = fit->inverse_mass * lanes_load(fit->weight + slot);
        for (size_t index = 0; index < arrays; index++) {
            const lanes q = share * lanes_load(values[index] + slot);
            lines[index].mean += q;
            for (size_t axis = 0; axis < axes; axis++)
                moment[index][axis] += q * offset[axis];
        }
    }
    for (size_t index = 0; index < arrays; index++) {
        for (size_t row = 0; row < axes; row++) {
            for (size_t axis = 0; axis < axes; axis++)
                lines[index].slope[row] += fit->inverse[row][axis] * moment[index][axis];
        }
    }
}

void cell_fit_scalar(const struct cell_fit *fit, real *values)
{
    struct lane_line line;
    fit_lines(fit, fit->axis_count, 1, &values, &line);
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT) {
        lanes offset[3];
        load_offset(fit, fit->axis_count, slot, offset);
        const lane_mask takes_part = lanes_load(fit->weight + slot) > 0;
        lanes_store(values + slot, lanes_select(takes_part, line_at(&line, fit->axis_count, offset),
                                                lanes_load(values + slot)));
    }
}

/* What the fit of a tensor does with its trace. */
struct trace_rule {
    lanes mean;        /* of the cells */
    lane_mask to_mean; /* lanes whose trace becomes the mean */
    const real *trace; /* [count] or NULL */
};

/* Normal components from their lines, then the trace. */
TALUS_INLINE void write_normals(const struct cell_fit *fit, size_t axes, size_t normals,
                                const struct lane_line lines[3], struct trace_rule rule,
                                real *const tensor[6])
{
    const real part = (real)1 / (real)normals;
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT) {
        lanes offset[3], old[3], fresh[3], sum = {0};
        load_offset(fit, axes, slot, offset);
        for (size_t index = 0; index < normals; index++) {
            old[index] = lanes_load(tensor[index] + slot);
            fresh[index] =
                lanes_select(fit->singular, old[index], line_at(&lines[index], axes, offset));
            sum += fresh[index];
        }
        lanes shift = lanes_keep(rule.to_mean, part * (rule.mean - sum));
        if (rule.trace != NULL)
            shift = part * (lanes_load(rule.trace + slot) - sum);
        const lane_mask takes_part = lanes_load(fit->weight + slot) > 0;
        for (size_t index = 0; index < normals; index++)
            lanes_store(tensor[index] + slot,
                        lanes_select(takes_part, fresh[index] + shift, old[index]));
    }
}

TALUS_INLINE void fit_normals(const struct cell_fit *fit, size_t axes, size_t normals,
                              bool constant_trace, const real *trace, real *const tensor[6])
{
    struct lane_line lines[3];
    struct trace_rule rule = {.trace = trace};
    fit_lines(fit, axes, normals, tensor, lines);
    for (size_t index = 0; index < normals; index++)
        rule.mean += lines[index].mean;
    rule.to_mean = constant_trace ? ~(lane_mask){0} : fit->singular;
    write_normals(fit, axes, normals, lines, rule, tensor);
}

/* Mean of a shear; as it is where C is singular. */
static void fit_shear(const struct cell_fit *fit, real *values)
{
    lanes mean = {0};
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT)
        mean += fit->inverse_mass * lanes_load(fit->weight + slot) * lanes_load(values + slot);
    for (size_t slot = 0; slot < fit->count; slot += LANE_COUNT) {
        const lane_mask fitted = (lanes_load(fit->weight + slot) > 0) & ~fit->singular;
        lanes_store(values + slot, lanes_select(fitted, mean, lanes_load(values + slot)));
    }
}

void cell_fit_tensor(const struct cell_fit *fit, size_t component_count, size_t normal_count,
                     bool constant_trace, const real *trace, real *const tensor[6])
{
    assert(normal_count == 3 || (normal_count == 2 && fit->axis_count == 2));
    if (fit->axis_count == 3)
        fit_normals(fit, 3, 3, constant_trace, trace, tensor);
    else if (fit->axis_count == 1)
        fit_normals(fit, 1, 3, constant_trace, trace, tensor);
    else if (normal_count == 3)
        fit_normals(fit, 2, 3, constant_trace, trace, tensor);
    else
        fit_normals(fit, 2, 2, constant_trace, trace, tensor);
    for (size_t component = 3; component < component_count; component++)
        fit_shear(fit, tensor[component]);
}
