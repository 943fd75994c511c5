/* SPDX-License-Identifier: Apache-2.0 */
/* The OpenAPI 3.1 document of the interface, made of routes.def, the operations and their tables.
 */
#ifndef TALUS_OPENAPI_H
#define TALUS_OPENAPI_H

#include <jansson.h>

/* The whole document, with the JSON Schema of scenes (borrowed) as a component. New reference; NULL
 * or an incomplete one if memory is short. */
json_t *openapi_document(const json_t *scene_schema);

#endif
