/* SPDX-License-Identifier: Apache-2.0 */
/* What the passes over nodes share: free nodes (node_update.c), and those with walls
 * (wall_nodes.c finds them, wall_update.c applies them). Sums go through chunks of fixed size that
 * are added in order, so that they have the same bits for any number of threads. */
#ifndef TALUS_NODE_PASSES_H
#define TALUS_NODE_PASSES_H

#include "boundaries/contact.h"
#include "explicit/run.h"

enum { NODE_CHUNK = 256, WALL_CHUNK = 128 }; /* node blocks, wall nodes */
/* Per chunk and face: impulse 3, moment 3, area; after the faces of a chunk: impulse of the walls
 * on the material 3, its magnitude, work of friction; what the walls change of local damping:
 * energy, impulse 3; work of the walls on the material, and of brakes that move with them. */
enum { FACE_SUMS = 7, CHUNK_SUMS = 10 };

static inline size_t wall_partial_stride(const struct run *run)
{
    return run->walls.face_count * FACE_SUMS + CHUNK_SUMS;
}

/* dt (f / m + g) of one node along one axis, without walls. `factor`: share of external forces. */
static inline double node_free_increment(const struct run *run, size_t block, size_t lane,
                                         uint32_t axis, double mass, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    double force = (double)node_values(nodes, block, nodes->layout.force + axis)[lane];
    if (nodes->layout.external != 0)
        force += factor * (double)node_values(nodes, block, nodes->layout.external + axis)[lane];
    return run->time_step * (force / mass + factor * run->gravity[axis]);
}

static inline size_t wall_chunk_count(const struct run *run)
{
    return (run->wall_node_count + WALL_CHUNK - 1) / WALL_CHUNK;
}

static inline size_t node_chunk_count(const struct run *run)
{
    return (run->grid.nodes.count + NODE_CHUNK - 1) / NODE_CHUNK;
}

/* Before the first pass: holds back what walls hold, at wall nodes begin ... end - 1. `factor` is
 * the share of gravity that acts. */
void wall_nodes_hold_back(struct run *run, size_t begin, size_t end, double factor);
/* Before a stress pass: what the walls let pass of the velocities at wall nodes begin ... end - 1.
 * Nothing is booked: no particle is pushed. */
void wall_nodes_start(struct run *run, size_t begin, size_t end);
/* ---- start_velocity.c, where node_layout.start is kept ---- */
/* Material moves or strains with a velocity between start and end. */
static inline bool start_velocity_blends(const struct run *run)
{
    return run->scene.solver.theta != 1 || run->scene.solver.strain_theta != 1;
}
/* `start` as far as the walls of `solved` let it pass. */
void wall_node_keep_start(const struct run *run, const struct wall_node *wall,
                          const struct contact *solved, const double start[3]);
/* Velocity of a block, after the walls, into the one that moves and the one that strains. */
void blend_block(const struct run *run, size_t block);

/* ---- local_damping.c ---- */
/* The brake on velocities `twice`/2 in the middle of the step, under the increment `whole`. */
static inline lanes local_brake(real damping, lanes twice, lanes whole)
{
    const lanes most = (real)0.5 * lanes_absolute(twice);
    const lanes share = damping * lanes_absolute(whole);
    const lanes taken = lanes_select(share < most, share, most);
    return lanes_select(twice > (real)0.0, -taken, taken);
}
/* The same at a wall, along the motion that it leaves, relative to it: `middle` is the velocity in
 * the middle of the step, `gain` what the walls let pass of the forces. */
void local_brake_at_wall(const struct run *run, const struct wall_node *wall,
                         const double middle[3], const double gain[3], double brake[3]);
/* Work and impulse of the brakes of a block, before the walls: nodes without ones are final. */
void local_damping_sum(const struct run *run, size_t block, double factor, struct node_sums *sums);

/* ---- wall_update.c ---- */
/* The contact of a wall node, without velocities. */
struct contact wall_node_contact(const struct run *run, const struct wall_node *wall);
/* Applies the walls at the wall nodes of a chunk and sums what they did into its partial. */
void wall_nodes_update(struct run *run, size_t chunk, double factor);
/* Adds the chunks in order, to faces, boundaries and the audit. */
void wall_nodes_sum(struct run *run);

#endif
