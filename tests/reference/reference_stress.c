/* SPDX-License-Identifier: Apache-2.0 */
/* Trial strain, fit, material, fit (Mast 2013, tables 3.4 and 4.1). */
#include "reference_mpm.h"

#include "materials/material.h"

#include <math.h>
#include <string.h>

static const struct material *model_of(const struct reference *reference,
                                       const struct reference_particle *particle)
{
    const size_t index = reference->scene->materials[particle->material].model_index;
    return material_table[index];
}

static const double *values_of(const struct reference *reference,
                               const struct reference_particle *particle)
{
    return reference->scene->materials[particle->material].values;
}

static void trial_strain(const struct reference *reference, struct reference_particle *p,
                         double time_step)
{
    const bool finite = reference->scene->solver.strain == TALUS_STRAIN_FINITE;
    const bool fluid = model_of(reference, p)->volumetric;
    const struct tensor f = tensor_add(tensor_unit(), time_step, p->gradient);
    struct reference_update *update = &p->update;
    *update = (struct reference_update){
        .gradient = p->gradient, .time_step = time_step, .finite_strain = finite};
    if (finite)
        p->volume_ratio *= tensor_determinant(f);
    update->volume_ratio = p->volume_ratio;
    update->strain = p->elastic;
    if (fluid)
        update->strain.m[0][0] +=
            finite ? log(tensor_determinant(f)) : time_step * tensor_trace(p->gradient);
    else if (finite)
        update->strain = tensor_half_logarithm(
            tensor_product(f, tensor_product(p->elastic, tensor_transpose(f))));
    else
        update->strain = tensor_add(p->elastic, time_step, tensor_symmetric(p->gradient));
    p->divergence = tensor_trace(p->gradient);
}

/* tau of the force: with the bulk viscosity C rho h c_b tr d. */
static void force_stress(struct reference *reference, struct reference_particle *p,
                         double time_step)
{
    const struct material *model = model_of(reference, p);
    const double *values = values_of(reference, p);
    const double density = values[MATERIAL_VALUE_DENSITY];
    const double bulk = reference_value(model, values, "bulk_modulus");
    double width = reference->scene->grid.cell[0];
    for (size_t axis = 1; axis < reference->scene->axis_count; axis++)
        width = fmin(width, reference->scene->grid.cell[axis]);
    const double viscosity =
        reference->scene->solver.viscous_damping * density * width * sqrt(bulk / density);
    const double q = viscosity * p->divergence;
    p->force_stress = tensor_add(p->update.stress, q, tensor_unit());
    reference->viscous_energy += p->reference_volume * q * p->divergence * time_step;
    reference->plastic_energy += p->reference_volume * p->update.dissipation;
}

static void store_strain(const struct reference *reference, struct reference_particle *p)
{
    const bool hencky = reference->scene->solver.strain == TALUS_STRAIN_FINITE &&
                        !model_of(reference, p)->volumetric;
    p->elastic = hencky ? tensor_exponential_of_twice(p->update.strain) : p->update.strain;
    p->plastic += p->update.plastic;
}

void reference_update_stress(struct reference *reference, double time_step)
{
    const struct talus_solver_options *solver = &reference->scene->solver;
    const bool averages = solver->anti_locking != TALUS_CONTROL_NONE;
    for (size_t i = 0; i < reference->particle_count; i++)
        trial_strain(reference, &reference->particles[i], time_step);
    if (averages) {
        reference_fit(reference, REFERENCE_STRAIN);
        reference_fit(reference, REFERENCE_DIVERGENCE);
    }
    for (size_t i = 0; i < reference->particle_count; i++) {
        struct reference_particle *p = &reference->particles[i];
        reference_material_update(model_of(reference, p), values_of(reference, p), &p->history,
                                  &p->update);
        store_strain(reference, p);
    }
    if (averages && solver->anti_locking_apply == TALUS_APPLY_STRAIN_AND_STRESS)
        reference_fit(reference, REFERENCE_STRESS);
    for (size_t i = 0; i < reference->particle_count; i++)
        force_stress(reference, &reference->particles[i], time_step);
}
