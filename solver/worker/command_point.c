/* SPDX-License-Identifier: Apache-2.0 */
#include "base/protocol.h"
#include "scene/scene_point.h"
#include "worker/command.h"

#include <stdbool.h>
#include <stdio.h>

struct printer {
    const struct material *material;
    bool failed; /* the output is gone or memory is out */
};

static json_t *component_list(const double values[SYM3_COMPONENTS])
{
    return json_pack("[f, f, f, f, f, f]", values[0], values[1], values[2], values[3], values[4],
                     values[5]);
}

static json_t *state_object(const struct material *material, const double *history)
{
    json_t *object = json_object();
    for (size_t index = 0; object != NULL && index < material->state_count; index++) {
        if (json_object_set_new(object, material->state_names[index], json_real(history[index])) !=
            0) {
            json_decref(object);
            return NULL;
        }
    }
    return object;
}

/* One line; takes `line` over. */
static bool print_line(json_t *line)
{
    bool printed = line != NULL && json_dumpf(line, stdout, JSON_COMPACT) == 0 && putchar('\n') > 0;
    json_decref(line);
    return printed;
}

static void print_step(void *context, const struct material_point_step *step)
{
    struct printer *printer = context;
    if (step->step == 0 || printer->failed)
        return; /* the initial state is what the user gave */
    json_t *line =
        json_pack("{s:I, s:o, s:o, s:f, s:f, s:f, s:f, s:f, s:f, s:o, s:i}", "step",
                  (json_int_t)step->step, "strain", component_list(step->strain), "stress",
                  component_list(step->stress), "p", step->p, "q", step->q, "volumetric_strain",
                  step->volumetric_strain, "plastic_strain", step->plastic_strain, "dissipation",
                  step->dissipation, "strain_energy", step->strain_energy, "state",
                  state_object(printer->material, step->history), "iterations", step->iterations);
    printer->failed = !print_line(line);
}

/* Mistakes as a last JSON line for machines and as text for people. */
static void print_issues(const struct scene_issues *issues)
{
    json_t *line = json_pack("{s:o}", "errors", scene_issues_json(issues));
    (void)print_line(line); /* the text below says the same */
    for (size_t index = 0; index < issues->count; index++) {
        const struct scene_issue *issue = &issues->items[index];
        (void)fprintf(stderr, "talus-worker point: %s: %s (%s)\n",
                      issue->pointer[0] == '\0' ? "/" : issue->pointer, issue->detail, issue->code);
    }
}

static int exit_code(enum talus_status status)
{
    switch (status) {
    case TALUS_OK:
        return PROTOCOL_EXIT_SUCCEEDED;
    case TALUS_INVALID:
        return PROTOCOL_EXIT_INVALID;
    case TALUS_UNSTABLE:
        return PROTOCOL_EXIT_UNSTABLE;
    case TALUS_MEMORY:
        return PROTOCOL_EXIT_MEMORY;
    default:
        return PROTOCOL_EXIT_OTHER;
    }
}

static enum talus_status job_point(const struct scene_point *point)
{
    const struct material *material = material_table[point->material.model_index];
    struct printer printer = {.material = material};
    struct talus_error error = {.status = TALUS_OK};
    const struct material_point_path path = scene_point_path(point);
    enum talus_status status =
        material_point_run(material, point->material.values, &path, print_step, &printer, &error);
    if (status != TALUS_OK) {
        struct scene_issue issue = {0};
        (void)snprintf(issue.pointer, sizeof issue.pointer, "%s", error.pointer);
        (void)snprintf(issue.code, sizeof issue.code, "%s", error.code);
        (void)snprintf(issue.detail, sizeof issue.detail, "%.*s", (int)sizeof issue.detail - 1,
                       error.text);
        print_issues(&(struct scene_issues){.items = &issue, .count = 1});
        return status;
    }
    return printer.failed || fflush(stdout) != 0 ? TALUS_IO : TALUS_OK;
}

int command_point(int argument_count, char **arguments)
{
    struct scene_point point;
    struct scene_issues issues;
    if (argument_count != 2) {
        (void)fprintf(stderr, "usage: talus-worker point PATH.json\n");
        return PROTOCOL_EXIT_OTHER;
    }
    enum talus_status status = scene_point_read_file(arguments[1], &point, &issues);
    if (status == TALUS_OK) {
        status = job_point(&point);
        scene_point_release(&point);
    } else {
        print_issues(&issues);
    }
    scene_issues_release(&issues);
    return exit_code(status);
}
