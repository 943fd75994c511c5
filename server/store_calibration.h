/* SPDX-License-Identifier: Apache-2.0 */
/* The calibration as it lies in the store. */
#ifndef TALUS_STORE_CALIBRATION_H
#define TALUS_STORE_CALIBRATION_H

#include "calibration_ratio.h"
#include "store.h"

enum { STORE_RATIO_NAME_SIZE = 256 };

struct store_ratio {
    char name[STORE_RATIO_NAME_SIZE];
    struct calibration_ratio ratio;
    int64_t used; /* grows with every use: the smallest is the oldest */
};

/* How good forecasts were. */
struct store_quality {
    int64_t judged, inside;
    double recent;
};

/* Which machine figures are of; texts are borrowed. */
struct store_machine {
    const char *processor, *build;
};

/* Reads at most `capacity` statistics of that processor, the last used first; those of another
 * build come with a weight of at most `foreign_weight`. *quality is zero where nothing is known. */
TALUS_MUST_CHECK enum talus_status
store_calibration_read(struct store *store, const struct store_machine *machine,
                       double foreign_weight, struct store_ratio *ratios, size_t capacity,
                       size_t *count, struct store_quality *quality, struct talus_error *error);

/* Writes statistics and quality in one transaction and forgets the dropped names. */
TALUS_MUST_CHECK enum talus_status
store_calibration_write(struct store *store, const struct store_machine *machine,
                        const struct store_ratio *const *ratios, size_t count,
                        const char *const *dropped, size_t dropped_count,
                        const struct store_quality *quality, struct talus_error *error);

#endif
