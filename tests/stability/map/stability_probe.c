/* SPDX-License-Identifier: Apache-2.0 */
/* Runs scenes one after the other inside of one process, for the bisections of the stability map: a
 * line of JSON in, a scene; a line out: {"energies": [...]} with kinetic + strain energy at every
 * sample, {"unstable": TEXT} or {"refused": TEXT}. */
#include "scene/scene_json.h"
#include "talus/simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void answer(const char *key, json_t *value)
{
    json_t *line = json_pack("{s:o}", key, value);
    char *text = json_dumps(line, JSON_COMPACT);
    (void)puts(text == NULL ? "{}" : text);
    (void)fflush(stdout);
    free(text);
    json_decref(line);
}

static size_t column_of(const struct talus_simulation *simulation, const char *name)
{
    size_t count = 0;
    const struct talus_column *columns = talus_simulation_columns(simulation, &count);
    for (size_t index = 0; index < count; index++) {
        if (strcmp(columns[index].name, name) == 0)
            return index;
    }
    return 0;
}

static void sample(struct talus_simulation *simulation, double *row, json_t *energies)
{
    talus_simulation_sample(simulation, row);
    const double energy =
        row[column_of(simulation, "energy.kinetic")] + row[column_of(simulation, "energy.strain")];
    (void)json_array_append_new(energies, isfinite(energy) ? json_real(energy) : json_null());
}

/* Steps to the end; the text of the error if it does not get there. */
static bool run(struct talus_simulation *simulation, double every, json_t *energies,
                struct talus_error *error)
{
    size_t columns = 0;
    (void)talus_simulation_columns(simulation, &columns);
    double *row = calloc(columns, sizeof *row);
    struct talus_simulation_state state;
    bool good = row != NULL;
    double next = every;
    talus_simulation_get_clock(simulation, &state);
    if (good)
        sample(simulation, row, energies);
    while (good && !state.finished) {
        good = talus_simulation_step(simulation, error) == TALUS_OK;
        talus_simulation_get_clock(simulation, &state);
        if (good && talus_simulation_is_nearest(simulation, next)) {
            sample(simulation, row, energies);
            next += every;
        }
    }
    free(row);
    return good;
}

static void solve(const struct talus_scene *scene)
{
    const struct talus_simulation_options options = {.threads = 1};
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    if (talus_simulation_create(scene, &options, &simulation, &error) != TALUS_OK) {
        answer("refused", json_string(error.text));
        return;
    }
    json_t *energies = json_array();
    if (run(simulation, scene->output.history_every, energies, &error))
        answer("energies", json_incref(energies));
    else
        answer("unstable", json_string(error.text));
    json_decref(energies);
    talus_simulation_destroy(simulation);
}

static void handle(const char *line)
{
    json_error_t where;
    json_t *root = json_loads(line, 0, &where), *effective = NULL;
    struct talus_scene scene;
    struct scene_issues issues = {0}, warnings = {0};
    if (root == NULL) {
        answer("refused", json_string(where.text));
        return;
    }
    if (scene_read(root, &scene, &effective, &issues, &warnings) != TALUS_OK) {
        answer("refused", json_string(issues.count > 0 ? issues.items[0].detail : "invalid"));
    } else {
        solve(&scene);
        talus_scene_release(&scene);
    }
    json_decref(effective);
    json_decref(root);
    scene_issues_release(&issues);
    scene_issues_release(&warnings);
}

int main(void)
{
    char *line = NULL;
    size_t capacity = 0;
    while (getline(&line, &capacity, stdin) > 0)
        handle(line);
    free(line);
    return 0;
}
