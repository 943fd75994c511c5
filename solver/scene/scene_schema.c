/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_sections.h"

json_t *scene_schema(void)
{
    json_t *schema =
        json_pack("{s:s, s:s, s:s}", "$schema", "https://json-schema.org/draft/2020-12/schema",
                  "title", "Talus scene", "description",
                  "A scene of the Material Point Method. SI units, angles in degrees, "
                  "tension positive.");
    json_t *root = scene_fields_schema(scene_root_fields);
    if (json_object_update_missing(schema, root) != 0) {
        json_decref(schema);
        schema = NULL;
    }
    json_decref(root);
    return schema;
}
