/* SPDX-License-Identifier: Apache-2.0 */
#include "base/protocol.h"
#include "worker/command.h"
#include "worker/job_run.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { THREADS_MAX = 1024, ATTEMPT_MAX = 1 << 20, END_MOVE_MAX = 100 };

struct end_moves {
    struct job_end_move moves[END_MOVE_MAX];
    size_t count;
};

static bool read_count(const char *text, int minimum, int maximum, int *value)
{
    char *end = NULL;
    errno = 0;
    long number = strtol(text, &end, 10);
    if (errno != 0 || *text == '\0' || *end != '\0' || number < minimum || number > maximum)
        return false;
    *value = (int)number;
    return true;
}

/* 0: as many as there are processors; the simulation uses those that pay. */
static bool read_threads(const char *text, int *threads)
{
    if (!read_count(text, 0, THREADS_MAX, threads))
        return false;
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (*threads == 0)
        *threads = processors < 1 ? 1 : processors < THREADS_MAX ? (int)processors : THREADS_MAX;
    return true;
}

static bool read_seconds(const char *text, double *value)
{
    char *end = NULL;
    *value = strtod(text, &end);
    return *text != '\0' && *end == '\0' && isfinite(*value) && *value > 0.0;
}

static bool read_option(struct job_options *options, int letter, const char *value)
{
    switch (letter) {
    case 'o':
        options->folder = value;
        return *value != '\0';
    case 't':
        return read_threads(value, &options->threads);
    case 'a':
        return read_count(value, 1, ATTEMPT_MAX, &options->attempt);
    case 'w':
        return read_seconds(value, &options->wall_seconds);
    case 'A':
        options->all_threads = true;
        return true;
    case 'r':
        options->resume = true;
        return true;
    case 'q':
        options->quiet = true;
        return true;
    default:
        return false;
    }
}

/* S or S@STEP, behind those given before. */
static bool read_end_move(struct end_moves *moves, const char *text)
{
    char *end = NULL;
    unsigned long long step = 0;
    double end_time = strtod(text, &end);
    if (*text == '\0' || !(end_time > 0.0) || !isfinite(end_time))
        return false;
    if (*end == '@' && end[1] >= '0' && end[1] <= '9')
        step = strtoull(end + 1, &end, 10);
    const bool ordered = moves->count == 0 || step >= moves->moves[moves->count - 1].step;
    if (*end != '\0' || !ordered || moves->count == END_MOVE_MAX)
        return false;
    moves->moves[moves->count++] = (struct job_end_move){end_time, step};
    return true;
}

static bool read_options(int argument_count, char **arguments, struct job_options *options,
                         struct end_moves *moves)
{
    static const struct option known[] = {{"out", required_argument, NULL, 'o'},
                                          {"threads", required_argument, NULL, 't'},
                                          {"all-threads", no_argument, NULL, 'A'},
                                          {"attempt", required_argument, NULL, 'a'},
                                          {"wall-seconds", required_argument, NULL, 'w'},
                                          {"end-time", required_argument, NULL, 'e'},
                                          {"resume", no_argument, NULL, 'r'},
                                          {"quiet", no_argument, NULL, 'q'},
                                          {NULL, 0, NULL, 0}};
    int letter = 0;
    while ((letter = getopt_long(argument_count, arguments, "", known, NULL)) != -1) {
        if (letter == 'e' ? !read_end_move(moves, optarg) : !read_option(options, letter, optarg)) {
            if (letter != '?')
                (void)fprintf(stderr, "talus-worker run: '%s' is not allowed here\n", optarg);
            return false;
        }
    }
    if (optind + 1 != argument_count || options->folder == NULL) {
        (void)fputs("usage: talus-worker run SCENE.json --out DIR [--threads N] [--all-threads] "
                    "[--attempt A] [--resume] [--wall-seconds S] [--end-time S[@STEP]] [--quiet]\n",
                    stderr);
        return false;
    }
    options->scene_path = arguments[optind];
    options->end_moves = moves->moves;
    options->end_move_count = moves->count;
    return true;
}

int command_run(int argument_count, char **arguments)
{
    struct job_options options = {.threads = 1, .arguments = arguments};
    struct end_moves moves = {.count = 0};
    if (!read_options(argument_count, arguments, &options, &moves))
        return PROTOCOL_EXIT_OTHER;
    struct talus_error error = {.status = TALUS_OK};
    struct job_run run = {.options = &options,
                          .control = {.descriptor = -1},
                          .lock = {.descriptor = -1},
                          .events = {.descriptor = -1},
                          .log = {.descriptor = -1},
                          .history = {.descriptor = -1}};
    enum talus_status status = control_open(&run.control, &error);
    if (status == TALUS_OK)
        status = job_start(&run, &error);
    if (status == TALUS_OK)
        status = job_loop(&run, &error);
    int exit_code = job_end(&run, status, &error);
    job_release(&run);
    return exit_code;
}
