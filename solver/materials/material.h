/* SPDX-License-Identifier: Apache-2.0 */
/* The seam for materials: one file per model, one line in materials.def.
 *
 * A material turns a trial elastic strain into stress, for a batch of particles at once. Kinematics
 * (finite or small strain), anti-locking and storage are not its business: at finite strain the
 * strain is the logarithmic (Hencky) elastic strain and the stress is the Kirchhoff stress, at
 * small strain they are the small elastic strain and the Cauchy stress (Mast 2013, sec. 3.2).
 *
 * Lifecycle: `prepare` turns the values of a scene into the model's own constants (a flat struct
 * without pointers, `constants_size` bytes, owned by the caller), once per scene. */
#ifndef TALUS_MATERIAL_H
#define TALUS_MATERIAL_H

#include "base/parameter.h"
#include "math/real.h"
#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>

enum { SYM3_COMPONENTS = 6, MATERIAL_SLOT_MULTIPLE = 32 / sizeof(real) };

/* Scratch arrays of one block of particles; slot i of every array belongs to the same particle.
 * Empty slots hold zero strain, volume_ratio 1 and zero history, and must come out finite.
 * Arrays of components beyond component_count are absent (NULL) and mean zero. No two arrays
 * overlap. */
struct material_batch {
    size_t count;           /* slots; a multiple of MATERIAL_SLOT_MULTIPLE, arrays aligned to 64
                               bytes */
    size_t component_count; /* 3 (line: xx yy zz), 4 (plane strain: + xy) or 6 (solid) */
    double time_step;       /* [s] */
    real *strain[SYM3_COMPONENTS];     /* in: trial elastic strain; out: elastic strain [1]. Slots
                                          that do not flow keep it to the last bit. Volumetric
                                          models (see `volumetric`) use strain[0] as the volumetric
                                          strain ln J (trace at small strain) */
    const real *rate[SYM3_COMPONENTS]; /* in: symmetric velocity gradient d [1/s] if needs_rate */
    const real *spin[3];               /* in: (L - L^T)/2, components xy, yz, xz [1/s], if
                                          needs_spin() at finite strain; else NULL */
    const real *volume_ratio;          /* in: J = V/V0 [1] (1 at small strain) */
    real *stress[SYM3_COMPONENTS];     /* out: Kirchhoff stress (finite) or Cauchy (small) [Pa] */
    real *const *history;              /* in/out: [state_count] arrays of the model's own state */
    real *plastic_strain;              /* out, of `plastic` models only: norm of the plastic strain
                                          increment of this step (0 where elastic) [1] */
    real *dissipation;                 /* out, of models that dissipate only: dissipated energy of
                                          this step per initial volume, >= 0, plastic and viscous
                                          [J/m^3] */
};

struct material_issue { /* what `check` found; the caller owns it */
    char key[64];       /* the parameter's key */
    char code[32];      /* "contradiction", "range", ... */
    char text[256];
};

struct material {
    const char *name;                   /* JSON name */
    const char *reference;              /* document and equation */
    const char *summary;                /* one sentence for people */
    const struct parameter *parameters; /* ends with key NULL; without `density` and the elastic
                                           constants unless own_elasticity is set */
    const char *const *reserved_keys;   /* refused as `unsupported`, not as unknown keys;
                                           NULL-terminated or NULL */
    bool own_elasticity; /* the table itself holds what the model knows of elasticity (fluids) */
    bool volumetric;     /* stores ln J only, in strain[0]; no deviatoric strain */
    bool needs_rate;     /* wants batch->rate */
    bool plastic;        /* may change the trial strain; writes batch->plastic_strain */
    bool dissipates;     /* writes batch->dissipation: plastic or viscous */
    size_t state_count;  /* history variables per particle; only these are stored */
    const char *const *state_names; /* [state_count] */
    size_t constants_size;          /* bytes of the model's constants */

    /* Parameters that contradict each other. values: as in talus_material.values (see
     * material_parameters). Returns the number of issues written to issues[capacity]. */
    size_t (*check)(const double *values, struct material_issue *issues, size_t capacity);
    /* values -> constants[constants_size]. Values have passed `check`. */
    void (*prepare)(const double *values, void *constants);
    /* Speed of the fastest wave [m/s] at the reference density. */
    double (*wave_speed)(const void *constants);
    /* Longitudinal viscosity limit: dynamic viscosity [Pa s]; 0 for solids. NULL means 0. */
    double (*viscosity)(const void *constants);
    /* Wants batch->spin at finite strain: its history holds a tensor that is not zero. NULL: never.
     */
    bool (*needs_spin)(const void *constants);
    /* Initial history of a particle with elastic strain e[6] (NULL: zeros). */
    void (*initialise)(const void *constants, const double strain[SYM3_COMPONENTS],
                       double *history);
    /* Trial strain -> stress, elastic strain, history, dissipation, for the whole batch. Returns
     * whether a slot flowed. If not, every slot keeps its trial strain and plastic strain and
     * plastic dissipation are zero throughout: nothing has to be carried back to the stored form of
     * the strain. Models that are not plastic return false. */
    bool (*update_stress)(const void *constants, const struct material_batch *batch);
    /* Strain energy per initial volume [J/m^3] into energy[count], out of strain as stored
     * (elastic) and history; reads nothing else of the batch. */
    void (*strain_energy)(const void *constants, const struct material_batch *batch, real *energy);
    /* Elastic strain that gives a stress (initial states): K, G law; fluids: strain[0] = ln J. */
    void (*strain_from_stress)(const void *constants, const double stress[SYM3_COMPONENTS],
                               double strain[SYM3_COMPONENTS]);
    /* Friction angle [deg] of a virgin state as a triaxial compression test would measure it; NULL
     * for models without friction. Values have passed `check`. */
    double (*initial_friction_angle_deg)(const double *values);
};

/* All models, in the order of materials.def. */
extern const struct material *const material_table[];
extern const size_t material_count;
/* The model of that name, or NULL. */
const struct material *material_find(const char *name);

/* The full parameter list of a model: density, the elastic constants (bulk_modulus, shear_modulus,
 * young_modulus, poisson_ratio as alternatives) unless own_elasticity, then its own table. Values
 * arrays have this order and length. Writes up to `capacity` pointers, returns the count. */
size_t material_parameters(const struct material *material, const struct parameter **parameters,
                           size_t capacity);
/* Index into a values array of a key, or (size_t)-1. */
size_t material_parameter_index(const struct material *material, const char *key);
enum { MATERIAL_VALUE_DENSITY = 0, MATERIAL_PARAMETER_MAX = 64 };

/* Bulk and shear modulus [Pa] out of either pair of elastic constants. For models with
 * own elasticity: bulk_modulus and 0. */
void material_elastic_moduli(const struct material *material, const double *values, double *bulk,
                             double *shear);
/* Friction angle [deg] in force at the start, before any plastic strain, as a triaxial compression
 * test would measure it: sets the active earth pressure coefficient of the K0 rule `auto` and
 * Jaky's 1 - sin(phi). 0 where the model has none. */
double material_initial_friction_angle_deg(const struct material *material, const double *values);

#endif
