/* SPDX-License-Identifier: Apache-2.0 */
/* What happens at the nodes: forces to velocity increments, walls, reactions. Node blocks are
 * independent; sums over walls go through chunks of fixed size that are added in order, so that
 * they have the same bits for any number of threads. */
#include "boundaries/contact.h"
#include "explicit/run.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { WALL_CHUNK = 128 };
/* Per chunk and face: impulse 3, moment 3, area; after the faces of a chunk: impulse of the walls
 * on the material 3, its magnitude, work of friction; what the walls change of local damping:
 * energy, impulse 3. */
enum { FACE_SUMS = 7, CHUNK_SUMS = 9 };

static size_t partial_stride(const struct run *run)
{
    return run->walls.face_count * FACE_SUMS + CHUNK_SUMS;
}

static int append_wall_nodes(struct run *run, size_t block)
{
    const struct domain *domain = &run->grid.domain;
    const int32_t *place = run->grid.nodes.place[block];
    assert(domain->axis_count >= 1 && domain->axis_count <= 3);
    run->block_walled[block] = false;
    for (int lane = 0; lane < LANE_COUNT; lane++) {
        const int32_t node[3] = {place[0] + lane, place[1], place[2]};
        struct node_faces faces;
        wall_set_node_faces(&run->walls, domain, node, &faces);
        if (faces.count == 0)
            continue;
        if (run->wall_node_count == run->wall_node_capacity) {
            const size_t capacity =
                run->wall_node_capacity == 0 ? 256 : 2 * run->wall_node_capacity;
            struct wall_node *larger = realloc(run->wall_nodes, capacity * sizeof *larger);
            if (larger == NULL)
                return -1;
            run->wall_nodes = larger;
            run->wall_node_capacity = capacity;
        }
        struct wall_node *wall = &run->wall_nodes[run->wall_node_count++];
        memset(wall, 0, sizeof *wall);
        wall->block = (uint32_t)block;
        wall->lane = (uint8_t)lane;
        wall->faces = faces;
        for (size_t axis = 0; axis < domain->axis_count; axis++)
            wall->position[axis] = domain_node_position(domain, axis, node[axis]);
        run->block_walled[block] = true;
    }
    return 0;
}

static void mark_block(struct run *run, struct particle_block *block)
{
    const struct domain *domain = &run->grid.domain;
    block->constrained = false;
    for (int corner = 0; corner < 1 << domain->axis_count; corner++)
        block->constrained = block->constrained || run->block_walled[block->nodes[corner]];
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        /* One cell more on each side: a particle is tested after it has moved. */
        low[axis] = domain_node_position(domain, axis, block->cell[axis] - 1);
        high[axis] = domain_node_position(domain, axis,
                                          block->cell[axis] + (axis == 0 ? LANE_COUNT : 1) + 1);
    }
    block->eliminates = wall_set_may_eliminate(&run->walls, low, high);
}

int run_find_walls(struct run *run)
{
    struct node_blocks *nodes = &run->grid.nodes;
    if (nodes->count > run->block_walled_capacity) {
        bool *walled = realloc(run->block_walled, nodes->capacity * sizeof *walled);
        if (walled == NULL)
            return -1;
        run->block_walled = walled;
        run->block_walled_capacity = nodes->capacity;
    }
    for (size_t block = run->walled_block_count; block < nodes->count; block++) {
        if (append_wall_nodes(run, block) != 0)
            return -1;
    }
    run->walled_block_count = nodes->count;
    const size_t chunks = (run->wall_node_count + WALL_CHUNK - 1) / WALL_CHUNK;
    if (chunks * partial_stride(run) > run->wall_partial_capacity) {
        const size_t capacity = 2 * chunks * partial_stride(run);
        double *partials = realloc(run->wall_partials, capacity * sizeof *partials);
        if (partials == NULL)
            return -1;
        run->wall_partials = partials;
        run->wall_partial_capacity = capacity;
    }
    for (size_t index = 0; index < run->grid.block_count; index++)
        mark_block(run, &run->grid.blocks[index]);
    return 0;
}

double run_force_factor(const struct run *run)
{
    const double ramp = run->scene.solver.force_ramp;
    return ramp > 0 ? fmin(1.0, (run->time + run->time_step) / ramp) : 1.0;
}

/* dt (f_int / m + g) of one node, without walls. */
static void free_increment(const struct run *run, const struct wall_node *wall, double mass,
                           double factor, double increment[3])
{
    const struct node_blocks *nodes = &run->grid.nodes;
    memset(increment, 0, 3 * sizeof *increment);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double force =
            node_values(nodes, wall->block, nodes->layout.force + axis)[wall->lane];
        increment[axis] = run->time_step * (force / mass + factor * run->scene.gravity[axis]);
    }
}

static void kick_block(struct run *run, size_t block, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const lanes mass = lanes_load(node_values(nodes, block, nodes->layout.mass));
    const lane_mask moves = mass > (real)run->mass_cutoff;
    const lanes inverse = (real)1.0 / lanes_select(moves, mass, lanes_splat((real)1.0));
    const real time_step = (real)run->time_step;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const lanes force = lanes_load(node_values(nodes, block, nodes->layout.force + axis));
        const lanes kick =
            time_step * (force * inverse + (real)(factor * run->scene.gravity[axis]));
        lanes_store(node_values(nodes, block, nodes->layout.kick + axis), lanes_keep(moves, kick));
        lanes_store(node_values(nodes, block, nodes->layout.momentum + axis), lanes_splat(0.0));
    }
}

void run_kick_nodes(struct run *run)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const double factor = run_force_factor(run);
#pragma omp parallel num_threads(run->threads) if (run->threads > 1)
    {
#pragma omp for schedule(static)
        for (size_t block = 0; block < nodes->count; block++)
            kick_block(run, block, factor);
#pragma omp for schedule(static)
        for (size_t index = 0; index < run->wall_node_count; index++) {
            const struct wall_node *wall = &run->wall_nodes[index];
            const double mass = node_values(nodes, wall->block, nodes->layout.mass)[wall->lane];
            if (mass <= run->mass_cutoff)
                continue;
            double increment[3];
            free_increment(run, wall, mass, factor, increment);
            contact_hold_back(run->walls.faces, &wall->faces, mass, run->time_step, increment);
            for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
                node_values(nodes, wall->block, nodes->layout.kick + axis)[wall->lane] =
                    (real)increment[axis];
        }
    }
}

/* Momentum -> velocity before the walls; local damping goes into the correction. With `last` the
 * velocity before the step is P/m and the whole increment is the correction. */
static void update_block(struct run *run, size_t block, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    const real damping = (real)run->scene.solver.local_damping;
    const lanes mass = lanes_load(node_values(nodes, block, nodes->layout.mass));
    const lane_mask moves = mass > (real)run->mass_cutoff;
    const lanes inverse = (real)1.0 / lanes_select(moves, mass, lanes_splat((real)1.0));
    const real time_step = (real)run->time_step;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        real *momentum = node_values(nodes, block, nodes->layout.momentum + axis);
        const lanes force = lanes_load(node_values(nodes, block, nodes->layout.force + axis));
        const lanes whole =
            time_step * (force * inverse + (real)(factor * run->scene.gravity[axis]));
        const lanes start = lanes_load(momentum) * inverse;
        lanes correction = last ? whole : lanes_splat(0.0);
        if (damping > 0) {
            /* Opposes the motion by a share of the out-of-balance force, and never reverses it. */
            const lanes moving = start + correction;
            const lanes speed = lanes_absolute(moving);
            const lanes brake = damping * lanes_absolute(whole);
            const lanes taken = lanes_select(brake < speed, brake, speed);
            correction -= lanes_select(moving > (real)0.0, taken, -taken);
        }
        correction = lanes_keep(moves, correction);
        lanes_store(node_values(nodes, block, nodes->layout.correction + axis), correction);
        lanes_store(momentum, lanes_splat(0.0)); /* may be the place of the velocity */
        lanes_store(node_values(nodes, block, nodes->layout.velocity + axis),
                    lanes_keep(moves, start) + correction);
    }
}

static void add_face_sums(const struct run *run, const struct wall_node *wall,
                          const struct contact *contact, double *partial)
{
    const double full = 1e-3 * run->reference_density * domain_cell_volume(&run->grid.domain);
    for (size_t index = 0; index < wall->faces.count; index++) {
        double *sums = partial + wall->faces.face[index] * FACE_SUMS;
        const struct wall_face *face = &run->walls.faces[wall->faces.face[index]];
        const double *about = run->scene.boundaries[face->boundary_index].moment_about;
        double load[3], arm[3];
        for (size_t axis = 0; axis < 3; axis++) {
            load[axis] = -contact->impulse[index][axis];
            arm[axis] = wall->position[axis] - about[axis];
            sums[axis] += load[axis];
        }
        for (size_t axis = 0; axis < 3; axis++) {
            const size_t next = (axis + 1) % 3, after = (axis + 2) % 3;
            sums[3 + axis] += arm[next] * load[after] - arm[after] * load[next];
        }
        if (contact->mass > full)
            sums[6] += wall->faces.area[index];
    }
}

/* A wall node on its way through the node update. */
struct wall_passage {
    double start[3];  /* [m/s] before the forces of the step */
    double kept[3];   /* [m/s] what the particles carry already */
    double braked[3]; /* [m/s] local damping as applied to a free node; then as it is with walls */
};

/* Velocities and increments before the walls. Local damping is taken back: it is a share of what
 * the walls leave unbalanced, or it would carry load in the place of friction. */
static void enter_wall(struct run *run, const struct wall_node *wall, double factor,
                       struct contact *contact, struct wall_passage *passage, double *damping_sums)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    free_increment(run, wall, contact->mass, factor, contact->acceleration_increment);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double whole = contact->acceleration_increment[axis];
        const double moved =
            node_values(nodes, wall->block, nodes->layout.velocity + axis)[wall->lane];
        const double kick =
            last ? 0.0 : node_values(nodes, wall->block, nodes->layout.kick + axis)[wall->lane];
        const double correction =
            node_values(nodes, wall->block, nodes->layout.correction + axis)[wall->lane];
        const double braked = correction - (last ? whole : 0.0);
        passage->kept[axis] = moved - correction;
        passage->start[axis] = passage->kept[axis] - kick;
        contact->free_velocity[axis] = moved - braked + (last ? 0.0 : whole - kick);
        damping_sums[0] += contact->mass * braked * (moved - 0.5 * (braked + whole));
        damping_sums[1 + axis] -= contact->mass * braked;
    }
}

/* Local damping along the motion that the walls leave; never reverses it. */
static void brake_at_wall(struct contact *contact, const struct wall_passage *passage,
                          double damping, double *damping_sums)
{
    double square = 0, gain = 0;
    for (size_t axis = 0; axis < 3; axis++) {
        square += contact->velocity[axis] * contact->velocity[axis];
        gain += (contact->velocity[axis] - passage->start[axis]) * contact->velocity[axis];
    }
    if (square == 0)
        return;
    const double share = fmin(1.0, damping * fabs(gain) / square);
    for (size_t axis = 0; axis < 3; axis++) {
        const double braked = -share * contact->velocity[axis];
        contact->velocity[axis] += braked;
        contact->handed_velocity[axis] += braked;
        damping_sums[0] -=
            contact->mass * braked * 0.5 * (contact->velocity[axis] + passage->start[axis]);
        damping_sums[1 + axis] += contact->mass * braked;
    }
}

/* Applies the walls at one node and books what they did. */
static void update_wall_node(struct run *run, struct wall_node *wall, double factor,
                             double *partial)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    memset(wall->impulse, 0, sizeof wall->impulse);
    struct contact contact = {.faces = run->walls.faces,
                              .node = &wall->faces,
                              .mass =
                                  node_values(nodes, wall->block, nodes->layout.mass)[wall->lane],
                              .time_step = run->time_step};
    if (contact.mass <= run->mass_cutoff)
        return;
    double *totals = partial + run->walls.face_count * FACE_SUMS;
    struct wall_passage passage = {.start = {0, 0, 0}};
    enter_wall(run, wall, factor, &contact, &passage, totals + 5);
    contact_solve(&contact);
    double square = 0;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        wall->impulse[axis] =
            contact.mass * (contact.handed_velocity[axis] - contact.free_velocity[axis]);
        totals[axis] += wall->impulse[axis];
        square += wall->impulse[axis] * wall->impulse[axis];
    }
    if (run->scene.solver.local_damping > 0)
        brake_at_wall(&contact, &passage, run->scene.solver.local_damping, totals + 5);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        node_values(nodes, wall->block, nodes->layout.velocity + axis)[wall->lane] =
            (real)contact.velocity[axis];
        node_values(nodes, wall->block, nodes->layout.correction + axis)[wall->lane] =
            (real)(contact.handed_velocity[axis] - passage.kept[axis]);
        /* Along the normal the boundary does no work; along it this is the work of friction. */
        totals[4] -= wall->impulse[axis] * contact.velocity[axis];
    }
    totals[3] += sqrt(square);
    add_face_sums(run, wall, &contact, partial);
}

static void book_window(struct wall_record *record, struct peak_window *window, double time,
                        double step, double window_length)
{
    double force[3], square = 0;
    if (window->capacity == 0) {
        for (size_t axis = 0; axis < 3; axis++)
            force[axis] = record->step_impulse[axis] / step;
    } else {
        double *entry = window->entries + 4 * ((window->first + window->count) % window->capacity);
        for (size_t axis = 0; axis < 3; axis++)
            entry[axis] = record->step_impulse[axis];
        entry[3] = step;
        window->count++;
        record->window_time += step;
        while (window->count > 1 && (record->window_time - window->entries[4 * window->first + 3] >=
                                         window_length * (1 - 1e-12) ||
                                     window->count == window->capacity)) {
            record->window_time -= window->entries[4 * window->first + 3];
            window->first = (window->first + 1) % window->capacity;
            window->count--;
        }
        double sum[4] = {0, 0, 0, 0};
        for (size_t index = 0; index < window->count; index++) {
            const double *old = window->entries + 4 * ((window->first + index) % window->capacity);
            for (size_t axis = 0; axis < 4; axis++)
                sum[axis] += old[axis];
        }
        record->window_time = sum[3];
        for (size_t axis = 0; axis < 3; axis++)
            force[axis] = sum[axis] / fmax(sum[3], window_length);
    }
    for (size_t axis = 0; axis < 3; axis++)
        square += force[axis] * force[axis];
    if (sqrt(square) > record->peak) {
        record->peak = sqrt(square);
        record->peak_time = time;
        memcpy(record->peak_force, force, sizeof force);
    }
}

static void add_record(struct wall_record *record, const double *sums)
{
    for (size_t axis = 0; axis < 3; axis++) {
        record->step_impulse[axis] += sums[axis];
        record->step_moment[axis] += sums[3 + axis];
    }
    record->contact_area += sums[6];
}

static void finish_record(struct run *run, struct wall_record *record, struct peak_window *window,
                          double window_length)
{
    for (size_t axis = 0; axis < 3; axis++) {
        record->interval_impulse[axis] += record->step_impulse[axis];
        record->interval_moment[axis] += record->step_moment[axis];
    }
    /* A fixed step that is cut short at the end must not pass for a peak (time_step.c). */
    book_window(record, window, run->time + run->time_step,
                fmax(run->time_step, fmin(run->last_time_step, run->scene.solver.time_step)),
                window_length);
}

static void clear_step(struct wall_record *record)
{
    memset(record->step_impulse, 0, sizeof record->step_impulse);
    memset(record->step_moment, 0, sizeof record->step_moment);
    record->contact_area = 0;
}

/* Adds the chunks in order, to faces, boundaries and the audit. */
static void sum_walls(struct run *run, size_t chunk_count)
{
    for (size_t face = 0; face < run->walls.face_count; face++)
        clear_step(&run->faces[face]);
    for (size_t index = 0; index < run->scene.boundary_count; index++)
        clear_step(&run->boundaries[index]);
    for (size_t chunk = 0; chunk < chunk_count; chunk++) {
        const double *partial = run->wall_partials + chunk * partial_stride(run);
        for (size_t face = 0; face < run->walls.face_count; face++) {
            add_record(&run->faces[face], partial + face * FACE_SUMS);
            add_record(&run->boundaries[run->walls.faces[face].boundary_index],
                       partial + face * FACE_SUMS);
        }
        const double *totals = partial + run->walls.face_count * FACE_SUMS;
        for (size_t axis = 0; axis < 3; axis++)
            run->audit.impulse[axis] += totals[axis] + totals[6 + axis];
        run->audit.exchanged += totals[3];
        run->energy.wall += totals[4];
        run->energy.damping += totals[5];
    }
    for (size_t face = 0; face < run->walls.face_count; face++) {
        const size_t boundary = run->walls.faces[face].boundary_index;
        finish_record(run, &run->faces[face], &run->windows[face],
                      run->scene.boundaries[boundary].peak_window);
    }
    for (size_t index = 0; index < run->scene.boundary_count; index++)
        finish_record(run, &run->boundaries[index], &run->windows[run->walls.face_count + index],
                      run->scene.boundaries[index].peak_window);
}

/* Gravity and local damping act at every node: their impulses, for the audit. */
static void book_body_forces(struct run *run, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    const bool damped = run->scene.solver.local_damping > 0;
    assert(run->grid.domain.axis_count <= 3);
    double mass_sum = 0, impulse[3] = {0, 0, 0}, energy = 0;
    for (size_t block = 0; block < nodes->count; block++) {
        const real *mass = node_values(nodes, block, nodes->layout.mass);
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            if (mass[lane] <= run->mass_cutoff)
                continue;
            mass_sum += mass[lane];
            for (uint32_t axis = 0; damped && axis < run->grid.domain.axis_count; axis++) {
                const double force =
                    node_values(nodes, block, nodes->layout.force + axis)[lane] / mass[lane];
                const double whole = run->time_step * (force + factor * run->scene.gravity[axis]);
                const double correction =
                    node_values(nodes, block, nodes->layout.correction + axis)[lane];
                const double moved = node_values(nodes, block, nodes->layout.velocity + axis)[lane];
                const double braked = correction - (last ? whole : 0.0);
                impulse[axis] += mass[lane] * braked;
                energy -= mass[lane] * braked * (moved - 0.5 * (braked + whole));
            }
        }
    }
    double square = 0;
    for (size_t axis = 0; axis < 3; axis++) {
        const double weight = mass_sum * factor * run->scene.gravity[axis] * run->time_step;
        run->audit.impulse[axis] += weight + impulse[axis];
        square += (weight + impulse[axis]) * (weight + impulse[axis]);
    }
    run->audit.exchanged += sqrt(square);
    run->energy.damping += energy;
}

/* The share of gravity that the ramp holds back is in the potential, and must not be: its work is
 * external. */
static void book_ramp(struct run *run, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    double power = 0;
    for (size_t block = 0; block < nodes->count; block++) {
        const real *mass = node_values(nodes, block, nodes->layout.mass);
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
            const real *velocity = node_values(nodes, block, nodes->layout.velocity + axis);
            for (size_t lane = 0; lane < LANE_COUNT; lane++)
                power += mass[lane] * run->scene.gravity[axis] * velocity[lane];
        }
    }
    run->energy.external -= (1 - factor) * power * run->time_step;
}

static void clear_scattered(struct run *run, size_t block)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    lanes_store(node_values(nodes, block, nodes->layout.mass), lanes_splat(0.0));
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        lanes_store(node_values(nodes, block, nodes->layout.force + axis), lanes_splat(0.0));
}

void run_update_nodes(struct run *run)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const double factor = run_force_factor(run);
    const size_t chunk_count = (run->wall_node_count + WALL_CHUNK - 1) / WALL_CHUNK;
    const size_t stride = partial_stride(run);
#pragma omp parallel for schedule(static) num_threads(run->threads) if (run->threads > 1)
    for (size_t block = 0; block < nodes->count; block++)
        update_block(run, block, factor);
    book_body_forces(run, factor);
#pragma omp parallel for schedule(static) num_threads(run->threads) if (run->threads > 1)
    for (size_t chunk = 0; chunk < chunk_count; chunk++) {
        double *partial = run->wall_partials + chunk * stride;
        memset(partial, 0, stride * sizeof *partial);
        const size_t begin = chunk * WALL_CHUNK;
        for (size_t index = begin; index < begin + WALL_CHUNK && index < run->wall_node_count;
             index++)
            update_wall_node(run, &run->wall_nodes[index], factor, partial);
    }
    sum_walls(run, chunk_count);
    if (factor < 1)
        book_ramp(run, factor);
#pragma omp parallel for schedule(static) num_threads(run->threads) if (run->threads > 1)
    for (size_t block = 0; block < nodes->count; block++)
        clear_scattered(run, block);
}
