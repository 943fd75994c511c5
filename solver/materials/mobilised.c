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

TALUS_INLINE double tangent_deg(double angle)
{
    return elementary_tangent_deg(minimum(maximum(angle, 0.0), angle_limit_deg));
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
        material_issue_add(&issues, "dilation_angle", "range",
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
        .deviatoric_share = measure == MEASURE_VOLUMETRIC ? 0.0 : 1.0,
        .volumetric_share = measure == MEASURE_DEVIATORIC ? 0.0 : 1.0,
        .apex = 3.0 * apex,
    };
    mobilised->constant = mobilised->hardening == 0.0 && mobilised->initial_drop == 0.0;
    mobilised->tangent = tangent_deg(residual);
    /* without hardening the critical-state angle is the friction angle: no dilation */
    bool none = mobilised->critical_state || isnan(values[MOBILISED_DILATION_ANGLE]);
    mobilised->flow_tangent = none ? 0.0 : tan(angle_radians(values[MOBILISED_DILATION_ANGLE]));
}

double mobilised_wave_speed(const void *constants)
{
    const struct mobilised *mobilised = constants;
    return elasticity_wave_speed(&mobilised->elasticity);
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

void mobilised_strain_energy(const void *constants, const struct material_batch *batch,
                             double *energy)
{
    const struct mobilised *mobilised = constants;
    elasticity_strain_energy(&mobilised->elasticity, batch, energy);
}

void mobilised_strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                                  double strain[SYM3_COMPONENTS])
{
    const struct mobilised *mobilised = constants;
    elasticity_strain_from_stress(&mobilised->elasticity, stress, strain);
}

double mobilised_initial_friction_angle_deg(const double *values)
{
    /* lambda = 0 and no pressure: pressure can only raise the angle */
    double angle = read_residual(values) - read_hardening(values, MOBILISED_A4);
    return minimum(maximum(angle, 0.0), angle_limit_deg);
}

void mobilised_angles_at_start(const struct mobilised *mobilised,
                               const struct material_batch *batch, size_t begin, size_t count,
                               struct mobilised_angles *angles)
{
    const struct mobilised m = *mobilised;
    const double *measure = batch->history[MOBILISED_STATE_LAMBDA];
    const double *invariant = batch->history[MOBILISED_STATE_INVARIANT];
    for (size_t index = 0; index < count; index++) {
        angles->tangent[index] = m.tangent;
        angles->flow_tangent[index] = m.flow_tangent;
    }
    if (m.constant)
        return;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        double lambda = m.strain_scale * measure[begin + index];
        double exponent = m.pressure_decay * invariant[begin + index] - m.strain_decay * lambda;
        double peak = m.hardening * lambda - m.initial_drop;
        angles->tangent[index] = tangent_deg(m.residual + peak * elementary_exp(exponent));
    }
    if (!m.critical_state)
        return;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        double lambda = m.strain_scale * measure[begin + index];
        double drop = m.initial_drop * elementary_exp(-m.critical_decay * lambda);
        angles->flow_tangent[index] = angles->tangent[index] - tangent_deg(m.residual - drop);
    }
}

void mobilised_advance(const struct mobilised *mobilised, const struct material_batch *batch,
                       size_t begin, size_t count, const struct invariants *invariants)
{
    double *measure = batch->history[MOBILISED_STATE_LAMBDA];
    double *invariant = batch->history[MOBILISED_STATE_INVARIANT];
    double bulk = mobilised->elasticity.bulk;
    double shear = mobilised->elasticity.shear;
    double deviatoric_share = mobilised->deviatoric_share;
    double volumetric_share = mobilised->volumetric_share;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        double deviatoric =
            (1.0 - invariants->scale[index]) * invariants->norm[index] / (2.0 * shear);
        double spherical = (invariants->trial[index] - invariants->first[index]) / (9.0 * bulk);
        measure[begin + index] += sqrt(deviatoric_share * deviatoric * deviatoric +
                                       volumetric_share * 3.0 * spherical * spherical);
        invariant[begin + index] = invariants->first[index];
    }
}
