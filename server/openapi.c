/* SPDX-License-Identifier: Apache-2.0 */
/* Missing memory shows as members that are missing: jansson's setters refuse NULL values. */
#include "openapi.h"

#include "request.h"
#include "schemas.h"
#include "talus/version.h"

#include <stdio.h>
#include <string.h>

static void put(json_t *object, const char *key, json_t *value)
{
    (void)json_object_set_new(object, key, value);
}

/* "v1/jobs/" + "*" -> "/v1/jobs/{id}". */
static void path_print(const struct route *route, char *path, size_t size)
{
    const struct json_field *name = route->operation->path;
    size_t length = 1;
    (void)snprintf(path, size, "/");
    for (const char *in = route->path; *in != '\0' && length + 1 < size; in++) {
        if (*in != '*') {
            path[length++] = *in;
            path[length] = '\0';
            continue;
        }
        const char *key = name == NULL || name->key == NULL ? "" : name->key;
        int added = snprintf(path + length, size - length, "{%s}", key);
        length += added < 0 ? 0 : (size_t)added;
        name += name != NULL && name->key != NULL;
        in += in[1] == '*';
    }
}

static json_t *parameter_json(const struct json_field *field, const char *place, json_t *named)
{
    struct json_field plain = *field;
    plain.meaning = NULL;
    const bool required = strcmp(place, "path") == 0 || !field->optional;
    return json_pack("{s:s, s:s, s:b, s:s, s:o}", "name", field->key, "in", place, "required",
                     required, "description", field->meaning == NULL ? "" : field->meaning,
                     "schema", json_field_schema(&plain, named));
}

static void add_parameters(json_t *list, const struct json_field *field, const char *place,
                           json_t *named)
{
    for (; field != NULL && field->key != NULL; field++)
        (void)json_array_append_new(list, parameter_json(field, place, named));
}

static json_t *header_json(const char *name)
{
    static const char *const meanings[][2] = {
#define RESPONSE_HEADER(name, meaning) {name, meaning},
#include "response_headers.def"
#undef RESPONSE_HEADER
    };
    for (size_t index = 0; index < sizeof meanings / sizeof meanings[0]; index++) {
        if (strcmp(meanings[index][0], name) == 0)
            return json_pack("{s:s, s:{s:s}}", "description", meanings[index][1], "schema", "type",
                             "string");
    }
    return NULL; /* a unit test finds it missing */
}

static json_t *media_json(const struct response *response, json_t *named)
{
    if (response->schema != NULL)
        return json_pack("{s:o}", "schema", json_field_schema(response->schema, named));
    if (strncmp(response->type, "text/", 5) == 0)
        return json_pack("{s:{s:s}}", "schema", "type", "string");
    return json_object(); /* bytes */
}

static void add_responses(json_t *responses, const struct operation *operation, bool head,
                          json_t *named)
{
    for (const struct response *response = operation->responses; response->status != 0;
         response++) {
        char status[16];
        (void)snprintf(status, sizeof status, "%u", response->status);
        json_t *entry = json_object_get(responses, status);
        if (entry == NULL) {
            put(responses, status, json_pack("{s:s}", "description", response->meaning));
            entry = json_object_get(responses, status);
        }
        if (response->headers != NULL && json_object_get(entry, "headers") == NULL) {
            json_t *headers = json_object();
            for (size_t index = 0; response->headers[index] != NULL; index++)
                put(headers, response->headers[index], header_json(response->headers[index]));
            put(entry, "headers", headers);
        }
        if (response->type == NULL || head)
            continue;
        if (json_object_get(entry, "content") == NULL)
            put(entry, "content", json_object());
        put(json_object_get(entry, "content"), response->type, media_json(response, named));
    }
}

static void add_problem(json_t *responses, unsigned int status, bool head)
{
    char key[16];
    (void)snprintf(key, sizeof key, "%u", status);
    put(responses, key,
        json_pack("{s:s+}", "$ref", "#/components/responses/",
                  head ? "ProblemWithoutBody" : "Problem"));
}

static void add_problems(json_t *responses, const struct operation *operation, bool head)
{
    static const unsigned int common[] = {400, 401, 403, 413, 414, 422, 431, 503};
    for (size_t index = 0; index < sizeof common / sizeof common[0]; index++)
        add_problem(responses, common[index], head);
    if (operation->path != NULL)
        add_problem(responses, MHD_HTTP_NOT_FOUND, head);
    if (operation->body != NULL)
        add_problem(responses, MHD_HTTP_UNSUPPORTED_MEDIA_TYPE, head);
    for (size_t index = 0; operation->problems != NULL && operation->problems[index] != 0; index++)
        add_problem(responses, operation->problems[index], head);
}

/* The parts of the interface, in alphabetical order; what begins as no other is the service's. */
static const struct {
    const char *name, *beginning, *meaning;
} tags[] = {
    {"jobs", "v1/jobs", "one run of one scene, and what it leaves behind"},
    {"service", "", "the daemon itself, and what needs no job"},
    {"studies", "v1/studies", "many runs of one scene with changes"},
};
enum { TAG_COUNT = sizeof tags / sizeof tags[0], TAG_SERVICE = 1 };

static json_t *tag_json(const char *path)
{
    size_t found = TAG_SERVICE;
    for (size_t index = 0; index < TAG_COUNT; index++) {
        if (index != TAG_SERVICE &&
            strncmp(path, tags[index].beginning, strlen(tags[index].beginning)) == 0)
            found = index;
    }
    return json_string(tags[found].name);
}

static json_t *tags_json(void)
{
    json_t *list = json_array();
    for (size_t index = 0; index < TAG_COUNT; index++)
        (void)json_array_append_new(list, json_pack("{s:s, s:s}", "name", tags[index].name,
                                                    "description", tags[index].meaning));
    return list;
}

/* Who may call it. */
static const char *role_meaning(const struct route *route)
{
    static const char *const meanings[] = {
        [ROLE_ANYONE] = "Needs no token, wherever the daemon listens.",
        [ROLE_READ] = "Where tokens are asked for: for every token.",
        [ROLE_SUBMIT] = "Where tokens are asked for: for the roles submit and admin.",
        [ROLE_ADMIN] = "Where tokens are asked for: for the role admin.",
    };
    if (route->role == ROLE_SUBMIT && strchr(route->path, '*') != NULL)
        return "Where tokens are asked for: for the one that submitted it, and the role admin.";
    return meanings[route->role];
}

static json_t *operation_json(const struct route *route, bool head, json_t *named)
{
    const struct operation *operation = route->operation;
    json_t *parameters = json_array(), *responses = json_object();
    add_parameters(parameters, operation->path, "path", named);
    add_parameters(parameters, operation->query, "query", named);
    add_parameters(parameters, operation->headers, "header", named);
    add_responses(responses, operation, head, named);
    add_problems(responses, operation, head);
    json_t *object =
        json_pack("{s:s+, s:s+, s:s, s:[o]}", "operationId", head ? "head_" : "", route->name,
                  "summary", operation->summary, head ? ", without its body" : "", "description",
                  role_meaning(route), "tags", tag_json(route->path));
    if (route->role == ROLE_ANYONE)
        put(object, "security", json_array());
    if (json_array_size(parameters) > 0)
        put(object, "parameters", json_incref(parameters));
    if (operation->body != NULL)
        put(object, "requestBody",
            json_pack("{s:b, s:{s:{s:o}}}", "required", 1, "content", "application/json", "schema",
                      json_field_schema(operation->body, named)));
    put(object, "responses", responses);
    json_decref(parameters);
    return object;
}

static void lower_print(char *text, size_t size, const char *method)
{
    size_t length = 0;
    for (; method[length] != '\0' && length + 1 < size; length++)
        text[length] = (char)(method[length] | 0x20);
    text[length] = '\0';
}

static json_t *paths_json(json_t *named)
{
    json_t *paths = json_object();
    for (size_t index = 0; index < request_route_count; index++) {
        const struct route *route = &request_routes[index];
        char path[256], method[16];
        path_print(route, path, sizeof path);
        lower_print(method, sizeof method, route->method);
        if (json_object_get(paths, path) == NULL)
            put(paths, path, json_object());
        json_t *entry = json_object_get(paths, path);
        put(entry, method, operation_json(route, false, named));
        if (strcmp(method, "get") == 0)
            put(entry, "head", operation_json(route, true, named));
    }
    return paths;
}

json_t *openapi_document(const json_t *scene_schema)
{
    static const char license[] = "https://www.apache.org/licenses/LICENSE-2.0";
    json_t *named = json_object(), *scene = json_deep_copy(scene_schema);
    json_t *paths = paths_json(named);
    json_t *problem = json_field_schema(&schema_problem, named);
    (void)json_object_del(scene, "$schema"); /* the document's own dialect is the same */
    put(named, "Scene", scene);
    return json_pack(
        "{s:s, s:{s:s, s:s, s:s, s:{s:s, s:s}}, s:[{s:s}], s:o, s:[{}, {s:[]}], s:o, "
        "s:{s:o, s:{s:{s:s, s:{s:{s:o}}, s:{s:o}}, s:{s:s}}, s:{s:{s:s, s:s}}}}",
        "openapi", "3.1.0", "info", "title", "Talus", "version", TALUS_VERSION, "description",
        "A service for the Material Point Method. SI units; angles in degrees.", "license", "name",
        "Apache-2.0", "url", license, "servers", "url", "/", "tags", tags_json(), "security",
        "token", "paths", paths, "components", "schemas", named, "responses", "Problem",
        "description", "what is wrong (RFC 9457), all mistakes at once", "content",
        "application/problem+json", "schema", problem, "headers", "Retry-After",
        header_json("Retry-After"), "ProblemWithoutBody", "description",
        "what is wrong, in the status", "securitySchemes", "token", "type", "http", "scheme",
        "bearer");
}
