/* SPDX-License-Identifier: Apache-2.0 */
/* Everything a scene can say, out of the tables that read it. */
#include "scene/scene_condition.h"
#include "scene/scene_sections.h"

#include "shapes/shape.h"
#include "talus/version.h"
#include "transfers/velocity_transfer.h"

static json_t *describe_particle_fields(void)
{
    json_t *list = json_array();
#define TALUS_FIELD(ENUM, name, components, unit, text)                                            \
    (void)json_array_append_new(list,                                                              \
                                json_pack("{s:s, s:i, s:s, s:s}", "field", #name, "components",    \
                                          components, "unit", unit, "meaning", text));
#include "talus/fields.def"
#undef TALUS_FIELD
    return list;
}

static json_t *describe_shapes(void)
{
    json_t *list = json_array();
    for (size_t index = 0; index < shape_count; index++)
        (void)json_array_append_new(list,
                                    json_pack("{s:s, s:s, s:s}", "shape", shape_table[index]->name,
                                              "summary", shape_table[index]->summary, "reference",
                                              shape_table[index]->reference));
    return list;
}

static json_t *describe_transfers(void)
{
    json_t *list = json_array();
    for (size_t index = 0; index < transfer_count; index++)
        (void)json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "transfer",
                                                    transfer_table[index]->name, "summary",
                                                    transfer_table[index]->summary, "reference",
                                                    transfer_table[index]->reference));
    return list;
}

static json_t *describe_codes(void)
{
    enum { STRUCTURE, MEANING, FORM };
    static const char *const classes[] = {"structure", "meaning", "form"};
    json_t *list = json_array();
#define SCENE_CODE(code, CLASS, text)                                                              \
    (void)json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "code", #code, "class",         \
                                                classes[CLASS], "meaning", text));
#include "scene/scene_codes.def"
#undef SCENE_CODE
    return list;
}

json_t *scene_describe(void)
{
    static const struct {
        const char *part;
        const struct scene_field *table;
    } parts[] = {
        {"scene", scene_root_fields},           {"grid", scene_grid_fields},
        {"solver", scene_solver_fields},        {"bodies", scene_body_fields},
        {"boundaries", scene_boundary_fields},  {"probes", scene_probe_fields},
        {"references", scene_reference_fields}, {"output", scene_output_fields},
    };
    json_t *answer = json_pack("{s:s, s:s}", "build", talus_build(), "units",
                               "SI; angles in degrees; tension positive");
    for (size_t index = 0; index < sizeof parts / sizeof parts[0]; index++)
        (void)json_object_set_new(answer, parts[index].part,
                                  scene_fields_describe(parts[index].table));
    (void)json_object_set_new(answer, "materials", scene_materials_describe());
    (void)json_object_set_new(answer, "shapes", describe_shapes());
    (void)json_object_set_new(answer, "transfers", describe_transfers());
    (void)json_object_set_new(answer, "conditions", scene_conditions_describe());
    (void)json_object_set_new(answer, "fields", describe_particle_fields());
    (void)json_object_set_new(answer, "codes", describe_codes());
    return answer;
}
