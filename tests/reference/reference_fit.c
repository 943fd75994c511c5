/* SPDX-License-Identifier: Apache-2.0 */
/* Anti-locking (Mast 2013, chapter 4) by its formulas: every control volume looks at all particles.
 * Fits are about the centre of mass: q(x) = mean + slope . (x - centroid). */
#include "reference_mpm.h"

#include "materials/material.h"

#include <math.h>
#include <stdlib.h>

/* Smallest eigenvalue of C / (mass h^2) with which a line is fitted. */
#define LEAST_SPREAD 1e-4

struct fit {
    struct reference *reference;
    enum reference_fitted what;
    double *weight;        /* [particle_count] of the present control volume; owned */
    double *value;         /* [particle_count] the present quantity; owned */
    struct tensor *result; /* [particle_count] owned */
    /* of the present control volume */
    double mass, centroid[3];
    struct tensor inverse; /* of C / (mass h h) */
    int singular;
};

struct line {
    double mean, slope[3];
};

static int is_volumetric(const struct fit *fit, const struct reference_particle *p)
{
    const size_t index = fit->reference->scene->materials[p->material].model_index;
    return fit->what == REFERENCE_DIVERGENCE ||
           (fit->what == REFERENCE_STRAIN && material_table[index]->volumetric);
}

/* A scalar is one component, and its own trace. */
static struct tensor tensor_of(const struct fit *fit, const struct reference_particle *p)
{
    struct tensor scalar = tensor_scale(tensor_unit(), 0);
    if (fit->what == REFERENCE_STRAIN)
        return p->update.strain;
    if (fit->what == REFERENCE_STRESS)
        return p->update.stress;
    scalar.m[0][0] = p->divergence;
    return scalar;
}

static enum talus_anti_locking_field field_of(const struct fit *fit)
{
    return fit->what == REFERENCE_DIVERGENCE ? TALUS_FIT_VOLUMETRIC
                                             : fit->reference->scene->solver.anti_locking_field;
}

/* Centre of mass and C^-1 of the control volume whose particles have fit->weight. */
static void measure(struct fit *fit)
{
    const struct reference *reference = fit->reference;
    const double *h = reference->scene->grid.cell;
    struct tensor C = tensor_unit();
    fit->mass = fit->centroid[0] = fit->centroid[1] = fit->centroid[2] = 0;
    for (size_t k = 0; k < reference->particle_count; k++) {
        fit->mass += fit->weight[k];
        for (size_t axis = 0; axis < 3; axis++)
            fit->centroid[axis] += fit->weight[k] * reference->particles[k].gathered[axis];
    }
    fit->singular = 1;
    if (fit->mass == 0 || field_of(fit) == TALUS_FIT_VOLUMETRIC)
        return;
    for (size_t axis = 0; axis < 3; axis++)
        fit->centroid[axis] /= fit->mass;
    for (size_t a = 0; a < reference->scene->axis_count; a++) {
        for (size_t b = 0; b < reference->scene->axis_count; b++) {
            C.m[a][b] = 0;
            for (size_t k = 0; k < reference->particle_count; k++) {
                const double *x = reference->particles[k].gathered;
                if (fit->weight[k] == 0)
                    continue;
                C.m[a][b] += fit->weight[k] * (x[a] - fit->centroid[a]) *
                             (x[b] - fit->centroid[b]) / (fit->mass * h[a] * h[b]);
            }
        }
    }
    const struct spectrum spectrum = tensor_spectrum(C);
    fit->singular =
        fmin(spectrum.value[0], fmin(spectrum.value[1], spectrum.value[2])) < LEAST_SPREAD;
    if (!fit->singular)
        fit->inverse = tensor_inverse(C);
}

/* Line through fit->value over the control volume; level where it is singular. */
static struct line find_line(const struct fit *fit)
{
    const struct reference *reference = fit->reference;
    const double *h = reference->scene->grid.cell;
    struct line line = {.mean = 0};
    double moment[3] = {0, 0, 0};
    for (size_t k = 0; k < reference->particle_count; k++) {
        if (fit->weight[k] > 0)
            line.mean += fit->weight[k] * fit->value[k] / fit->mass;
    }
    for (size_t k = 0; k < reference->particle_count && !fit->singular; k++) {
        if (fit->weight[k] == 0)
            continue;
        for (size_t axis = 0; axis < reference->scene->axis_count; axis++)
            moment[axis] += fit->weight[k] / fit->mass *
                            (reference->particles[k].gathered[axis] - fit->centroid[axis]) /
                            h[axis] * (fit->value[k] - line.mean);
    }
    for (size_t a = 0; a < reference->scene->axis_count && !fit->singular; a++) {
        for (size_t b = 0; b < reference->scene->axis_count; b++)
            line.slope[a] += fit->inverse.m[a][b] * moment[b] / h[a];
    }
    return line;
}

static double line_at(const struct fit *fit, const struct line *line, const double position[3])
{
    double value = line->mean;
    for (size_t axis = 0; axis < 3; axis++)
        value += line->slope[axis] * (position[axis] - fit->centroid[axis]);
    return value;
}

/* The same about the trace, or one component, of all particles. */
static struct line fit_component(struct fit *fit, int row, int column, int trace)
{
    for (size_t k = 0; k < fit->reference->particle_count; k++) {
        if (fit->weight[k] == 0)
            continue;
        const struct tensor q = tensor_of(fit, &fit->reference->particles[k]);
        fit->value[k] = trace ? tensor_trace(q) : q.m[row][column];
    }
    return find_line(fit);
}

/* The fitted trace at a point: a line for `full`, else the mean; always the mean where the rest is
 * fitted over other control volumes. */
static double fitted_trace(struct fit *fit, const double position[3])
{
    const struct line trace = fit_component(fit, 0, 0, 1);
    const int hybrid = fit->reference->scene->solver.anti_locking == TALUS_CONTROL_HYBRID;
    return field_of(fit) == TALUS_FIT_FULL && !hybrid ? line_at(fit, &trace, position) : trace.mean;
}

static struct tensor with_trace(struct tensor q, double trace)
{
    return tensor_add(q, (trace - tensor_trace(q)) / 3.0, tensor_unit());
}

/* All components at a point: lines on the diagonal, means beside it. */
static struct tensor fitted_tensor(struct fit *fit, const double position[3])
{
    struct tensor q = tensor_unit();
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            const struct line line = fit_component(fit, row, column, 0);
            q.m[row][column] = row == column ? line_at(fit, &line, position) : line.mean;
        }
    }
    return field_of(fit) == TALUS_FIT_FULL ? q : with_trace(q, fitted_trace(fit, position));
}

static int together(const struct fit *fit, const struct reference_particle *p, size_t material)
{
    return fit->what == REFERENCE_DIVERGENCE || p->material == material;
}

/* Weights of the cell of a particle. */
static void take_cell(struct fit *fit, const struct reference_particle *p)
{
    for (size_t k = 0; k < fit->reference->particle_count; k++) {
        const struct reference_particle *q = &fit->reference->particles[k];
        fit->weight[k] = q->cell == p->cell && together(fit, q, p->material) ? q->mass : 0;
    }
    measure(fit);
}

static void fit_cells(struct fit *fit)
{
    for (size_t k = 0; k < fit->reference->particle_count; k++) {
        const struct reference_particle *p = &fit->reference->particles[k];
        take_cell(fit, p);
        const int whole = field_of(fit) != TALUS_FIT_VOLUMETRIC && !fit->singular;
        if (is_volumetric(fit, p)) {
            fit->result[k].m[0][0] = fitted_trace(fit, p->gathered);
            continue;
        }
        fit->result[k] = whole ? fitted_tensor(fit, p->gathered)
                               : with_trace(tensor_of(fit, p), fit_component(fit, 0, 0, 1).mean);
    }
}

/* Weights of the support of a node. */
static void take_node(struct fit *fit, const int node[3], size_t material)
{
    for (size_t k = 0; k < fit->reference->particle_count; k++) {
        const struct reference_particle *q = &fit->reference->particles[k];
        double gradient[3];
        double weight = reference_hat(fit->reference, node, q->gathered, gradient);
        if (weight > 0 &&
            fit->reference->scene->solver.anti_locking_averaging != TALUS_AVERAGING_WEIGHTED)
            weight = 1;
        fit->weight[k] = together(fit, q, material) ? weight * q->mass : 0;
    }
    measure(fit);
}

/* Adds the share of a node to all particles of a material in its support. */
static void spread_node(struct fit *fit, const int node[3], size_t material, int whole)
{
    const struct talus_scene *scene = fit->reference->scene;
    double at[3] = {0, 0, 0};
    for (size_t axis = 0; axis < scene->axis_count; axis++)
        at[axis] = scene->grid.min[axis] + node[axis] * scene->grid.cell[axis];
    take_node(fit, node, material);
    if (fit->mass == 0)
        return;
    struct tensor value = tensor_scale(tensor_unit(), 0);
    if (whole)
        value = fitted_tensor(fit, at);
    else
        value.m[0][0] = fitted_trace(fit, at);
    for (size_t k = 0; k < fit->reference->particle_count; k++) {
        const struct reference_particle *p = &fit->reference->particles[k];
        double gradient[3];
        double share = reference_hat(fit->reference, node, p->gathered, gradient);
        if (share > 0 && scene->solver.anti_locking_averaging == TALUS_AVERAGING_UNWEIGHTED)
            share = 1.0 / (1 << scene->axis_count);
        if (fit->weight[k] > 0)
            fit->result[k] = tensor_add(fit->result[k], share, value);
    }
}

/* result <- sum N (value at the node), of the tensor or of its trace in [0][0]. */
static void fit_nodes(struct fit *fit, int whole)
{
    const int *line = fit->reference->node_line;
    const size_t sets =
        fit->what == REFERENCE_DIVERGENCE ? 1 : fit->reference->scene->material_count;
    for (int index = 0; index < line[0] * line[1] * line[2]; index++) {
        const int node[3] = {index % line[0], index / line[0] % line[1], index / line[0] / line[1]};
        /* Of the positions that are fitted; there is none before the first forces. */
        if (fit->reference->time > 0 && fit->reference->nodes[index].mass == 0)
            continue;
        for (size_t material = 0; material < sets; material++)
            spread_node(fit, node, material, whole);
    }
}

/* The trace of the nodes into what is left as it is, or fitted over cells. */
static void join_trace(struct fit *fit)
{
    const int hybrid = fit->reference->scene->solver.anti_locking == TALUS_CONTROL_HYBRID;
    for (size_t k = 0; k < fit->reference->particle_count; k++) {
        const struct reference_particle *p = &fit->reference->particles[k];
        const double trace = fit->result[k].m[0][0];
        if (is_volumetric(fit, p))
            continue;
        take_cell(fit, p);
        const int whole = hybrid && field_of(fit) != TALUS_FIT_VOLUMETRIC && !fit->singular;
        fit->result[k] =
            with_trace(whole ? fitted_tensor(fit, p->gathered) : tensor_of(fit, p), trace);
    }
}

static void write_back(struct fit *fit)
{
    for (size_t k = 0; k < fit->reference->particle_count; k++) {
        struct reference_particle *p = &fit->reference->particles[k];
        struct tensor result = fit->result[k];
        if (is_volumetric(fit, p)) { /* only its trace means something */
            const double trace = tensor_trace(result);
            result = tensor_scale(result, 0);
            result.m[0][0] = trace;
        }
        if (fit->what == REFERENCE_STRAIN)
            p->update.strain = result;
        else if (fit->what == REFERENCE_STRESS)
            p->update.stress = result;
        else
            p->divergence = result.m[0][0];
    }
}

void reference_fit(struct reference *reference, enum reference_fitted what)
{
    const size_t count = reference->particle_count;
    struct fit fit = {.reference = reference,
                      .what = what,
                      .weight = calloc(count, sizeof *fit.weight),
                      .value = calloc(count, sizeof *fit.value),
                      .result = calloc(count, sizeof *fit.result)};
    if (fit.weight == NULL || fit.value == NULL || fit.result == NULL)
        abort();
    const int node = reference->scene->solver.anti_locking == TALUS_CONTROL_NODE;
    const int whole = node && field_of(&fit) != TALUS_FIT_VOLUMETRIC;
    if (reference->scene->solver.anti_locking == TALUS_CONTROL_CELL)
        fit_cells(&fit);
    else
        fit_nodes(&fit, whole);
    if (reference->scene->solver.anti_locking != TALUS_CONTROL_CELL && !whole)
        join_trace(&fit);
    write_back(&fit);
    free(fit.weight);
    free(fit.value);
    free(fit.result);
}
