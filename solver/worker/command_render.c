/* SPDX-License-Identifier: Apache-2.0 */
#include "base/protocol.h"
#include "output/render.h"
#include "worker/command.h"

#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { DEFAULT_WIDTH = 1200 };

static bool parse_number(const char *text, uint64_t maximum, uint64_t *number)
{
    char *end = NULL;
    errno = 0;
    const unsigned long long value = strtoull(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end != '\0' || errno != 0 || value > maximum)
        return false;
    *number = value;
    return true;
}

static int refuse(const char *text)
{
    (void)fprintf(stderr,
                  "talus-worker render: %s\n"
                  "usage: talus-worker render FOLDER --output PNG [--frame N] [--field F] "
                  "[--width PIXELS] [--style points|voxels]\n",
                  text);
    return PROTOCOL_EXIT_OTHER;
}

/* Reads the options; returns what is wrong with them, or NULL. */
static const char *read_options(int argument_count, char **arguments,
                                struct render_request *request, struct talus_error *error)
{
    static const struct option options[] = {
        {"frame", required_argument, NULL, 'n'},  {"field", required_argument, NULL, 'f'},
        {"width", required_argument, NULL, 'w'},  {"style", required_argument, NULL, 's'},
        {"output", required_argument, NULL, 'o'}, {NULL, 0, NULL, 0},
    };
    int option;
    uint64_t width = DEFAULT_WIDTH;
    optind = 1;
    while ((option = getopt_long(argument_count, arguments, "", options, NULL)) != -1) {
        if (option == 'n' && !parse_number(optarg, 999999, &request->frame))
            return "--frame takes the number of a frame";
        if (option == 'f')
            request->field = optarg;
        if (option == 'w' && !parse_number(optarg, RENDER_WIDTH_MAX, &width))
            return "--width takes a number of pixels, 4096 at most";
        if (option == 's' && render_find_style(optarg, &request->style, error) != TALUS_OK)
            return error->text;
        if (option == 'o')
            request->output = optarg;
        if (option == '?')
            return "unknown option";
    }
    request->width = (int)width;
    if (optind + 1 != argument_count)
        return "give the folder of one job";
    request->folder = arguments[optind];
    return request->output == NULL ? "--output is missing" : NULL;
}

int command_render(int argument_count, char **arguments)
{
    struct render_request request = {0};
    struct talus_error error = {0};
    const char *mistake = read_options(argument_count, arguments, &request, &error);
    if (mistake != NULL)
        return refuse(mistake);
    if (render_frame(&request, &error) != TALUS_OK) {
        (void)fprintf(stderr, "talus-worker render: %s\n", error.text);
        return PROTOCOL_EXIT_OTHER;
    }
    return PROTOCOL_EXIT_SUCCEEDED;
}
