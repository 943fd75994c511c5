/* SPDX-License-Identifier: Apache-2.0 */
/* Materials: the parameter table of a model becomes a table of fields, so that reading, schema and
 * description are the same code as everywhere else. */
#include "scene/scene_sections.h"

#include "materials/material.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PREFIX_MAX = 4, MODEL_MAX = 32 };

/* The fields of one model. Nested keys ("friction.a0") become objects. */
struct model_table {
    struct scene_field fields[MATERIAL_PARAMETER_MAX + 16];
    size_t field_count;
    struct scene_field nested[MATERIAL_PARAMETER_MAX + PREFIX_MAX];
    size_t nested_count;
    char prefix[PREFIX_MAX][32];
    size_t prefix_count;
    const char *model_words[2];
};

static void list_models(const char *words[MODEL_MAX + 1])
{
    size_t count = 0;
    for (; count < material_count && count < MODEL_MAX; count++)
        words[count] = material_table[count]->name;
    words[count] = NULL;
}

static struct scene_field field_from_parameter(const struct parameter *parameter, size_t index)
{
    static const enum scene_field_kind kinds[] = {
        [PARAMETER_NUMBER] = SCENE_NUMBER,
        [PARAMETER_BOOLEAN] = SCENE_BOOLEAN,
        [PARAMETER_CHOICE] = SCENE_CHOICE,
    };
    return (struct scene_field){
        .key = parameter->key,
        .kind = kinds[parameter->kind],
        .unit = parameter->unit,
        .minimum = parameter->minimum,
        .maximum = parameter->maximum,
        .above_minimum = parameter->above_minimum,
        .below_maximum = parameter->below_maximum,
        .required = parameter->required,
        .default_value = parameter->default_value,
        .alternative = parameter->alternative,
        .choices = parameter->choices,
        .lacking = parameter->reserved_choices,
        .storage = SCENE_STORE_DOUBLE,
        .offset = index * sizeof(double),
        .meaning = parameter->meaning,
    };
}

/* Adds a key of a nested object; the keys of one object follow each other. */
static void add_nested(struct model_table *table, const struct scene_field *field)
{
    size_t length = strcspn(field->key, ".");
    char *prefix = table->prefix_count > 0 ? table->prefix[table->prefix_count - 1] : NULL;
    if (prefix == NULL || strlen(prefix) != length || strncmp(prefix, field->key, length) != 0) {
        if (table->prefix_count == PREFIX_MAX)
            return;
        if (prefix != NULL)
            table->nested[table->nested_count++].key = NULL;
        prefix = table->prefix[table->prefix_count++];
        (void)snprintf(prefix, sizeof table->prefix[0], "%.*s", (int)length, field->key);
        table->fields[table->field_count++] = (struct scene_field){
            .key = prefix,
            .kind = SCENE_OBJECT,
            .unit = "1",
            .required = field->required,
            .alternative = field->alternative,
            .fields = &table->nested[table->nested_count],
            .meaning = "keys that belong together",
        };
    }
    struct scene_field *entry = &table->nested[table->nested_count++];
    *entry = *field;
    entry->key = field->key + length + 1;
    entry->alternative = NULL;
}

static void model_table_init(struct model_table *table, const struct material *model)
{
    const struct parameter *parameters[MATERIAL_PARAMETER_MAX];
    size_t count = material_parameters(model, parameters, MATERIAL_PARAMETER_MAX);
    memset(table, 0, sizeof *table);
    table->model_words[0] = model->name;
    table->fields[table->field_count++] = (struct scene_field){
        .key = "model",
        .kind = SCENE_CHOICE,
        .unit = "1",
        .required = true,
        .choices = table->model_words,
        .offset = SCENE_NOWHERE,
        .meaning = "name of the model",
    };
    for (size_t index = 0; index < count; index++) {
        struct scene_field field = field_from_parameter(parameters[index], index);
        if (strchr(field.key, '.') != NULL)
            add_nested(table, &field);
        else
            table->fields[table->field_count++] = field;
    }
    for (const char *const *key = model->reserved_keys; key != NULL && *key != NULL; key++) {
        if (table->field_count + 1 < sizeof table->fields / sizeof table->fields[0])
            table->fields[table->field_count++] =
                (struct scene_field){.key = *key, .unsupported = true};
    }
}

/* Lets the model look at all values together. */
static void check_values(struct scene_reader *reader, const struct scene_path *path,
                         const struct material *model, const double *values)
{
    struct material_issue issues[8];
    size_t count = model->check(values, issues, sizeof issues / sizeof issues[0]);
    for (size_t index = 0; index < count; index++) {
        char prefix[64];
        size_t length = strcspn(issues[index].key, ".");
        bool nested = issues[index].key[length] == '.';
        (void)snprintf(prefix, sizeof prefix, "%.*s", (int)length, issues[index].key);
        struct scene_path first = {.parent = path, .key = prefix};
        struct scene_path second = {.parent = &first, .key = issues[index].key + length + 1};
        scene_mistake(reader, nested ? &second : &first, issues[index].code, NULL, NULL, "%s",
                      issues[index].text);
    }
}

/* The model that an entry names, or NULL with a mistake. */
static const struct material *read_model(struct scene_reader *reader, const struct scene_path *path,
                                         const json_t *given)
{
    const char *words[MODEL_MAX + 1];
    const json_t *name = json_object_get(given, "model");
    struct scene_path here = {.parent = path, .key = "model"};
    list_models(words);
    if (!json_is_object(given)) {
        scene_mistake(reader, path, "type", given, json_string("object"),
                      "expected an object, not %s", scene_type_word(given));
        return NULL;
    }
    if (name == NULL) {
        scene_mistake(reader, &here, "required", NULL, scene_word_list(words),
                      "'model' is required: name of the model");
        return NULL;
    }
    int index = scene_choice_read(reader, &here, name, words, NULL);
    return index < 0 ? NULL : material_table[index];
}

void scene_material_read(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, struct talus_material *entry, json_t *effective)
{
    const struct material *model = read_model(reader, path, given);
    entry->name = scene_copy_text(reader, path->key);
    entry->values = calloc(MATERIAL_PARAMETER_MAX, sizeof *entry->values);
    if (entry->values == NULL)
        reader->out_of_memory = true;
    if (model == NULL || entry->values == NULL)
        return;
    for (size_t index = 0; index < MATERIAL_PARAMETER_MAX; index++)
        entry->values[index] = NAN;
    while (material_table[entry->model_index] != model)
        entry->model_index++;
    struct model_table table;
    size_t mistakes = reader->issues->count;
    model_table_init(&table, model);
    scene_fields_read(reader, path, table.fields, given, entry->values, effective);
    if (reader->issues->count == mistakes)
        check_values(reader, path, model, entry->values);
}

void scene_materials_read(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    size_t count = json_object_size(given);
    if (!json_is_object(given)) {
        scene_mistake(reader, path, "type", given, json_string("object"),
                      "expected an object, not %s", scene_type_word(given));
        return;
    }
    if (count < 1 || count > SCENE_MATERIAL_MAX) {
        scene_mistake(reader, path, "length", NULL, NULL, "expected 1 to %d materials, not %zu",
                      SCENE_MATERIAL_MAX, count);
        return;
    }
    scene->materials = calloc(count, sizeof *scene->materials);
    if (scene->materials == NULL) {
        reader->out_of_memory = true;
        return;
    }
    json_t *inner = json_object();
    scene_put(reader, effective, path->key, inner);
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)given, name, value)
    { /* the iterator does not write */
        struct scene_path here = {.parent = path, .key = name};
        json_t *entry = json_object();
        if (name[0] == '\0' || scene_character_count(name) > 48)
            scene_mistake(reader, &here, "name", NULL, NULL, "a name has 1 to 48 characters");
        scene_material_read(reader, &here, value, &scene->materials[scene->material_count++],
                            entry);
        scene_put(reader, inner, name, entry);
    }
}

json_t *scene_materials_schema(void)
{
    json_t *models = json_array();
    for (size_t index = 0; index < material_count; index++) {
        struct model_table table;
        model_table_init(&table, material_table[index]);
        (void)json_array_append_new(models, scene_fields_schema(table.fields));
    }
    return json_pack("{s:s, s:i, s:i, s:{s:i, s:i}, s:{s:o}}", "type", "object", "minProperties", 1,
                     "maxProperties", (int)SCENE_MATERIAL_MAX, "propertyNames", "minLength", 1,
                     "maxLength", 48, "additionalProperties", "oneOf", models);
}

json_t *scene_materials_describe(void)
{
    json_t *models = json_array();
    for (size_t index = 0; index < material_count; index++) {
        const struct material *model = material_table[index];
        struct model_table table;
        model_table_init(&table, model);
        (void)json_array_append_new(models, json_pack("{s:s, s:s, s:s, s:o}", "model", model->name,
                                                      "summary", model->summary, "reference",
                                                      model->reference, "parameters",
                                                      scene_fields_describe(table.fields)));
    }
    return models;
}
