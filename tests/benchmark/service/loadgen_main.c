/* SPDX-License-Identifier: Apache-2.0 */
/* talus-loadgen: puts a load on a daemon of this machine and measures it. Only 127.0.0.1 is ever
 * spoken to, and every load ends by itself. */
#include "loadgen_polls.h"
#include "loadgen_watch.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXIT_USAGE = 2 };
static const double seconds_max = 3600, count_max = 60000, rate_max = 1e6;

static const char usage[] =
    "talus-loadgen: load for a talusd at a port of 127.0.0.1\n\n"
    "  talus-loadgen polls --port P [--connections N] [--active A] [--seconds S] [--rate R] "
    "PATH...\n"
    "      GET of the paths in turn over N keep-alive connections, A of which ask: R requests\n"
    "      a second over all, or (0) each again as soon as it has its answer\n"
    "  talus-loadgen watch --port P --lines FILE [--watchers N] [--seconds S] PATH\n"
    "      N readers of one event stream until it ends; FILE is the job's events.ndjson\n\n"
    "Each prints one line of JSON.\n";

struct load_options {
    double port, connections, active, seconds, rate, watchers;
    const char *lines;
};

static bool number_read(const char *text, double low, double high, double *number)
{
    char *end = NULL;
    *number = strtod(text, &end);
    return end != text && *end == '\0' && *number >= low && *number <= high;
}

static bool options_read(int count, char **arguments, struct load_options *read)
{
    static const struct option options[] = {
        {"port", required_argument, NULL, 'p'},   {"connections", required_argument, NULL, 'c'},
        {"active", required_argument, NULL, 'a'}, {"seconds", required_argument, NULL, 's'},
        {"rate", required_argument, NULL, 'r'},   {"watchers", required_argument, NULL, 'w'},
        {"lines", required_argument, NULL, 'l'},  {NULL, 0, NULL, 0},
    };
    int option;
    bool good = true;
    while (good && (option = getopt_long(count, arguments, "", options, NULL)) != -1) {
        switch (option) {
        case 'p':
            good = number_read(optarg, 1, 65535, &read->port);
            break;
        case 'c':
            good = number_read(optarg, 1, count_max, &read->connections);
            break;
        case 'a':
            good = number_read(optarg, 1, count_max, &read->active);
            break;
        case 's':
            good = number_read(optarg, 0.01, seconds_max, &read->seconds);
            break;
        case 'r':
            good = number_read(optarg, 0, rate_max, &read->rate);
            break;
        case 'w':
            good = number_read(optarg, 1, count_max, &read->watchers);
            break;
        case 'l':
            read->lines = optarg;
            break;
        default:
            good = false;
        }
    }
    return good && read->port > 0;
}

int main(int argument_count, char **arguments)
{
    struct load_options read = {.connections = 1, .seconds = 5, .watchers = 1};
    bool polls = argument_count > 1 && strcmp(arguments[1], "polls") == 0;
    bool watch = argument_count > 1 && strcmp(arguments[1], "watch") == 0;
    bool good = (polls || watch) && options_read(argument_count - 1, arguments + 1, &read);
    char **paths = arguments + 1 + optind;
    size_t path_count = good ? (size_t)(argument_count - 1 - optind) : 0;
    if (!good || path_count == 0 || (watch && (path_count > 1 || read.lines == NULL))) {
        (void)fputs(usage, stderr);
        return EXIT_USAGE;
    }
    if (read.active < 1 || read.active > read.connections)
        read.active = read.connections;
    const struct polls_options poll_load = {.port = (unsigned)read.port,
                                            .paths = paths,
                                            .path_count = path_count,
                                            .connections = (size_t)read.connections,
                                            .active = (size_t)read.active,
                                            .seconds = read.seconds,
                                            .rate = read.rate};
    const struct watch_options watch_load = {.port = (unsigned)read.port,
                                             .path = paths[0],
                                             .lines = read.lines,
                                             .watchers = (size_t)read.watchers,
                                             .seconds = read.seconds};
    return polls ? polls_run(&poll_load) : watch_run(&watch_load);
}
