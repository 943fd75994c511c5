/* SPDX-License-Identifier: Apache-2.0 */
/* The linear kernels for DIMENSION axes; included once per dimension by linear.c (no guard).
 * Basis index s: bit 0 x, bit 1 y, bit 2 z; basis_s is the product of the coordinates of its bits.
 */
#define CONCAT_(a, b) a##_##b
#define CONCAT(a, b) CONCAT_(a, b)
#define LOCAL(name) CONCAT(name, DIMENSION)
#define BASIS (1 << DIMENSION)
#ifdef __OPTIMIZE__
#define UNROLL _Pragma("GCC unroll 8")
#else
#define UNROLL /* gcc warns where it cannot follow it */
#endif

/* phi_s at the particles of one row. */
static inline void LOCAL(basis)(const lanes position[DIMENSION], lanes phi[BASIS])
{
    phi[0] = lanes_splat(1.0);
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        UNROLL for (int s = 0; s < 1 << axis; s++)
        {
            phi[s | 1 << axis] = phi[s] * position[axis];
        }
    }
}

static inline void LOCAL(load_position)(double *const values[DIMENSION], size_t slot,
                                        lanes position[DIMENSION])
{
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        position[axis] = lanes_load(values[axis] + slot);
    }
}

/* Node values of one component -> polynomial coefficients in every cell of the block. */
static inline void LOCAL(load_coefficients)(const struct node_blocks *nodes,
                                            const struct particle_block *block, uint32_t component,
                                            lanes c[BASIS])
{
    UNROLL for (int s = 0; s < BASIS; s += 2)
    {
        const lanes low = lanes_load(node_values(nodes, block->nodes[s], component));
        const lanes high =
            lanes_shift_down(low, *node_values(nodes, block->nodes[s + 1], component));
        c[s] = 0.5 * (low + high);
        c[s + 1] = high - low;
    }
    UNROLL for (int bit = 2; bit < BASIS; bit *= 2)
    {
        UNROLL for (int s = 0; s < BASIS; s++)
        {
            if (s & bit)
                continue;
            const lanes low = c[s], high = c[s | bit];
            c[s] = 0.5 * (low + high);
            c[s | bit] = high - low;
        }
    }
}

/* Moments of one component -> added to the nodes: the transpose of load_coefficients. */
static inline void LOCAL(add_moments)(struct node_blocks *nodes, const struct particle_block *block,
                                      uint32_t component, lanes moment[BASIS])
{
    UNROLL for (int bit = BASIS / 2; bit > 1; bit /= 2)
    {
        UNROLL for (int s = 0; s < BASIS; s++)
        {
            if (s & bit)
                continue;
            const lanes half = 0.5 * moment[s], slope = moment[s | bit];
            moment[s] = half - slope;
            moment[s | bit] = half + slope;
        }
    }
    UNROLL for (int s = 0; s < BASIS; s += 2)
    {
        const lanes low = 0.5 * moment[s] - moment[s + 1];
        const lanes high = 0.5 * moment[s] + moment[s + 1];
        double *near = node_values(nodes, block->nodes[s], component);
        lanes_store(near, lanes_load(near) + low + lanes_shift_up(high));
        *node_values(nodes, block->nodes[s + 1], component) += high[LANE_COUNT - 1];
    }
}

static inline lanes LOCAL(evaluate)(const lanes c[BASIS], const lanes phi[BASIS])
{
    lanes value = c[0];
    UNROLL for (int s = 1; s < BASIS; s++)
    {
        value += c[s] * phi[s];
    }
    return value;
}

/* d/dx of the polynomial along one axis, per cell width. */
static inline lanes LOCAL(differentiate)(const lanes c[BASIS], const lanes phi[BASIS], int axis)
{
    lanes value = c[1 << axis];
    UNROLL for (int s = 1; s < BASIS; s++)
    {
        if (s & 1 << axis || s == 0)
            continue;
        value += c[s | 1 << axis] * phi[s];
    }
    return value;
}

static inline void LOCAL(position_arrays)(const struct shape_context *context,
                                          const struct particle_block *block,
                                          double *values[DIMENSION])
{
    for (uint32_t axis = 0; axis < DIMENSION; axis++)
        values[axis] = particle_values(context->particles, block, PARTICLE_POSITION, axis);
}

static void LOCAL(kick)(const struct shape_context *context, struct particle_block *block)
{
    double *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const double *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const struct node_layout *layout = &context->nodes->layout;
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        double *velocity = particle_values(context->particles, block, PARTICLE_VELOCITY, axis);
        lanes c[BASIS], moment[BASIS] = {0};
        LOCAL(load_coefficients)(context->nodes, block, layout->kick + axis, c);
        for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
            lanes x[DIMENSION], phi[BASIS];
            LOCAL(load_position)(position, slot, x);
            LOCAL(basis)(x, phi);
            const lanes m = lanes_load(mass + slot);
            /* Empty slots must not gather velocity. */
            const lanes v =
                lanes_keep(m > 0.0, lanes_load(velocity + slot) + LOCAL(evaluate)(c, phi));
            lanes_store(velocity + slot, v);
            const lanes p = m * v;
            UNROLL for (int s = 0; s < BASIS; s++)
            {
                moment[s] += p * phi[s];
            }
        }
        LOCAL(add_moments)(context->nodes, block, layout->momentum + axis, moment);
    }
}

static void LOCAL(apply_correction)(const struct shape_context *context,
                                    struct particle_block *block)
{
    double *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const double *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        double *velocity = particle_values(context->particles, block, PARTICLE_VELOCITY, axis);
        lanes c[BASIS];
        LOCAL(load_coefficients)
        (context->nodes, block, context->nodes->layout.correction + axis, c);
        for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
            lanes x[DIMENSION], phi[BASIS];
            LOCAL(load_position)(position, slot, x);
            LOCAL(basis)(x, phi);
            const lanes dv = lanes_keep(lanes_load(mass + slot) > 0.0, LOCAL(evaluate)(c, phi));
            lanes_store(velocity + slot, lanes_load(velocity + slot) + dv);
        }
    }
}

static void LOCAL(gather)(const struct shape_context *context, struct particle_block *block,
                          bool correct, struct block_scratch *scratch)
{
    if (correct)
        LOCAL(apply_correction)(context, block);
    double *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const double *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        lanes c[BASIS];
        LOCAL(load_coefficients)
        (context->nodes, block, context->nodes->layout.velocity + axis, c);
        for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
            lanes x[DIMENSION], phi[BASIS];
            LOCAL(load_position)(position, slot, x);
            LOCAL(basis)(x, phi);
            const lane_mask filled = lanes_load(mass + slot) > 0.0;
            lanes_store(scratch->velocity[axis] + slot,
                        lanes_keep(filled, LOCAL(evaluate)(c, phi)));
            UNROLL for (int along = 0; along < DIMENSION; along++)
            {
                const lanes slope =
                    LOCAL(differentiate)(c, phi, along) * context->inverse_cell[along];
                lanes_store(scratch->gradient[3 * axis + (uint32_t)along] + slot,
                            lanes_keep(filled, slope));
            }
        }
    }
}

/* force_k: moment_s -= sum over the axes a in s of q_ka phi_(s without a). */
static inline void LOCAL(add_force)(lanes moment[BASIS], const lanes q[DIMENSION],
                                    const lanes phi[BASIS])
{
    UNROLL for (int s = 1; s < BASIS; s++)
    {
        UNROLL for (int axis = 0; axis < DIMENSION; axis++)
        {
            if (s & 1 << axis)
                moment[s] -= q[axis] * phi[s ^ 1 << axis];
        }
    }
}

/* Index of component (row, column) in the order xx yy zz xy yz xz. */
static const unsigned char LOCAL(symmetric_index)[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

static void LOCAL(scatter_force)(const struct shape_context *context,
                                 const struct particle_block *block,
                                 const struct block_scratch *scratch, uint32_t row)
{
    double *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    lanes moment[BASIS] = {0};
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION], phi[BASIS], q[DIMENSION];
        LOCAL(load_position)(position, slot, x);
        LOCAL(basis)(x, phi);
        UNROLL for (int axis = 0; axis < DIMENSION; axis++)
        {
            const double *values = scratch->force_stress[LOCAL(symmetric_index)[row][axis]];
            q[axis] = lanes_load(values + slot) * context->inverse_cell[axis];
        }
        LOCAL(add_force)(moment, q, phi);
    }
    LOCAL(add_moments)(context->nodes, block, context->nodes->layout.force + row, moment);
}

/* component_i += sum N weight (velocity or 1). */
static void LOCAL(scatter_weight)(const struct shape_context *context,
                                  const struct particle_block *block, const double *weight,
                                  const double *velocity, uint32_t component)
{
    double *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    lanes moment[BASIS] = {0};
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION], phi[BASIS];
        LOCAL(load_position)(position, slot, x);
        LOCAL(basis)(x, phi);
        lanes w = lanes_load(weight + slot);
        if (velocity != NULL)
            w *= lanes_load(velocity + slot);
        UNROLL for (int s = 0; s < BASIS; s++)
        {
            moment[s] += w * phi[s];
        }
    }
    LOCAL(add_moments)(context->nodes, block, component, moment);
}

static void LOCAL(scatter)(const struct shape_context *context, const struct particle_block *block,
                           const struct block_scratch *scratch, bool momentum)
{
    const struct node_layout *layout = &context->nodes->layout;
    LOCAL(scatter_weight)(context, block, scratch->mass, NULL, layout->mass);
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        LOCAL(scatter_force)(context, block, scratch, axis);
        if (momentum)
            LOCAL(scatter_weight)
        (context, block, scratch->mass,
         particle_values(context->particles, block, PARTICLE_VELOCITY, axis),
         layout->momentum + axis);
    }
}

static void LOCAL(scatter_one)(const struct shape_context *context,
                               const struct particle_block *block, size_t slot,
                               const double force_stress[6], bool momentum)
{
    double *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const double mass = particle_values(context->particles, block, PARTICLE_MASS, 0)[slot];
    const struct node_layout *layout = &context->nodes->layout;
    const size_t lane = slot % LANE_COUNT;
    for (int corner = 0; corner < BASIS; corner++) {
        double weight = 1.0, slope[DIMENSION];
        for (int axis = 0; axis < DIMENSION; axis++) {
            const double sign = corner >> axis & 1 ? 1.0 : -1.0;
            weight *= 0.5 + sign * position[axis][slot];
            slope[axis] = sign * context->inverse_cell[axis];
            for (int other = 0; other < DIMENSION; other++) {
                if (other != axis)
                    slope[axis] *= 0.5 + (corner >> other & 1 ? 1.0 : -1.0) * position[other][slot];
            }
        }
        /* The upper x node of the last lane is the first of the next block. */
        const size_t shifted = lane + (size_t)(corner & 1);
        const uint32_t node_block = block->nodes[shifted == LANE_COUNT ? corner : corner & ~1];
        const size_t node = shifted % LANE_COUNT;
        node_values(context->nodes, node_block, layout->mass)[node] += weight * mass;
        for (uint32_t row = 0; row < DIMENSION; row++) {
            double force = 0;
            for (int axis = 0; axis < DIMENSION; axis++)
                force -= force_stress[LOCAL(symmetric_index)[row][axis]] * slope[axis];
            node_values(context->nodes, node_block, layout->force + row)[node] += force;
            if (momentum)
                node_values(context->nodes, node_block, layout->momentum + row)[node] +=
                    weight * mass *
                    particle_values(context->particles, block, PARTICLE_VELOCITY, row)[slot];
        }
    }
}

static const struct shape_kernels LOCAL(linear_kernels) = {
    .kick = LOCAL(kick),
    .gather = LOCAL(gather),
    .scatter = LOCAL(scatter),
    .scatter_one = LOCAL(scatter_one),
};

#undef UNROLL
#undef BASIS
#undef LOCAL
#undef CONCAT
#undef CONCAT_
