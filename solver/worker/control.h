/* SPDX-License-Identifier: Apache-2.0 */
/* How a run is steered from outside: SIGTERM, SIGINT and SIGHUP ask it to checkpoint and stop,
 * SIGUSR1 to read control.json. Signals are read from a descriptor between steps; none interrupts
 * anything. */
#ifndef TALUS_CONTROL_H
#define TALUS_CONTROL_H

#include "talus/status.h"

#include <stdbool.h>
#include <stdint.h>

struct control {
    int descriptor; /* below 0: closed */
};

/* Blocks the signals for this process; must come before any thread is started. Also ignores
 * SIGPIPE and SIGXFSZ, so that a vanished reader or a full disk is an error of the write. */
TALUS_MUST_CHECK enum talus_status control_open(struct control *control, struct talus_error *error);
void control_close(struct control *control);

struct control_request {
    bool stop; /* SIGTERM and its like */
    bool look; /* SIGUSR1 */
};
/* What has been asked since the last call; never waits. */
struct control_request control_poll(const struct control *control);

/* How often something is wanted. A count grows with every order, so that an order that was given
 * while nobody looked, or to an attempt that crashed, is neither lost nor carried out twice. */
struct control_wish {
    bool at_once;   /* `true`: whenever control.json is looked at */
    uint64_t count; /* or a number: as soon as it exceeds what was carried out */
};

struct control_orders {
    bool end_time_given;
    double end_time; /* [s] */
    struct control_wish checkpoint, frame;
};
/* Reads control.json of the folder; no file: no orders. TALUS_INVALID if it is not as it should
 * be (an unknown key is an error). */
TALUS_MUST_CHECK enum talus_status control_read(const char *folder, struct control_orders *orders,
                                                struct talus_error *error);

#endif
