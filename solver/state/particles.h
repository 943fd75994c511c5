/* SPDX-License-Identifier: Apache-2.0 */
/* Particles, sorted by blocks of LANE_COUNT cells side by side along x.
 *
 * A block owns one chunk of memory: for each component of each stored field an array of
 * `row_capacity * LANE_COUNT` doubles, then the ids, then the bodies. Slot = row * LANE_COUNT +
 * lane; lane l holds the particles of cell l in its first lane_count[l] rows, without gaps. Empty
 * slots have id PARTICLE_NONE, mass, volume and increments zero: they take part in every vector
 * operation and contribute nothing. Invariant between steps: every particle lies in the cell of its
 * lane, |position| <= 1/2. */
#ifndef TALUS_PARTICLES_H
#define TALUS_PARTICLES_H

#include "state/lanes.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PARTICLE_NONE UINT32_MAX

enum particle_field {
#define PARTICLE_FIELD(ENUM, name, unit, text) PARTICLE_##ENUM,
#include "state/particle_fields.def"
#undef PARTICLE_FIELD
    PARTICLE_FIELD_COUNT
};

/* Which fields a scene stores. */
struct particle_layout {
    uint32_t component_count[PARTICLE_FIELD_COUNT];
    uint32_t first_component[PARTICLE_FIELD_COUNT];
    uint32_t double_count; /* components of all fields */
    bool has_body;         /* more than one body */
};

enum { BLOCK_NODE_NEIGHBOURS = 8 };

struct particle_block {
    int32_t cell[3];    /* of lane 0; cell[0] is a multiple of LANE_COUNT */
    uint32_t row_count; /* rows in use: the largest lane_count */
    uint32_t row_capacity;
    uint32_t lane_count[LANE_COUNT];
    real *data;     /* the chunk; [double_count][row_capacity * LANE_COUNT] */
    uint32_t *id;   /* [row_capacity * LANE_COUNT], inside the chunk */
    uint16_t *body; /* the same, or NULL */
    uint32_t nodes[BLOCK_NODE_NEIGHBOURS]; /* node blocks at (x + bit 0, y + bit 1, z + bit 2) */
    uint32_t *wide_nodes; /* node blocks of the neighbourhood (state/wide_window.h), or NULL; owned
                             by the grid */
    uint8_t folds[6];     /* per side (2 axis + upper): bit l, cell l has a wall there */
    bool constrained;     /* a node of it has a boundary condition */
    bool eliminates;      /* it reaches behind a boundary that eliminates particles */
    bool packed;          /* the chunk lies in the grid's slab, which owns it */
};

/* All values of one particle, outside of any block. */
enum { PARTICLE_MAX_DOUBLES = 96 };
struct particle_record {
    uint32_t id;
    uint16_t body;
    real values[PARTICLE_MAX_DOUBLES]; /* [double_count] */
};

/* Sets first_component and double_count from component_count. */
void particle_layout_finish(struct particle_layout *layout);
/* Bytes of a chunk with that many rows. */
size_t particle_chunk_bytes(const struct particle_layout *layout, uint32_t row_capacity);

/* Array of one component of a field: [row_capacity * LANE_COUNT]. */
static inline real *particle_values(const struct particle_layout *layout,
                                    const struct particle_block *block, enum particle_field field,
                                    uint32_t component)
{
    return block->data +
           (size_t)(layout->first_component[field] + component) * block->row_capacity * LANE_COUNT;
}

/* Bytes of the first `component_count` components. */
static inline size_t particle_block_bytes(const struct particle_block *block,
                                          uint32_t component_count)
{
    return (size_t)component_count * block->row_capacity * LANE_COUNT * sizeof(real);
}

/* Gives the block a chunk of at least `rows` rows, keeping its particles. 0, or -1 without memory.
 */
int particle_block_reserve(const struct particle_layout *layout, struct particle_block *block,
                           uint32_t rows);
void particle_block_release(struct particle_block *block);
/* Moves the chunk to memory of somebody else with room for particle_chunk_bytes of as many rows as
 * are in use, rounded up to an even number; `rows` says how many. */
void particle_block_pack(const struct particle_layout *layout, struct particle_block *block,
                         uint32_t rows, void *memory);
/* Rows for packing: just enough at first; a block that has grown since keeps some of its slack. */
static inline uint32_t particle_block_packed_rows(const struct particle_block *block, bool first)
{
    const uint32_t needed = (block->row_count + 1) / 2 * 2;
    const uint32_t roomy = (block->row_count + block->row_count / 4 + 1) / 2 * 2;
    const uint32_t least = roomy < block->row_capacity ? roomy : block->row_capacity;
    return first || block->row_count == 0 || least < needed ? needed : least;
}
/* Gives an empty block a chunk with a copy of the given bytes (checkpoints). 0, or -1 without
 * memory. */
int particle_block_attach(const struct particle_layout *layout, struct particle_block *block,
                          uint32_t row_capacity, const void *chunk);

/* Appends a particle to a lane; there must be room (particle_block_reserve). Returns its slot. */
size_t particle_block_insert(const struct particle_layout *layout, struct particle_block *block,
                             uint32_t lane, const struct particle_record *record);
/* Takes a particle out; the last one of its lane moves into the gap. */
void particle_block_remove(const struct particle_layout *layout, struct particle_block *block,
                           size_t slot, struct particle_record *record);

#endif
