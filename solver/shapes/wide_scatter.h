/* SPDX-License-Identifier: Apache-2.0 */
/* The scattering kernels of wide shapes; included by wide_kernel.h (no guard). */

/* sums += the momentum of the particles, N m (v + affine part); overwrites the slopes of the chunk
 * if there is one. */
static void LOCAL(spread_momentum)(struct LOCAL(chunk) * chunk, const real *mass,
                                   struct LOCAL(sums) sums[DIMENSION])
{
    lanes p[DIMENSION][WIDE_CHUNK], q[DIMENSION][DIMENSION][WIDE_CHUNK];
    const bool affine = chunk->context->particles->component_count[PARTICLE_AFFINE] > 0;
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        const real *velocity = LOCAL(values)(chunk, PARTICLE_VELOCITY, axis);
        for (size_t r = 0; r < chunk->rows; r++) {
            const size_t slot = (chunk->begin + r) * LANE_COUNT;
            p[axis][r] = lanes_load(mass + slot) * lanes_load(velocity + slot);
        }
        for (uint32_t along = 0; affine && along < DIMENSION; along++) {
            const real *slope = LOCAL(values)(chunk, PARTICLE_AFFINE, DIMENSION * axis + along);
            for (size_t r = 0; r < chunk->rows; r++) {
                const size_t slot = (chunk->begin + r) * LANE_COUNT;
                q[axis][along][r] = lanes_load(mass + slot) * lanes_load(slope + slot);
            }
        }
    }
    LOCAL(spread)(chunk, p, DIMENSION, sums);
    if (affine) {
        LOCAL(chunk_affine)(chunk, false);
        LOCAL(spread_slopes)(chunk, q, sums);
    }
}

/* sums -= V0 tau . grad N. */
static void LOCAL(spread_force)(const struct LOCAL(chunk) * chunk,
                                const struct scatter_source *source,
                                struct LOCAL(sums) sums[DIMENSION])
{
    lanes q[DIMENSION][DIMENSION][WIDE_CHUNK];
    for (size_t r = 0; r < chunk->rows; r++) {
        const size_t slot = (chunk->begin + r) * LANE_COUNT;
        const lanes volume = lanes_load(source->volume + slot);
        UNROLL for (int along = 0; along < DIMENSION; along++)
        {
            const lanes factor = -volume * chunk->context->inverse_cell[along];
            UNROLL for (int axis = 0; axis < DIMENSION; axis++)
            {
                q[axis][along][r] =
                    factor * lanes_load(source->stress[sym3_component[axis][along]] + slot);
            }
        }
    }
    LOCAL(spread_slopes)(chunk, q, sums);
}

/* sums += N weight value; `value` NULL: 1. */
static void LOCAL(spread_value)(const struct LOCAL(chunk) * chunk, const real *weight,
                                const real *value, struct LOCAL(sums) * sums)
{
    lanes part[1][WIDE_CHUNK];
    for (size_t r = 0; r < chunk->rows; r++) {
        const size_t slot = (chunk->begin + r) * LANE_COUNT;
        part[0][r] = lanes_load(weight + slot);
        if (value != NULL)
            part[0][r] *= lanes_load(value + slot);
    }
    LOCAL(spread)(chunk, part, 1, sums);
}

static void LOCAL(scatter)(const struct shape_context *context, const struct particle_block *block,
                           const struct scatter_source *source, unsigned what)
{
    const struct node_layout *layout = &context->nodes->layout;
    struct LOCAL(sums) mass = {0}, force[DIMENSION] = {0}, momentum[DIMENSION] = {0};
    struct LOCAL(chunk) chunk;
    LOCAL(chunk_init)(context, block, &chunk);
    while (LOCAL(chunk_next)(&chunk)) {
        if (what & SCATTER_MASS)
            LOCAL(spread_value)(&chunk, source->mass, NULL, &mass);
        if (what & SCATTER_FORCE)
            LOCAL(spread_force)(&chunk, source, force);
        if (what & SCATTER_MOMENTUM)
            LOCAL(spread_momentum)(&chunk, source->mass, momentum);
    }
    if (what & SCATTER_MASS)
        LOCAL(merge)(&chunk, layout->mass, &mass, 1);
    if (what & SCATTER_FORCE)
        LOCAL(merge)(&chunk, layout->force, force, DIMENSION);
    if (what & SCATTER_MOMENTUM)
        LOCAL(merge)(&chunk, layout->momentum, momentum, DIMENSION);
}

static void LOCAL(scatter_values)(const struct shape_context *context,
                                  const struct particle_block *block, const real *weight,
                                  size_t count, const real *const *values, uint32_t first)
{
    struct LOCAL(chunk) chunk;
    LOCAL(chunk_init)(context, block, &chunk);
    while (LOCAL(chunk_next)(&chunk)) {
        for (size_t index = 0; index < count; index++) {
            struct LOCAL(sums) sums = {0};
            LOCAL(spread_value)(&chunk, weight, values[index], &sums);
            LOCAL(merge)(&chunk, first + (uint32_t)index, &sums, 1);
        }
    }
}

/* One particle: the weights of its row, in its lane. */
struct LOCAL(one) {
    const struct shape_context *context;
    const struct particle_block *block;
    size_t slot;
    const real *force_stress; /* [6] V0 tau */
    unsigned what;
    real w[DIMENSION][WIDE_NODES], slope[DIMENSION][WIDE_NODES], arm[DIMENSION][WIDE_NODES];
};

static void LOCAL(one_weights)(struct LOCAL(one) * one)
{
    const size_t lane = one->slot % LANE_COUNT;
    struct LOCAL(support) support;
    struct LOCAL(stencil) stencil;
    LOCAL(support_init)(one->context, one->block, &support);
    LOCAL(stencil_at)(&support, one->slot - lane, &stencil);
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        for (int k = 0; k < WIDE_NODES; k++) {
            one->w[axis][k] = stencil.w[axis][k][lane];
            one->slope[axis][k] = stencil.dw[axis][k][lane] * one->context->inverse_cell[axis];
            one->arm[axis][k] = (real)k - (real)1.5 - support.position[axis][one->slot];
        }
    }
}

/* What it gives to the node at offsets k, which is `node` of a node block. */
static void LOCAL(add_one)(const struct LOCAL(one) * one, const int k[3], uint32_t node_block,
                           size_t node)
{
    const struct particle_layout *particles = one->context->particles;
    const struct node_layout *layout = &one->context->nodes->layout;
    const bool affine = particles->component_count[PARTICLE_AFFINE] > 0;
    real *values = node_values(one->context->nodes, node_block, 0) + node, slope[DIMENSION];
    real mass = particle_values(particles, one->block, PARTICLE_MASS, 0)[one->slot];
    for (int axis = 0; axis < DIMENSION; axis++) {
        mass *= one->w[axis][k[axis]];
        slope[axis] = one->slope[axis][k[axis]];
        for (int other = 0; other < DIMENSION; other++)
            slope[axis] *= other == axis ? 1 : one->w[other][k[other]];
    }
    if (one->what & SCATTER_MASS)
        values[layout->mass * LANE_COUNT] += mass;
    for (uint32_t row = 0; row < DIMENSION; row++) {
        real force = 0;
        real velocity = particle_values(particles, one->block, PARTICLE_VELOCITY, row)[one->slot];
        for (uint32_t axis = 0; axis < DIMENSION; axis++) {
            force -= one->force_stress[sym3_component[row][axis]] * slope[axis];
            if (affine)
                velocity += particle_values(particles, one->block, PARTICLE_AFFINE,
                                            DIMENSION * row + axis)[one->slot] *
                            one->arm[axis][k[axis]];
        }
        if (one->what & SCATTER_FORCE)
            values[(layout->force + row) * LANE_COUNT] += force;
        if (one->what & SCATTER_MOMENTUM)
            values[(layout->momentum + row) * LANE_COUNT] += mass * velocity;
    }
}

static void LOCAL(scatter_one)(const struct shape_context *context,
                               const struct particle_block *block, size_t slot,
                               const real force_stress[6], unsigned what)
{
    struct LOCAL(one) one = {context, block, slot, force_stress, what, {{0}}, {{0}}, {{0}}};
    LOCAL(one_weights)(&one);
    for (int row = 0; row < WIDE_ROWS; row++) {
        for (int x = 0; x < WIDE_NODES; x++) {
            const int k[3] = {x, row % WIDE_COLUMNS, row / WIDE_COLUMNS};
            const size_t column = WINDOW_ORIGIN + slot % LANE_COUNT + (size_t)x - 1;
            const uint32_t nodes = block->wide_nodes[3 * (size_t)row + column / LANE_COUNT];
            LOCAL(add_one)(&one, k, nodes, column % LANE_COUNT);
        }
    }
}
