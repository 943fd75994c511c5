/* SPDX-License-Identifier: Apache-2.0 */
#include "reference_mpm.h"

#include "materials/material.h"
#include "transfers/velocity_transfer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double reference_hat(const struct reference *reference, const int node[3], const double position[3],
                     double gradient[3])
{
    const struct talus_grid *grid = &reference->scene->grid;
    double value[3] = {1, 1, 1}, slope[3] = {0, 0, 0};
    for (size_t axis = 0; axis < reference->scene->axis_count; axis++) {
        const double h = grid->cell[axis];
        const double x = position[axis] - (grid->min[axis] + node[axis] * h);
        value[axis] = fabs(x) < h ? 1.0 - fabs(x) / h : 0.0;
        slope[axis] = fabs(x) < h ? (x > 0 ? -1.0 : 1.0) / h : 0.0;
    }
    gradient[0] = slope[0] * value[1] * value[2];
    gradient[1] = value[0] * slope[1] * value[2];
    gradient[2] = value[0] * value[1] * slope[2];
    return value[0] * value[1] * value[2];
}

struct support { /* the nodes around a particle */
    int count;
    struct reference_node *node[8];
    double weight[8], gradient[8][3];
};

static size_t node_index(const struct reference *reference, const int node[3])
{
    return ((size_t)node[2] * (size_t)reference->node_line[1] + (size_t)node[1]) *
               (size_t)reference->node_line[0] +
           (size_t)node[0];
}

static struct support find_support(const struct reference *reference, const double position[3])
{
    const struct talus_grid *grid = &reference->scene->grid;
    struct support support = {.count = 1 << reference->scene->axis_count};
    for (int corner = 0; corner < support.count; corner++) {
        int node[3] = {0, 0, 0};
        for (size_t axis = 0; axis < reference->scene->axis_count; axis++)
            node[axis] = (int)floor((position[axis] - grid->min[axis]) / grid->cell[axis]) +
                         (corner >> axis & 1);
        support.node[corner] = &reference->nodes[node_index(reference, node)];
        support.weight[corner] = reference_hat(reference, node, position, support.gradient[corner]);
    }
    return support;
}

static int cell_index(const struct reference *reference, const double position[3])
{
    const struct talus_grid *grid = &reference->scene->grid;
    int cell = 0;
    for (size_t axis = reference->scene->axis_count; axis-- > 0;)
        cell = cell * reference->node_line[axis] +
               (int)floor((position[axis] - grid->min[axis]) / grid->cell[axis]);
    return cell;
}

static bool carries_affine(const struct reference *reference)
{
    return strcmp(transfer_of(&reference->scene->solver)->name, "apic") == 0;
}

/* m_i, f_i = -sum V0 tau G, and P_i if wanted, of the present positions. */
static void scatter(struct reference *reference)
{
    for (size_t i = 0; i < reference->node_count; i++) {
        reference->nodes[i].mass = 0;
        memset(reference->nodes[i].force, 0, sizeof reference->nodes[i].force);
    }
    for (size_t k = 0; k < reference->particle_count; k++) {
        const struct reference_particle *p = &reference->particles[k];
        const struct support support = find_support(reference, p->position);
        for (int i = 0; i < support.count; i++) {
            support.node[i]->mass += support.weight[i] * p->mass;
            for (int row = 0; row < 3; row++) {
                for (int axis = 0; axis < 3; axis++)
                    support.node[i]->force[row] -= p->reference_volume *
                                                   p->force_stress.m[row][axis] *
                                                   support.gradient[i][axis];
            }
        }
    }
}

static void scatter_momentum(struct reference *reference)
{
    for (size_t i = 0; i < reference->node_count; i++)
        memset(reference->nodes[i].momentum, 0, sizeof reference->nodes[i].momentum);
    for (size_t k = 0; k < reference->particle_count; k++) {
        const struct reference_particle *p = &reference->particles[k];
        const struct support support = find_support(reference, p->position);
        for (int i = 0; i < support.count; i++) {
            for (int axis = 0; axis < 3; axis++) {
                double velocity = p->velocity[axis];
                for (int along = 0; along < 3; along++)
                    velocity += p->affine.m[axis][along] *
                                (support.node[i]->position[along] - p->position[along]);
                support.node[i]->momentum[axis] += support.weight[i] * p->mass * velocity;
            }
        }
    }
}

void reference_release(struct reference *reference)
{
    free(reference->particles);
    free(reference->nodes);
    memset(reference, 0, sizeof *reference);
}

static double force_factor(const struct reference *reference)
{
    const double ramp = reference->scene->solver.force_ramp;
    return ramp > 0 ? fmin(1.0, (reference->time + reference->time_step) / ramp) : 1.0;
}

/* dt (f_int / m + g) */
static void free_increment(const struct reference *reference, const struct reference_node *node,
                           double increment[3])
{
    for (int axis = 0; axis < 3; axis++)
        increment[axis] =
            reference->time_step * (node->force[axis] / node->mass +
                                    force_factor(reference) * reference->scene->gravity[axis]);
}

static bool find_walls(const struct reference *reference, size_t index,
                       bool active[REFERENCE_WALL_MAX])
{
    const int *line = reference->node_line;
    const int flat = (int)index;
    const int node[3] = {flat % line[0], flat / line[0] % line[1], flat / line[0] / line[1]};
    bool any = false;
    for (int k = 0; k < reference->wall_count; k++) {
        active[k] = reference_wall_holds(&reference->walls[k], node);
        any = any || active[k];
    }
    return any;
}

/* The particles get the forces before the walls have acted, in a scatter and gather of their own.
 */
static bool kicks(const struct reference *reference)
{
    const struct talus_solver_options *solver = &reference->scene->solver;
    return solver->stress_update == TALUS_STRESS_MODIFIED_LAST ||
           (solver->stress_update == TALUS_STRESS_FIRST && solver->local_damping > 0);
}

/* Adds the kicks of the nodes to the velocities of the particles. */
static void give_kicks(struct reference *reference)
{
    for (size_t k = 0; k < reference->particle_count; k++) {
        struct reference_particle *p = &reference->particles[k];
        const struct support support = find_support(reference, p->position);
        for (int i = 0; i < support.count; i++) {
            for (int axis = 0; axis < 3; axis++) {
                p->velocity[axis] += support.weight[i] * support.node[i]->kick[axis];
                for (int along = 0; along < 3 && carries_affine(reference); along++)
                    p->affine.m[axis][along] +=
                        support.gradient[i][along] * support.node[i]->kick[axis];
            }
        }
    }
    scatter_momentum(reference);
}

static void kick(struct reference *reference)
{
    for (size_t i = 0; i < reference->node_count; i++) {
        struct reference_node *node = &reference->nodes[i];
        bool active[REFERENCE_WALL_MAX];
        memset(node->kick, 0, sizeof node->kick);
        memset(node->passed, 0, sizeof node->passed);
        if (node->mass <= reference->mass_cutoff)
            continue;
        free_increment(reference, node, node->kick);
        if (find_walls(reference, i, active))
            reference_hold_back(reference->walls, reference->wall_count, active, node->mass,
                                reference->time_step, node->kick);
        memcpy(node->passed, node->kick, sizeof node->passed);
        for (int axis = 0; axis < 3; axis++)
            node->before[axis] = node->momentum[axis] / node->mass;
    }
    give_kicks(reference);
}

/* `velocity`, as far as the walls let it pass where no force changes it. */
static void constrain(const struct reference *reference, const struct reference_node *node,
                      double velocity[3])
{
    const size_t index = (size_t)(node - reference->nodes);
    struct reference_contact contact = {.pushed = node->wall_impulse};
    bool active[REFERENCE_WALL_MAX];
    if (!find_walls(reference, index, active))
        return;
    memcpy(contact.free_velocity, velocity, sizeof contact.free_velocity);
    memcpy(contact.increment, velocity, sizeof contact.increment);
    reference_contact_solve(reference->walls, reference->wall_count, active, node->mass,
                            reference->time_step, &contact);
    memcpy(velocity, contact.velocity, sizeof contact.velocity);
}

/* Local damping of a node: opposes each component of the velocity in the middle of the step by a
 * share of what the forces add, and takes half of it at most. At a wall along the motion that it
 * leaves. */
static void find_brake(const struct reference *reference, const struct reference_node *node,
                       const double middle[3], const double gain[3], double brake[3])
{
    const double share = reference->scene->solver.local_damping;
    bool active[REFERENCE_WALL_MAX];
    if (!find_walls(reference, (size_t)(node - reference->nodes), active)) {
        for (int axis = 0; axis < 3; axis++)
            brake[axis] =
                -copysign(fmin(share * fabs(gain[axis]), fabs(middle[axis])), middle[axis]);
        return;
    }
    double square = 0, along = 0;
    memcpy(brake, middle, 3 * sizeof *brake);
    constrain(reference, node, brake);
    for (int axis = 0; axis < 3; axis++) {
        square += brake[axis] * brake[axis];
        along += gain[axis] * brake[axis];
    }
    for (int axis = 0; axis < 3; axis++)
        brake[axis] *= square > 0 ? -fmin(1.0, share * fabs(along) / square) : 0.0;
}

/* The particles take what brakes their nodes, as they have taken the kick. */
static void brake(struct reference *reference)
{
    for (size_t i = 0; i < reference->node_count; i++) {
        struct reference_node *node = &reference->nodes[i];
        double middle[3];
        if (node->mass <= reference->mass_cutoff)
            continue;
        for (int axis = 0; axis < 3; axis++)
            middle[axis] = 0.5 * (node->before[axis] + node->momentum[axis] / node->mass);
        find_brake(reference, node, middle, node->passed, node->kick);
    }
    give_kicks(reference);
    for (size_t i = 0; i < reference->node_count; i++) {
        const struct reference_node *node = &reference->nodes[i];
        for (int axis = 0; axis < 3 && node->mass > reference->mass_cutoff; axis++)
            reference->damping_energy -=
                node->kick[axis] * 0.5 * (node->momentum[axis] + node->mass * node->before[axis]);
    }
}

/* `last`: the particles take the brake with the whole of the increment. */
static void brake_last(struct reference *reference, struct reference_node *node,
                       const double before[3])
{
    double middle[3], gain[3], taken[3];
    for (int axis = 0; axis < 3; axis++) {
        middle[axis] = 0.5 * (before[axis] + node->velocity[axis]);
        gain[axis] = node->velocity[axis] - before[axis];
    }
    find_brake(reference, node, middle, gain, taken);
    for (int axis = 0; axis < 3; axis++) {
        node->velocity[axis] += taken[axis];
        node->correction[axis] += taken[axis];
        reference->damping_energy -=
            node->mass * taken[axis] * 0.5 * (node->velocity[axis] + before[axis]);
    }
}

static void apply_walls(struct reference *reference, struct reference_node *node,
                        const bool active[REFERENCE_WALL_MAX], const double increment[3])
{
    struct reference_contact contact;
    memset(&contact, 0, sizeof contact);
    memcpy(contact.increment, increment, sizeof contact.increment);
    memcpy(contact.free_velocity, node->velocity, sizeof contact.free_velocity);
    reference_contact_solve(reference->walls, reference->wall_count, active, node->mass,
                            reference->time_step, &contact);
    for (int axis = 0; axis < 3; axis++) {
        node->velocity[axis] = contact.velocity[axis];
        node->correction[axis] = contact.handed[axis];
        for (int k = 0; k < reference->wall_count; k++) {
            node->wall_impulse[axis] += contact.impulse[k][axis];
            reference->wall_impulse[k][axis] -= contact.impulse[k][axis];
            reference->wall_energy -= contact.impulse[k][axis] * contact.velocity[axis];
        }
    }
}

/* Velocity at the start of the step, which strains the material of `first`. */
static void start_node(struct reference *reference, size_t index)
{
    struct reference_node *node = &reference->nodes[index];
    memset(node->straining, 0, sizeof node->straining);
    if (node->mass <= reference->mass_cutoff)
        return;
    for (int axis = 0; axis < 3; axis++)
        node->straining[axis] = node->momentum[axis] / node->mass;
    constrain(reference, node, node->straining);
}

/* What moves and strains the material, between the velocity at the start and that at the end. */
static void blend_velocities(const struct reference *reference, struct reference_node *node,
                             const double before[3])
{
    const struct talus_solver_options *solver = &reference->scene->solver;
    double start[3];
    memcpy(start, before, sizeof start);
    constrain(reference, node, start);
    for (int axis = 0; axis < 3; axis++) {
        const double change = node->velocity[axis] - start[axis];
        node->motion[axis] = node->velocity[axis] - (1 - solver->theta) * change;
        node->straining[axis] = node->velocity[axis] - (1 - solver->strain_theta) * change;
    }
}

static void update_node(struct reference *reference, size_t index)
{
    struct reference_node *node = &reference->nodes[index];
    double increment[3], before[3];
    bool active[REFERENCE_WALL_MAX];
    memset(node->velocity, 0, sizeof node->velocity);
    memset(node->correction, 0, sizeof node->correction);
    memset(node->wall_impulse, 0, sizeof node->wall_impulse);
    memset(node->motion, 0, sizeof node->motion);
    memset(node->straining, 0, sizeof node->straining);
    if (node->mass <= reference->mass_cutoff)
        return;
    free_increment(reference, node, increment);
    for (int axis = 0; axis < 3; axis++) {
        const double carried = node->momentum[axis] / node->mass;
        before[axis] = kicks(reference) ? node->before[axis] : carried;
        node->velocity[axis] =
            carried + increment[axis] - (kicks(reference) ? node->passed[axis] : 0);
    }
    if (find_walls(reference, index, active))
        apply_walls(reference, node, active, increment);
    else
        memcpy(node->correction, node->velocity, sizeof node->correction);
    if (!kicks(reference))
        brake_last(reference, node, before);
    for (int axis = 0; axis < 3; axis++)
        node->correction[axis] -= node->momentum[axis] / node->mass;
    blend_velocities(reference, node, before);
    /* The potential counts the whole of gravity; what a ramp holds back is external work. */
    for (int axis = 0; axis < 3; axis++)
        reference->external_energy -= (1 - force_factor(reference)) * node->mass *
                                      reference->scene->gravity[axis] * node->motion[axis] *
                                      reference->time_step;
}

static void gather_gradients(struct reference *reference)
{
    for (size_t k = 0; k < reference->particle_count; k++) {
        struct reference_particle *p = &reference->particles[k];
        const struct support support = find_support(reference, p->position);
        memset(&p->gradient, 0, sizeof p->gradient);
        p->cell = cell_index(reference, p->position);
        memcpy(p->gathered, p->position, sizeof p->gathered);
        for (int i = 0; i < support.count; i++) {
            for (int row = 0; row < 3; row++) {
                for (int axis = 0; axis < 3; axis++)
                    p->gradient.m[row][axis] +=
                        support.node[i]->straining[row] * support.gradient[i][axis];
            }
        }
    }
}

/* `first`: strain and stress at the positions of the start, with the velocities of the start. */
static void update_stress_first(struct reference *reference)
{
    for (size_t i = 0; i < reference->node_count; i++)
        start_node(reference, i);
    gather_gradients(reference);
    reference_update_stress(reference, reference->time_step);
    scatter(reference);
}

/* `apic`: the slope of the nodes' velocity, which for hat functions is its affine part. */
static void take_affine(struct reference *reference)
{
    gather_gradients(reference);
    for (size_t k = 0; k < reference->particle_count; k++)
        reference->particles[k].affine = reference->particles[k].gradient;
}

/* Share of the nodes' velocity in the particles'. */
static double pic_share(const struct reference *reference)
{
    const struct talus_solver_options *solver = &reference->scene->solver;
    if (strcmp(transfer_of(solver)->name, "flip") != 0)
        return 1.0;
    return isnan(solver->flip_ratio) ? 1.0 - exp(-solver->pic_rate * reference->time_step)
                                     : 1.0 - solver->flip_ratio;
}

static void move_particles(struct reference *reference)
{
    const double share = pic_share(reference);
    for (size_t k = 0; k < reference->particle_count; k++) {
        struct reference_particle *p = &reference->particles[k];
        const struct support support = find_support(reference, p->position);
        double motion[3] = {0, 0, 0};
        memset(p->grid_velocity, 0, sizeof p->grid_velocity);
        for (int i = 0; i < support.count; i++) {
            const struct reference_node *node = support.node[i];
            for (int row = 0; row < 3; row++) {
                p->velocity[row] += support.weight[i] * node->correction[row];
                p->grid_velocity[row] += support.weight[i] * node->velocity[row];
                motion[row] += support.weight[i] * node->motion[row];
            }
        }
        for (int axis = 0; axis < 3; axis++) {
            p->velocity[axis] += share * (p->grid_velocity[axis] - p->velocity[axis]);
            p->position[axis] += reference->time_step * motion[axis];
        }
    }
}

void reference_step(struct reference *reference)
{
    memset(reference->wall_impulse, 0, sizeof reference->wall_impulse);
    scatter_momentum(reference);
    const bool first = reference->scene->solver.stress_update == TALUS_STRESS_FIRST;
    if (first)
        update_stress_first(reference);
    if (kicks(reference))
        kick(reference);
    if (kicks(reference) && reference->scene->solver.local_damping > 0)
        brake(reference);
    for (size_t i = 0; i < reference->node_count; i++)
        update_node(reference, i);
    if (carries_affine(reference))
        take_affine(reference);
    else if (!first)
        gather_gradients(reference);
    move_particles(reference);
    if (!first)
        reference_update_stress(reference, reference->time_step);
    scatter(reference);
    reference->time += reference->time_step;
}

static void place_nodes(struct reference *reference)
{
    const struct talus_grid *grid = &reference->scene->grid;
    for (size_t i = 0; i < reference->node_count; i++) {
        size_t left = i;
        for (size_t axis = 0; axis < 3; axis++) {
            const size_t line = (size_t)reference->node_line[axis];
            reference->nodes[i].position[axis] =
                axis < reference->scene->axis_count
                    ? grid->min[axis] + (double)(left % line) * grid->cell[axis]
                    : 0.0;
            left /= line;
        }
    }
}

void reference_start(struct reference *reference, const struct talus_scene *scene,
                     const struct talus_simulation *simulation)
{
    struct talus_simulation_state state;
    struct talus_error error = {0};
    talus_simulation_get_state(simulation, &state);
    memset(reference, 0, sizeof *reference);
    reference->scene = scene;
    reference->time_step = scene->solver.time_step;
    reference->particle_count = state.particle_count;
    reference->node_count = 1;
    for (size_t axis = 0; axis < 3; axis++) {
        reference->node_line[axis] =
            axis < scene->axis_count ? (int)scene->grid.cell_count[axis] + 1 : 1;
        reference->node_count *= (size_t)reference->node_line[axis];
    }
    for (size_t k = 0; k < scene->boundary_count; k++)
        reference->walls[reference->wall_count++] = reference_wall_read(scene, k);
    reference->nodes = calloc(reference->node_count, sizeof *reference->nodes);
    reference->particles = calloc(state.particle_count, sizeof *reference->particles);
    double *values = calloc(8 * state.particle_count, sizeof *values);
    if (values == NULL || reference->nodes == NULL || reference->particles == NULL)
        abort();
    double *velocity = values + 3 * state.particle_count, *mass = values + 6 * state.particle_count;
    double *body = values + 7 * state.particle_count;
    talus_simulation_read_positions(simulation, values);
    if (talus_simulation_read_field(simulation, TALUS_FIELD_VELOCITY, velocity, &error) !=
            TALUS_OK ||
        talus_simulation_read_field(simulation, TALUS_FIELD_MASS, mass, &error) != TALUS_OK ||
        talus_simulation_read_field(simulation, TALUS_FIELD_BODY, body, &error) != TALUS_OK)
        abort();
    double least = INFINITY;
    for (size_t k = 0; k < state.particle_count; k++) {
        struct reference_particle *p = &reference->particles[k];
        memcpy(p->position, values + 3 * k, sizeof p->position);
        memcpy(p->velocity, velocity + 3 * k, sizeof p->velocity);
        p->mass = mass[k];
        p->material = scene->bodies[(size_t)body[k]].material_index;
        const struct talus_material *material = &scene->materials[p->material];
        p->reference_volume = p->mass / material->values[MATERIAL_VALUE_DENSITY];
        p->volume_ratio = 1;
        p->cell = cell_index(reference, p->position);
        memcpy(p->gathered, p->position, sizeof p->gathered);
        if (scene->solver.strain == TALUS_STRAIN_FINITE &&
            !material_table[material->model_index]->volumetric)
            p->elastic = tensor_unit();
        least = fmin(least, p->mass);
    }
    reference->mass_cutoff = 1e-11 * least;
    free(values);
    place_nodes(reference);
    reference_update_stress(reference, 0);
    scatter(reference);
    if (carries_affine(reference)) {
        scatter_momentum(reference);
        for (size_t i = 0; i < reference->node_count; i++)
            start_node(reference, i);
        take_affine(reference);
    }
}

struct reference_energy reference_energies(const struct reference *reference)
{
    struct reference_energy energy = {.external = reference->external_energy,
                                      .dissipated =
                                          reference->plastic_energy + reference->viscous_energy +
                                          reference->damping_energy + reference->wall_energy};
    for (size_t k = 0; k < reference->particle_count; k++) {
        const struct reference_particle *p = &reference->particles[k];
        const struct talus_material *material = &reference->scene->materials[p->material];
        const struct material *model = material_table[material->model_index];
        for (int axis = 0; axis < 3; axis++) {
            energy.kinetic += 0.5 * p->mass * p->velocity[axis] * p->velocity[axis];
            energy.potential -= p->mass * reference->scene->gravity[axis] * p->position[axis];
        }
        /* Anti-locking of the stress leaves the strain as the material returned it. */
        energy.strain +=
            p->reference_volume *
            reference_material_energy(model, material->values, &p->history, p->update.strain);
    }
    return energy;
}

void reference_momentum(const struct reference *reference, double momentum[3])
{
    memset(momentum, 0, 3 * sizeof *momentum);
    for (size_t k = 0; k < reference->particle_count; k++) {
        for (int axis = 0; axis < 3; axis++)
            momentum[axis] += reference->particles[k].mass * reference->particles[k].velocity[axis];
    }
}
