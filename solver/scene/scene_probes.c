/* SPDX-License-Identifier: Apache-2.0 */
/* Probes: what is read from the run at every sample. */
#include "scene/scene_component.h"
#include "scene/scene_face.h"
#include "scene/scene_sections.h"

#include "seeding/seeding.h"

#include <string.h>

struct probe_keys {
    struct talus_probe probe;
    const char *name;
};
#define AT(member) offsetof(struct probe_keys, probe.member)

static const char *const kind_words[] = {"front",    "height", "extent",         "point",
                                         "energy",   "mass",   "centre_of_mass", "reaction",
                                         "integral", NULL};
static const char *const measure_words[] = {"particle", "centre_of_mass", NULL};
static const char *const part_words[] = {"total",      "kinetic",  "strain",    "potential",
                                         "dissipated", "external", "numerical", NULL};
static const char *const face_words[] = {"x_min", "x_max", "y_min", "y_max",
                                         "z_min", "z_max", NULL};
static const char *const quantity_words[] = {"force", "moment", "contact_area", NULL};

/* Keys that go with some kinds only. */
struct kind_key {
    const char *key;
    unsigned kinds; /* bit set of enum talus_probe_kind */
    bool required;
};
#define KIND(name) (1u << TALUS_PROBE_##name)
static const struct kind_key kind_keys[] = {
    {"along", KIND(FRONT) | KIND(EXTENT), true},
    {"along", KIND(HEIGHT), false},
    {"measure", KIND(FRONT) | KIND(HEIGHT) | KIND(EXTENT), false},
    {"at", KIND(POINT), true},
    {"field", KIND(POINT) | KIND(INTEGRAL), true},
    {"component", KIND(POINT) | KIND(INTEGRAL) | KIND(CENTRE_OF_MASS) | KIND(REACTION), false},
    {"part", KIND(ENERGY), false},
    {"boundary", KIND(REACTION), true},
    {"face", KIND(REACTION), false},
    {"quantity", KIND(REACTION), false},
};
enum { KIND_KEY_COUNT = sizeof kind_keys / sizeof kind_keys[0] };

static void read_body(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective)
{
    struct talus_probe *probe = target;
    probe->body_index = given == NULL ? -1 : scene_body_find(reader, path, given);
    if (probe->body_index >= 0)
        scene_put(reader, effective, path->key, json_string(json_string_value(given)));
}

static void read_on(struct scene_reader *reader, const struct scene_path *path, const json_t *given,
                    void *target, json_t *effective)
{
    struct talus_probe *probe = target;
    probe->on_boundary = given == NULL ? -1 : scene_boundary_find(reader, path, given);
    if (probe->on_boundary >= 0)
        scene_put(reader, effective, path->key, json_string(json_string_value(given)));
}

static void read_boundary(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *target, json_t *effective)
{
    struct talus_probe *probe = target;
    probe->boundary_index = given == NULL ? -1 : scene_boundary_find(reader, path, given);
    if (probe->boundary_index >= 0)
        scene_put(reader, effective, path->key, json_string(json_string_value(given)));
}

static json_t *word_schema(void)
{
    return json_pack("{s:s}", "type", "string");
}

static const struct scene_field within_fields[] = {
    {.key = "min",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .default_value = -INFINITY,
     .open = true,
     .offset = AT(within_min),
     .meaning = "lower corner; null: open"},
    {.key = "max",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .default_value = INFINITY,
     .open = true,
     .offset = AT(within_max),
     .meaning = "upper corner; null: open"},
    {.key = NULL},
};

const struct scene_field scene_probe_fields[] = {
    {.key = "name",
     .kind = SCENE_NAME,
     .unit = "1",
     .offset = offsetof(struct probe_keys, name),
     .meaning = "name of the series; default probe_INDEX"},
    {.key = "kind",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .required = true,
     .choices = kind_words,
     .offset = AT(kind),
     .meaning = "what is read"},
    {.key = "body",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_body,
     .schema = word_schema,
     .meaning = "only particles of this body"},
    {.key = "within",
     .kind = SCENE_OBJECT,
     .unit = "m",
     .fields = within_fields,
     .meaning = "only particles in this box"},
    {.key = "on",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_on,
     .schema = word_schema,
     .meaning = "only particles within half a cell of this boundary"},
    {.key = "mean_from",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .default_value = NAN,
     .offset = AT(mean_from),
     .meaning = "adds the mean from this time to the end as a metric"},
    {.key = "along",
     .kind = SCENE_VECTOR,
     .unit = "1",
     .default_value = NAN,
     .offset = AT(along),
     .meaning = "direction; height: default against gravity"},
    {.key = "measure",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .default_value = NAN,
     .choices = measure_words,
     .offset = AT(measure),
     .meaning = "outermost particle plus half its size, or twice the mean distance (Mast 2013, eq. "
                "7.8)"},
    {.key = "at",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .default_value = NAN,
     .offset = AT(at),
     .meaning = "the particle nearest at the start is followed"},
    {.key = "field",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .default_value = NAN,
     .choices = scene_field_words,
     .offset = AT(field),
     .meaning = "particle field"},
    {.key = "component",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .default_value = NAN,
     .choices = scene_component_names,
     .offset = SCENE_NOWHERE,
     .meaning = "x, y, z or xx, ...; default all, one series each"},
    {.key = "part",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .default_value = NAN,
     .choices = part_words,
     .offset = AT(part),
     .meaning = "part of the energy; default total"},
    {.key = "boundary",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_boundary,
     .schema = word_schema,
     .meaning = "boundary whose reaction is read"},
    {.key = "face",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .default_value = NAN,
     .choices = face_words,
     .offset = SCENE_NOWHERE,
     .meaning = "one face of a box (x_min, ...); default the whole boundary"},
    {.key = "quantity",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .default_value = NAN,
     .choices = quantity_words,
     .offset = AT(quantity),
     .meaning = "part of the reaction; default force"},
    {.key = "phase", .unsupported = true},
    {.key = NULL},
};

/* Keys that the kind needs, and keys that it does not know. */
static void check_kind_keys(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, enum talus_probe_kind kind)
{
    for (size_t index = 0; index < KIND_KEY_COUNT; index++) {
        const struct kind_key *entry = &kind_keys[index];
        struct scene_path here = {.parent = path, .key = entry->key};
        bool present = json_object_get(given, entry->key) != NULL;
        bool applies = (entry->kinds & (1u << kind)) != 0;
        bool elsewhere = index > 0 && strcmp(kind_keys[index - 1].key, entry->key) == 0;
        for (size_t other = 0; other < KIND_KEY_COUNT; other++)
            applies |= other != index && strcmp(kind_keys[other].key, entry->key) == 0 &&
                       (kind_keys[other].kinds & (1u << kind)) != 0;
        if (present && !applies && !elsewhere)
            scene_mistake(reader, &here, "unknown_key", NULL, NULL,
                          "'%s' does not apply to the probe kind \"%s\"", entry->key,
                          kind_words[kind]);
        if (!present && entry->required && (entry->kinds & (1u << kind)) != 0)
            scene_mistake(reader, &here, "required", NULL, NULL,
                          "'%s' is required by the probe kind \"%s\"", entry->key,
                          kind_words[kind]);
    }
}

static void finish_along(struct scene_reader *reader, const struct scene_path *path,
                         struct talus_probe *probe, json_t *effective)
{
    struct scene_path here = {.parent = path, .key = "along"};
    enum talus_axis vertical = seeding_vertical_axis(reader->scene);
    if (probe->kind != TALUS_PROBE_FRONT && probe->kind != TALUS_PROBE_HEIGHT &&
        probe->kind != TALUS_PROBE_EXTENT)
        return;
    if (isnan(probe->along[0]) && probe->kind == TALUS_PROBE_HEIGHT) {
        if (vertical == TALUS_NO_AXIS) {
            scene_mistake(reader, &here, "incomplete", NULL, NULL,
                          "without gravity a height needs 'along'");
            return;
        }
        for (size_t k = 0; k < 3; k++)
            probe->along[k] = -reader->scene->gravity[k];
    }
    (void)scene_direction_normalise(reader, &here, probe->along, effective);
}

static void finish_face(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given, struct talus_probe *probe)
{
    const char *face = json_string_value(json_object_get(given, "face"));
    const char *shown[7] = {NULL};
    struct scene_path here = {.parent = path, .key = "face"};
    probe->face_index = -1;
    if (face == NULL || probe->kind != TALUS_PROBE_REACTION || probe->boundary_index < 0 ||
        reader->axis_count == 0)
        return;
    const struct talus_boundary *boundary = &reader->scene->boundaries[probe->boundary_index];
    if (boundary->shape != TALUS_BOUNDARY_BOX) {
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "only boxes have faces that are read apart");
    } else {
        memcpy(shown, face_words, boundary->face_count * sizeof *shown);
        for (int index = 0; shown[index] != NULL; index++) {
            if (strcmp(shown[index], face) == 0)
                probe->face_index = index;
        }
        if (probe->face_index < 0)
            scene_mistake(reader, &here, "dimension", NULL, scene_word_list(shown),
                          "the box has no face '%s'", face);
    }
}

/* Number of components of what the probe reads. */
static size_t component_count(const struct talus_probe *probe)
{
    if (probe->kind == TALUS_PROBE_POINT || probe->kind == TALUS_PROBE_INTEGRAL)
        return scene_field_components(probe->field);
    if (probe->kind == TALUS_PROBE_REACTION && probe->quantity == TALUS_REACTION_CONTACT_AREA)
        return 1;
    return probe->kind == TALUS_PROBE_REACTION || probe->kind == TALUS_PROBE_CENTRE_OF_MASS ? 3 : 1;
}

static void finish_component(struct scene_reader *reader, const struct scene_path *path,
                             const json_t *given, struct talus_probe *probe)
{
    const char *words[10] = {NULL};
    struct scene_path here = {.parent = path, .key = "component"};
    bool moment = probe->kind == TALUS_PROBE_REACTION && probe->quantity == TALUS_REACTION_MOMENT;
    scene_component_words(component_count(probe), reader->axis_count, words);
    if (moment && reader->axis_count == 2) { /* in a plane only the moment about z exists */
        words[0] = words[1] = "";
        words[2] = "z";
        probe->component = 2;
    }
    if (json_object_get(given, "component") != NULL)
        probe->component =
            scene_component_read(reader, &here, json_object_get(given, "component"), words);
}

/* Keys whose default holds for some kinds only. */
static void put_defaults(struct scene_reader *reader, const struct talus_probe *probe,
                         json_t *effective)
{
    switch (probe->kind) {
    case TALUS_PROBE_FRONT:
    case TALUS_PROBE_HEIGHT:
    case TALUS_PROBE_EXTENT:
        scene_put(reader, effective, "measure", json_string(measure_words[probe->measure]));
        break;
    case TALUS_PROBE_ENERGY:
        scene_put(reader, effective, "part", json_string(part_words[probe->part]));
        break;
    case TALUS_PROBE_REACTION:
        scene_put(reader, effective, "quantity", json_string(quantity_words[probe->quantity]));
        break;
    default:
        break;
    }
}

static void read_probe(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *item, json_t *effective)
{
    struct probe_keys keys;
    memset(&keys, 0, sizeof keys);
    struct talus_probe *probe = &keys.probe;
    for (size_t k = 0; k < 3; k++) {
        probe->within_min[k] = -INFINITY;
        probe->within_max[k] = INFINITY;
    }
    probe->along[0] = probe->mean_from = NAN;
    probe->component = probe->face_index = -1;
    probe->kind = (enum talus_probe_kind)TALUS_PROBE_INTEGRAL;
    size_t mistakes = reader->issues->count;
    scene_fields_read(reader, path, scene_probe_fields, given, &keys, effective);
    if (json_object_get(effective, "kind") != NULL) {
        check_kind_keys(reader, path, given, probe->kind);
        put_defaults(reader, probe, effective);
    }
    if (reader->issues->count == mistakes) {
        finish_along(reader, path, probe, effective);
        finish_face(reader, path, given, probe);
        finish_component(reader, path, given, probe);
    }
    struct scene_path mean = {.parent = path, .key = "mean_from"};
    if (probe->mean_from >= reader->scene->duration)
        scene_mistake(reader, &mean, "order", NULL, NULL, "%g s is not before the end at %g s",
                      probe->mean_from, reader->scene->duration);
    probe->name = scene_entry_name(reader, path, keys.name, "probe", effective);
    memcpy(item, probe, sizeof *probe);
}

void scene_probes_read(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    void *items;
    const char *names[SCENE_ENTRY_MAX];
    scene->probe_count = scene_list_read(reader, path, given, 0, sizeof(struct talus_probe), &items,
                                         effective, read_probe);
    scene->probes = items;
    for (size_t index = 0; index < scene->probe_count; index++)
        names[index] = scene->probes[index].name;
    scene_names_check(reader, path, names, scene->probe_count);
}

/* What kind_keys says of one kind. */
static void add_kind_rule(json_t *entry, size_t kind)
{
    const char *without[KIND_KEY_COUNT + 1] = {NULL}, *with[KIND_KEY_COUNT + 1] = {NULL};
    size_t without_count = 0, with_count = 0;
    for (size_t index = 0; index < KIND_KEY_COUNT; index++) {
        const struct kind_key *key = &kind_keys[index];
        bool applies = false;
        for (size_t other = 0; other < KIND_KEY_COUNT; other++)
            applies |= strcmp(kind_keys[other].key, key->key) == 0 &&
                       (kind_keys[other].kinds & (1u << kind)) != 0;
        if (!applies)
            without[without_count++] = key->key;
        if (key->required && (key->kinds & (1u << kind)) != 0)
            with[with_count++] = key->key;
    }
    scene_rule_add(entry, "kind", kind_words[kind], without, with);
}

json_t *scene_probes_schema(void)
{
    json_t *schema = scene_list_schema(scene_probe_fields, 0);
    for (size_t kind = 0; kind_words[kind] != NULL; kind++)
        add_kind_rule(json_object_get(schema, "items"), kind);
    return schema;
}
