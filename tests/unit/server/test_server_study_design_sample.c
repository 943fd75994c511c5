/* SPDX-License-Identifier: Apache-2.0 */
/* Designs of the kind sample. */
#include "study_design_fixture.h"

#include <math.h>
#include <stdio.h>

static void test_sample(void **state)
{
    static const char *const methods[] = {"sobol", "latin_hypercube"};
    (void)state;
    for (int method = 0; method < 2; method++) {
        char text[400];
        (void)snprintf(text, sizeof text,
                       "{\"sample\":{\"method\":\"%s\",\"count\":16,\"seed\":%d,\"parameters\":{"
                       "\"/duration\":{\"min\":1,\"max\":3},\"E\":{\"min\":1e3,\"max\":1e7,"
                       "\"scale\":\"log\"}},\"set\":{\"/materials/sand/E\":\"E\"}}}",
                       methods[method], 5 * method);
        struct study_plan plan = design_plan(text);
        bool hit[2][16] = {{false}};
        assert_int_equal(plan.kind, STUDY_SAMPLE);
        assert_int_equal(study_plan_count(&plan), 16);
        for (size_t row = 0; row < 16; row++) {
            const json_t *set = json_object_get(json_array_get(plan.rows, row), "set");
            double duration = json_number_value(json_object_get(set, "/duration"));
            double decades = log10(json_number_value(json_object_get(set, "/materials/sand/E")));
            hit[0][(size_t)((duration - 1.0) * 8.0 + 1e-9)] = true;
            hit[1][(size_t)((decades - 3.0) * 4.0 + 1e-9)] = true;
        }
        for (size_t stratum = 0; stratum < 16; stratum++)
            assert_true(hit[0][stratum] && hit[1][stratum]);
        study_plan_release(&plan);
    }
    /* The same on every machine: written down here. */
    struct study_plan plan =
        design_plan("{\"sample\":{\"method\":\"latin_hypercube\",\"count\":3,\"seed\":1,"
                    "\"parameters\":{\"/duration\":{\"min\":0,\"max\":1}}}}");
    design_expect_json(plan.rows,
                       "[{\"parameters\":{\"/duration\":0.323667584529},\"set\":{\"/duration\":"
                       "0.323667584529}},{\"parameters\":{\"/duration\":0.481453072352},"
                       "\"set\":{\"/duration\":0.481453072352}},{\"parameters\":{\"/duration\":"
                       "0.814754900275},\"set\":{\"/duration\":0.814754900275}}]");
    study_plan_release(&plan);
}

static void test_sample_mistakes(void **state)
{
    static const char range[] = "/design/sample/parameters/~1duration";
    (void)state;
    design_expect(SAMPLE("\"count\":4", "\"min\":0,\"max\":1"), "/design/sample/method", "required",
                  "");
    design_expect(SAMPLE("\"method\":\"sobl\",\"count\":4", "\"min\":0,\"max\":1"),
                  "/design/sample/method", "unknown_value", "'sobol'");
    design_expect(SAMPLE("\"method\":7,\"count\":4", "\"min\":0,\"max\":1"),
                  "/design/sample/method", "type", "");
    design_expect(SAMPLE("\"method\":\"sobol\"", "\"min\":0,\"max\":1"), "/design/sample/count",
                  "required", "");
    design_expect(SAMPLE("\"method\":\"sobol\",\"count\":0", "\"min\":0,\"max\":1"),
                  "/design/sample/count", "range", "");
    design_expect(SAMPLE("\"method\":\"sobol\",\"count\":2.5", "\"min\":0,\"max\":1"),
                  "/design/sample/count", "type", "whole");
    design_expect(SAMPLE("\"method\":\"sobol\",\"count\":101", "\"min\":0,\"max\":1"),
                  "/design/sample/count", "range", "at most 100");
    design_expect(SAMPLE("\"method\":\"sobol\",\"count\":1e15", "\"min\":0,\"max\":1"),
                  "/design/sample/count", "range", "at most 100");
    design_expect(SAMPLE(SOBOL ",\"seed\":-1", "\"min\":0,\"max\":1"), "/design/sample/seed",
                  "range", "");
    design_expect(SAMPLE(SOBOL ",\"seed\":\"x\"", "\"min\":0,\"max\":1"), "/design/sample/seed",
                  "type", "");
    design_expect(SAMPLE(SOBOL ",\"sede\":1", "\"min\":0,\"max\":1"), "/design/sample/sede",
                  "unknown_key", "\"seed\"");
    design_expect(SAMPLE(SOBOL, "\"min\":0,\"max\":0"), "/design/sample/parameters/~1duration/max",
                  "range", "larger");
    design_expect(SAMPLE(SOBOL, "\"min\":0"), "/design/sample/parameters/~1duration/max",
                  "required", "");
    design_expect(SAMPLE(SOBOL, "\"min\":\"0\",\"max\":1"),
                  "/design/sample/parameters/~1duration/min", "type", "");
    design_expect(SAMPLE(SOBOL, "\"min\":0,\"max\":1,\"scale\":\"log\""),
                  "/design/sample/parameters/~1duration/min", "range", "positive");
    design_expect(SAMPLE(SOBOL, "\"min\":1,\"max\":2,\"scale\":\"lgo\""),
                  "/design/sample/parameters/~1duration/scale", "unknown_value", "'log'");
    design_expect(SAMPLE(SOBOL, "\"min\":0,\"max\":1,\"steps\":3"),
                  "/design/sample/parameters/~1duration/steps", "unknown_key", "");
    design_expect("{\"sample\":{" SOBOL ",\"parameters\":{\"/duration\":[0,1]}}}", range, "type",
                  "'min'");
    design_expect("{\"sample\":{" SOBOL ",\"parameters\":{}}}", "/design/sample/parameters",
                  "range", "");
    design_expect("{\"sample\":{" SOBOL "}}", "/design/sample/parameters", "required", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sample),
        cmocka_unit_test(test_sample_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
