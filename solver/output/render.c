/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render.h"

#include "output/file.h"
#include "output/render_annotation.h"
#include "output/render_drawing.h"

#include <cairo.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Particles are drawn twice as fine and scaled down: smooth edges. */
enum { OVERSAMPLING = 2 };

enum talus_status render_find_style(const char *name, enum render_style *style,
                                    struct talus_error *error)
{
    if (strcmp(name, "points") == 0)
        *style = RENDER_POINTS;
    else if (strcmp(name, "voxels") == 0)
        *style = RENDER_VOXELS;
    else
        return talus_error_set(error, TALUS_INVALID, "unknown_value", "/style",
                               "'%s' is not a style; there are: points, voxels", name);
    return TALUS_OK;
}

/* Everything that a picture is made from. */
struct picture {
    struct render_scene scene;
    struct render_data data, before; /* this frame, and the positions of the first */
    struct colour_range range;
    struct layout layout;
    struct view view;
};

static enum talus_status frame_path(const struct render_request *request, uint64_t frame,
                                    char path[FILE_PATH_SIZE], struct talus_error *error)
{
    char name[48];
    (void)snprintf(name, sizeof name, "frames/frame_%06" PRIu64 ".hdf", frame);
    return file_path(path, request->folder, name, error);
}

static enum talus_status read_picture(const struct render_request *request, struct picture *picture,
                                      struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = file_path(path, request->folder, "scene.json", error);
    if (status == TALUS_OK)
        status = render_scene_read(&picture->scene, path, error);
    if (status == TALUS_OK)
        status = frame_path(request, request->frame, path, error);
    if (status == TALUS_OK)
        status = render_data_read(&picture->data, path, request->field, error);
    if (status == TALUS_OK)
        status = frame_path(request, 0, path, error);
    if (status == TALUS_OK && request->frame > 0) {
        /* The first frame only steadies the view; a run may have lost it. */
        struct talus_error ignored = {0};
        if (render_data_read_positions(&picture->before, path, &ignored) != TALUS_OK)
            render_data_release(&picture->before);
    }
    return status;
}

static void lay_out(const struct render_request *request, struct picture *picture)
{
    const struct box3 box =
        view_find_box(&picture->scene, picture->data.positions, picture->data.count,
                      picture->before.positions, picture->before.count);
    view_init(&picture->view, &picture->scene, box);
    picture->layout =
        layout_find(request->width, view_aspect(&picture->view), picture->data.values != NULL);
    view_fit(&picture->view, picture->layout.plot);
}

static void paint_raster(cairo_t *context, const struct raster *raster)
{
    const int stride = raster->width * (int)sizeof *raster->pixels;
    cairo_surface_t *surface = cairo_image_surface_create_for_data(
        (unsigned char *)raster->pixels, CAIRO_FORMAT_RGB24, raster->width, raster->height, stride);
    cairo_save(context);
    cairo_scale(context, 1.0 / OVERSAMPLING, 1.0 / OVERSAMPLING);
    cairo_set_source_surface(context, surface, 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_GOOD);
    cairo_paint(context);
    cairo_restore(context);
    cairo_surface_destroy(surface);
}

static enum talus_status draw_space(cairo_t *context, const struct picture *picture,
                                    enum render_style style, struct talus_error *error)
{
    struct raster raster;
    struct view view = picture->view;
    enum talus_status status = TALUS_OK;
    view.scale *= OVERSAMPLING;
    view.left *= OVERSAMPLING;
    view.top *= OVERSAMPLING;
    if (raster_init(&raster, OVERSAMPLING * picture->layout.width,
                    OVERSAMPLING * picture->layout.height)) {
        const double line_width = OVERSAMPLING * picture->layout.font / 9.0;
        draw_boundaries(&raster, &view, &picture->scene, line_width);
        draw_particles(&raster, &view, &picture->scene, &picture->data, &picture->range, style);
        paint_raster(context, &raster);
    } else {
        status = talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a picture");
    }
    raster_release(&raster);
    return status;
}

static enum talus_status write_png(cairo_surface_t *surface, const char *path,
                                   struct talus_error *error)
{
    char aside[FILE_PATH_SIZE];
    enum talus_status status = file_aside_path(aside, path, error);
    if (status != TALUS_OK)
        return status;
    cairo_status_t result = cairo_surface_write_to_png(surface, aside);
    if (result != CAIRO_STATUS_SUCCESS) {
        (void)remove(aside);
        return talus_error_set(error, TALUS_IO, "write", "", "cannot write %s: %s", path,
                               cairo_status_to_string(result));
    }
    return file_publish(aside, path, error);
}

static enum talus_status draw_picture(const struct render_request *request,
                                      const struct picture *picture, struct talus_error *error)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture->layout.width,
                                                          picture->layout.height);
    cairo_t *context = cairo_create(surface);
    enum talus_status status = draw_space(context, picture, request->style, error);
    if (status == TALUS_OK) {
        annotate_axes(context, &picture->layout, &picture->view, &picture->scene);
        annotate_title(context, &picture->layout, picture->scene.title, &picture->data,
                       &picture->range);
        if (picture->data.values != NULL)
            annotate_bar(context, &picture->layout, &picture->data, &picture->range);
        if (cairo_status(context) == CAIRO_STATUS_SUCCESS)
            status = write_png(surface, request->output, error);
        else
            status = talus_error_set(error, TALUS_INTERNAL, "drawing", "", "cairo: %s",
                                     cairo_status_to_string(cairo_status(context)));
    }
    cairo_destroy(context);
    cairo_surface_destroy(surface);
    return status;
}

enum talus_status render_frame(const struct render_request *request, struct talus_error *error)
{
    struct picture picture = {0};
    if (request->width < RENDER_WIDTH_MIN || request->width > RENDER_WIDTH_MAX)
        return talus_error_set(error, TALUS_INVALID, "range", "/width",
                               "a width of %d pixels is not within %d..%d", request->width,
                               RENDER_WIDTH_MIN, RENDER_WIDTH_MAX);
    enum talus_status status = read_picture(request, &picture, error);
    if (status == TALUS_OK && picture.data.values != NULL)
        status = colour_range_find(picture.data.values, picture.data.count, &picture.range, error);
    if (status == TALUS_OK) {
        lay_out(request, &picture);
        status = draw_picture(request, &picture, error);
    }
    render_data_release(&picture.data);
    render_data_release(&picture.before);
    render_scene_release(&picture.scene);
    return status;
}
