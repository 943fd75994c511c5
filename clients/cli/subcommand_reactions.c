/* SPDX-License-Identifier: Apache-2.0 */
#include "job_text.h"
#include "reaction_table.h"
#include "subcommand.h"

#include <stdlib.h>
#include <string.h>

/* The steady force is the mean over the last fifth of what has been computed. */
static const double steady_share = 0.2;

static const struct option_spec options[] = {
    {"from", "T", "steady force: the mean from that time on [s] (default: the last fifth)"},
    {NULL, NULL, NULL},
};

struct summary {
    struct reaction_table table;
    json_t *means; /* reaction name -> [x, y, z] */
    char unit[16];
    double from; /* [s]; below 0: the last fifth */
};

/* Mean of a series of interval averages from a time on: every value stands for the interval that
 * ends at its time, so it is weighted with that interval's length. */
static double mean_from(const json_t *times, const json_t *values, double from)
{
    double sum = 0.0, length = 0.0;
    for (size_t row = 1; row < json_array_size(times); row++) {
        const double begin = json_number_value(json_array_get(times, row - 1));
        const double end = json_number_value(json_array_get(times, row));
        if (end <= from)
            continue;
        const double part = end - (begin > from ? begin : from);
        sum += part * json_number_value(json_array_get(values, row));
        length += part;
    }
    return length > 0.0 ? sum / length : 0.0;
}

static void add_mean(struct summary *summary, const json_t *data)
{
    char name[96];
    int component;
    const json_t *times = json_object_get(data, "time");
    const size_t count = json_array_size(times);
    if (count == 0 ||
        !reaction_series_parse(json_text(data, "name"), name, sizeof name, &component))
        return;
    const double end = json_number_value(json_array_get(times, count - 1));
    const double from = summary->from >= 0.0 ? summary->from : (1.0 - steady_share) * end;
    json_t *means = json_object_get(summary->means, name);
    if (means == NULL) {
        means = json_pack("[n, n, n]");
        (void)json_object_set_new(summary->means, name, means);
    }
    (void)json_array_set_new(means, (size_t)component,
                             json_real(mean_from(times, json_object_get(data, "value"), from)));
}

/* Fetches every component of every force. */
static int fetch_series(struct connection *connection, const char *id, const json_t *list,
                        struct summary *summary)
{
    size_t index;
    json_t *item;
    json_array_foreach(list, index, item)
    {
        char name[96];
        int component;
        json_t *data = NULL;
        if (!reaction_series_parse(json_text(item, "name"), name, sizeof name, &component))
            continue;
        (void)snprintf(summary->unit, sizeof summary->unit, "%s", json_text(item, "unit"));
        char *path = job_path(id, "/series/", json_text(item, "name"));
        if (path == NULL)
            return EXIT_USAGE;
        const struct http_request request = {.method = "GET", .path = path};
        const int code = connection_ask(connection, &request, &data);
        free(path);
        if (code != EXIT_DONE)
            return code;
        add_mean(summary, data);
        const bool fine = reaction_table_add(&summary->table, data);
        json_decref(data);
        if (!fine) {
            (void)fprintf(stderr, "talus: out of memory\n");
            return EXIT_USAGE;
        }
    }
    return EXIT_DONE;
}

static json_t *vector_json(const double values[3], const bool present[3])
{
    json_t *vector = json_array();
    for (int component = 0; component < 3; component++) {
        if (present[component])
            (void)json_array_append_new(vector, json_real(values[component]));
    }
    return vector;
}

/* The peak of single steps (or of the scene's window) is a metric of a job that has ended; before,
 * the largest interval average is what there is. */
static void find_peak(const json_t *job, const struct reaction *reaction, double *peak,
                      double *peak_time, bool *exact)
{
    char key[160];
    const json_t *metrics = json_object_get(job, "metrics");
    (void)snprintf(key, sizeof key, "reaction.%s.peak", reaction->name);
    const json_t *value = json_object_get(metrics, key);
    (void)snprintf(key, sizeof key, "reaction.%s.peak_time", reaction->name);
    *exact = json_is_number(value);
    *peak = *exact ? json_number_value(value) : reaction->peak;
    *peak_time = *exact ? json_number_value(json_object_get(metrics, key)) : reaction->peak_time;
}

static json_t *reaction_json(const struct summary *summary, const struct reaction *reaction,
                             const json_t *job)
{
    double peak, peak_time, mean[3];
    bool exact;
    find_peak(job, reaction, &peak, &peak_time, &exact);
    for (size_t axis = 0; axis < 3; axis++)
        mean[axis] = json_number_value(
            json_array_get(json_object_get(summary->means, reaction->name), axis));
    return json_pack("{s:s, s:s, s:f, s:o, s:o, s:f, s:f, s:b}", "name", reaction->name, "unit",
                     summary->unit, "time", reaction->time, "force",
                     vector_json(reaction->force, reaction->present), "steady",
                     vector_json(mean, reaction->present), "peak", peak, "peak_time", peak_time,
                     "peak_of_steps", exact);
}

static void print_vector(const char *label, const json_t *vector, const char *unit)
{
    size_t index;
    json_t *value;
    (void)printf("  %-8s", label);
    json_array_foreach(vector, index, value)
    {
        char text[48];
        force_format(json_number_value(value), unit, text, sizeof text);
        (void)printf(" %14s", text);
    }
    (void)printf("\n");
}

static void print_reaction(const json_t *reaction)
{
    char peak[48];
    const char *unit = json_text(reaction, "unit");
    force_format(json_number_value(json_object_get(reaction, "peak")), unit, peak, sizeof peak);
    (void)printf("%s\n  %-8s %14s at %.4g s (%s)\n", json_text(reaction, "name"), "peak", peak,
                 json_number_value(json_object_get(reaction, "peak_time")),
                 json_is_true(json_object_get(reaction, "peak_of_steps"))
                     ? "largest of all steps"
                     : "largest sample so far");
    print_vector("steady", json_object_get(reaction, "steady"), unit);
    print_vector("last", json_object_get(reaction, "force"), unit);
}

static void print_summary(const struct connection *connection, const struct summary *summary,
                          const json_t *job)
{
    json_t *all = json_array();
    for (size_t index = 0; index < summary->table.count; index++)
        (void)json_array_append_new(all, reaction_json(summary, &summary->table.items[index], job));
    if (connection->json) {
        (void)json_dumpf(all, stdout, JSON_INDENT(2));
        (void)printf("\n");
    } else {
        size_t index;
        json_t *reaction;
        json_array_foreach(all, index, reaction) print_reaction(reaction);
        if (json_array_size(all) == 0)
            (void)printf("no forces yet\n");
    }
    json_decref(all);
}

static bool read_from(const struct arguments *arguments, double *from)
{
    const char *text = arguments_value(arguments, "from");
    char *end = NULL;
    *from = -1.0;
    if (text == NULL)
        return true;
    *from = strtod(text, &end);
    if (text[0] != '\0' && *end == '\0' && *from >= 0.0)
        return true;
    (void)fprintf(stderr, "talus: --from takes a time in seconds\n");
    return false;
}

static int run(struct connection *connection, const struct arguments *arguments)
{
    struct summary summary = {.unit = "N"};
    json_t *job = NULL, *list = NULL;
    const char *id = arguments->operands[0];
    if (!read_from(arguments, &summary.from))
        return EXIT_USAGE;
    char *job_address = job_path(id, "", NULL), *list_address = job_path(id, "/series", NULL);
    summary.means = json_object();
    int code = job_address == NULL || list_address == NULL ? EXIT_USAGE : EXIT_DONE;
    if (code == EXIT_DONE)
        code = connection_ask(connection,
                              &(struct http_request){.method = "GET", .path = job_address}, &job);
    if (code == EXIT_DONE)
        code = connection_ask(connection,
                              &(struct http_request){.method = "GET", .path = list_address}, &list);
    if (code == EXIT_DONE)
        code = fetch_series(connection, id, list, &summary);
    if (code == EXIT_DONE)
        print_summary(connection, &summary, job);
    free(job_address);
    free(list_address);
    json_decref(job);
    json_decref(list);
    json_decref(summary.means);
    reaction_table_release(&summary.table);
    return code;
}

const struct subcommand subcommand_reactions = {
    .name = "reactions",
    .synopsis = "ID",
    .summary = "shows the forces on a job's boundaries: peak, steady, last",
    .details = "Forces are what the material does to the boundary.\n",
    .options = options,
    .operand_min = 1,
    .operand_max = 1,
    .run = run,
};
