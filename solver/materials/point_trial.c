/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/point_trial.h"

#include "math/log_strain.h"

#include <stdlib.h>
#include <string.h>

static const struct mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

enum talus_status point_init(struct point *point, const struct material *material,
                             const double *values, bool finite_strain,
                             const double stress[SYM3_COMPONENTS], struct talus_error *error)
{
    size_t state_count = material->state_count;
    memset(point, 0, sizeof *point);
    point->material = material;
    point->finite_strain = finite_strain;
    point->constants = calloc(1, material->constants_size);
    point->state.history = calloc(state_count + 1, sizeof *point->state.history);
    point->trial.history_values =
        calloc((state_count + 1) * POINT_LANES, sizeof *point->trial.history_values);
    point->trial.history = calloc(state_count + 1, sizeof *point->trial.history);
    if (point->constants == NULL || point->state.history == NULL ||
        point->trial.history_values == NULL || point->trial.history == NULL) {
        point_release(point);
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "no memory for a point");
    }
    for (size_t state = 0; state < state_count; state++)
        point->trial.history[state] = &point->trial.history_values[state * POINT_LANES];
    material->prepare(values, point->constants);
    material->strain_from_stress(point->constants, stress, point->state.elastic);
    if (material->initialise != NULL)
        material->initialise(point->constants, point->state.elastic, point->state.history);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        double pressure = component < 3 ? (stress[0] + stress[1] + stress[2]) / 3.0 : 0.0;
        point->state.stress[component] = material->volumetric ? pressure : stress[component];
    }
    point->state.gradient = identity;
    point->state.volume_ratio = 1.0;
    return TALUS_OK;
}

void point_release(struct point *point)
{
    free(point->constants);
    free(point->state.history);
    free(point->trial.history_values);
    free(point->trial.history);
    memset(point, 0, sizeof *point);
}

/* The six arrays of a tensor over the lanes. */
static void point_arrays(real values[SYM3_COMPONENTS][POINT_LANES], real *arrays[SYM3_COMPONENTS])
{
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        arrays[component] = values[component];
}

static struct sym3 lane_tensor(real values[SYM3_COMPONENTS][POINT_LANES], int lane)
{
    return (struct sym3){values[0][lane], values[1][lane], values[2][lane],
                         values[3][lane], values[4][lane], values[5][lane]};
}

static struct sym3 sym3_from(const double a[SYM3_COMPONENTS])
{
    return (struct sym3){(real)a[0], (real)a[1], (real)a[2], (real)a[3], (real)a[4], (real)a[5]};
}

static void lane_set(real values[SYM3_COMPONENTS][POINT_LANES], int lane, struct sym3 tensor)
{
    const real components[SYM3_COMPONENTS] = {tensor.xx, tensor.yy, tensor.zz,
                                              tensor.xy, tensor.yz, tensor.xz};
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        values[component][lane] = components[component];
}

void point_trial_stretch(struct point *point)
{
    struct point_trial *trial = &point->trial;
    real stretch[SYM3_COMPONENTS][POINT_LANES];
    real *arrays[SYM3_COMPONENTS];
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        for (int lane = 0; lane < POINT_LANES; lane++)
            stretch[component][lane] = (real)(0.5 * trial->strain[component][lane]);
    }
    point_arrays(stretch, arrays);
    exp_strain_batch(POINT_LANES, SYM3_COMPONENTS, arrays, arrays);
    for (int lane = 0; lane < POINT_LANES; lane++) {
        struct sym3 half = lane_tensor(stretch, lane); /* (exp(increment) - 1)/2 */
        trial->step[lane] = mat3_from_sym3(sym3_add_diagonal(sym3_scale(2.0, half), 1.0));
    }
}

/* Trial Hencky strain: e <- f e f^T + (f f^T - 1)/2 between exponential and logarithm. */
static bool trial_elastic_finite(struct point *point)
{
    struct point_trial *trial = &point->trial;
    const double *kept = point->state.elastic;
    real *arrays[SYM3_COMPONENTS];
    struct sym3 hencky = sym3_from(kept);
    point_arrays(trial->elastic, arrays);
    for (int lane = 0; lane < POINT_LANES; lane++)
        lane_set(trial->elastic, lane, hencky);
    exp_strain_batch(POINT_LANES, SYM3_COMPONENTS, arrays, arrays);
    for (int lane = 0; lane < POINT_LANES; lane++) {
        const struct sym3 one = {1, 1, 1, 0, 0, 0};
        struct sym3 pushed =
            sym3_push_forward(trial->step[lane], lane_tensor(trial->elastic, lane));
        struct sym3 square = sym3_push_forward(trial->step[lane], one);
        pushed = sym3_add_scaled(pushed, 0.5, sym3_add_scaled(square, -1.0, one));
        lane_set(trial->elastic, lane, pushed);
    }
    return log_strain_batch(POINT_LANES, SYM3_COMPONENTS, arrays, arrays) == 0;
}

/* Rotation part of f as the spin whose Cayley transform it is, over a step of `time_step`. */
static void trial_spin(struct point_trial *trial, double time_step)
{
    real square[SYM3_COMPONENTS][POINT_LANES];
    real *arrays[SYM3_COMPONENTS];
    const struct sym3 one = {1, 1, 1, 0, 0, 0};
    point_arrays(square, arrays);
    for (int lane = 0; lane < POINT_LANES; lane++)
        lane_set(square, lane, sym3_push_forward(trial->step[lane], one));
    for (int lane = 0; lane < POINT_LANES; lane++) {
        struct sym3 half = sym3_scale(0.5, sym3_add_scaled(lane_tensor(square, lane), -1.0, one));
        lane_set(square, lane, half);
    }
    /* f f^T = V^2: V^-1 = exp(-1/2 ln(f f^T)) */
    (void)log_strain_batch(POINT_LANES, SYM3_COMPONENTS, arrays, arrays);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        for (int lane = 0; lane < POINT_LANES; lane++)
            square[component][lane] *= -0.5;
    }
    exp_strain_batch(POINT_LANES, SYM3_COMPONENTS, arrays, arrays);
    for (int lane = 0; lane < POINT_LANES; lane++) {
        struct sym3 inverse = sym3_add_diagonal(sym3_scale(2.0, lane_tensor(square, lane)), 1.0);
        struct mat3 turn = mat3_multiply(mat3_from_sym3(inverse), trial->step[lane]);
        real scale = 2 / ((1 + turn.m[0][0] + turn.m[1][1] + turn.m[2][2]) * (real)time_step);
        trial->spin[0][lane] = scale * (turn.m[0][1] - turn.m[1][0]);
        trial->spin[1][lane] = scale * (turn.m[1][2] - turn.m[2][1]);
        trial->spin[2][lane] = scale * (turn.m[0][2] - turn.m[2][0]);
    }
}

/* Everything that the model reads. */
static bool trial_prepare(struct point *point, double time_step)
{
    struct point_trial *trial = &point->trial;
    bool valid = true;
    for (int lane = 0; lane < POINT_LANES; lane++) {
        for (int component = 0; component < SYM3_COMPONENTS; component++) {
            trial->elastic[component][lane] =
                (real)(point->state.elastic[component] + trial->strain[component][lane]);
            trial->rate[component][lane] = (real)(trial->strain[component][lane] / time_step);
        }
        for (size_t state = 0; state < point->material->state_count; state++)
            trial->history[state][lane] = (real)point->state.history[state];
        trial->volume_ratio[lane] = 1.0;
    }
    if (point->finite_strain) {
        for (int lane = 0; lane < POINT_LANES; lane++)
            trial->volume_ratio[lane] =
                (real)point->state.volume_ratio * mat3_determinant(trial->step[lane]);
        valid = point->material->volumetric || trial_elastic_finite(point);
        if (point->material->needs_spin != NULL && point->material->needs_spin(point->constants))
            trial_spin(trial, time_step);
    }
    for (int lane = 0; point->material->volumetric && lane < POINT_LANES; lane++)
        trial->elastic[0][lane] = (real)(point->state.elastic[0] + trial->strain[0][lane] +
                                         trial->strain[1][lane] + trial->strain[2][lane]);
    return valid;
}

bool point_trial_run(struct point *point, double time_step)
{
    struct point_trial *trial = &point->trial;
    struct material_batch batch = {
        .count = POINT_LANES,
        .component_count = SYM3_COMPONENTS,
        .time_step = time_step,
        .volume_ratio = trial->volume_ratio,
        .history = trial->history,
        .plastic_strain = trial->plastic_strain,
        .dissipation = trial->dissipation,
    };
    bool valid = trial_prepare(point, time_step);
    point_arrays(trial->elastic, batch.strain);
    point_arrays(trial->stress, batch.stress);
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        batch.rate[component] = trial->rate[component];
    for (int component = 0; component < 3 && point->finite_strain; component++)
        batch.spin[component] = trial->spin[component];
    if (!valid)
        return false;
    point->material->update_stress(point->constants, &batch);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        for (int lane = 0; lane < POINT_LANES; lane++) {
            trial->stress[component][lane] /= trial->volume_ratio[lane];
            valid = valid && isfinite(trial->stress[component][lane]);
        }
    }
    return valid;
}

void point_trial_accept(struct point *point)
{
    const struct point_trial *trial = &point->trial;
    struct point_state *state = &point->state;
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        state->elastic[component] = trial->elastic[component][0];
        state->strain[component] += trial->strain[component][0];
        state->stress[component] = trial->stress[component][0];
    }
    if (point->finite_strain)
        state->gradient = mat3_multiply(trial->step[0], state->gradient);
    state->volume_ratio = trial->volume_ratio[0];
    state->plastic_strain += trial->plastic_strain[0];
    state->dissipation += trial->dissipation[0];
    for (size_t index = 0; index < point->material->state_count; index++)
        state->history[index] = trial->history[index][0];
}

double point_strain_energy(struct point *point)
{
    real energy[POINT_LANES];
    struct point_trial *trial = &point->trial;
    struct material_batch batch = {
        .count = POINT_LANES,
        .component_count = SYM3_COMPONENTS,
        .history = trial->history,
    };
    for (int lane = 0; lane < POINT_LANES; lane++) {
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            trial->elastic[component][lane] = (real)point->state.elastic[component];
        for (size_t state = 0; state < point->material->state_count; state++)
            trial->history[state][lane] = (real)point->state.history[state];
    }
    point_arrays(trial->elastic, batch.strain);
    point->material->strain_energy(point->constants, &batch, energy);
    return energy[0];
}
