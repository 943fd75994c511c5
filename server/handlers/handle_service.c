/* SPDX-License-Identifier: Apache-2.0 */
/* Version, liveness, readiness, and the JSON Schema of scenes. */
#include "access.h"
#include "audit.h"
#include "calibration.h"
#include "conditional.h"
#include "folder.h"
#include "helper.h"
#include "openapi.h"
#include "request.h"
#include "schemas.h"
#include "service.h"
#include "talus/version.h"

const struct operation operation_version = {
    .summary = "Version and build of the daemon",
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_version,
                                            .meaning = "what runs here"},
                                           RESPONSE_END},
};

enum handled handle_version(struct request *request)
{
    struct calibration_summary quality;
    calibration_summarise(request->service->calibration, &quality);
    json_t *recent = quality.judged > 0 ? json_real(quality.recent) : NULL;
    reply_json(&request->reply, MHD_HTTP_OK,
               json_pack("{s:s, s:s, s:s, s:s, s:{s:I, s:I, s:o*, s:I}}", "name", "talus",
                         "version", TALUS_VERSION, "build", talus_build(), "api", "v1", "forecasts",
                         "judged", (json_int_t)quality.judged, "inside", (json_int_t)quality.inside,
                         "inside_ratio", recent, "learned", (json_int_t)quality.names));
    return HANDLED;
}

static const struct response status_response[] = {
    {.status = 200, .type = "application/json", .schema = &schema_status, .meaning = "all is well"},
    RESPONSE_END};

const struct operation operation_healthz = {
    .summary = "Whether the daemon is alive",
    .responses = status_response,
};

enum handled handle_healthz(struct request *request)
{
    reply_json(&request->reply, MHD_HTTP_OK, json_pack("{s:s}", "status", "ok"));
    return HANDLED;
}

const struct operation operation_readyz = {
    .summary =
        "Whether the daemon takes jobs: 503 while it stops, the disk is low, the store fails",
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_readiness,
                                            .meaning = "it does"},
                                           RESPONSE_END},
};

/* What an operator should look at while work goes on; for anyone to read. */
static json_t *warnings_json(struct service *service)
{
    json_t *warnings = json_array();
    if (access_is_stale(service->access))
        (void)json_array_append_new(warnings, json_string("the token file has mistakes: the tokens "
                                                          "of before are in force"));
    if (audit_lost_count(service->audit) > 0)
        (void)json_array_append_new(warnings, json_string("the audit log lacks lines"));
    return warnings;
}

enum handled handle_readyz(struct request *request)
{
    struct service *service = request->service;
    const char *reason = NULL;
    if (atomic_load(&service->draining))
        reason = "the daemon is stopping";
    else if (!store_healthy(service->store))
        reason = "the store does not take writes";
    else if (folder_free_bytes(service->state) < service->config->disk_reserve_bytes)
        reason = "the disk is nearly full";
    if (reason == NULL)
        reply_json(&request->reply, MHD_HTTP_OK,
                   json_pack("{s:s, s:o}", "status", "ready", "warnings", warnings_json(service)));
    else
        reply_problem(&request->reply, MHD_HTTP_SERVICE_UNAVAILABLE, "not_ready", request->raw,
                      NULL, "%s", reason);
    return HANDLED;
}

/* The schema that a helper tells, or NULL with the reply made; new reference. */
static json_t *schema_ask(struct request *request)
{
    struct talus_error error = {0};
    json_t *answer = NULL;
    json_t *question = json_pack("{s:s}", "op", "schema");
    enum talus_status status = helper_ask(
        request->helper, question, request->service->config->helper_seconds, &answer, &error);
    json_decref(question);
    json_t *schema = json_incref(json_object_get(answer, "schema"));
    json_decref(answer);
    if (status != TALUS_OK)
        reply_error(&request->reply, request->raw, &error);
    else if (schema == NULL)
        reply_problem(&request->reply, MHD_HTTP_SERVICE_UNAVAILABLE, "schema", request->raw, NULL,
                      "the worker program tells no schema");
    return schema;
}

/* A copy of the schema of scenes, or NULL with the reply made; new reference. */
static json_t *schema_copy(struct request *request)
{
    struct service *service = request->service;
    (void)pthread_mutex_lock(&service->schema_mutex);
    if (service->schema == NULL)
        service->schema = schema_ask(request);
    json_t *schema = service->schema == NULL ? NULL : json_deep_copy(service->schema);
    (void)pthread_mutex_unlock(&service->schema_mutex);
    return schema;
}

const struct operation operation_scene_schema = {
    .summary = "JSON Schema (2020-12) of scenes",
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/schema+json",
                                            .schema = &schema_any_object,
                                            .headers = conditional_headers,
                                            .meaning = "the schema"},
                                           CONDITIONAL_UNCHANGED,
                                           RESPONSE_END},
    .problems = conditional_problems,
};

enum handled handle_scene_schema(struct request *request)
{
    json_t *schema = schema_copy(request);
    if (schema != NULL)
        conditional_document(request, "application/schema+json", schema);
    return HANDLED;
}

const struct operation operation_openapi = {
    .summary = "This interface as an OpenAPI 3.1 document",
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_any_object,
                                            .meaning = "the document"},
                                           RESPONSE_END},
};

enum handled handle_openapi(struct request *request)
{
    json_t *scene = schema_copy(request);
    if (scene != NULL)
        reply_json(&request->reply, MHD_HTTP_OK, openapi_document(scene));
    json_decref(scene);
    return HANDLED;
}
