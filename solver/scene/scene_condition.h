/* SPDX-License-Identifier: Apache-2.0 */
/* What a boundary does to the material, as keys of a boundary or of one face of a box. */
#ifndef TALUS_SCENE_CONDITION_H
#define TALUS_SCENE_CONDITION_H

#include "scene/scene_field.h"

struct scene_condition {                             /* as given */
    size_t index;                                    /* into the table of conditions */
    double friction_coefficient, friction_angle_deg; /* NAN: not given */
    double adhesion, turbulence;                     /* the same */
};

/* Entries for tables whose target starts with a struct scene_condition. */
#define SCENE_CONDITION_FIELDS                                                                     \
    {.key = "condition",                                                                           \
     .kind = SCENE_CUSTOM,                                                                         \
     .unit = "1",                                                                                  \
     .required = true,                                                                             \
     .read = scene_condition_name_read,                                                            \
     .schema = scene_condition_name_schema,                                                        \
     .meaning = "what the boundary does to the material"},                                         \
        {.key = "friction_coefficient",                                                            \
         .kind = SCENE_NUMBER,                                                                     \
         .unit = "1",                                                                              \
         .maximum = INFINITY,                                                                      \
         .default_value = NAN,                                                                     \
         .alternative = "friction",                                                                \
         .offset = offsetof(struct scene_condition, friction_coefficient),                         \
         .meaning = "largest tangential over normal force"},                                       \
        {.key = "friction_angle",                                                                  \
         .kind = SCENE_NUMBER,                                                                     \
         .unit = "deg",                                                                            \
         .maximum = 90.0,                                                                          \
         .below_maximum = true,                                                                    \
         .default_value = NAN,                                                                     \
         .alternative = "friction",                                                                \
         .offset = offsetof(struct scene_condition, friction_angle_deg),                           \
         .meaning = "angle whose tangent is the friction coefficient"},                            \
        {.key = "adhesion",                                                                        \
         .kind = SCENE_NUMBER,                                                                     \
         .unit = "Pa",                                                                             \
         .maximum = INFINITY,                                                                      \
         .default_value = NAN,                                                                     \
         .offset = offsetof(struct scene_condition, adhesion),                                     \
         .meaning = "friction: shear stress that holds without any push"},                         \
    {                                                                                              \
        .key = "turbulence", .kind = SCENE_NUMBER, .unit = "m/s^2", .maximum = INFINITY,           \
        .above_minimum = true, .default_value = NAN,                                               \
        .offset = offsetof(struct scene_condition, turbulence),                                    \
        .meaning = "friction: xi of Voellmy's shear stress rho g v^2 / xi"                         \
    }

extern const struct scene_field scene_condition_fields[];

void scene_condition_name_read(struct scene_reader *reader, const struct scene_path *path,
                               const json_t *given, void *target, json_t *effective);
json_t *scene_condition_name_schema(void);
/* Adds to the schema of an object with these fields what each condition needs and does not know. */
void scene_condition_rules_add(json_t *schema);

/* Nothing given yet. */
void scene_condition_init(struct scene_condition *condition);
/* Checks what belongs to the condition (`given`: the object that holds its keys) and turns it into
 * the face's own terms. */
void scene_condition_finish(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, const struct scene_condition *condition,
                            struct talus_boundary_face *face);
/* Name of a condition (static storage). */
const char *scene_condition_name(size_t index);
/* True if the condition takes particles out. */
bool scene_condition_eliminates(size_t index);
/* True if the condition prescribes the boundary's velocity. */
bool scene_condition_prescribes(size_t index);
/* [{"condition","summary","reference","parameters"}] */
json_t *scene_conditions_describe(void);

#endif
