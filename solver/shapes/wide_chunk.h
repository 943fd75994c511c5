/* SPDX-License-Identifier: Apache-2.0 */
/* The rows of a block, a chunk at a time, with their stencils; included by wide_kernel.h (no
 * guard).
 */

struct LOCAL(chunk) {
    const struct shape_context *context;
    const struct particle_block *block;
    const real *mass; /* of all particles of the block */
    struct LOCAL(support) support;
    size_t begin, rows; /* of particles */
    struct LOCAL(stencil) stencils[WIDE_CHUNK];
};

/* Before the first chunk of a block. */
static void LOCAL(chunk_init)(const struct shape_context *context,
                              const struct particle_block *block, struct LOCAL(chunk) * chunk)
{
    chunk->context = context;
    chunk->block = block;
    chunk->mass = particle_values(context->particles, block, PARTICLE_MASS, 0);
    chunk->begin = chunk->rows = 0;
    LOCAL(support_init)(context, block, &chunk->support);
}

/* Goes on to the next chunk; false after the last. */
static bool LOCAL(chunk_next)(struct LOCAL(chunk) * chunk)
{
    chunk->begin += chunk->rows;
    const size_t left = chunk->block->row_count - chunk->begin;
    chunk->rows = left < WIDE_CHUNK ? left : WIDE_CHUNK;
    for (size_t r = 0; r < chunk->rows; r++)
        LOCAL(stencil_at)(&chunk->support, (chunk->begin + r) * LANE_COUNT, &chunk->stencils[r]);
    return chunk->rows > 0;
}

/* Slopes -> affine_stencil. */
static void LOCAL(chunk_affine)(struct LOCAL(chunk) * chunk, bool gathers)
{
    for (size_t r = 0; r < chunk->rows; r++) {
        const size_t slot = (chunk->begin + r) * LANE_COUNT;
        LOCAL(affine_stencil)(&chunk->support, slot, gathers, &chunk->stencils[r]);
    }
}

/* A component of all particles of the block. */
static inline real *LOCAL(values)(const struct LOCAL(chunk) * chunk, enum particle_field field,
                                  uint32_t component)
{
    return particle_values(chunk->context->particles, chunk->block, field, component);
}

/* One component of the nodes around the block. */
struct LOCAL(window) {
    _Alignas(64) real values[WIDE_ROWS * WINDOW_WIDTH];
};

static void LOCAL(load_windows)(const struct LOCAL(chunk) * chunk, uint32_t first,
                                struct LOCAL(window) * windows, uint32_t count)
{
    for (uint32_t index = 0; index < count; index++) {
        real *values = windows[index].values;
        window_load(chunk->context->nodes, chunk->block, WIDE_ROWS, first + index, values);
    }
}
