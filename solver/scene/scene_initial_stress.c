/* SPDX-License-Identifier: Apache-2.0 */
/* The stress of a body at the start: none, hydrostatic, geostatic or six components. */
#include "scene/scene_sections.h"

#include <string.h>

#define AT(member) offsetof(struct talus_body, member)

static const char *const k0_words[] = {"elastic", "jaky", "auto", NULL};

static const struct scene_field k0_field = {
    .key = "k0",
    .kind = SCENE_NUMBER,
    .unit = "1",
    .minimum = 0.0,
    .maximum = 100.0,
};

static void read_k0(struct scene_reader *reader, const struct scene_path *path, const json_t *given,
                    void *target, json_t *effective)
{
    struct talus_body *body = target;
    if (json_is_number(given)) {
        body->k0_rule = TALUS_K0_GIVEN;
        if (scene_number_read(reader, path, &k0_field, given, &body->k0))
            scene_put(reader, effective, path->key, json_real(body->k0));
        return;
    }
    int rule = given == NULL ? 2 : scene_choice_read(reader, path, given, k0_words, NULL);
    if (rule < 0)
        return;
    body->k0_rule = (enum talus_k0)(TALUS_K0_ELASTIC + rule);
    scene_put(reader, effective, path->key, json_string(k0_words[rule]));
}

static json_t *k0_schema(void)
{
    return json_pack("{s:[o, o]}", "oneOf", scene_field_schema(&k0_field),
                     json_pack("{s:o}", "enum", scene_word_list(k0_words)));
}

static const struct scene_field geostatic_fields[] = {
    {.key = "k0",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_k0,
     .schema = k0_schema,
     .meaning = "horizontal over vertical stress: a number, \"elastic\", \"jaky\" or \"auto\""},
    {.key = "surcharge",
     .kind = SCENE_NUMBER,
     .unit = "Pa",
     .minimum = 0.0,
     .maximum = INFINITY,
     .offset = AT(surcharge),
     .meaning = "pressure on the top of the body"},
    {.key = NULL},
};

static const struct scene_field hydrostatic_fields[] = {
    {.key = "surface",
     .kind = SCENE_NUMBER,
     .unit = "m",
     .default_value = NAN,
     .offset = AT(surface),
     .meaning = "coordinate of the surface on the vertical axis; default the top of the body"},
    {.key = NULL},
};

static const struct scene_field rule_fields[] = {
    {.key = "hydrostatic",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .required = true,
     .alternative = "rule",
     .fields = hydrostatic_fields,
     .meaning = "pressure of a fluid at rest"},
    {.key = "geostatic",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .required = true,
     .alternative = "rule",
     .fields = geostatic_fields,
     .meaning = "weight of what lies above, and K0 times that to the sides"},
    {.key = NULL},
};

static const struct scene_field stress_field = {.key = "stress", .unit = "Pa"};

static void read_components(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, struct talus_body *body, json_t *effective)
{
    static const char *const names[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
    if (json_array_size(given) != 6) {
        scene_mistake(reader, path, "length", given, json_integer(6),
                      "a stress has six components (xx, yy, zz, xy, yz, xz), not %zu",
                      json_array_size(given));
        return;
    }
    json_t *list = json_array();
    body->initial_stress = TALUS_INITIAL_GIVEN;
    for (size_t k = 0; k < 6; k++) {
        struct scene_path here = {.parent = path, .index = k};
        const json_t *entry = json_array_get(given, k);
        bool absent = (reader->axis_count == 1 && k >= 3) || (reader->axis_count == 2 && k >= 4);
        if (scene_number_read(reader, &here, &stress_field, entry, &body->stress[k]) && absent &&
            body->stress[k] != 0.0)
            scene_mistake(reader, &here, "contradiction", entry, json_integer(0),
                          "the component %s is zero in this dimension", names[k]);
        if (json_array_append_new(list, json_real(body->stress[k])) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, path->key, list);
}

static void read_word(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, struct talus_body *body, json_t *effective)
{
    static const char *const words[] = {"none", "hydrostatic", NULL};
    int word = given == NULL ? 0 : scene_choice_read(reader, path, given, words, NULL);
    if (word < 0)
        return;
    body->initial_stress = word == 0 ? TALUS_INITIAL_NONE : TALUS_INITIAL_HYDROSTATIC;
    scene_put(reader, effective, path->key, json_string(words[word]));
}

void scene_initial_stress_read(struct scene_reader *reader, const struct scene_path *path,
                               const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    if (json_is_array(given)) {
        read_components(reader, path, given, body, effective);
    } else if (!json_is_object(given)) {
        read_word(reader, path, given, body, effective);
    } else {
        json_t *inner = json_object();
        scene_fields_read(reader, path, rule_fields, given, body, inner);
        body->initial_stress = json_object_get(given, "geostatic") != NULL
                                   ? TALUS_INITIAL_GEOSTATIC
                                   : TALUS_INITIAL_HYDROSTATIC;
        if (body->initial_stress == TALUS_INITIAL_HYDROSTATIC && isnan(body->surface)) {
            json_decref(inner); /* the short form says the same */
            inner = json_string("hydrostatic");
        }
        scene_put(reader, effective, path->key, inner);
    }
}

json_t *scene_initial_stress_schema(void)
{
    return json_pack("{s:[{s:[s, s]}, o, {s:s, s:i, s:i, s:o}]}", "oneOf", "enum", "none",
                     "hydrostatic", scene_fields_schema(rule_fields), "type", "array", "minItems",
                     6, "maxItems", 6, "items", scene_number_schema(&stress_field));
}
