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

static inline void LOCAL(load_position)(real *const values[DIMENSION], size_t slot,
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
        real *near = node_values(nodes, block->nodes[s], component);
        lanes_store(near, lanes_load(near) + low + lanes_shift_up(high));
        *node_values(nodes, block->nodes[s + 1], component) += high[LANE_COUNT - 1];
    }
}

/* The polynomial at the particles of one row: Horner's rule, one axis after the other. */
static inline lanes LOCAL(evaluate)(const lanes c[BASIS], const lanes position[DIMENSION])
{
    lanes value[BASIS];
    UNROLL for (int s = 0; s < BASIS; s++)
    {
        value[s] = c[s];
    }
    UNROLL for (int axis = DIMENSION - 1; axis >= 0; axis--)
    {
        UNROLL for (int s = 0; s < 1 << axis; s++)
        {
            value[s] += position[axis] * value[s | 1 << axis];
        }
    }
    return value[0];
}

/* The same with the derivative along every axis, per cell width: eleven multiply-adds in 3D. */
static inline lanes LOCAL(evaluate_with_slopes)(const lanes c[BASIS],
                                                const lanes position[DIMENSION],
                                                lanes slope[DIMENSION])
{
    lanes value[BASIS], derivative[DIMENSION][BASIS];
    UNROLL for (int s = 0; s < BASIS; s++)
    {
        value[s] = c[s];
    }
    UNROLL for (int axis = DIMENSION - 1; axis >= 0; axis--)
    {
        UNROLL for (int s = 0; s < 1 << axis; s++)
        {
            derivative[axis][s] = value[s | 1 << axis];
            value[s] += position[axis] * value[s | 1 << axis];
            UNROLL for (int other = axis + 1; other < DIMENSION; other++)
            {
                derivative[other][s] += position[axis] * derivative[other][s | 1 << axis];
            }
        }
    }
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        slope[axis] = derivative[axis][0];
    }
    return value[0];
}

static inline void LOCAL(position_arrays)(const struct shape_context *context,
                                          const struct particle_block *block,
                                          real *values[DIMENSION])
{
    for (uint32_t axis = 0; axis < DIMENSION; axis++)
        values[axis] = particle_values(context->particles, block, PARTICLE_POSITION, axis);
}

/* moment_s += m sum over the axes b in s of A_b (1/4 - x_b^2) phi_(s without b): what the affine
 * part of the velocity adds to the momentum p phi_s, A per cell width. */
static inline void LOCAL(add_affine)(lanes moment[BASIS], lanes m, real *const affine[DIMENSION],
                                     size_t slot, const lanes x[DIMENSION], const lanes phi[BASIS])
{
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        const lanes q = m * lanes_load(affine[axis] + slot) * ((real)0.25 - x[axis] * x[axis]);
        UNROLL for (int s = 1; s < BASIS; s++)
        {
            if (s & 1 << axis)
                moment[s] += q * phi[s ^ 1 << axis];
        }
    }
}

/* The row of PARTICLE_AFFINE of one velocity component. */
static inline void LOCAL(affine_arrays)(const struct shape_context *context,
                                        const struct particle_block *block, uint32_t row,
                                        real *affine[DIMENSION])
{
    for (uint32_t axis = 0; axis < DIMENSION; axis++)
        affine[axis] =
            particle_values(context->particles, block, PARTICLE_AFFINE, DIMENSION * row + axis);
}

/* One velocity component of the kick; `affine`: the scene stores PARTICLE_AFFINE. */
TALUS_INLINE void LOCAL(kick_axis)(const struct shape_context *context,
                                   const struct particle_block *block, uint32_t axis,
                                   real *const position[DIMENSION], bool affine)
{
    const real *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const struct node_layout *layout = &context->nodes->layout;
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    real *velocity = particle_values(context->particles, block, PARTICLE_VELOCITY, axis);
    real *row[DIMENSION];
    if (affine)
        LOCAL(affine_arrays)(context, block, axis, row);
    lanes c[BASIS], moment[BASIS] = {0};
    LOCAL(load_coefficients)(context->nodes, block, layout->kick + axis, c);
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION], phi[BASIS], kicked;
        LOCAL(load_position)(position, slot, x);
        LOCAL(basis)(x, phi);
        const lanes m = lanes_load(mass + slot);
        /* Empty slots must not gather velocity. */
        if (affine) {
            lanes slope[DIMENSION];
            kicked = LOCAL(evaluate_with_slopes)(c, x, slope);
            UNROLL for (int along = 0; along < DIMENSION; along++)
            {
                lanes_store(row[along] + slot,
                            lanes_keep(m > 0, lanes_load(row[along] + slot) + slope[along]));
            }
            LOCAL(add_affine)(moment, m, row, slot, x, phi);
        } else {
            kicked = LOCAL(evaluate)(c, x);
        }
        const lanes v = lanes_keep(m > 0, lanes_load(velocity + slot) + kicked);
        lanes_store(velocity + slot, v);
        const lanes p = m * v;
        UNROLL for (int s = 0; s < BASIS; s++)
        {
            moment[s] += p * phi[s];
        }
    }
    LOCAL(add_moments)(context->nodes, block, layout->momentum + axis, moment);
}

static void LOCAL(kick)(const struct shape_context *context, struct particle_block *block)
{
    real *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const bool affine = context->particles->component_count[PARTICLE_AFFINE] > 0;
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        if (affine)
            LOCAL(kick_axis)(context, block, axis, position, true);
        else
            LOCAL(kick_axis)(context, block, axis, position, false);
    }
}

/* Way of the step and gradient of the increment along one axis, out of one node component. */
TALUS_INLINE void LOCAL(gather_axis)(const struct shape_context *context,
                                     const struct particle_block *block, uint32_t component,
                                     uint32_t axis, real *const position[DIMENSION], unsigned what,
                                     struct block_scratch *scratch)
{
    const real *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    real *gradient[DIMENSION];
    lanes c[BASIS], ratio[DIMENSION];
    LOCAL(load_coefficients)(context->nodes, block, component + axis, c);
    UNROLL for (int s = 0; s < BASIS; s++)
    {
        c[s] *= context->displacement[axis];
    }
    UNROLL for (uint32_t along = 0; along < DIMENSION; along++)
    {
        gradient[along] = scratch->gradient[3 * axis + along];
        ratio[along] = lanes_splat(context->cell_ratio[axis][along]);
    }
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION], slope[DIMENSION];
        LOCAL(load_position)(position, slot, x);
        const lane_mask filled = lanes_load(mass + slot) > 0;
        const lanes moved = LOCAL(evaluate_with_slopes)(c, x, slope);
        if (what & GATHER_DISPLACEMENT)
            lanes_store(scratch->displacement[axis] + slot, lanes_keep(filled, moved));
        UNROLL for (int along = 0; along < DIMENSION; along++)
        {
            if (what & GATHER_GRADIENT)
                lanes_store(gradient[along] + slot,
                            lanes_keep(filled, slope[along] * ratio[along]));
        }
    }
}

/* PARTICLE_AFFINE of one velocity component: for hat functions the slope of the velocity. */
static void LOCAL(gather_affine)(const struct shape_context *context,
                                 const struct particle_block *block, uint32_t axis,
                                 real *const position[DIMENSION])
{
    const real *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    real *row[DIMENSION];
    lanes c[BASIS];
    LOCAL(affine_arrays)(context, block, axis, row);
    LOCAL(load_coefficients)(context->nodes, block, context->nodes->layout.velocity + axis, c);
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION], slope[DIMENSION];
        LOCAL(load_position)(position, slot, x);
        (void)LOCAL(evaluate_with_slopes)(c, x, slope);
        UNROLL for (int along = 0; along < DIMENSION; along++)
        {
            lanes_store(row[along] + slot, lanes_keep(lanes_load(mass + slot) > 0, slope[along]));
        }
    }
}

/* v_p += sum N correction_i along one axis. */
static void LOCAL(correct_axis)(const struct shape_context *context,
                                const struct particle_block *block, uint32_t axis,
                                real *const position[DIMENSION])
{
    const real *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    real *velocity = particle_values(context->particles, block, PARTICLE_VELOCITY, axis);
    lanes c[BASIS];
    LOCAL(load_coefficients)(context->nodes, block, context->nodes->layout.correction + axis, c);
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION];
        LOCAL(load_position)(position, slot, x);
        const lanes dv = lanes_keep(lanes_load(mass + slot) > 0, LOCAL(evaluate)(c, x));
        lanes_store(velocity + slot, lanes_load(velocity + slot) + dv);
    }
}

static void LOCAL(gather)(const struct shape_context *context, const struct particle_block *block,
                          unsigned what, struct block_scratch *scratch)
{
    enum { BOTH = GATHER_DISPLACEMENT | GATHER_GRADIENT };
    const struct node_layout *layout = &context->nodes->layout;
    const bool together = (what & BOTH) == BOTH && layout->motion == layout->velocity;
    real *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    for (uint32_t axis = 0; axis < DIMENSION; axis++) {
        if (what & GATHER_CORRECTION)
            LOCAL(correct_axis)(context, block, axis, position);
        if (together) {
            LOCAL(gather_axis)(context, block, layout->velocity, axis, position, BOTH, scratch);
        } else {
            if (what & GATHER_DISPLACEMENT)
                LOCAL(gather_axis)
            (context, block, layout->motion, axis, position, GATHER_DISPLACEMENT, scratch);
            if (what & GATHER_GRADIENT)
                LOCAL(gather_axis)
            (context, block, layout->velocity, axis, position, GATHER_GRADIENT, scratch);
        }
        if (what & GATHER_AFFINE)
            LOCAL(gather_affine)(context, block, axis, position);
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

/* force_row_i -= sum (V0 tau) . grad N; momentum_row_i += sum N m v. */
TALUS_INLINE void LOCAL(scatter_row)(const struct shape_context *context,
                                     const struct particle_block *block,
                                     const struct scatter_source *source, uint32_t row,
                                     unsigned what, bool affine)
{
    real *position[DIMENSION], *affine_row[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    if (affine)
        LOCAL(affine_arrays)(context, block, row, affine_row);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    const real *velocity = particle_values(context->particles, block, PARTICLE_VELOCITY, row);
    const real *stress[DIMENSION];
    UNROLL for (int axis = 0; axis < DIMENSION; axis++)
    {
        stress[axis] = source->stress[sym3_component[row][axis]];
    }
    lanes force[BASIS] = {0}, momenta[BASIS] = {0};
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION], phi[BASIS], q[DIMENSION];
        LOCAL(load_position)(position, slot, x);
        LOCAL(basis)(x, phi);
        if (what & SCATTER_FORCE) {
            const lanes volume = lanes_load(source->volume + slot);
            UNROLL for (int axis = 0; axis < DIMENSION; axis++)
            {
                q[axis] = volume * context->inverse_cell[axis] * lanes_load(stress[axis] + slot);
            }
            LOCAL(add_force)(force, q, phi);
        }
        if (what & SCATTER_MOMENTUM) {
            const lanes m = lanes_load(source->mass + slot);
            const lanes p = m * lanes_load(velocity + slot);
            UNROLL for (int s = 0; s < BASIS; s++)
            {
                momenta[s] += p * phi[s];
            }
            if (affine)
                LOCAL(add_affine)(momenta, m, affine_row, slot, x, phi);
        }
    }
    if (what & SCATTER_FORCE)
        LOCAL(add_moments)(context->nodes, block, context->nodes->layout.force + row, force);
    if (what & SCATTER_MOMENTUM)
        LOCAL(add_moments)(context->nodes, block, context->nodes->layout.momentum + row, momenta);
}

/* node component += sum N weight value; without `value` sum N weight. */
TALUS_INLINE void LOCAL(scatter_value)(const struct shape_context *context,
                                       const struct particle_block *block, const real *weight,
                                       const real *value, uint32_t component)
{
    real *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    lanes moment[BASIS] = {0};
    for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
        lanes x[DIMENSION], phi[BASIS];
        LOCAL(load_position)(position, slot, x);
        LOCAL(basis)(x, phi);
        lanes w = lanes_load(weight + slot);
        if (value != NULL)
            w *= lanes_load(value + slot);
        UNROLL for (int s = 0; s < BASIS; s++)
        {
            moment[s] += w * phi[s];
        }
    }
    LOCAL(add_moments)(context->nodes, block, component, moment);
}

static void LOCAL(scatter_values)(const struct shape_context *context,
                                  const struct particle_block *block, const real *weight,
                                  size_t count, const real *const *values, uint32_t first)
{
    for (size_t index = 0; index < count; index++)
        LOCAL(scatter_value)(context, block, weight, values[index], first + (uint32_t)index);
}

static void LOCAL(gather_values)(const struct shape_context *context,
                                 const struct particle_block *block, size_t count,
                                 real *const *values, uint32_t first)
{
    real *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const real *mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    for (size_t index = 0; index < count; index++) {
        lanes c[BASIS];
        LOCAL(load_coefficients)(context->nodes, block, first + (uint32_t)index, c);
        for (size_t slot = 0; slot < slot_count; slot += LANE_COUNT) {
            lanes x[DIMENSION];
            LOCAL(load_position)(position, slot, x);
            lanes_store(values[index] + slot,
                        lanes_keep(lanes_load(mass + slot) > 0, LOCAL(evaluate)(c, x)));
        }
    }
}

static void LOCAL(scatter)(const struct shape_context *context, const struct particle_block *block,
                           const struct scatter_source *source, unsigned what)
{
    enum { BOTH = SCATTER_FORCE | SCATTER_MOMENTUM };
    const bool affine = context->particles->component_count[PARTICLE_AFFINE] > 0;
    if (what & SCATTER_MASS)
        LOCAL(scatter_value)
    (context, block, source->mass, NULL, context->nodes->layout.mass);
    for (uint32_t row = 0; row < DIMENSION; row++) {
        if (affine && what & SCATTER_MOMENTUM)
            LOCAL(scatter_row)(context, block, source, row, what, true);
        else if ((what & BOTH) == BOTH)
            LOCAL(scatter_row)(context, block, source, row, BOTH, false);
        else if (what & SCATTER_FORCE)
            LOCAL(scatter_row)(context, block, source, row, SCATTER_FORCE, false);
        else if (what & SCATTER_MOMENTUM)
            LOCAL(scatter_row)(context, block, source, row, SCATTER_MOMENTUM, false);
    }
}

/* What one particle gives to a node along one axis: force, and momentum over its weighted mass. */
static real LOCAL(force_of_one)(const real force_stress[6], uint32_t row,
                                const real slope[DIMENSION])
{
    real sum = 0;
    for (int axis = 0; axis < DIMENSION; axis++)
        sum -= force_stress[sym3_component[row][axis]] * slope[axis];
    return sum;
}

static real LOCAL(velocity_of_one)(const struct particle_layout *particles,
                                   const struct particle_block *block, size_t slot, uint32_t row,
                                   const real offset[DIMENSION])
{
    real velocity = particle_values(particles, block, PARTICLE_VELOCITY, row)[slot];
    for (uint32_t axis = 0; axis < DIMENSION && particles->component_count[PARTICLE_AFFINE] > 0;
         axis++)
        velocity += offset[axis] * particle_values(particles, block, PARTICLE_AFFINE,
                                                   DIMENSION * row + axis)[slot];
    return velocity;
}

static void LOCAL(scatter_one)(const struct shape_context *context,
                               const struct particle_block *block, size_t slot,
                               const real force_stress[6], unsigned what)
{
    real *position[DIMENSION];
    LOCAL(position_arrays)(context, block, position);
    const real mass = particle_values(context->particles, block, PARTICLE_MASS, 0)[slot];
    const struct node_layout *layout = &context->nodes->layout;
    const size_t lane = slot % LANE_COUNT;
    for (int corner = 0; corner < BASIS; corner++) {
        real weight = 1, slope[DIMENSION], offset[DIMENSION];
        for (int axis = 0; axis < DIMENSION; axis++) {
            const real sign = corner >> axis & 1 ? 1.0 : -1.0;
            weight *= 0.5 + sign * position[axis][slot];
            slope[axis] = sign * context->inverse_cell[axis];
            offset[axis] = (real)0.5 * sign - position[axis][slot];
            for (int other = 0; other < DIMENSION; other++) {
                if (other != axis)
                    slope[axis] *= 0.5 + (corner >> other & 1 ? 1.0 : -1.0) * position[other][slot];
            }
        }
        /* The upper x node of the last lane is the first of the next block. */
        const size_t shifted = lane + (size_t)(corner & 1);
        const uint32_t node_block = block->nodes[shifted == LANE_COUNT ? corner : corner & ~1];
        const size_t node = shifted % LANE_COUNT;
        if (what & SCATTER_MASS)
            node_values(context->nodes, node_block, layout->mass)[node] += weight * mass;
        for (uint32_t row = 0; row < DIMENSION; row++) {
            if (what & SCATTER_FORCE)
                node_values(context->nodes, node_block, layout->force + row)[node] +=
                    LOCAL(force_of_one)(force_stress, row, slope);
            if (what & SCATTER_MOMENTUM)
                node_values(context->nodes, node_block, layout->momentum + row)[node] +=
                    weight * mass *
                    LOCAL(velocity_of_one)(context->particles, block, slot, row, offset);
        }
    }
}

static const struct shape_kernels LOCAL(linear_kernels) = {
    .kick = LOCAL(kick),
    .gather = LOCAL(gather),
    .scatter = LOCAL(scatter),
    .scatter_one = LOCAL(scatter_one),
    .scatter_values = LOCAL(scatter_values),
    .gather_values = LOCAL(gather_values),
};

#undef UNROLL
#undef BASIS
#undef LOCAL
#undef CONCAT
#undef CONCAT_
