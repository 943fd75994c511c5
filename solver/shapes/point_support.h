/* SPDX-License-Identifier: Apache-2.0 */
/* Shape functions that are sums of the grid's linear interpolation at a few points: sum N u is
 * sum_k a_k u(p_k) and its slopes are sum_k b_k u(p_k). So are those of CPDI, whose points are the
 * corners of the particle's domain, and the linear ones: the value at the particle and differences
 * between opposite faces of its cell. Included once per dimension by point_kernel.h (no guard).
 *
 * Coordinates are in cell widths from the lower node of the particle's own cell. */

enum { LOCAL(POINT_MAX) = 1 << DIMENSION > 2 * DIMENSION + 1 ? 1 << DIMENSION : 2 * DIMENSION + 1 };

struct LOCAL(point) {
    size_t index;                 /* of its lower node in a window */
    real t[DIMENSION];            /* place between the nodes; 0..1, beyond it where walls fold */
    int32_t base[DIMENSION];      /* its lower node */
    real value, slope[DIMENSION]; /* a, b */
};

struct LOCAL(support) {
    int count;
    struct LOCAL(point) points[LOCAL(POINT_MAX)];
};

/* What the supports of a block are made from. */
struct LOCAL(geometry) {
    const struct shape_context *context;
    const struct particle_block *block;
    const real *position[DIMENSION], *mass;
    const real *domain[DIMENSION][DIMENSION]; /* [edge][axis]; half edges of the domain */
    const real *convected; /* 0 where the particle takes linear functions; NULL: none does */
};

static void LOCAL(geometry_init)(const struct shape_context *context,
                                 const struct particle_block *block,
                                 struct LOCAL(geometry) * geometry)
{
    const struct particle_layout *layout = context->particles;
    geometry->context = context;
    geometry->block = block;
    geometry->mass = particle_values(layout, block, PARTICLE_MASS, 0);
    geometry->convected = layout->component_count[PARTICLE_CONVECTED] > 0
                              ? particle_values(layout, block, PARTICLE_CONVECTED, 0)
                              : NULL;
    for (uint32_t edge = 0; edge < DIMENSION; edge++) {
        geometry->position[edge] = particle_values(layout, block, PARTICLE_POSITION, edge);
        for (uint32_t axis = 0; axis < DIMENSION; axis++)
            geometry->domain[edge][axis] =
                particle_values(layout, block, PARTICLE_DOMAIN, DIMENSION * edge + axis);
    }
}

/* Puts a point into the grid. What rounding leaves behind a wall at the side of the particle's own
 * cell is taken by the nodes in front of it. */
TALUS_INLINE void LOCAL(place_point)(const struct LOCAL(geometry) * geometry, size_t slot,
                                     const real place[DIMENSION], struct LOCAL(point) * point)
{
    const size_t lane = slot % LANE_COUNT;
    int32_t node[3] = {(int32_t)lane, 0, 0};
    for (int axis = 0; axis < DIMENSION; axis++) {
        int32_t base = (int32_t)floor((double)place[axis]);
        const bool below = base < 0 && geometry->block->folds[2 * axis] >> lane & 1;
        const bool above = base > 0 && geometry->block->folds[2 * axis + 1] >> lane & 1;
        if (below || above)
            base = 0;
        point->base[axis] = base;
        point->t[axis] = place[axis] - (real)base;
        node[axis] += base;
    }
    point->index = window_index(DIMENSION, POINT_REACH, node[0], node[1], node[2]);
}

static void LOCAL(linear_support)(const struct LOCAL(geometry) * geometry, size_t slot,
                                  struct LOCAL(support) * support)
{
    real centre[DIMENSION];
    for (int axis = 0; axis < DIMENSION; axis++)
        centre[axis] = (real)0.5 + geometry->position[axis][slot];
    memset(support, 0, sizeof *support);
    support->count = 2 * DIMENSION + 1;
    for (int k = 0; k < 2 * DIMENSION + 1; k++) {
        struct LOCAL(point) *point = &support->points[k];
        LOCAL(place_point)(geometry, slot, centre, point);
        if (k == 0) {
            point->value = 1;
            continue;
        }
        const int axis = (k - 1) / 2, upper = (k - 1) % 2;
        point->t[axis] = (real)upper;
        point->slope[axis] = upper ? 1 : -1;
    }
}

/* What the walls beside its cell leave a particle along an axis, in cell widths. */
TALUS_INLINE real LOCAL(room_at_walls)(const struct LOCAL(geometry) * geometry, size_t slot,
                                       int axis)
{
    const size_t lane = slot % LANE_COUNT;
    const real place = geometry->position[axis][slot];
    real room = POINT_REACH;
    if (geometry->block->folds[2 * axis] >> lane & 1)
        room = (real)0.5 + place;
    if (geometry->block->folds[2 * axis + 1] >> lane & 1 && (real)0.5 - place < room)
        room = (real)0.5 - place;
    return room;
}

/* A domain ends at the walls beside the cell of its particle: where it would reach behind one it is
 * squeezed across it. Continued behind it, the corners of a sheared domain would take mass from
 * nodes in front of it that nothing else gives any, and a node of negative mass moves for nobody.
 */
static void LOCAL(end_at_walls)(const struct LOCAL(geometry) * geometry, size_t slot,
                                real edges[DIMENSION][DIMENSION])
{
    for (int axis = 0; axis < DIMENSION; axis++) {
        const real room = LOCAL(room_at_walls)(geometry, slot, axis);
        real reach = 0;
        for (int edge = 0; edge < DIMENSION; edge++)
            reach += real_absolute(edges[edge][axis]);
        for (int edge = 0; reach > room && edge < DIMENSION; edge++)
            edges[edge][axis] *= room / reach;
    }
}

/* On a wall nothing is left of a domain across it: there a particle is a point. */
static bool LOCAL(lies_on_wall)(const struct LOCAL(geometry) * geometry, size_t slot)
{
    bool lies = false;
    for (int axis = 0; axis < DIMENSION; axis++)
        lies = lies || LOCAL(room_at_walls)(geometry, slot, axis) < (real)1e-3;
    return lies;
}

/* Half edges of a domain, shortened as a convected where it would reach farther than POINT_REACH
 * cells from the particle, or behind a wall. */
static void LOCAL(load_edges)(const struct LOCAL(geometry) * geometry, size_t slot,
                              real edges[DIMENSION][DIMENSION])
{
    real reach = 0;
    for (int axis = 0; axis < DIMENSION; axis++) {
        real sum = 0;
        for (int edge = 0; edge < DIMENSION; edge++) {
            edges[edge][axis] = geometry->domain[edge][axis][slot];
            sum += real_absolute(edges[edge][axis]);
        }
        reach = sum > reach ? sum : reach;
    }
    for (int edge = 0; reach > POINT_REACH && edge < DIMENSION; edge++) {
        for (int axis = 0; axis < DIMENSION; axis++)
            edges[edge][axis] *= POINT_REACH / reach;
    }
    LOCAL(end_at_walls)(geometry, slot, edges);
}

/* Reciprocal vectors: g_a . r_b = 1 where a = b, else 0. */
static void LOCAL(reciprocal)(real r[DIMENSION][DIMENSION], real g[DIMENSION][DIMENSION])
{
#if DIMENSION == 1
    g[0][0] = 1 / r[0][0];
#elif DIMENSION == 2
    const real inverse = 1 / (r[0][0] * r[1][1] - r[0][1] * r[1][0]);
    g[0][0] = inverse * r[1][1];
    g[0][1] = -inverse * r[1][0];
    g[1][0] = -inverse * r[0][1];
    g[1][1] = inverse * r[0][0];
#else
    real determinant = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        for (int x = 0; x < 3; x++) {
            const int y = (x + 1) % 3, z = (x + 2) % 3;
            g[a][x] = r[b][y] * r[c][z] - r[b][z] * r[c][y];
        }
    }
    for (int x = 0; x < 3; x++)
        determinant += r[0][x] * g[0][x];
    for (int entry = 0; entry < 9; entry++)
        g[entry / 3][entry % 3] /= determinant;
#endif
}

/* Corners of the domain: N = mean of N(corner), grad N = mean of N(corner) sum_a xi_a g_a
 * (Sadeghirad, Brannon and Burghardt 2011; Mast 2013, sec. 2.4.7). */
static void LOCAL(corner_support)(const struct LOCAL(geometry) * geometry, size_t slot,
                                  struct LOCAL(support) * support)
{
    real r[DIMENSION][DIMENSION], g[DIMENSION][DIMENSION];
    const real share = (real)1 / (1 << DIMENSION);
    LOCAL(load_edges)(geometry, slot, r);
    LOCAL(reciprocal)(r, g);
    support->count = 1 << DIMENSION;
    for (int corner = 0; corner < 1 << DIMENSION; corner++) {
        struct LOCAL(point) *point = &support->points[corner];
        real place[DIMENSION];
        for (int axis = 0; axis < DIMENSION; axis++) {
            place[axis] = (real)0.5 + geometry->position[axis][slot];
            point->slope[axis] = 0;
            for (int edge = 0; edge < DIMENSION; edge++) {
                const real sign = corner >> edge & 1 ? 1 : -1;
                place[axis] += sign * r[edge][axis];
                point->slope[axis] += share * sign * g[edge][axis];
            }
        }
        point->value = share;
        LOCAL(place_point)(geometry, slot, place, point);
    }
}

static void LOCAL(support_at)(const struct LOCAL(geometry) * geometry, size_t slot,
                              struct LOCAL(support) * support)
{
    if ((geometry->convected != NULL && geometry->convected[slot] == 0) ||
        LOCAL(lies_on_wall)(geometry, slot))
        LOCAL(linear_support)(geometry, slot, support);
    else
        LOCAL(corner_support)(geometry, slot, support);
}
