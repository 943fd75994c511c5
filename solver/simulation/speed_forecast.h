/* SPDX-License-Identifier: Apache-2.0 */
/* How fast signals will travel while a scene moves, before it runs: an automatic step follows the
 * fastest of them. */
#ifndef TALUS_SPEED_FORECAST_H
#define TALUS_SPEED_FORECAST_H

#include "explicit/run.h"

/* Means over the run [m/s]. */
struct speed_forecast {
    double start;    /* of signals, at t = 0 */
    double low;      /* of signals, if nothing ever moves */
    double expected; /* of signals */
    double high;     /* of signals, if all energy at hand goes into the fastest particle */
    double motion;   /* expected, of the fastest particles themselves */
};

/* Out of a run that has been built, without particles. The fastest particle of a body starts with
 * its initial speed, gains what gravity gives over the height that it can fall (to the highest
 * plane below it or the end of the grid), and what walls and tractions push (p / (rho c) of a wave,
 * twice that where it is reflected). Half of free fall is expected; the upper end is a front that
 * all the weight behind it drives, all the time. */
struct speed_forecast speed_forecast_make(const struct run *run);

#endif
