/* SPDX-License-Identifier: Apache-2.0 */
/* Nodes that carry hardly any mass: the pull of a particle that has just entered a cell would
 * accelerate them without bound. Their internal force is dropped (`cutoff`), or given to the nodes
 * around them in proportion to their masses (`redistribute`), so that no momentum is lost. With hat
 * functions one of the nodes of a particle's cell always has an eighth of its mass. */
#include "explicit/run.h"

#include <math.h>

/* A node lighter than this share of the lightest particle is light: `last` is stable where it is
 * above half of the square of the Courant number, so up to 0.45. */
#define LIGHT_SHARE 0.1

struct place {
    int32_t x, y, z;
};

/* One node: its block and lane. */
struct node_at {
    uint32_t block; /* BLOCK_NONE: there is none */
    size_t lane;
};

static struct node_at find_node(const struct node_blocks *nodes, const struct place *place)
{
    const int32_t lane = ((place->x % LANE_COUNT) + LANE_COUNT) % LANE_COUNT;
    const int32_t column = (place->x - lane) / LANE_COUNT;
    return (struct node_at){block_map_find(&nodes->map, block_key(column, place->y, place->z)),
                            (size_t)lane};
}

/* The nodes around one that are heavy enough to take its force. */
struct heavy_neighbours {
    struct node_at node[26];
    size_t count;
    double mass; /* of all [kg] */
};

static void find_heavy(const struct run *run, const struct place *centre, double light,
                       struct heavy_neighbours *found)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const size_t axes = run->grid.domain.axis_count;
    const int32_t high_y = axes > 1 ? 1 : 0, high_z = axes > 2 ? 1 : 0;
    found->count = 0;
    found->mass = 0;
    for (int32_t z = -high_z; z <= high_z; z++) {
        for (int32_t y = -high_y; y <= high_y; y++) {
            for (int32_t x = -1; x <= 1; x++) {
                const struct place place = {centre->x + x, centre->y + y, centre->z + z};
                const struct node_at node = find_node(nodes, &place);
                if (node.block == BLOCK_NONE)
                    continue;
                const double mass = node_values(nodes, node.block, nodes->layout.mass)[node.lane];
                if (mass < light)
                    continue;
                found->node[found->count++] = node;
                found->mass += mass;
            }
        }
    }
}

/* Force of a light node to its heavy neighbours. True if there are any. */
static bool give_away(const struct run *run, size_t block, size_t lane, double light)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const int32_t *first = nodes->place[block];
    const struct place centre = {first[0] + (int32_t)lane, first[1], first[2]};
    struct heavy_neighbours heavy;
    find_heavy(run, &centre, light, &heavy);
    for (size_t index = 0; index < heavy.count; index++) {
        const struct node_at *node = &heavy.node[index];
        const double share =
            node_values(nodes, node->block, nodes->layout.mass)[node->lane] / heavy.mass;
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            node_values(nodes, node->block, nodes->layout.force + axis)[node->lane] +=
                (real)(share * node_values(nodes, block, nodes->layout.force + axis)[lane]);
    }
    return heavy.count > 0;
}

/* What a force that is dropped would have given to the momentum is an impulse from outside. */
static void book_dropped(struct run *run, const double force[3])
{
    double square = 0;
    for (size_t axis = 0; axis < 3; axis++) {
        const double impulse = -force[axis] * run->time_step;
        run->audit.impulse[axis] += impulse;
        square += impulse * impulse;
    }
    run->audit.exchanged += sqrt(square);
}

static void treat_node(struct run *run, size_t block, size_t lane, double light)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const bool shares = run->scene.solver.small_mass == TALUS_SMALL_MASS_REDISTRIBUTE;
    double dropped[3] = {0, 0, 0};
    if (shares && !give_away(run, block, lane, light))
        return;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        real *force = node_values(nodes, block, nodes->layout.force + axis) + lane;
        dropped[axis] = *force;
        *force = 0;
    }
    if (!shares)
        book_dropped(run, dropped);
}

void run_treat_light_nodes(struct run *run)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const double light = LIGHT_SHARE * run->least_mass;
    if (run->scene.solver.small_mass == TALUS_SMALL_MASS_NONE)
        return;
    for (size_t block = 0; block < nodes->count; block++) {
        const real *mass = node_values(nodes, block, nodes->layout.mass);
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            if (mass[lane] > run->mass_cutoff && mass[lane] < light)
                treat_node(run, block, lane, light);
        }
    }
}
