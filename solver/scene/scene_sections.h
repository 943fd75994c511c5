/* SPDX-License-Identifier: Apache-2.0 */
/* The parts of a scene, one file each: the table that describes it and the function that reads it.
 * Private to solver/scene. */
#ifndef TALUS_SCENE_SECTIONS_H
#define TALUS_SCENE_SECTIONS_H

#include "scene/scene_field.h"

/* Bounds on the lists of a scene, so that no scene of a few megabytes takes minutes to check. */
enum {
    SCENE_MATERIAL_MAX = 64, /* the solver's own limit */
    SCENE_ENTRY_MAX = 1000,  /* bodies, boundaries, probes, references */
    SCENE_CURVE_MAX = 100000,
    SCENE_CELL_MAX = 1048576, /* cells per axis */
};

extern const struct scene_field scene_root_fields[];
extern const struct scene_field scene_grid_fields[];
extern const struct scene_field scene_solver_fields[];
extern const struct scene_field scene_body_fields[];
extern const struct scene_field scene_boundary_fields[];
extern const struct scene_field scene_probe_fields[];
extern const struct scene_field scene_reference_fields[];
extern const struct scene_field scene_output_fields[];

/* A scene with averages against locking that names no shape takes `linear`, what they were made
 * for; `root` is the document, `effective` the scene with all defaults (docs/methods.md, "The
 * default"). */
void scene_solver_choose_shape(struct scene_reader *reader, const json_t *root, json_t *effective);

/* The dimensions with so many axes; new array. */
json_t *scene_dimensions_of(size_t axis_count);

/* Readers for the custom fields of the root; target is the scene. */
#define SCENE_SECTION(name)                                                                        \
    void scene_##name##_read(struct scene_reader *reader, const struct scene_path *path,           \
                             const json_t *given, void *target, json_t *effective);                \
    json_t *scene_##name##_schema(void)
SCENE_SECTION(grid);
SCENE_SECTION(materials);
SCENE_SECTION(bodies);
SCENE_SECTION(initial_stress);
SCENE_SECTION(gravity);
SCENE_SECTION(boundaries);
SCENE_SECTION(probes);
SCENE_SECTION(references);
SCENE_SECTION(output);
#undef SCENE_SECTION

/* ---- lists of entries ---- */
/* Reads an array with at least `minimum` and at most SCENE_ENTRY_MAX entries: allocates
 * *items[count] of `item_size` bytes (zeroed, owned by the caller) and calls read_entry for each
 * object in it. Returns the count. */
size_t
scene_list_read(struct scene_reader *reader, const struct scene_path *path, const json_t *given,
                size_t minimum, size_t item_size, void **items, json_t *effective,
                void (*read_entry)(struct scene_reader *reader, const struct scene_path *path,
                                   const json_t *given, void *item, json_t *effective));

/* The name given, or "KIND_INDEX"; a new string. Puts it into `effective`. */
char *scene_entry_name(struct scene_reader *reader, const struct scene_path *path,
                       const char *given, const char *kind, json_t *effective);
/* Reports names that occur twice; `names` has `count` entries, NULL ones are skipped. */
void scene_names_check(struct scene_reader *reader, const struct scene_path *path,
                       const char *const *names, size_t count);
/* Index of the entry of the scene with that name, or -1 with a mistake. */
int scene_material_find(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given);
int scene_body_find(struct scene_reader *reader, const struct scene_path *path,
                    const json_t *given);
int scene_boundary_find(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given);
int scene_probe_find(struct scene_reader *reader, const struct scene_path *path,
                     const json_t *given);

/* Schema of an array of entries with this table. */
json_t *scene_list_schema(const struct scene_field *table, size_t minimum);

/* ---- materials ---- */
/* Reads one material, named after the key of its place, into a zeroed entry that owns its name and
 * values even after mistakes; `effective` may be NULL. */
void scene_material_read(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, struct talus_material *entry, json_t *effective);
/* [{"model","summary","reference","parameters":[...]}] */
json_t *scene_materials_describe(void);

/* ---- checks of the whole scene ---- */
/* True if some mistake lies at or below this pointer. */
bool scene_issues_under(const struct scene_issues *issues, const char *pointer);
/* Geometry, cost and initial states: what no single entry can tell. */
void scene_check(struct scene_reader *reader);
/* Boundaries that are not on grid lines; needs a scene without mistakes. */
void scene_check_boundaries(struct scene_reader *reader);

#endif
