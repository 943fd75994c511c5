/* SPDX-License-Identifier: Apache-2.0 */
/* Units of the metrics of a study, which the histories of its jobs know. */
#ifndef TALUS_STUDY_UNITS_H
#define TALUS_STUDY_UNITS_H

#include "service.h"

#include <jansson.h>

/* {METRIC: unit} for those metrics in the rows of a table of results (study_view.h) that follow
 * from a history, as far as some job that is still there tells it. New reference, NULL without
 * memory. */
json_t *study_units(const struct service *service, const json_t *rows);

#endif
