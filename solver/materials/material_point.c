/* SPDX-License-Identifier: Apache-2.0 */
/* The steps of a path and the iteration that finds strains for given stresses. */
#include "materials/material_point.h"

#include "materials/point_trial.h"
#include "math/linear_solve.h"
#include "math/log_strain.h"

#include <stdio.h>
#include <string.h>

/* Newton's method with a numerical tangent. The source iterates with the elastic operator (Mast
 * 2013, eq. 3.130), which needs ever more iterations near the peak. */
enum { ITERATION_MAX = 60, HALVING_MAX = 12 };
/* Of the stress scale; what the numbers can hold if that is less. */
static const double stress_tolerance = 16 * REAL_EPSILON > 1e-11 ? 16 * REAL_EPSILON : 1e-11;

struct control { /* of one step */
    size_t unknown_count;
    int unknown[SYM3_COMPONENTS]; /* components whose stress is given */
    double target[SYM3_COMPONENTS];
    double increment[SYM3_COMPONENTS]; /* total strain increment; unknowns: the estimate */
    double time_step;
    double scale; /* what stresses are compared with, at least [Pa] */
    int iterations;
};

/* Runs lane 0 with the increment and one lane per unknown with `offset` added to it. */
static bool control_try(struct point *point, const struct control *control, double offset)
{
    struct point_trial *trial = &point->trial;
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        for (int lane = 0; lane < POINT_LANES; lane++)
            trial->strain[component][lane] =
                lane == POINT_LANES - 1 ? 0.0 : control->increment[component];
    }
    for (size_t index = 0; index < control->unknown_count; index++)
        trial->strain[control->unknown[index]][index + 1] += offset;
    if (point->finite_strain)
        point_trial_stretch(point);
    return point_trial_run(point, control->time_step);
}

/* Largest stress error of lane 0. */
static double control_error(const struct point *point, const struct control *control)
{
    double largest = 0.0;
    for (size_t index = 0; index < control->unknown_count; index++) {
        int component = control->unknown[index];
        double error = fabs(point->trial.stress[component][0] - control->target[component]);
        largest = fmax(largest, error);
    }
    return largest;
}

/* What the error may be: a share of the stresses at hand. */
static double control_tolerance(const struct point *point, const struct control *control)
{
    double scale = control->scale;
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        scale = fmax(scale, fabs(point->trial.stress[component][0]));
    return stress_tolerance * scale;
}

/* Newton step of the unknowns into change[], out of the lanes of the last try. */
static void control_newton(const struct point *point, const struct control *control, double offset,
                           double change[SYM3_COMPONENTS], double stiffness)
{
    const struct point_trial *trial = &point->trial;
    double matrix[LINEAR_SOLVE_MAX][LINEAR_SOLVE_MAX];
    for (size_t row = 0; row < control->unknown_count; row++) {
        int component = control->unknown[row];
        change[row] = control->target[component] - trial->stress[component][0];
        for (size_t column = 0; column < control->unknown_count; column++)
            matrix[row][column] =
                (trial->stress[component][column + 1] - trial->stress[component][0]) / offset;
    }
    if (linear_solve(control->unknown_count, matrix, change))
        return;
    /* perfectly plastic: no tangent; creep towards the target with the elastic stiffness */
    for (size_t row = 0; row < control->unknown_count; row++) {
        int component = control->unknown[row];
        change[row] = (control->target[component] - trial->stress[component][0]) / stiffness;
    }
}

/* Size of the offset for the tangent: far below the increment, far above round-off. */
static double control_offset(const struct point *point, const struct control *control)
{
    double increment = 0.0;
    double elastic = 0.0;
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        increment = fmax(increment, fabs(control->increment[component]));
        elastic = fmax(elastic, fabs(point->state.elastic[component]));
    }
    const double share = 0.5 * sqrt(REAL_EPSILON);
    return fmax(fmax(1e-6, share) * increment, fmax(fmax(1e-8, share) * elastic, 1e-12));
}

/* Takes as much of the change as does not make the error grow. */
static bool control_search(struct point *point, struct control *control, double offset,
                           const double change[SYM3_COMPONENTS], double *error)
{
    const struct control before = *control;
    double factor = 1.0;
    double last = *error;
    bool valid = false;
    for (int halving = 0; halving < HALVING_MAX; halving++) {
        for (size_t index = 0; index < control->unknown_count; index++) {
            int component = control->unknown[index];
            control->increment[component] = before.increment[component] + factor * change[index];
        }
        valid = control_try(point, control, offset);
        *error = control_error(point, control);
        if (valid && *error <= last) /* equal: across a gap, where nothing is carried */
            break;
        factor *= 0.5;
    }
    return valid;
}

/* Finds the strain increment that gives the target stresses and leaves it in lane 0. */
static bool control_solve(struct point *point, struct control *control, double stiffness)
{
    double offset = control_offset(point, control);
    bool valid = control_try(point, control, offset);
    double error = control_error(point, control);
    for (control->iterations = 0; valid && error > control_tolerance(point, control);
         control->iterations++) {
        double change[SYM3_COMPONENTS];
        if (control->iterations == ITERATION_MAX)
            return false;
        control_newton(point, control, offset, change, stiffness);
        valid = control_search(point, control, offset, change, &error);
    }
    return valid;
}

/* Stress that the error of the control is compared with. */
static double stress_scale(const struct point *point, const struct control *control, double bulk)
{
    double scale = 1e-12 * bulk;
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        scale = fmax(scale, fabs(point->state.stress[component]));
        scale = fmax(scale, fabs(control->target[component]));
        scale = fmax(scale, 1e-3 * bulk * fabs(control->increment[component]));
    }
    return scale;
}

struct run { /* a path under way */
    struct point point;
    double bulk, stiffness; /* K, K + 4 G / 3 [Pa] */
    size_t step;
    void (*emit)(void *context, const struct material_point_step *step);
    void *context;
};

static double deviator_norm(const double stress[SYM3_COMPONENTS], double mean)
{
    double sum = 0.0;
    for (int component = 0; component < 3; component++)
        sum += (stress[component] - mean) * (stress[component] - mean) +
               2.0 * stress[component + 3] * stress[component + 3];
    return sqrt(sum);
}

static void run_emit(struct run *run, int iterations)
{
    const struct point_state *state = &run->point.state;
    struct material_point_step step = {
        .step = run->step,
        .p = (state->stress[0] + state->stress[1] + state->stress[2]) / 3.0,
        .volumetric_strain = state->strain[0] + state->strain[1] + state->strain[2],
        .plastic_strain = state->plastic_strain,
        .dissipation = state->dissipation,
        .strain_energy = point_strain_energy(&run->point),
        .history = state->history,
        .iterations = iterations,
    };
    memcpy(step.strain, state->strain, sizeof step.strain);
    memcpy(step.stress, state->stress, sizeof step.stress);
    step.q = sqrt(1.5) * deviator_norm(step.stress, step.p);
    run->emit(run->context, &step);
    run->step++;
}

/* What a segment asks for at the end of one of its steps. */
static void control_set(struct control *control, const struct point_state *state,
                        const struct point_state *start,
                        const struct material_point_segment *segment, size_t step)
{
    double share = (double)step / (double)segment->step_count;
    control->unknown_count = 0;
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        double begin = start->strain[component];
        double strain = begin + share * (segment->strain[component] - begin);
        control->target[component] = 0.0;
        if (segment->stress_given[component]) {
            begin = start->stress[component];
            control->target[component] = begin + share * (segment->stress[component] - begin);
            control->unknown[control->unknown_count++] = component;
            /* the last step's increment stays: the estimate */
        } else if (segment->strain_given[component]) {
            control->increment[component] = strain - state->strain[component];
        } else {
            control->increment[component] = 0.0;
        }
    }
}

static enum talus_status run_controlled(struct run *run,
                                        const struct material_point_segment *segment, size_t index,
                                        struct talus_error *error)
{
    struct point *point = &run->point;
    const struct point_state start = point->state;
    struct control control = {.time_step = segment->duration / (double)segment->step_count};
    for (size_t step = 1; step <= segment->step_count; step++) {
        control_set(&control, &point->state, &start, segment, step);
        control.scale = stress_scale(point, &control, run->bulk);
        if (!control_solve(point, &control, run->stiffness)) {
            char pointer[64];
            (void)snprintf(pointer, sizeof pointer, "/path/%zu", index);
            return talus_error_set(error, TALUS_UNSTABLE, "no_convergence", pointer,
                                   "step %zu of %zu: no strain gives the stresses asked for after "
                                   "%d iterations; the material may not carry them, or the steps "
                                   "are too large",
                                   step, segment->step_count, control.iterations);
        }
        point_trial_accept(point);
        run_emit(run, control.iterations);
    }
    return TALUS_OK;
}

/* a b^-1; false if det b is not positive. */
static bool gradient_ratio(struct mat3 a, struct mat3 b, struct mat3 *ratio)
{
    real determinant = mat3_determinant(b);
    struct mat3 inverse;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            int r = (j + 1) % 3;
            int s = (j + 2) % 3;
            int u = (i + 1) % 3;
            int v = (i + 2) % 3;
            inverse.m[i][j] = (b.m[r][u] * b.m[s][v] - b.m[r][v] * b.m[s][u]) / determinant;
        }
    }
    *ratio = mat3_multiply(a, inverse);
    return determinant > 0.0 && mat3_determinant(a) > 0.0;
}

/* The stretching of f: 1/2 ln(f f^T), in all lanes. */
static void set_step_gradient(struct point_trial *trial, struct mat3 step)
{
    const struct sym3 one = {1, 1, 1, 0, 0, 0};
    struct sym3 e = sym3_scale((real)0.5, sym3_add_scaled(sym3_push_forward(step, one), -1, one));
    real values[SYM3_COMPONENTS] = {e.xx, e.yy, e.zz, e.xy, e.yz, e.xz};
    real *arrays[SYM3_COMPONENTS];
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        arrays[component] = &values[component];
    (void)log_strain_batch(1, SYM3_COMPONENTS, arrays, arrays); /* f is regular */
    for (int lane = 0; lane < POINT_LANES; lane++) {
        trial->step[lane] = step;
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            trial->strain[component][lane] = values[component];
    }
}

static enum talus_status run_gradient(struct run *run, const struct material_point_segment *segment,
                                      size_t index, struct talus_error *error)
{
    struct point *point = &run->point;
    const struct mat3 start = point->state.gradient;
    double time_step = segment->duration / (double)segment->step_count;
    for (size_t step = 1; step <= segment->step_count; step++) {
        double share = (double)step / (double)segment->step_count;
        struct mat3 gradient;
        struct mat3 increment;
        for (int entry = 0; entry < 9; entry++) {
            double begin = start.m[entry / 3][entry % 3];
            gradient.m[entry / 3][entry % 3] =
                (real)(begin + share * (segment->gradient[entry] - begin));
        }
        bool valid = gradient_ratio(gradient, point->state.gradient, &increment);
        if (valid) {
            set_step_gradient(&point->trial, increment);
            valid = point_trial_run(point, time_step);
        }
        if (!valid) {
            char pointer[64];
            (void)snprintf(pointer, sizeof pointer, "/path/%zu/deformation_gradient", index);
            return talus_error_set(error, TALUS_INVALID, "range", pointer,
                                   "step %zu of %zu: det F is not positive, or F is too large",
                                   step, segment->step_count);
        }
        point_trial_accept(point);
        run_emit(run, 0);
    }
    return TALUS_OK;
}

enum talus_status material_point_run(const struct material *material, const double *values,
                                     const struct material_point_path *path,
                                     void (*emit)(void *context,
                                                  const struct material_point_step *step),
                                     void *context, struct talus_error *error)
{
    struct run run = {.emit = emit, .context = context};
    double shear = 0.0;
    enum talus_status status =
        point_init(&run.point, material, values, path->finite_strain, path->initial_stress, error);
    if (status != TALUS_OK)
        return status;
    material_elastic_moduli(material, values, &run.bulk, &shear);
    run.stiffness = run.bulk + 4.0 / 3.0 * shear;
    run_emit(&run, 0);
    for (size_t index = 0; status == TALUS_OK && index < path->segment_count; index++) {
        const struct material_point_segment *segment = &path->segments[index];
        if (segment->gradient_given)
            status = run_gradient(&run, segment, index, error);
        else
            status = run_controlled(&run, segment, index, error);
    }
    point_release(&run.point);
    return status;
}
