/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_HELPER_CHART_H
#define TALUS_HELPER_CHART_H

#include <jansson.h>

/* Answers {"op":"chart", ...} (output/chart.h says the rest) with {"ok":true,"svg":TEXT} or an
 * error; new reference, NULL without memory. */
json_t *helper_chart(const json_t *question);

#endif
