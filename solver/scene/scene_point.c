/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_point.h"

#include "scene/scene_sections.h"

#include <stdlib.h>
#include <string.h>

#define POINT_AT(member) offsetof(struct scene_point, member)
#define SEGMENT_AT(member) offsetof(struct segment_reading, member)

enum { GRADIENT_ENTRIES = 9 };

struct segment_reading { /* a segment as its table fills it; NAN: not given */
    double strain[SYM3_COMPONENTS];
    double stress[SYM3_COMPONENTS];
    double gradient[GRADIENT_ENTRIES];
    bool gradient_given;
    double steps, duration;
};

static const char *const component_names[SYM3_COMPONENTS] = {"xx", "yy", "zz", "xy", "yz", "xz"};

#define COMPONENT(NAME, UNIT, MEMBER)                                                              \
    {                                                                                              \
        .key = #NAME, .kind = SCENE_NUMBER, .unit = UNIT, .default_value = NAN,                    \
        .offset = SEGMENT_AT(MEMBER), .meaning = "reached at the end of the segment"               \
    }

static const struct scene_field strain_fields[] = {
    COMPONENT(xx, "1", strain[0]),
    COMPONENT(yy, "1", strain[1]),
    COMPONENT(zz, "1", strain[2]),
    COMPONENT(xy, "1", strain[3]),
    COMPONENT(yz, "1", strain[4]),
    COMPONENT(xz, "1", strain[5]),
    {.key = NULL},
};

static const struct scene_field stress_fields[] = {
    COMPONENT(xx, "Pa", stress[0]),
    COMPONENT(yy, "Pa", stress[1]),
    COMPONENT(zz, "Pa", stress[2]),
    COMPONENT(xy, "Pa", stress[3]),
    COMPONENT(yz, "Pa", stress[4]),
    COMPONENT(xz, "Pa", stress[5]),
    {.key = NULL},
};

/* An array of `count` numbers; false (and a mistake) if it is not. */
static bool read_numbers(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, size_t count, const char *unit, double *values)
{
    const struct scene_field field = {.key = path->key, .unit = unit};
    bool valid = true;
    if (!json_is_array(given)) {
        scene_mistake(reader, path, "type", given, json_string("array"),
                      "expected an array of %zu numbers, not %s", count, scene_type_word(given));
        return false;
    }
    if (json_array_size(given) != count) {
        scene_mistake(reader, path, "length", given, json_integer((json_int_t)count),
                      "expected %zu numbers, not %zu", count, json_array_size(given));
        return false;
    }
    for (size_t index = 0; index < count; index++) {
        struct scene_path here = {.parent = path, .index = index};
        if (!scene_number_read(reader, &here, &field, json_array_get(given, index), &values[index]))
            valid = false;
    }
    return valid;
}

static void read_gradient(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *target, json_t *effective)
{
    struct segment_reading *segment = target;
    (void)effective;
    segment->gradient_given = given != NULL;
    if (given != NULL)
        (void)read_numbers(reader, path, given, GRADIENT_ENTRIES, "1", segment->gradient);
}

static const struct scene_field segment_fields[] = {
    {.key = "strain",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = strain_fields,
     .meaning = "components of the total strain"},
    {.key = "stress",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = stress_fields,
     .meaning = "components of the Cauchy stress"},
    {.key = "deformation_gradient",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_gradient,
     .meaning = "F at the end of the segment, row by row; finite strain only"},
    {.key = "steps",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 1.0,
     .maximum = 1e7,
     .whole = true,
     .required = true,
     .default_value = NAN,
     .offset = SEGMENT_AT(steps),
     .meaning = "number of equal steps"},
    {.key = "duration",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .default_value = 1.0,
     .offset = SEGMENT_AT(duration),
     .meaning = "time that the segment takes, for viscous materials"},
    {.key = NULL},
};

/* What the table cannot tell: which components and kinds of control go together. */
static void check_segment(struct scene_reader *reader, const struct scene_path *path,
                          const struct segment_reading *segment, const json_t *given)
{
    struct scene_path stress = {.parent = path, .key = "stress"};
    struct scene_path gradient = {.parent = path, .key = "deformation_gradient"};
    for (size_t component = 0; component < SYM3_COMPONENTS; component++) {
        struct scene_path here = {.parent = &stress, .key = component_names[component]};
        if (!isnan(segment->strain[component]) && !isnan(segment->stress[component]))
            scene_mistake(reader, &here, "contradiction", NULL, NULL,
                          "strain and stress of the component %s are both given",
                          component_names[component]);
    }
    if (segment->gradient_given &&
        (json_object_get(given, "strain") != NULL || json_object_get(given, "stress") != NULL))
        scene_mistake(reader, &gradient, "contradiction", NULL, NULL,
                      "a deformation gradient leaves no strain or stress to give");
}

static void read_segment(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, void *item, json_t *effective)
{
    struct material_point_segment *segment = item;
    struct segment_reading reading = {.steps = 1.0};
    size_t mistakes = reader->issues->count;
    for (size_t component = 0; component < SYM3_COMPONENTS; component++)
        reading.strain[component] = reading.stress[component] = NAN;
    scene_fields_read(reader, path, segment_fields, given, &reading, effective);
    check_segment(reader, path, &reading, given);
    if (reader->issues->count != mistakes)
        return;
    for (size_t component = 0; component < SYM3_COMPONENTS; component++) {
        segment->strain_given[component] = !isnan(reading.strain[component]);
        segment->stress_given[component] = !isnan(reading.stress[component]);
        segment->strain[component] = reading.strain[component];
        segment->stress[component] = reading.stress[component];
    }
    segment->gradient_given = reading.gradient_given;
    memcpy(segment->gradient, reading.gradient, sizeof segment->gradient);
    segment->step_count = (size_t)reading.steps;
    segment->duration = reading.duration;
}

static void read_material(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *target, json_t *effective)
{
    struct scene_point *point = target;
    (void)effective;
    scene_material_read(reader, path, given, &point->material, NULL);
}

static void read_initial_stress(struct scene_reader *reader, const struct scene_path *path,
                                const json_t *given, void *target, json_t *effective)
{
    struct scene_point *point = target;
    (void)effective;
    if (given != NULL)
        (void)read_numbers(reader, path, given, SYM3_COMPONENTS, "Pa", point->initial_stress);
}

static void read_path(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective)
{
    struct scene_point *point = target;
    void *segments = NULL;
    point->segment_count = scene_list_read(reader, path, given, 1, sizeof *point->path, &segments,
                                           effective, read_segment);
    point->path = segments;
}

static const char *const strain_words[] = {"small", "finite", NULL};

static const struct scene_field point_fields[] = {
    {.key = "material",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_material,
     .meaning = "model and parameters, as in a scene"},
    {.key = "strain",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = strain_words,
     .offset = POINT_AT(strain),
     .meaning = "small strain, or finite (Hencky) strain"},
    {.key = "initial_stress",
     .kind = SCENE_CUSTOM,
     .unit = "Pa",
     .read = read_initial_stress,
     .meaning = "six components"},
    {.key = "path",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_path,
     .meaning = "segments, one after the other"},
    {.key = NULL},
};

static void check_gradients(struct scene_reader *reader, const struct scene_point *point)
{
    const struct scene_path path = {.key = "path"};
    for (size_t index = 0; point->strain == 0 && index < point->segment_count; index++) {
        struct scene_path segment = {.parent = &path, .index = index};
        struct scene_path here = {.parent = &segment, .key = "deformation_gradient"};
        if (point->path[index].gradient_given)
            scene_mistake(reader, &here, "contradiction", NULL, NULL,
                          "a deformation gradient needs \"strain\": \"finite\"");
    }
}

enum talus_status scene_point_read(const json_t *root, struct scene_point *point,
                                   struct scene_issues *issues)
{
    struct scene_issues warnings = {0};
    struct scene_reader reader = {.issues = issues, .warnings = &warnings};
    json_t *effective = json_object();
    memset(point, 0, sizeof *point);
    memset(issues, 0, sizeof *issues);
    scene_fields_read(&reader, NULL, point_fields, root, point, effective);
    check_gradients(&reader, point);
    json_decref(effective);
    scene_issues_release(&warnings);
    if (issues->count == 0 && !reader.out_of_memory)
        return TALUS_OK;
    scene_point_release(point);
    return reader.out_of_memory ? TALUS_MEMORY : TALUS_INVALID;
}

enum talus_status scene_point_read_file(const char *path, struct scene_point *point,
                                        struct scene_issues *issues)
{
    json_error_t error;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (root != NULL) {
        enum talus_status status = scene_point_read(root, point, issues);
        json_decref(root);
        return status;
    }
    struct scene_reader reader = {.issues = issues};
    memset(point, 0, sizeof *point);
    memset(issues, 0, sizeof *issues);
    scene_file_mistake(&reader, &error);
    return TALUS_INVALID;
}

struct material_point_path scene_point_path(const struct scene_point *point)
{
    struct material_point_path path = {.finite_strain = point->strain == 1,
                                       .segments = point->path,
                                       .segment_count = point->segment_count};
    memcpy(path.initial_stress, point->initial_stress, sizeof path.initial_stress);
    return path;
}

void scene_point_release(struct scene_point *point)
{
    free(point->material.name);
    free(point->material.values);
    free(point->path);
    memset(point, 0, sizeof *point);
}
