/* SPDX-License-Identifier: Apache-2.0 */
/* The table of all models and the parameters that they share. */
#include "materials/elasticity.h"
#include "materials/material.h"

#include <assert.h>
#include <string.h>

#define MATERIAL(symbol) extern const struct material symbol;
#include "materials/materials.def"
#undef MATERIAL

const struct material *const material_table[] = {
#define MATERIAL(symbol) &symbol,
#include "materials/materials.def"
#undef MATERIAL
};
const size_t material_count = sizeof material_table / sizeof material_table[0];

static const struct parameter density_parameter = {
    .key = "density",
    .symbol = "rho_0",
    .unit = "kg/m^3",
    .minimum = 0.0,
    .above_minimum = true,
    .maximum = INFINITY,
    .required = true,
    .default_value = NAN,
    .meaning = "mass over volume in the initial, stressed state",
};

/* In the order of enum elasticity_value. */
static const struct parameter elastic_parameters[] = {
    {.key = "bulk_modulus",
     .symbol = "K",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "elastic stiffness",
     .meaning = "mean stress over volumetric strain; goes with shear_modulus"},
    {.key = "shear_modulus",
     .symbol = "G",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "second elastic constant",
     .meaning = "shear stress over engineering shear strain; goes with bulk_modulus"},
    {.key = "young_modulus",
     .symbol = "E",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "elastic stiffness",
     .meaning = "uniaxial stress over strain; goes with poisson_ratio"},
    {.key = "poisson_ratio",
     .symbol = "nu",
     .unit = "1",
     .minimum = -1.0,
     .above_minimum = true,
     .maximum = 0.5,
     .below_maximum = true,
     .required = true,
     .default_value = NAN,
     .alternative = "second elastic constant",
     .meaning = "lateral contraction over axial extension; goes with young_modulus"},
};

const struct material *material_find(const char *name)
{
    for (size_t index = 0; index < material_count; index++) {
        if (strcmp(material_table[index]->name, name) == 0)
            return material_table[index];
    }
    return NULL;
}

size_t material_parameters(const struct material *material, const struct parameter **parameters,
                           size_t capacity)
{
    size_t count = 0;
    if (count < capacity)
        parameters[count] = &density_parameter;
    count++;
    size_t elastic_count =
        material->own_elasticity ? 0 : sizeof elastic_parameters / sizeof elastic_parameters[0];
    for (size_t index = 0; index < elastic_count; index++, count++) {
        if (count < capacity)
            parameters[count] = &elastic_parameters[index];
    }
    for (const struct parameter *own = material->parameters; own->key != NULL; own++, count++) {
        if (count < capacity)
            parameters[count] = own;
    }
    assert(count <= MATERIAL_PARAMETER_MAX);
    return count;
}

size_t material_parameter_index(const struct material *material, const char *key)
{
    const struct parameter *parameters[MATERIAL_PARAMETER_MAX];
    size_t count = material_parameters(material, parameters, MATERIAL_PARAMETER_MAX);
    for (size_t index = 0; index < count; index++) {
        if (strcmp(parameters[index]->key, key) == 0)
            return index;
    }
    return (size_t)-1;
}

void material_elastic_moduli(const struct material *material, const double *values, double *bulk,
                             double *shear)
{
    if (material->own_elasticity) {
        *bulk = values[material_parameter_index(material, "bulk_modulus")];
        *shear = 0.0;
        return;
    }
    struct elasticity elasticity = elasticity_read(values);
    *bulk = elasticity.bulk;
    *shear = elasticity.shear;
}

double material_initial_friction_angle_deg(const struct material *material, const double *values)
{
    return material->initial_friction_angle_deg == NULL
               ? 0.0
               : material->initial_friction_angle_deg(values);
}
