/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_place.h"

#include <cairo-svg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CONTOUR_ROWS_MAX = 12 };

size_t chart_contour_rows(const struct chart *chart)
{
    return chart->series_count < CONTOUR_ROWS_MAX ? chart->series_count : CONTOUR_ROWS_MAX;
}

struct chart *chart_create(const json_t *specification, struct talus_error *error)
{
    struct chart *chart = calloc(1, sizeof *chart);
    if (chart == NULL) {
        (void)talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a chart");
        return NULL;
    }
    enum talus_status status = chart_specify(chart, specification, error);
    if (status == TALUS_OK)
        status = chart_read_rows(chart, json_object_get(specification, "rows"), error);
    if (status == TALUS_OK)
        return chart;
    chart_destroy(chart);
    return NULL;
}

void chart_destroy(struct chart *chart)
{
    if (chart == NULL)
        return;
    chart_release(chart);
    free(chart);
}

static double title_room(const struct chart *chart)
{
    return (chart->title[0] == '\0' ? 1.5 : 3.2) * chart_font(chart);
}

void chart_measure(const struct chart *chart, double *width, double *height)
{
    const size_t rows = chart_contour_rows(chart);
    *width = chart->width;
    *height = chart->kind == CHART_CONTOURS
                  ? (double)rows * (chart->gridded ? 0.29 : 0.5) * chart->width
                  : 0.56 * chart->width;
    *height =
        ceil(*height + title_room(chart) + (chart_has_note(chart) ? 1.8 : 0.5) * chart_font(chart));
}

void chart_draw(const struct chart *chart, cairo_t *context)
{
    const double font = chart_font(chart), top = title_room(chart);
    double width, height;
    chart_measure(chart, &width, &height);
    const double bottom = (chart_has_note(chart) ? 1.8 : 0.5) * font;
    const struct rectangle area = {font, top, width - 2.0 * font, height - top - bottom};
    chart_begin(chart, context, height);
    if (chart->kind == CHART_CONTOURS)
        chart_panel_contours(chart, area, 0.9 * font, context);
    else
        chart_panel_lines(chart, area, font, true, context);
    chart_note(chart, context, height);
}

struct svg_text {
    char *data;
    size_t length, capacity;
};

static cairo_status_t svg_write(void *closure, const unsigned char *data, unsigned int length)
{
    struct svg_text *text = closure;
    if (text->length + length + 1 > text->capacity) {
        const size_t capacity = 2 * (text->length + length + 1);
        char *grown = realloc(text->data, capacity);
        if (grown == NULL)
            return CAIRO_STATUS_NO_MEMORY;
        text->data = grown;
        text->capacity = capacity;
    }
    memcpy(text->data + text->length, data, length);
    text->length += length;
    text->data[text->length] = '\0';
    return CAIRO_STATUS_SUCCESS;
}

/* Cairo numbers the surfaces of a process; without the number equal charts are equal texts. */
static void drop_surface_number(char *svg)
{
    static const char mark[] = "id=\"surface";
    char *place = strstr(svg, mark);
    if (place == NULL)
        return;
    place += strlen(mark);
    const size_t digits = strspn(place, "0123456789");
    memmove(place, place + digits, strlen(place + digits) + 1);
}

enum talus_status chart_svg(const json_t *specification, char **svg, struct talus_error *error)
{
    struct svg_text text = {0};
    struct chart *chart = chart_create(specification, error);
    double width, height;
    *svg = NULL;
    if (chart == NULL)
        return error->status;
    chart_measure(chart, &width, &height);
    cairo_surface_t *surface = cairo_svg_surface_create_for_stream(svg_write, &text, width, height);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
    cairo_t *context = cairo_create(surface);
    chart_draw(chart, context);
    cairo_status_t result = cairo_status(context);
    cairo_destroy(context);
    cairo_surface_finish(surface);
    if (result == CAIRO_STATUS_SUCCESS)
        result = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    chart_destroy(chart);
    if (result == CAIRO_STATUS_SUCCESS && text.data != NULL) {
        drop_surface_number(text.data);
        *svg = text.data;
        return TALUS_OK;
    }
    free(text.data);
    return talus_error_set(error, result == CAIRO_STATUS_NO_MEMORY ? TALUS_MEMORY : TALUS_INTERNAL,
                           "drawing", "", "cairo: %s", cairo_status_to_string(result));
}
