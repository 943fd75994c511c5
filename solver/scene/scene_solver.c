/* SPDX-License-Identifier: Apache-2.0 */
/* How the equations are solved. */
#include "scene/scene_sections.h"
#include "scene/scene_words.h"

#define PIC_SHARE "share of PIC"
#define AT(member) offsetof(struct talus_scene, solver.member)

static const char *const kind_words[] = {"explicit", NULL};
static const char *const kind_lacking[] = {"quasi_static", NULL};
static const char *const shape_words[] = {
#define SHAPE(symbol) #symbol,
#include "shapes/shapes.def"
#undef SHAPE
    NULL,
};
/* What most scenes lose least by; averages make it too soft (docs/methods.md, "The default"). */
enum {
#define SHAPE(symbol) SHAPE_INDEX_##symbol,
#include "shapes/shapes.def"
#undef SHAPE
    SHAPE_INDEX_DEFAULT = SHAPE_INDEX_bspline2,
    SHAPE_INDEX_BESIDE_ANTI_LOCKING = SHAPE_INDEX_linear
};
static const char *const gimp_scaling_words[] = {"volume", "stretch", NULL};
static const char *const transfer_words[] = {
#define TRANSFER(symbol) #symbol,
#include "transfers/transfers.def"
#undef TRANSFER
    NULL,
};
const char *const scene_stress_words[] = {"modified_last", "last", "first", NULL};
const char *const scene_strain_words[] = {"finite", "small", NULL};
static const char *const strain_lacking[] = {"rate", NULL};
const char *const scene_control_words[] = {"none", "cell", "node", "hybrid", NULL};
const char *const scene_fit_words[] = {"volumetric", "full", "full_constant_volume", NULL};
static const char *const apply_words[] = {"strain_and_stress", "strain", NULL};
static const char *const averaging_words[] = {"weighted", "unweighted_sums", "unweighted", NULL};
static const char *const small_mass_words[] = {"none", "cutoff", "redistribute", NULL};
static const char *const front_words[] = {"start_velocity", "free_flight", NULL};
const char *const scene_precision_words[] = {"double", "single", NULL};

static const struct scene_field anti_locking_fields[] = {
    {.key = "control",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = scene_control_words,
     .offset = AT(anti_locking),
     .meaning = "over what strains are averaged: nothing, each cell, the support of each node, or "
                "nodes for the volumetric and cells for the deviatoric part"},
    {.key = "field",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = scene_fit_words,
     .offset = AT(anti_locking_field),
     .meaning = "what is fitted: the volumetric part by its mean; all components, normal ones by "
                "lines and shears by their means; the same with a constant volumetric part"},
    {.key = "apply",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = apply_words,
     .offset = AT(anti_locking_apply),
     .meaning = "average strains and stresses, or strains only"},
    {.key = "averaging",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = averaging_words,
     .offset = AT(anti_locking_averaging),
     .meaning = "nodes: weights N in the sums and back, in the way back only, or none at all"},
    {.key = NULL},
};

static const struct scene_field settle_fields[] = {
    {.key = "time",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .minimum = 0.0,
     .maximum = INFINITY,
     .offset = AT(settle_time),
     .meaning = "time before t = 0 that is run without being recorded; walls stand still"},
    {.key = "damping",
     .kind = SCENE_NUMBER,
     .unit = "1/s",
     .minimum = 0.0,
     .maximum = INFINITY,
     .offset = AT(settle_damping),
     .meaning = "c: in that time velocities fall by exp(-c dt) a step"},
    {.key = NULL},
};

static const struct scene_field hybrid_fields[] = {
    {.key = "scale",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = 2.0,
     .default_value = 0.75,
     .offset = AT(hybrid_scale),
     .meaning = "of the domains, when a particle looks for cells at the edge of the material"},
    {.key = "count",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .maximum = 1000.0,
     .default_value = 8,
     .whole = true,
     .offset = AT(hybrid_count),
     .meaning = "cells with at most so many particles are at the edge"},
    {.key = NULL},
};

static const struct scene_field front_fields[] = {
    {.key = "threshold",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = 1.0,
     .default_value = 0.25,
     .offset = AT(front_threshold),
     .meaning = "particles are smoothed at nodes of whose support a smaller share is full"},
    {.key = "reading",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = front_words,
     .offset = AT(front_reading),
     .meaning = "they strain with the nodes' velocity at the start of the step, or fly on with "
                "their own velocity without strain"},
    {.key = NULL},
};

static const struct scene_field stabilise_fields[] = {
    {.key = "viscous_damping",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .maximum = 100.0,
     .offset = AT(viscous_damping),
     .meaning = "C of the volumetric damping stress C rho h c tr(d)"},
    {.key = "local_damping",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .maximum = 1.0,
     .below_maximum = true,
     .offset = AT(local_damping),
     .meaning = "share of the out-of-balance force that opposes the motion"},
    {.key = "force_ramp",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .minimum = 0.0,
     .maximum = INFINITY,
     .offset = AT(force_ramp),
     .meaning = "time over which gravity grows from zero"},
    {.key = "small_mass",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = small_mass_words,
     .offset = AT(small_mass),
     .meaning = "internal force of nodes below a tenth of a particle's mass: kept, dropped, or "
                "given to the nodes around them"},
    {.key = "front_smoothing",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .alternative = "front smoothing", /* none unless it is given */
     .fields = front_fields,
     .meaning = "particles at nearly empty nodes are updated from the start of the step only "
                "(Mast 2013); none unless given"},
    {.key = "settle",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = settle_fields,
     .meaning = "what comes to rest before t = 0"},
    {.key = NULL},
};

const struct scene_field scene_solver_fields[] = {
    {.key = "kind",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = kind_words,
     .lacking = kind_lacking,
     .offset = SCENE_NOWHERE,
     .meaning = "time integration"},
    {.key = "time_step",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .above_minimum = true,
     .word = "auto",
     .offset = AT(time_step),
     .meaning = "fixed step, or \"auto\": `courant` times the critical step"},
    {.key = "courant",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .maximum = 10.0,
     .above_minimum = true,
     .default_value = 0.4,
     .offset = AT(courant),
     .meaning = "automatic step over critical step; above 1 only with allow_unstable"},
    {.key = "allow_unstable",
     .kind = SCENE_BOOLEAN,
     .unit = "1",
     .offset = AT(allow_unstable),
     .meaning = "accept a fixed step above the critical one"},
    {.key = "shape",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = shape_words,
     .storage = SCENE_STORE_SIZE,
     .default_value = SHAPE_INDEX_DEFAULT,
     .offset = AT(shape_index),
     .meaning = "shape functions; beside anti_locking the default is linear"},
    {.key = "gimp_scaling",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = gimp_scaling_words,
     .offset = AT(gimp_scaling),
     .meaning = "what the size of particles follows with gimp_scaled: their volume (Andersen and "
                "Andersen 2012, eq. 28), or their stretch along every axis"},
    {.key = "cpdi_hybrid",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = hybrid_fields,
     .meaning = "where particles of cpdi_hybrid take CPDI (Mast 2013, sec. B.2.2)"},
    {.key = "transfer",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = transfer_words,
     .storage = SCENE_STORE_SIZE,
     .offset = AT(transfer_index),
     .meaning = "how velocities go between particles and grid"},
    {.key = "pic_rate",
     .kind = SCENE_NUMBER,
     .unit = "1/s",
     .minimum = 0.0,
     .maximum = INFINITY,
     .alternative = PIC_SHARE,
     .offset = AT(pic_rate),
     .meaning = "flip: lambda; the PIC share of a step is 1 - exp(-lambda dt)"},
    {.key = "flip_ratio",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .maximum = 1.0,
     .default_value = NAN,
     .alternative = PIC_SHARE,
     .offset = AT(flip_ratio),
     .meaning = "flip: its share of a step, as the sources give it; results depend on the step"},
    {.key = "stress_update",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = scene_stress_words,
     .offset = AT(stress_update),
     .meaning = "when the stress is updated in a step, and with which velocity"},
    {.key = "theta",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .maximum = 1.0,
     .default_value = 1.0,
     .offset = AT(theta),
     .meaning = "share of the new velocity in the one that moves particles"},
    {.key = "strain_theta",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .maximum = 1.0,
     .default_value = 1.0,
     .offset = AT(strain_theta),
     .meaning = "share of the new velocity in the one that strains particles; below 1 with "
                "allow_unstable"},
    {.key = "strain",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = scene_strain_words,
     .lacking = strain_lacking,
     .offset = AT(strain),
     .meaning = "finite (Hencky) or small strain"},
    {.key = "anti_locking",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = anti_locking_fields,
     .meaning = "averages that keep nearly incompressible material from locking"},
    {.key = "stabilise",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = stabilise_fields,
     .meaning = "damping and ramps"},
    {.key = "precision",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = scene_precision_words,
     .offset = AT(precision),
     .meaning = "floating point numbers of particles, nodes and kernels"},
    {.key = "steps", .unsupported = true},
    {.key = "tolerance", .unsupported = true},
    {.key = "max_iterations", .unsupported = true},
    {.key = "recovery", .unsupported = true},
    {.key = "stiffness", .unsupported = true},
    {.key = "element", .unsupported = true},
    {.key = NULL},
};

void scene_solver_choose_shape(struct scene_reader *reader, const json_t *root, json_t *effective)
{
    struct talus_solver_options *solver = &reader->scene->solver;
    if (solver->anti_locking == TALUS_CONTROL_NONE ||
        json_object_get(json_object_get(root, "solver"), "shape") != NULL)
        return;
    solver->shape_index = SHAPE_INDEX_BESIDE_ANTI_LOCKING;
    scene_put(reader, json_object_get(effective, "solver"), "shape",
              json_string(shape_words[SHAPE_INDEX_BESIDE_ANTI_LOCKING]));
}
