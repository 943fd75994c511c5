/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Light from the upper left, in front of the picture (x right, y down, z to the eye), unit length.
 */
static const double light_direction[3] = {-0.41, -0.57, 0.71};

bool raster_init(struct raster *raster, int width, int height)
{
    size_t count = (size_t)width * (size_t)height;
    *raster = (struct raster){.width = width, .height = height};
    raster->pixels = malloc(count * sizeof *raster->pixels);
    raster->depth = malloc(count * sizeof *raster->depth);
    if (raster->pixels == NULL || raster->depth == NULL)
        return false;
    for (size_t index = 0; index < count; index++) {
        raster->pixels[index] = 0xffffff;
        raster->depth[index] = INFINITY;
    }
    return true;
}

void raster_release(struct raster *raster)
{
    free(raster->pixels);
    free(raster->depth);
    memset(raster, 0, sizeof *raster);
}

static uint32_t pack_channel(double value)
{
    return (uint32_t)lrint(255.0 * fmin(fmax(value, 0.0), 1.0));
}

static uint32_t pack_colour(struct colour colour)
{
    return pack_channel(colour.red) << 16 | pack_channel(colour.green) << 8 |
           pack_channel(colour.blue);
}

struct colour colour_shade(struct colour colour, double light)
{
    return (struct colour){colour.red * light, colour.green * light, colour.blue * light};
}

/* The pixel to colour if something at this depth is the nearest there, else NULL. */
static uint32_t *claim_pixel(struct raster *raster, int x, int y, double depth)
{
    const size_t index = (size_t)y * (size_t)raster->width + (size_t)x;
    if (!((float)depth < raster->depth[index]))
        return NULL;
    raster->depth[index] = (float)depth;
    return &raster->pixels[index];
}

/* First and one past the last pixel whose centre lies in [low, high], within 0..count. */
static int first_pixel(double low, int count)
{
    return (int)fmin(fmax(ceil(low - 0.5), 0.0), count);
}

static int end_pixel(double high, int count)
{
    return (int)fmin(fmax(floor(high - 0.5) + 1.0, 0.0), count);
}

void raster_draw_disc(struct raster *raster, struct screen_point centre, double radius,
                      struct colour colour, bool round)
{
    if (!isfinite(centre.x) || !isfinite(centre.y) || !isfinite(centre.depth))
        return;
    const double reach = fmax(radius, 0.6); /* even the smallest disc meets a pixel centre */
    const uint32_t flat = pack_colour(colour);
    const int begin_x = first_pixel(centre.x - reach, raster->width);
    const int end_x = end_pixel(centre.x + reach, raster->width);
    const int begin_y = first_pixel(centre.y - reach, raster->height);
    const int end_y = end_pixel(centre.y + reach, raster->height);
    for (int y = begin_y; y < end_y; y++) {
        for (int x = begin_x; x < end_x; x++) {
            const double dx = (x + 0.5 - centre.x) / reach, dy = (y + 0.5 - centre.y) / reach;
            const double square = dx * dx + dy * dy;
            if (square > 1.0)
                continue;
            const double dz = round ? sqrt(1.0 - square) : 0.0;
            uint32_t *pixel = claim_pixel(raster, x, y, centre.depth - dz * reach);
            if (pixel == NULL)
                continue;
            const double facing =
                dx * light_direction[0] + dy * light_direction[1] + dz * light_direction[2];
            *pixel =
                round ? pack_colour(colour_shade(colour, 0.55 + 0.45 * fmax(facing, 0.0))) : flat;
        }
    }
}

/* Twice the signed area of the triangle a, b, (x, y). */
static double edge_function(struct screen_point a, struct screen_point b, double x, double y)
{
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static void draw_triangle(struct raster *raster, struct screen_point a, struct screen_point b,
                          struct screen_point c, uint32_t packed)
{
    const double area = edge_function(a, b, c.x, c.y);
    if (!isfinite(area) || area == 0.0)
        return;
    const int begin_x = first_pixel(fmin(a.x, fmin(b.x, c.x)), raster->width);
    const int end_x = end_pixel(fmax(a.x, fmax(b.x, c.x)), raster->width);
    const int begin_y = first_pixel(fmin(a.y, fmin(b.y, c.y)), raster->height);
    const int end_y = end_pixel(fmax(a.y, fmax(b.y, c.y)), raster->height);
    for (int y = begin_y; y < end_y; y++) {
        for (int x = begin_x; x < end_x; x++) {
            const double weight_a = edge_function(b, c, x + 0.5, y + 0.5) / area;
            const double weight_b = edge_function(c, a, x + 0.5, y + 0.5) / area;
            const double weight_c = 1.0 - weight_a - weight_b;
            if (weight_a < 0.0 || weight_b < 0.0 || weight_c < 0.0)
                continue;
            uint32_t *pixel = claim_pixel(
                raster, x, y, weight_a * a.depth + weight_b * b.depth + weight_c * c.depth);
            if (pixel != NULL)
                *pixel = packed;
        }
    }
}

void raster_draw_quad(struct raster *raster, const struct screen_point corners[4],
                      struct colour colour)
{
    const uint32_t packed = pack_colour(colour);
    draw_triangle(raster, corners[0], corners[1], corners[2], packed);
    draw_triangle(raster, corners[0], corners[2], corners[3], packed);
}

void raster_draw_line(struct raster *raster, struct screen_point from, struct screen_point to,
                      double width, struct colour colour)
{
    const double dx = to.x - from.x, dy = to.y - from.y;
    const double length = hypot(dx, dy);
    if (!isfinite(length) || length == 0.0)
        return;
    const double side_x = -dy / length * width / 2.0, side_y = dx / length * width / 2.0;
    const double lift = width / 2.0; /* an edge lies on the face that it bounds: in front of it */
    const struct screen_point corners[4] = {
        {from.x + side_x, from.y + side_y, from.depth - lift},
        {to.x + side_x, to.y + side_y, to.depth - lift},
        {to.x - side_x, to.y - side_y, to.depth - lift},
        {from.x - side_x, from.y - side_y, from.depth - lift},
    };
    raster_draw_quad(raster, corners, colour);
}
