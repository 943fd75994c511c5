/* SPDX-License-Identifier: Apache-2.0 */
#include "antilocking/node_fit.h"

#include "antilocking/cell_fit.h"

#include <assert.h>
#include <string.h>

static size_t triangle(size_t axis_count)
{
    return axis_count * (axis_count + 1) / 2;
}

void node_fit_init(struct node_fit *fit, const struct talus_scene *scene, size_t component_count)
{
    const struct talus_solver_options *solver = &scene->solver;
    const bool hybrid = solver->anti_locking == TALUS_CONTROL_HYBRID;
    const bool whole = solver->anti_locking_field != TALUS_FIT_VOLUMETRIC;
    memset(fit, 0, sizeof *fit);
    if (solver->anti_locking != TALUS_CONTROL_NODE && !hybrid)
        return;
    fit->active = true;
    fit->averaging = solver->anti_locking_averaging;
    fit->trace_only = hybrid || !whole;
    fit->constant_trace = solver->anti_locking_field == TALUS_FIT_FULL_CONSTANT_VOLUME;
    fit->axis_count = scene->axis_count;
    fit->normal_count = scene->dimension == TALUS_PLANE_STRESS ? 2 : 3;
    fit->quantity_count = fit->trace_only ? 1 : component_count;
    fit->linear_count = fit->trace_only ? 0 : 3;
    fit->set_count = scene->material_count;
    for (size_t axis = 0; axis < scene->axis_count; axis++)
        fit->origin[axis] = (int32_t)(scene->grid.cell_count[axis] / 2);
    const size_t moments = fit->linear_count > 0 ? fit->axis_count + triangle(fit->axis_count) : 0;
    fit->quantity_stride = (uint32_t)(fit->quantity_count + fit->linear_count * fit->axis_count);
    fit->set_stride = (uint32_t)(1 + moments) + 2 * fit->quantity_stride;
    fit->shares_mass = fit->set_count == 1 && fit->averaging == TALUS_AVERAGING_WEIGHTED;
    fit->wants_divergence = solver->viscous_damping > 0;
    fit->component_count = (uint32_t)fit->set_count * fit->set_stride + fit->wants_divergence;
}

void node_fit_place(struct node_fit *fit, uint32_t first)
{
    fit->first = first;
    fit->divergence = first + (uint32_t)fit->set_count * fit->set_stride;
}

static uint32_t set_component(const struct node_fit *fit, size_t set)
{
    return fit->first + (uint32_t)set * fit->set_stride;
}

static uint32_t quantity_component(const struct node_fit *fit, size_t set, enum node_fit_what what,
                                   size_t quantity)
{
    const size_t linear = quantity < fit->linear_count ? quantity : fit->linear_count;
    return set_component(fit, set) + fit->set_stride - 2 * fit->quantity_stride +
           (uint32_t)what * fit->quantity_stride + (uint32_t)(quantity + linear * fit->axis_count);
}

/* Pairs of node blocks that the cells of a block touch: at the same x, and LANE_COUNT further. */
static size_t pair_count(const struct node_fit *fit)
{
    return (size_t)1 << (fit->axis_count - 1);
}

/* Every node of a cell gets the whole sum over the cell. */
static void scatter_cells(const struct node_fit *fit, const struct node_fit_block *at,
                          const real *weight, const real *value, uint32_t component)
{
    const size_t count = (size_t)at->block->row_count * LANE_COUNT;
    lanes sum = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes w = lanes_load(weight + slot);
        sum += value == NULL ? w : w * lanes_load(value + slot);
    }
    for (size_t pair = 0; pair < pair_count(fit); pair++) {
        real *lower = node_values(at->context->nodes, at->block->nodes[2 * pair], component);
        real *upper = node_values(at->context->nodes, at->block->nodes[2 * pair + 1], component);
        lanes_store(lower, lanes_load(lower) + sum + lanes_shift_up(sum));
        upper[0] += sum[LANE_COUNT - 1];
    }
}

/* Every particle of a cell gets the mean of the nodes of the cell. */
static void gather_cells(const struct node_fit *fit, const struct node_fit_block *at,
                         uint32_t component, real *values)
{
    const size_t count = (size_t)at->block->row_count * LANE_COUNT;
    lanes sum = {0};
    for (size_t pair = 0; pair < pair_count(fit); pair++) {
        const real *lower = node_values(at->context->nodes, at->block->nodes[2 * pair], component);
        const real *upper =
            node_values(at->context->nodes, at->block->nodes[2 * pair + 1], component);
        const lanes near = lanes_load(lower);
        sum += near + lanes_shift_down(near, upper[0]);
    }
    const lanes mean = sum * (real)(1.0 / (2.0 * (double)pair_count(fit)));
    for (size_t slot = 0; slot < count; slot += LANE_COUNT)
        lanes_store(values + slot, mean);
}

/* sum N m value; without N where the support is treated as one large cell. */
static void scatter_sum(const struct node_fit *fit, const struct node_fit_block *at,
                        const real *weight, const real *value, uint32_t component)
{
    if (fit->averaging == TALUS_AVERAGING_WEIGHTED)
        at->kernels->scatter_values(at->context, at->block, weight, 1, &value, component);
    else
        scatter_cells(fit, at, weight, value, component);
}

static void gather_value(const struct node_fit *fit, const struct node_fit_block *at,
                         uint32_t component, real *values)
{
    if (fit->averaging == TALUS_AVERAGING_UNWEIGHTED)
        gather_cells(fit, at, component, values);
    else
        at->kernels->gather_values(at->context, at->block, 1, &values, component);
}

void node_fit_locate(const struct node_fit *fit, const struct node_fit_block *at)
{
    const size_t count = (size_t)at->block->row_count * LANE_COUNT;
    assert(fit->axis_count <= 3);
    for (uint32_t axis = 0; axis < fit->axis_count && fit->linear_count > 0; axis++) {
        const real *position =
            particle_values(at->context->particles, at->block, PARTICLE_POSITION, axis);
        const real corner = (real)(at->block->cell[axis] - fit->origin[axis]) + (real)0.5;
        lanes centre = lanes_splat(corner);
        for (int lane = 0; lane < LANE_COUNT && axis == 0; lane++)
            centre[lane] += (real)lane;
        for (size_t slot = 0; slot < count; slot += LANE_COUNT)
            lanes_store(at->coordinate[axis] + slot, centre + lanes_load(position + slot));
    }
}

static const real *multiply(const struct node_fit_block *at, const real *a, const real *b)
{
    const size_t count = (size_t)at->block->row_count * LANE_COUNT;
    for (size_t slot = 0; slot < count; slot += LANE_COUNT)
        lanes_store(at->product + slot, lanes_load(a + slot) * lanes_load(b + slot));
    return at->product;
}

void node_fit_scatter_masses(const struct node_fit *fit, const struct node_fit_block *at,
                             size_t set, const real *weight, bool taken)
{
    uint32_t component = set_component(fit, set);
    if (!(taken && fit->shares_mass))
        scatter_sum(fit, at, weight, NULL, component);
    component++;
    if (fit->linear_count == 0)
        return;
    for (size_t axis = 0; axis < fit->axis_count; axis++)
        scatter_sum(fit, at, weight, at->coordinate[axis], component++);
    for (size_t row = 0; row < fit->axis_count; row++) {
        for (size_t column = row; column < fit->axis_count; column++)
            scatter_sum(fit, at, weight, multiply(at, at->coordinate[row], at->coordinate[column]),
                        component++);
    }
}

void node_fit_scatter(const struct node_fit *fit, const struct node_fit_block *at, size_t set,
                      enum node_fit_what what, const real *weight, real *const *quantities)
{
    for (size_t quantity = 0; quantity < fit->quantity_count; quantity++) {
        uint32_t component = quantity_component(fit, set, what, quantity);
        scatter_sum(fit, at, weight, quantities[quantity], component++);
        for (size_t axis = 0; axis < fit->axis_count && quantity < fit->linear_count; axis++)
            scatter_sum(fit, at, weight, multiply(at, quantities[quantity], at->coordinate[axis]),
                        component++);
    }
}

void node_fit_scatter_divergence(const struct node_fit *fit, const struct node_fit_block *at,
                                 const real *mass, const real *divergence)
{
    scatter_sum(fit, at, mass, divergence, fit->divergence);
}

void node_fit_gather(const struct node_fit *fit, const struct node_fit_block *at, size_t set,
                     enum node_fit_what what, real *const *quantities)
{
    for (size_t quantity = 0; quantity < fit->quantity_count; quantity++)
        gather_value(fit, at, quantity_component(fit, set, what, quantity), quantities[quantity]);
}

void node_fit_gather_divergence(const struct node_fit *fit, const struct node_fit_block *at,
                                real *divergence)
{
    gather_value(fit, at, fit->divergence, divergence);
}

void node_fit_clear(const struct node_fit *fit, const struct node_blocks *nodes, size_t block)
{
    memset(node_values(nodes, block, fit->first), 0,
           fit->component_count * LANE_COUNT * sizeof(real));
}

void node_fit_take_mass(const struct node_fit *fit, const struct node_blocks *nodes, size_t block)
{
    if (fit->shares_mass)
        lanes_store(node_values(nodes, block, set_component(fit, 0)),
                    lanes_load(node_values(nodes, block, nodes->layout.mass)));
}

/* How the particles around the nodes of a block lie. */
struct node_support {
    lanes inverse_mass;  /* 0 without mass */
    lanes centroid[3];   /* from the origin, in cell widths */
    lanes offset[3];     /* node - centroid */
    lanes inverse[3][3]; /* of C / mass; 0 where it is singular */
    size_t fall_backs;
};

static lanes load_component(const struct node_blocks *nodes, size_t block, size_t component)
{
    return lanes_load(node_values(nodes, block, (uint32_t)component));
}

static void load_support(const struct node_fit *fit, const struct node_blocks *nodes, size_t block,
                         size_t set, struct node_support *support)
{
    size_t component = set_component(fit, set);
    const lanes mass = load_component(nodes, block, component++);
    const lane_mask loaded = mass > 0;
    support->inverse_mass = lanes_keep(loaded, 1 / lanes_select(loaded, mass, lanes_splat(1)));
    support->fall_backs = 0;
    lanes C[3][3] = {{{0}}};
    assert(fit->axis_count <= 3);
    for (size_t axis = 0; axis < fit->axis_count; axis++) {
        lanes place = lanes_splat((real)(nodes->place[block][axis] - fit->origin[axis]));
        for (int lane = 0; lane < LANE_COUNT && axis == 0; lane++)
            place[lane] += (real)lane;
        support->centroid[axis] = support->inverse_mass * load_component(nodes, block, component++);
        support->offset[axis] = place - support->centroid[axis];
    }
    for (size_t row = 0; row < fit->axis_count; row++) {
        for (size_t column = row; column < fit->axis_count; column++)
            C[row][column] = C[column][row] =
                support->inverse_mass * load_component(nodes, block, component++) -
                support->centroid[row] * support->centroid[column];
    }
    const lane_mask singular = fit_inverse(fit->axis_count, C, support->inverse);
    for (int lane = 0; lane < LANE_COUNT; lane++)
        support->fall_backs += loaded[lane] != 0 && singular[lane] != 0;
}

/* Rise of a linear quantity from the centroid to the node. */
static lanes rise(const struct node_fit *fit, const struct node_support *support,
                  const struct node_blocks *nodes, size_t block, size_t component, lanes mean)
{
    lanes moment[3] = {{0}}, sum = {0};
    for (size_t axis = 0; axis < fit->axis_count; axis++)
        moment[axis] = support->inverse_mass * load_component(nodes, block, component + axis) -
                       support->centroid[axis] * mean;
    for (size_t row = 0; row < fit->axis_count; row++) {
        for (size_t axis = 0; axis < fit->axis_count; axis++)
            sum += support->offset[row] * support->inverse[row][axis] * moment[axis];
    }
    return sum;
}

static void solve_set(const struct node_fit *fit, const struct node_blocks *nodes, size_t block,
                      size_t set, enum node_fit_what what, const struct node_support *support)
{
    lanes value[6], trace_rise = {0};
    assert(fit->quantity_count <= 6);
    for (size_t quantity = 0; quantity < fit->quantity_count; quantity++) {
        const size_t component = quantity_component(fit, set, what, quantity);
        const lanes mean = support->inverse_mass * load_component(nodes, block, component);
        lanes climb = {0};
        if (quantity < fit->linear_count)
            climb = rise(fit, support, nodes, block, component + 1, mean);
        if (quantity < fit->normal_count)
            trace_rise += climb;
        value[quantity] = mean + climb;
    }
    for (size_t quantity = 0; quantity < fit->quantity_count; quantity++) {
        if (fit->constant_trace && quantity < fit->normal_count)
            value[quantity] -= trace_rise * (real)(1.0 / (double)fit->normal_count);
        lanes_store(node_values(nodes, block, quantity_component(fit, set, what, quantity)),
                    value[quantity]);
    }
}

/* Without lines, and one quantity. */
static void solve_mean(const struct node_fit *fit, const struct node_blocks *nodes, size_t block,
                       size_t set, enum node_fit_what what)
{
    const lanes mass = load_component(nodes, block, set_component(fit, set));
    real *value = node_values(nodes, block, quantity_component(fit, set, what, 0));
    lanes_store(value, lanes_keep(mass > 0, lanes_load(value) /
                                                lanes_select(mass > 0, mass, lanes_splat(1))));
}

/* Over all materials: damping is of the motion. */
static void solve_divergence(const struct node_fit *fit, const struct node_blocks *nodes,
                             size_t block)
{
    lanes mass = {0};
    for (size_t set = 0; set < fit->set_count; set++)
        mass += load_component(nodes, block, set_component(fit, set));
    real *values = node_values(nodes, block, fit->divergence);
    lanes_store(values, lanes_load(values) / lanes_select(mass > 0, mass, lanes_splat(1)));
}

size_t node_fit_solve(const struct node_fit *fit, const struct node_blocks *nodes, size_t block,
                      enum node_fit_what what)
{
    size_t fall_backs = 0;
    for (size_t set = 0; set < fit->set_count; set++) {
        struct node_support support;
        if (fit->trace_only) {
            solve_mean(fit, nodes, block, set, what);
            continue;
        }
        load_support(fit, nodes, block, set, &support);
        solve_set(fit, nodes, block, set, what, &support);
        fall_backs += support.fall_backs;
    }
    if (what == NODE_FIT_STRAIN && fit->wants_divergence)
        solve_divergence(fit, nodes, block);
    return fall_backs;
}
