/* SPDX-License-Identifier: Apache-2.0 */
/* What probes add up over particles. All probes of a sample look at a block while it is in the
 * cache; blocks that lie outside of what a probe looks at, or cannot hold its outermost particle,
 * are passed over. Sums go block by block, in double. */
#ifndef TALUS_PROBE_SCAN_H
#define TALUS_PROBE_SCAN_H

#include "explicit/run.h"

/* Sums over the particles that a probe selects; what its kind does not need stays as it is where
 * nothing is selected. */
struct probe_sums {
    double mass, first[3]; /* sum m [kg], sum m x [kg m]; 0 */
    /* [m] of x . along, with half a particle on each side; INFINITY, -INFINITY. low: extent only */
    double low, high;
    double integral[9]; /* sum V f */
};

/* Sums for every probe of the scene that looks at particles into sums[probe_count]. */
void probe_scan(const struct run *run, struct probe_sums *sums);

/* sum m |x . along - mean| of one probe [kg m]. */
double probe_scan_spread(const struct run *run, const struct talus_probe *probe, double mean);

#endif
