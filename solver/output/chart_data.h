/* SPDX-License-Identifier: Apache-2.0 */
/* What a chart draws, read from the rows of a study. Private to chart*.c. */
#ifndef TALUS_CHART_DATA_H
#define TALUS_CHART_DATA_H

#include "output/chart.h"
#include "output/render_text.h"

#include <stdbool.h>
#include <stddef.h>

enum chart_kind { CHART_LINES, CHART_WORK_PRECISION, CHART_CONTOURS };

/* Named values: the values of a parameter in the order in which they are shown. */
struct chart_words {
    size_t count;
    bool numeric; /* every value is a number: ascending; else in order of appearance */
    struct chart_word {
        char *text;    /* owned */
        double number; /* NAN unless numeric */
    } * items;
    json_t *index; /* text -> position */
};

struct chart_quantity {
    const char *name, *unit; /* borrowed; NULL name: there is no such axis; NULL unit: not known */
    struct unit_prefix prefix; /* of a metric on a linear axis: points are multiplied already */
    bool is_parameter, logarithmic;
    struct chart_words words; /* parameters */
};

/* A point; the z of contours. `x` and `y` of texts are their positions among the words. */
struct chart_point {
    double x, y, z;
    size_t series, row;
};

struct chart {
    enum chart_kind kind;
    bool joined;       /* points of a series are joined by lines */
    bool gridded;      /* contours: the rows are most of the grid of all values of x and y */
    const char *title; /* borrowed, "" without one */
    double width;      /* [pixels] */
    struct chart_quantity x, y, z, series;
    size_t series_count; /* at least 1 */
    struct chart_point *points;
    size_t count;
    size_t row_count, unfinished, failed, missing, not_positive; /* rows; those not drawn */
};

/* Reads the specification but for its rows. */
TALUS_MUST_CHECK enum talus_status chart_specify(struct chart *chart, const json_t *specification,
                                                 struct talus_error *error);
/* Reads the rows of a chart that is specified. */
TALUS_MUST_CHECK enum talus_status chart_read_rows(struct chart *chart, const json_t *rows,
                                                   struct talus_error *error);
void chart_release(struct chart *chart);

/* Rows of contours that are drawn: one a series, up to a limit. */
size_t chart_contour_rows(const struct chart *chart);

/* Whether values of this axis are texts, shown at equal distances. */
bool chart_is_worded(const struct chart_quantity *quantity);

#endif
