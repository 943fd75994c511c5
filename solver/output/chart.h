/* SPDX-License-Identifier: Apache-2.0 */
/* Draws the results of a study as an SVG: lines, work against precision, contours.
 *
 * A specification is an object with
 * - rows: [{ "parameters": {NAME: number or text}, "state", "metrics": {NAME: number or null} }]
 * - chart: { "x", "y", "z"?, "series"?, "log"? }, names of parameters or metrics. Without z, lines
 *   through points (x, y), one for each value of the parameter `series`; with it, contours of the
 *   metric z over x and y, a row of them for each value of `series`, beside the cuts along x and y
 *   where the rows make a grid. log: true (x and y), letters of the axes ("xz") or a list
 * - kind: the kind of design (optional): "work_precision" joins the points in the order of the rows
 *   and marks the Pareto front, "sample" does not join them; others: "grid", "list", "bisect"
 * - title (optional)
 * - units: {NAME: unit} (optional), beside those of metrics that every job has
 * - width in pixels (optional, 1000; contours 1200)
 *
 * Rows that have not succeeded, or lack a value, are not drawn, and counted in a note. */
#ifndef TALUS_CHART_H
#define TALUS_CHART_H

#include "talus/status.h"

#include <jansson.h>

enum { CHART_WIDTH_MIN = 300, CHART_WIDTH_MAX = 4000 };

/* The chart as SVG text, for the caller to free(). TALUS_INVALID with a pointer into the
 * specification, TALUS_MEMORY, TALUS_INTERNAL. */
TALUS_MUST_CHECK enum talus_status chart_svg(const json_t *specification, char **svg,
                                             struct talus_error *error);

#endif
