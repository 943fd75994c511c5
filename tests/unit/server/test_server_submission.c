/* SPDX-License-Identifier: Apache-2.0 */
/* Each mistake in what surrounds a scene is told with its pointer, all at once. */
#include "server_fixture.h"
#include "submission.h"

#include <string.h>

static json_t *mistakes(const char *body, struct job *job)
{
    const json_t *scene;
    json_t *root = json_loads(body, 0, NULL), *errors = json_array();
    assert_non_null(root);
    memset(job, 0, sizeof *job);
    submission_read(root, 8, job, &scene, errors);
    json_decref(root);
    return errors;
}

static void expect(const char *body, const char *pointer, const char *code)
{
    struct job job;
    json_t *errors = mistakes(body, &job);
    if (json_array_size(errors) != 1)
        fail_msg("%zu mistakes in %s", json_array_size(errors), body);
    const json_t *issue = json_array_get(errors, 0);
    assert_string_equal(json_string_value(json_object_get(issue, "pointer")), pointer);
    assert_string_equal(json_string_value(json_object_get(issue, "code")), code);
    json_decref(errors);
    job_release(&job);
}

static void test_good(void **state)
{
    struct job job;
    (void)state;
    json_t *errors =
        mistakes("{\"scene\":{},\"name\":\"n\",\"labels\":{\"k\":\"v\"},\"priority\":-7,"
                 "\"threads\":3,\"limits\":{\"wall_seconds\":1.5,\"memory_bytes\":1e9,"
                 "\"disk_bytes\":1000000},\"retries\":0,\"reuse\":false}",
                 &job);
    assert_int_equal(json_array_size(errors), 0);
    assert_string_equal(job.name, "n");
    assert_string_equal(job.labels, "{\"k\":\"v\"}");
    assert_int_equal(job.priority, -7);
    assert_int_equal(job.threads, 3);
    assert_true(job.wall_limit == 1.5);
    assert_int_equal(job.memory_limit, 1000000000);
    assert_int_equal(job.disk_limit, 1000000);
    assert_int_equal(job.retries, 0);
    json_decref(errors);
    job_release(&job);
}

static void test_defaults(void **state)
{
    struct job job;
    (void)state;
    json_t *errors = mistakes("{\"scene\":{}}", &job);
    assert_int_equal(json_array_size(errors), 0);
    assert_int_equal(job.threads, 1);
    assert_int_equal(job.retries, 2);
    assert_int_equal(job.priority, 0);
    json_decref(errors);
}

static void test_single_mistakes(void **state)
{
    (void)state;
    expect("{}", "/scene", "required");
    expect("[]", "", "type");
    expect("{\"scene\":{},\"nmae\":\"x\"}", "/nmae", "unknown_key");
    expect("{\"scene\":{},\"a/b~c\":1}", "/a~1b~0c", "unknown_key");
    expect("{\"scene\":{},\"name\":5}", "/name", "type");
    expect("{\"scene\":{},\"labels\":[]}", "/labels", "type");
    expect("{\"scene\":{},\"labels\":{\"a\":1}}", "/labels/a", "type");
    expect("{\"scene\":{},\"priority\":101}", "/priority", "range");
    expect("{\"scene\":{},\"priority\":1.5}", "/priority", "type");
    expect("{\"scene\":{},\"priority\":\"1\"}", "/priority", "type");
    expect("{\"scene\":{},\"threads\":9}", "/threads", "capacity");
    expect("{\"scene\":{},\"threads\":4097}", "/threads", "range");
    expect("{\"scene\":{},\"labels\":{\"a:b\":\"c\"}}", "/labels/a:b", "pattern");
    expect("{\"scene\":{},\"threads\":-1}", "/threads", "range");
    expect("{\"scene\":{},\"retries\":-1}", "/retries", "range");
    expect("{\"scene\":{},\"limits\":5}", "/limits", "type");
    expect("{\"scene\":{},\"limits\":{\"wall\":5}}", "/limits/wall", "unknown_key");
    expect("{\"scene\":{},\"limits\":{\"wall_seconds\":0}}", "/limits/wall_seconds", "range");
    expect("{\"scene\":{},\"limits\":{\"memory_bytes\":5}}", "/limits/memory_bytes", "range");
    expect("{\"scene\":{},\"reuse\":1}", "/reuse", "type");
}

static void test_all_at_once(void **state)
{
    struct job job;
    (void)state;
    json_t *errors =
        mistakes("{\"x\":1,\"priority\":1000,\"limits\":{\"y\":1,\"disk_bytes\":-1}}", &job);
    assert_int_equal(json_array_size(errors), 5);
    json_decref(errors);
    job_release(&job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_single_mistakes),
        cmocka_unit_test(test_all_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
