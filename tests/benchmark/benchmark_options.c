/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_options.h"

#include "shapes/shape.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_usage(void)
{
    (void)fputs(
        "usage: talus-benchmark --short|--full|--smoke [--csv FILE | --results FOLDER]\n"
        "                       [--precision double|single] [--isa I]\n"
        "       talus-benchmark --case NAME [--body compact|flow] [--particles N] [--per-axis N]\n"
        "                       [--threads T] [--shape NAME] [--transfer flip|pic|apic]\n"
        "                       [--ordering last|modified_last]\n"
        "                       [--anti-locking none|cell|node|hybrid] [--field NAME]\n"
        "                       [--domain FACTOR] [--courant C]\n"
        "                       [--steps N] [--repeats N] [--precision double|single]\n"
        "                       [--isa x86-64-v4|x86-64-v3|x86-64-v2]\n"
        "cases:",
        stderr);
    for (size_t index = 0; index < benchmark_case_count; index++)
        (void)fprintf(stderr, " %s", benchmark_cases[index].name);
    (void)fputs("\n", stderr);
}

static bool read_count(const char *text, long maximum, size_t *value)
{
    char *end = NULL;
    errno = 0;
    const long number = strtol(text, &end, 10);
    if (errno != 0 || *text == '\0' || *end != '\0' || number < 1 || number > maximum)
        return false;
    *value = (size_t)number;
    return true;
}

/* The index of the word that is given. */
static bool read_word(const char *text, const char *const words[2], bool *second)
{
    *second = strcmp(text, words[1]) == 0;
    return *second || strcmp(text, words[0]) == 0;
}

static bool is_one_of(const char *text, const char *const *words)
{
    while (*words != NULL && strcmp(text, *words) != 0)
        words++;
    return *words != NULL;
}

static bool read_number(const char *text, double least, double *value)
{
    char *end = NULL;
    *value = strtod(text, &end);
    return *text != '\0' && *end == '\0' && *value >= least && *value <= 1e6;
}

static bool read_option(struct benchmark_options *options, int letter, const char *text)
{
    static const char *const bodies[2] = {"compact", "flow"};
    static const char *const orderings[2] = {"modified_last", "last"};
    static const char *const precisions[2] = {"double", "single"};
    struct benchmark_setup *setup = &options->setup;
    size_t count = 1;
    bool second = false, good = true;
    switch (letter) {
    case 'c':
        setup->subject = benchmark_case_find(text);
        return setup->subject != NULL;
    case 'b':
        good = read_word(text, bodies, &second);
        setup->body = second ? BENCHMARK_FLOW : BENCHMARK_COMPACT;
        return good;
    case 'n':
        return read_count(text, 100000000, &setup->particles);
    case 'p':
        return read_count(text, 10, &setup->per_axis);
    case 't':
        good = read_count(text, 1024, &count);
        setup->threads = (int)count;
        return good;
    case 'h':
        setup->shape = text;
        return shape_find(text) != NULL;
    case 'x':
        setup->transfer = text;
        return is_one_of(text, (const char *const[]){"flip", "pic", "apic", NULL});
    case 'o':
        return read_word(text, orderings, &setup->last);
    case 'a':
        setup->control = text;
        return is_one_of(text, (const char *const[]){"none", "cell", "node", "hybrid", NULL});
    case 'l':
        setup->field = text;
        return is_one_of(text,
                         (const char *const[]){"volumetric", "full", "full_constant_volume", NULL});
    case 'd':
        return read_number(text, 1, &setup->domain_factor);
    case 'k':
        return read_number(text, 1e-6, &setup->courant);
    case 's':
        return read_count(text, 1000000, &options->effort.steps);
    case 'r':
        return read_count(text, 1000000, &options->effort.repeats);
    case 'S':
    case 'F':
    case 'M':
        options->whole = true;
        options->form = letter == 'S'   ? BENCHMARK_SHORT
                        : letter == 'F' ? BENCHMARK_FULL
                                        : BENCHMARK_SMOKE;
        return true;
    case 'v':
        options->path = text;
        return *text != '\0';
    case 'f':
        options->folder = text;
        return *text != '\0';
    case 'q':
        return read_word(text, precisions, &options->single);
    case 'i':
        options->isa = text;
        return true;
    default:
        return false;
    }
}

bool benchmark_options_read(int argument_count, char **arguments, struct benchmark_options *options)
{
    static const struct option known[] = {{"case", required_argument, NULL, 'c'},
                                          {"body", required_argument, NULL, 'b'},
                                          {"particles", required_argument, NULL, 'n'},
                                          {"per-axis", required_argument, NULL, 'p'},
                                          {"threads", required_argument, NULL, 't'},
                                          {"shape", required_argument, NULL, 'h'},
                                          {"transfer", required_argument, NULL, 'x'},
                                          {"ordering", required_argument, NULL, 'o'},
                                          {"anti-locking", required_argument, NULL, 'a'},
                                          {"domain", required_argument, NULL, 'd'},
                                          {"courant", required_argument, NULL, 'k'},
                                          {"steps", required_argument, NULL, 's'},
                                          {"repeats", required_argument, NULL, 'r'},
                                          {"short", no_argument, NULL, 'S'},
                                          {"full", no_argument, NULL, 'F'},
                                          {"smoke", no_argument, NULL, 'M'},
                                          {"csv", required_argument, NULL, 'v'},
                                          {"results", required_argument, NULL, 'f'},
                                          {"isa", required_argument, NULL, 'i'},
                                          {"precision", required_argument, NULL, 'q'},
                                          {"field", required_argument, NULL, 'l'},
                                          {NULL, 0, NULL, 0}};
    int letter = 0;
    *options = (struct benchmark_options){
        .folder = ".",
        .setup = {.particles = 500000, .threads = 1, .domain_factor = 1},
        .effort = {.steps = 32, .repeats = 7},
    };
    while ((letter = getopt_long(argument_count, arguments, "", known, NULL)) != -1) {
        if (!read_option(options, letter, optarg)) {
            if (letter != '?')
                (void)fprintf(stderr, "talus-benchmark: '%s' is not allowed here\n", optarg);
            print_usage();
            return false;
        }
    }
    if (optind != argument_count || options->whole == (options->setup.subject != NULL)) {
        print_usage();
        return false;
    }
    if (!options->whole && options->setup.per_axis == 0)
        options->setup.per_axis = options->setup.subject->per_axis;
    return true;
}
