/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_field.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double vector_magnitude(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Symmetric tensors are xx yy zz xy yz xz. */
static double tensor_mean(const double *s)
{
    return (s[0] + s[1] + s[2]) / 3.0;
}

static double tensor_norm(const double *s)
{
    return sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2] +
                2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

static double tensor_von_mises(const double *s)
{
    const double mean = tensor_mean(s);
    const double deviator[6] = {s[0] - mean, s[1] - mean, s[2] - mean, s[3], s[4], s[5]};
    return sqrt(1.5) * tensor_norm(deviator);
}

static double matrix_determinant(const double *m)
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/* A suffix is a component, or an invariant where `invariant` is set. The first of each number of
 * components is its default. */
struct reduction {
    size_t components;
    const char *suffix;
    size_t component;
    double (*invariant)(const double *values);
};

static const struct reduction reductions[] = {
    {1, "", 0, NULL},
    {3, "magnitude", 0, vector_magnitude},
    {3, "x", 0, NULL},
    {3, "y", 1, NULL},
    {3, "z", 2, NULL},
    {6, "von_mises", 0, tensor_von_mises},
    {6, "mean", 0, tensor_mean},
    {6, "norm", 0, tensor_norm},
    {6, "xx", 0, NULL},
    {6, "yy", 1, NULL},
    {6, "zz", 2, NULL},
    {6, "xy", 3, NULL},
    {6, "yz", 4, NULL},
    {6, "xz", 5, NULL},
    {9, "det", 0, matrix_determinant},
    {9, "xx", 0, NULL},
    {9, "xy", 1, NULL},
    {9, "xz", 2, NULL},
    {9, "yx", 3, NULL},
    {9, "yy", 4, NULL},
    {9, "yz", 5, NULL},
    {9, "zx", 6, NULL},
    {9, "zy", 7, NULL},
    {9, "zz", 8, NULL},
};
enum { REDUCTION_COUNT = sizeof reductions / sizeof reductions[0] };

static const struct reduction *find_reduction(size_t components, const char *suffix)
{
    for (size_t index = 0; index < REDUCTION_COUNT; index++) {
        if (reductions[index].components == components &&
            (suffix[0] == '\0' || strcmp(reductions[index].suffix, suffix) == 0))
            return &reductions[index];
    }
    return NULL;
}

static enum talus_status unknown_suffix(size_t components, const char *suffix,
                                        struct talus_error *error)
{
    char known[128] = "";
    for (size_t index = 0; index < REDUCTION_COUNT; index++) {
        const size_t used = strlen(known);
        if (reductions[index].components == components && components > 1)
            (void)snprintf(known + used, sizeof known - used, "%s.%s", used > 0 ? ", " : "",
                           reductions[index].suffix);
    }
    return talus_error_set(error, TALUS_INVALID, "unknown_value", "/field",
                           "a field of %zu component(s) has no '.%s'; it has: %s", components,
                           suffix, known[0] == '\0' ? "no suffix" : known);
}

enum talus_status render_field_reduce(double *values, size_t count, size_t components,
                                      const char *suffix, struct talus_error *error)
{
    const struct reduction *reduction = find_reduction(components, suffix);
    if (reduction == NULL)
        return unknown_suffix(components, suffix, error);
    for (size_t index = 0; index < count; index++) {
        const double *own = values + components * index;
        values[index] =
            reduction->invariant != NULL ? reduction->invariant(own) : own[reduction->component];
    }
    return TALUS_OK;
}

void render_field_label(const char *name, size_t components, const char *suffix, char *label,
                        size_t size)
{
    const struct reduction *reduction = find_reduction(components, suffix);
    const char *chosen = reduction == NULL ? "" : reduction->suffix;
    (void)snprintf(label, size, "%s%s%s", name, chosen[0] == '\0' ? "" : " ", chosen);
    for (char *letter = label; *letter != '\0'; letter++) {
        if (*letter == '_')
            *letter = ' ';
    }
}
