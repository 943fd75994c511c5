/* SPDX-License-Identifier: Apache-2.0 */
/* Requests over many keep-alive connections, all of them open, some or all of them busy. */
#ifndef TALUS_LOADGEN_POLLS_H
#define TALUS_LOADGEN_POLLS_H

#include <stddef.h>

struct polls_options {
    unsigned port;
    char *const *paths; /* asked for in turn */
    size_t path_count;
    size_t connections; /* all open; each has had one answer before the measurement */
    size_t active;      /* these go on asking */
    double seconds;
    double rate; /* requests a second over all, each timed from when it was due; 0: every active
                    connection asks again as soon as it has its answer */
};

/* Prints one line of JSON: connections, active, requests, failures (answers other than 200, broken
 * connections), bytes, seconds, per_second and the percentiles of the latency. Returns the exit
 * code: 0, or 1 if the load could not be put on. */
int polls_run(const struct polls_options *options);

#endif
