/* SPDX-License-Identifier: Apache-2.0 */
/* Every route says what it takes and answers, and the document tells it. */
#include "openapi.h"
#include "request.h"
#include "server_fixture.h"

#include <string.h>

static size_t wildcard_count(const char *path)
{
    size_t count = 0;
    for (; *path != '\0'; path++)
        count += path[0] == '*' && path[1] != '*';
    return count;
}

static size_t field_count(const struct json_field *field)
{
    size_t count = 0;
    for (; field != NULL && field->key != NULL; field++) {
        assert_non_null(field->meaning);
        count++;
    }
    return count;
}

static void test_every_route_has_its_operation(void **state)
{
    (void)state;
    for (size_t index = 0; index < request_route_count; index++) {
        const struct route *route = &request_routes[index];
        const struct operation *operation = route->operation;
        assert_non_null(operation->summary);
        assert_true(strlen(operation->summary) > 8);
        assert_int_equal(field_count(operation->path), wildcard_count(route->path));
        (void)field_count(operation->query);
        (void)field_count(operation->headers);
        assert_non_null(operation->responses);
        assert_in_range(operation->responses[0].status, 200, 299);
        for (size_t other = 0; other < index; other++)
            assert_string_not_equal(route->name, request_routes[other].name);
    }
}

/* The value at a path of keys, which end with NULL. */
static json_t *find(json_t *root, const char *const *keys)
{
    for (; *keys != NULL && root != NULL; keys++)
        root = json_object_get(root, *keys);
    return root;
}
#define FIND(root, ...) find(root, (const char *const[]){__VA_ARGS__, NULL})

static void test_document(void **state)
{
    (void)state;
    json_t *scene = json_pack("{s:s, s:s}", "$schema", "x", "type", "object");
    json_t *document = openapi_document(scene);
    assert_string_equal(json_string_value(FIND(document, "openapi")), "3.1.0");
    json_t *list = FIND(document, "paths", "/v1/jobs", "get");
    assert_string_equal(json_string_value(FIND(list, "operationId")), "job_list");
    assert_int_equal(json_array_size(FIND(list, "parameters")), 7);
    json_t *series = FIND(document, "paths", "/v1/jobs/{id}/series/{name}", "get", "responses",
                          "200", "content");
    assert_int_equal(json_object_size(series), 2);
    assert_non_null(FIND(document, "paths", "/v1/jobs/{id}/files/{name}", "head"));
    assert_non_null(FIND(document, "paths", "/v1/jobs/{id}/frames/{n}.png", "get"));
    json_t *limits = FIND(document, "components", "schemas", "Submission", "properties", "limits");
    assert_true(json_is_false(FIND(limits, "additionalProperties")));
    assert_int_equal(json_integer_value(FIND(limits, "properties", "memory_bytes", "minimum")),
                     1 << 20);
    assert_null(FIND(document, "components", "schemas", "Scene", "$schema"));
    assert_string_equal(json_string_value(FIND(document, "components", "schemas", "Scene", "type")),
                        "object");
    json_decref(document);
    json_decref(scene);
}

/* Every member of the document that could not be made is missing: follow all references. */
static void check_references(json_t *document, json_t *value)
{
    const char *key;
    json_t *member;
    size_t index;
    const char *reference = json_string_value(json_object_get(value, "$ref"));
    if (reference != NULL) {
        char part[32], name[64];
        assert_int_equal(sscanf(reference, "#/components/%31[^/]/%63s", part, name), 2);
        assert_non_null(FIND(document, "components", part, name));
    }
    json_object_foreach(value, key, member) check_references(document, member);
    json_array_foreach(value, index, member) check_references(document, member);
}

static void test_references(void **state)
{
    (void)state;
    json_t *scene = json_pack("{s:s}", "type", "object");
    json_t *document = openapi_document(scene);
    check_references(document, document);
    const char *path, *method, *status;
    json_t *entry, *operation, *response;
    json_object_foreach(FIND(document, "paths"), path, entry)
    {
        json_object_foreach(entry, method, operation)
        {
            json_object_foreach(FIND(operation, "responses"), status, response)
            {
                const char *name;
                json_t *header;
                assert_true(json_is_object(response));
                json_object_foreach(FIND(response, "headers"), name, header)
                    assert_true(json_is_object(header));
            }
        }
    }
    json_decref(document);
    json_decref(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_route_has_its_operation),
        cmocka_unit_test(test_document),
        cmocka_unit_test(test_references),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
