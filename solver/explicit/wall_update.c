/* SPDX-License-Identifier: Apache-2.0 */
/* Walls at the nodes: what they hold back before the first pass, contact and reactions after it. */
#include "explicit/node_passes.h"

#include <string.h>

/* dt (f_int / m + g) of one node, without walls. */
static void free_increment(const struct run *run, const struct wall_node *wall, double mass,
                           double factor, double increment[3])
{
    memset(increment, 0, 3 * sizeof *increment);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        increment[axis] = node_free_increment(run, wall->block, wall->lane, axis, mass, factor);
}

struct contact wall_node_contact(const struct run *run, const struct wall_node *wall)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const double *gravity = run->gravity;
    return (struct contact){
        .faces = run->walls.faces,
        .node = &wall->faces,
        .mass = node_values(nodes, wall->block, nodes->layout.mass)[wall->lane],
        .time_step = run->time_step,
        .density = run->reference_density,
        .gravity =
            sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1] + gravity[2] * gravity[2]),
    };
}

void wall_nodes_hold_back(struct run *run, size_t begin, size_t end, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    for (size_t index = begin; index < end; index++) {
        const struct wall_node *wall = &run->wall_nodes[index];
        struct contact contact = wall_node_contact(run, wall);
        if (contact.mass <= run->mass_cutoff)
            continue;
        double increment[3];
        free_increment(run, wall, contact.mass, factor, increment);
        contact_hold_back(&contact, increment);
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            node_values(nodes, wall->block, nodes->layout.kick + axis)[wall->lane] =
                (real)increment[axis];
    }
}

void wall_nodes_start(struct run *run, size_t begin, size_t end)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    for (size_t index = begin; index < end; index++) {
        const struct wall_node *wall = &run->wall_nodes[index];
        struct contact contact = wall_node_contact(run, wall);
        contact.constraints_only = true;
        if (contact.mass <= run->mass_cutoff)
            continue;
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            contact.free_velocity[axis] = contact.acceleration_increment[axis] =
                node_values(nodes, wall->block, nodes->layout.velocity + axis)[wall->lane];
        /* The sign of this velocity alone would let a body at rest open and never close: the strain
         * would grow with every oscillation of the particles. */
        memcpy(contact.pushed, wall->impulse, sizeof contact.pushed);
        contact_solve(&contact);
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            node_values(nodes, wall->block, nodes->layout.velocity + axis)[wall->lane] =
                (real)contact.velocity[axis];
    }
}

static void add_face_sums(const struct run *run, const struct wall_node *wall,
                          const struct contact *contact, double *partial)
{
    const struct domain *domain = &run->grid.domain;
    /* A node on the axis of revolution has a cell on one side only. */
    const double circle = domain_circle(domain, fmax(wall->position[0], domain->cell[0] / 6));
    const double full = 1e-3 * run->reference_density * circle * domain_cell_volume(domain);
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
    double start[3]; /* [m/s] before the forces of the step */
    double kept[3];  /* [m/s] what the particles carry already */
};

/* Velocities and increments of `last` and `first` before the walls. Local damping is taken back: it
 * is a share of what the walls leave unbalanced, or it would carry load in the place of friction.
 */
static void enter_unkicked(const struct run *run, const struct wall_node *wall,
                           struct contact *contact, struct wall_passage *passage,
                           double *damping_sums)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double whole = contact->acceleration_increment[axis];
        const double moved =
            node_values(nodes, wall->block, nodes->layout.velocity + axis)[wall->lane];
        const double correction =
            node_values(nodes, wall->block, nodes->layout.correction + axis)[wall->lane];
        const double braked = correction - whole;
        passage->kept[axis] = passage->start[axis] = moved - correction;
        contact->free_velocity[axis] = moved - braked;
        damping_sums[0] += contact->mass * braked * (moved - 0.5 * (braked + whole));
        damping_sums[1 + axis] -= contact->mass * braked;
    }
}

/* The same of `modified_last`: with what the walls held back of the kick. Brakes are part of what
 * has come back from the particles. */
static void enter_kicked(const struct run *run, const struct wall_node *wall,
                         struct contact *contact, struct wall_passage *passage)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const struct node_layout *layout = &nodes->layout;
    const uint32_t kick = layout->passed != 0 ? layout->passed : layout->kick;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double passed = node_values(nodes, wall->block, kick + axis)[wall->lane];
        const double moved = node_values(nodes, wall->block, layout->velocity + axis)[wall->lane];
        passage->kept[axis] = moved;
        if (layout->start != 0)
            passage->start[axis] =
                node_values(nodes, wall->block, layout->start + axis)[wall->lane];
        contact->free_velocity[axis] = moved + contact->acceleration_increment[axis] - passed;
    }
}

/* Local damping of `last` and `first`, after the walls. */
static void brake_unkicked(const struct run *run, const struct wall_node *wall,
                           struct contact *contact, const double start[3], double *damping_sums)
{
    double middle[3], gain[3], brake[3];
    for (size_t axis = 0; axis < 3; axis++) {
        middle[axis] = 0.5 * (start[axis] + contact->velocity[axis]);
        gain[axis] = contact->velocity[axis] - start[axis];
    }
    local_brake_at_wall(run, wall, middle, gain, brake);
    for (size_t axis = 0; axis < 3; axis++) {
        contact->velocity[axis] += brake[axis];
        contact->handed_velocity[axis] += brake[axis];
        damping_sums[0] -=
            contact->mass * brake[axis] * 0.5 * (contact->velocity[axis] + start[axis]);
        damping_sums[1 + axis] += contact->mass * brake[axis];
        /* Brakes are relative to walls: what they do as these move is work of the walls. */
        damping_sums[0] += contact->mass * brake[axis] * contact->frame[axis];
        damping_sums[4] += contact->mass * brake[axis] * contact->frame[axis];
    }
}

/* What the brake of `modified_last` has done as the walls moved. */
static void book_moved_brake(const struct run *run, const struct wall_node *wall,
                             const struct contact *contact, double *damping_sums)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double brake = node_values(nodes, wall->block, nodes->layout.kick + axis)[wall->lane];
        damping_sums[0] += contact->mass * brake * contact->frame[axis];
        damping_sums[4] += contact->mass * brake * contact->frame[axis];
    }
}

/* Work of the walls on the material in the step [J]; 0 where they stand still. */
static double work_of_walls(const struct run *run, const struct contact *contact)
{
    double work = 0;
    for (size_t place = 0; place < contact->node->count; place++) {
        const struct wall_face *face = &run->walls.faces[contact->node->face[place]];
        for (size_t axis = 0; axis < 3 && face->moves; axis++)
            work += contact->impulse[place][axis] * face->velocity[axis];
    }
    return work;
}

/* Applies the walls at one node and books what they did. */
static void update_wall_node(struct run *run, struct wall_node *wall, double factor,
                             double *partial)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    memset(wall->impulse, 0, sizeof wall->impulse);
    struct contact contact = wall_node_contact(run, wall);
    if (contact.mass <= run->mass_cutoff)
        return;
    double *totals = partial + run->walls.face_count * FACE_SUMS;
    struct wall_passage passage = {.start = {0, 0, 0}};
    free_increment(run, wall, contact.mass, factor, contact.acceleration_increment);
    if (run_kicks(run))
        enter_kicked(run, wall, &contact, &passage);
    else
        enter_unkicked(run, wall, &contact, &passage, totals + 5);
    contact_solve(&contact);
    const double work = work_of_walls(run, &contact);
    double square = 0;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        wall->impulse[axis] =
            contact.mass * (contact.handed_velocity[axis] - contact.free_velocity[axis]);
        totals[axis] += wall->impulse[axis];
        square += wall->impulse[axis] * wall->impulse[axis];
    }
    if (nodes->layout.passed != 0)
        book_moved_brake(run, wall, &contact, totals + 5);
    else if (run->scene.solver.local_damping > 0)
        brake_unkicked(run, wall, &contact, passage.start, totals + 5);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        node_values(nodes, wall->block, nodes->layout.velocity + axis)[wall->lane] =
            (real)contact.velocity[axis];
        node_values(nodes, wall->block, nodes->layout.correction + axis)[wall->lane] =
            (real)(contact.handed_velocity[axis] - passage.kept[axis]);
        totals[4] -= wall->impulse[axis] * contact.velocity[axis];
    }
    if (nodes->layout.start != 0)
        wall_node_keep_start(run, wall, &contact, passage.start);
    /* What walls that move do beyond their work on the material stays behind as friction, as all
     * does that walls at rest do. */
    totals[9] += work;
    totals[4] += work;
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

void wall_nodes_sum(struct run *run)
{
    for (size_t face = 0; face < run->walls.face_count; face++)
        clear_step(&run->faces[face]);
    for (size_t index = 0; index < run->scene.boundary_count; index++)
        clear_step(&run->boundaries[index]);
    for (size_t chunk = 0; chunk < wall_chunk_count(run); chunk++) {
        const double *partial = run->wall_partials + chunk * wall_partial_stride(run);
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
        run->energy.external += totals[9];
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

void wall_nodes_update(struct run *run, size_t chunk, double factor)
{
    const size_t stride = wall_partial_stride(run);
    double *partial = run->wall_partials + chunk * stride;
    memset(partial, 0, stride * sizeof *partial);
    const size_t begin = chunk * WALL_CHUNK;
    for (size_t index = begin; index < begin + WALL_CHUNK && index < run->wall_node_count; index++)
        update_wall_node(run, &run->wall_nodes[index], factor, partial);
}
