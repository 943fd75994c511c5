/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/mobilised.h"

#include "materials/cone.h"
#include "math/angle.h"
#include "math/elementary.h"

static const double angle_limit_deg = 89.0;

const char *const mobilised_strain_measures[] = {"total", "volumetric", "deviatoric", NULL};
enum strain_measure { MEASURE_TOTAL, MEASURE_VOLUMETRIC, MEASURE_DEVIATORIC };

const char *const mobilised_state_names[MOBILISED_STATE_COUNT] = {"plastic_strain_measure",
                                                                  "first_stress_invariant"};

/* Residual friction angle [deg]: a0, or the constant one. */
static double read_residual(const double *values)
{
    return isnan(values[MOBILISED_A0]) ? values[MOBILISED_FRICTION_ANGLE] : values[MOBILISED_A0];
}

/* A constant of the hardening law; none of them counts beside a constant friction angle. */
static double read_hardening(const double *values, enum mobilised_value index)
{
    return isnan(values[MOBILISED_A0]) || isnan(values[index]) ? 0.0 : values[index];
}

static bool is_critical_state(const double *values)
{
    return !isnan(values[MOBILISED_A0]) && !isnan(values[MOBILISED_A5]);
}

TALUS_INLINE real tangent_deg(real angle)
{
    return (real)elementary_tangent_deg(minimum(maximum(angle, 0), (real)angle_limit_deg));
}

size_t mobilised_check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    double dilation = values[MOBILISED_DILATION_ANGLE];
    elasticity_check(values, &issues);
    if (is_critical_state(values) && !isnan(dilation))
        material_issue_add(&issues, "dilation_angle", "contradiction",
                           "friction.a5 sets the dilation from the critical-state angle; "
                           "dilation_angle sets a constant one");
    if (isnan(values[MOBILISED_A0]) && dilation > values[MOBILISED_FRICTION_ANGLE])
        material_issue_add(&issues, "dilation_angle", "limit",
                           "dilation beyond the friction angle (%g) would make plastic flow a "
                           "source of energy",
                           values[MOBILISED_FRICTION_ANGLE]);
    if (values[MOBILISED_COHESION] > 0.0 && isnan(values[MOBILISED_APEX_STRESS]) &&
        read_residual(values) == 0.0)
        material_issue_add(&issues, "cohesion", "contradiction",
                           "a cone of cohesion with a residual friction angle of 0 has no apex");
    return issues.count;
}

void mobilised_prepare(const double *values, void *constants)
{
    struct mobilised *mobilised = constants;
    enum strain_measure measure =
        (enum strain_measure)read_hardening(values, MOBILISED_STRAIN_MEASURE);
    double residual = read_residual(values);
    double apex = values[MOBILISED_APEX_STRESS];
    double cohesion = values[MOBILISED_COHESION];
    if (isnan(apex))
        apex = cohesion > 0.0 ? cohesion / tan(angle_radians(residual)) : 0.0;

    *mobilised = (struct mobilised){
        .elasticity = elasticity_read(values),
        .residual = residual,
        .hardening = read_hardening(values, MOBILISED_A1),
        .pressure_decay = read_hardening(values, MOBILISED_A2),
        .strain_decay = read_hardening(values, MOBILISED_A3),
        .initial_drop = read_hardening(values, MOBILISED_A4),
        .critical_decay = read_hardening(values, MOBILISED_A5),
        .critical_state = is_critical_state(values),
        .strain_scale = isnan(values[MOBILISED_A0]) ? 1.0 : values[MOBILISED_STRAIN_SCALE],
        .total_share = measure == MEASURE_TOTAL ? 1.0 : 0.0,
        .deviatoric_share = measure == MEASURE_DEVIATORIC ? 1.0 : 0.0,
        .spherical_share = measure == MEASURE_VOLUMETRIC ? 1.0 : 0.0,
        .apex = 3.0 * apex,
    };
    mobilised->constant = mobilised->hardening == 0.0 && mobilised->initial_drop == 0.0;
    mobilised->tangent = tangent_deg((real)residual);
    /* without hardening the critical-state angle is the friction angle: no dilation */
    bool none = mobilised->critical_state || isnan(values[MOBILISED_DILATION_ANGLE]);
    mobilised->flow_tangent = none ? 0.0 : tan(angle_radians(values[MOBILISED_DILATION_ANGLE]));
}

void mobilised_initialise(const void *constants, const double strain[SYM3_COMPONENTS],
                          double *history)
{
    const struct mobilised *mobilised = constants;
    history[MOBILISED_STATE_LAMBDA] = 0.0;
    history[MOBILISED_STATE_INVARIANT] =
        strain == NULL ? 0.0
                       : 3.0 * mobilised->elasticity.bulk * (strain[0] + strain[1] + strain[2]);
}

double mobilised_initial_friction_angle_deg(const double *values)
{
    /* lambda = 0 and no pressure: pressure can only raise the angle */
    double angle = read_residual(values) - read_hardening(values, MOBILISED_A4);
    return fmin(fmax(angle, 0.0), angle_limit_deg);
}

static bool has_constant_dilation(const struct mobilised *mobilised)
{
    return mobilised->constant || !mobilised->critical_state;
}

static void fill(size_t count, real value, real *out)
{
    for (size_t index = 0; index < count; index++)
        out[index] = value;
}

/* Angles [deg], kept within 0 ... 89, become their tangents. */
static void take_tangents(size_t count, real *angles)
{
#pragma omp simd
    for (size_t index = 0; index < count; index++)
        angles[index] = tangent_deg(angles[index]);
}

void mobilised_friction_at_start(const struct mobilised *mobilised,
                                 const struct material_batch *batch, size_t begin, size_t count,
                                 struct mobilised_angles *angles)
{
    const real *measure = batch->history[MOBILISED_STATE_LAMBDA] + begin;
    const real *invariant = batch->history[MOBILISED_STATE_INVARIANT] + begin;
    const real residual = (real)mobilised->residual;
    const real hardening = (real)(mobilised->hardening * mobilised->strain_scale);
    const real initial_drop = (real)mobilised->initial_drop;
    const real pressure_decay = (real)mobilised->pressure_decay;
    const real strain_decay = (real)(mobilised->strain_decay * mobilised->strain_scale);
    count = whole_rows(count);
    if (mobilised->constant) {
        fill(count, (real)mobilised->tangent, angles->tangent);
        return;
    }
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real exponent = pressure_decay * invariant[index] - strain_decay * measure[index];
        real peak = hardening * measure[index] - initial_drop;
        angles->tangent[index] = residual + peak * (real)elementary_exp(exponent);
    }
    take_tangents(count, angles->tangent);
}

void mobilised_dilation_at_start(const struct mobilised *mobilised,
                                 const struct material_batch *batch, size_t begin, size_t count,
                                 struct mobilised_angles *angles)
{
    const real *measure = batch->history[MOBILISED_STATE_LAMBDA] + begin;
    const real residual = (real)mobilised->residual;
    const real initial_drop = (real)mobilised->initial_drop;
    const real critical_decay = (real)(mobilised->critical_decay * mobilised->strain_scale);
    real *flow_tangent = angles->flow_tangent;
    count = whole_rows(count);
    if (has_constant_dilation(mobilised)) {
        fill(count, (real)mobilised->flow_tangent, flow_tangent);
        return;
    }
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real drop = initial_drop * (real)elementary_exp(-critical_decay * measure[index]);
        flow_tangent[index] = residual - drop;
    }
    take_tangents(count, flow_tangent);
#pragma omp simd
    for (size_t index = 0; index < count; index++)
        flow_tangent[index] = angles->tangent[index] - flow_tangent[index];
}

TALUS_INLINE real cone_slope_of(real tangent)
{
    const real factor = (real)1.632993161855452; /* 2 sqrt(2/3) */
    return factor * tangent / (3 * real_sqrt(1 + tangent * tangent) - tangent);
}

void mobilised_cone_slopes(size_t count, const real *tangent, real *slope)
{
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++)
        slope[index] = cone_slope_of(tangent[index]);
}

void mobilised_mark_yielding(const struct mobilised *mobilised, const struct material_batch *batch,
                             size_t begin, size_t count, const real *slopes,
                             const struct invariants *invariants)
{
    const real apex = (real)mobilised->apex;
    real *invariant = batch->history[MOBILISED_STATE_INVARIANT] + begin;
    real *plastic_strain = batch->plastic_strain + begin;
    real *dissipation = batch->dissipation + begin;
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real beyond = invariants->first[index] - apex;
        real excess = invariants->norm[index] + slopes[index] * beyond;
        plastic_strain[index] = maximum(maximum(excess, beyond), 0);
        dissipation[index] = 0;
        invariant[index] = invariants->first[index];
    }
}

/* With `stops`, contraction ends where the mean stress turns tensile, or at once if nothing
 * resists; without it at the apex, which is the same if that is at I1 = 0. */
TALUS_INLINE void return_kernel(const struct mobilised *mobilised, size_t count, bool stops,
                                const real *slopes, const real *flow_slopes,
                                struct invariants *invariants, struct mobilised_flow *flow)
{
    const struct stiffness stiffness = elasticity_stiffness(&mobilised->elasticity);
    const real apex = (real)mobilised->apex;
    const real shear = stiffness.shear;
    const real bulk = 3 * stiffness.bulk;
    const real shear_inverse = 1 / shear;
    const real bulk_inverse = 1 / bulk;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real first = invariants->first[index];
        real norm = invariants->norm[index];
        real slope = slopes[index];
        real flow_slope = minimum(flow_slopes[index], slope);
        real excess = maximum(norm + slope * (first - apex), 0);
        real resistance = (shear + bulk * slope * flow_slope) * norm;
        real share = excess / (resistance > 0 ? resistance : 1); /* multiplier over |s| */
        real multiplier = share * norm;
        real scale = 1 - shear * share;
        real returned = first - bulk * flow_slope * multiplier;
        real spherical = flow_slope * multiplier;
        real stuck = resistance > 0 ? 0 : excess;
        if (stops) {
            real stop = maximum(first, 0);
            real past = minimum(minimum(-flow_slope, apex - stop), maximum(returned - stop, stuck));
            real stopped = slope * (apex - stop) / (norm > 0 ? norm : 1);
            bool is_past = past > 0;
            scale = is_past ? stopped : scale;
            returned = is_past ? stop : returned;
            spherical = is_past ? (first - stop) * bulk_inverse : spherical;
            multiplier = is_past ? (1 - stopped) * norm * shear_inverse : multiplier;
            stuck = minimum(stuck, -past);
        }
        /* where the line ends: no deviator left and under tension, beyond the apex, or nothing that
         * resists */
        real short_of = minimum(first - apex, -scale);
        bool to_apex = maximum(maximum(short_of, returned - apex), stuck) > 0;
        scale = to_apex ? 0 : scale;
        invariants->scale[index] = scale;
        invariants->returned[index] = to_apex ? apex : returned;
        invariants->spherical[index] = to_apex ? (first - apex) * bulk_inverse : spherical;
        flow->deviatoric[index] = to_apex ? norm * shear_inverse : multiplier;
        flow->left[index] = scale * norm;
    }
}

static void return_stress(const struct mobilised *mobilised, size_t count, const real *slopes,
                          const real *flow_slopes, struct invariants *invariants,
                          struct mobilised_flow *flow)
{
    const bool dilates = has_constant_dilation(mobilised) && mobilised->flow_tangent >= 0.0;
    if (mobilised->apex > 0.0 && !dilates)
        return_kernel(mobilised, count, true, slopes, flow_slopes, invariants, flow);
    else
        return_kernel(mobilised, count, false, slopes, flow_slopes, invariants, flow);
}

/* Plastic strain, dissipation and history of a return. */
static void book_flow(const struct mobilised *mobilised, const struct material_batch *batch,
                      size_t begin, size_t count, const struct invariants *invariants,
                      const struct mobilised_flow *flow)
{
    const real total_share = (real)mobilised->total_share;
    const real deviatoric_share = (real)mobilised->deviatoric_share;
    const real spherical_share = (real)(sqrt(3.0) * mobilised->spherical_share);
    real *measure = batch->history[MOBILISED_STATE_LAMBDA] + begin;
    real *invariant = batch->history[MOBILISED_STATE_INVARIANT] + begin;
    real *plastic_strain = batch->plastic_strain + begin;
    real *dissipation = batch->dissipation + begin;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real deviatoric = flow->deviatoric[index];
        real spherical = invariants->spherical[index];
        real returned = invariants->returned[index];
        real total = flow_norm(deviatoric, spherical);
        plastic_strain[index] = total;
        dissipation[index] = flow_dissipation(flow->left[index], returned, deviatoric, spherical);
        measure[index] += total_share * total + deviatoric_share * deviatoric +
                          spherical_share * real_absolute(spherical);
        invariant[index] = returned;
    }
}

void mobilised_return(const struct mobilised *mobilised, const struct material_batch *batch,
                      size_t begin, size_t count, const real *slopes,
                      const struct mobilised_angles *angles, mobilised_potential *potential,
                      struct invariants *invariants)
{
    MATERIAL_ALIGNED real flow_slope[MATERIAL_CHUNK];
    struct mobilised_flow flow;
    count = whole_rows(count);
    if (has_constant_dilation(mobilised))
        fill(count, cone_slope_of((real)mobilised->flow_tangent), flow_slope);
    else
        mobilised_cone_slopes(count, angles->flow_tangent, flow_slope);
    return_stress(mobilised, count, slopes, flow_slope, invariants, &flow);
    if (potential != NULL)
        potential(mobilised, count, batch->plastic_strain + begin, angles, invariants, &flow);
    book_flow(mobilised, batch, begin, count, invariants, &flow);
}
