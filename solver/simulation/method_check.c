/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/method_check.h"

#include "shapes/shape.h"
#include "transfers/velocity_transfer.h"

#include <math.h>
#include <stdio.h>

/* A share of PIC is part of `flip`; the others are nothing but PIC. */
static enum talus_status check_share(const struct talus_scene *scene, struct talus_error *error)
{
    const struct talus_solver_options *solver = &scene->solver;
    const char *name = transfer_of(solver)->name;
    if (solver->transfer_index == 0 || (!(solver->pic_rate > 0) && isnan(solver->flip_ratio)))
        return TALUS_OK;
    const bool ratio = !isnan(solver->flip_ratio);
    return talus_error_set(error, TALUS_INVALID, "contradiction",
                           ratio ? "/solver/flip_ratio" : "/solver/pic_rate",
                           "'%s' belongs to the transfer \"flip\"; \"%s\" takes the nodes' "
                           "velocity in every step",
                           ratio ? "flip_ratio" : "pic_rate", name);
}

/* A wall that leaves the particles their normal velocity has none to give to PIC: the momentum that
 * particles lose by taking the nodes' velocity would be nobody's. */
static enum talus_status check_walls(const struct talus_scene *scene, struct talus_error *error)
{
    for (size_t index = 0; index < scene->boundary_count; index++) {
        char pointer[64];
        if (scene->boundaries[index].wall != TALUS_WALL_KEEP || !transfer_blends(&scene->solver))
            continue;
        (void)snprintf(pointer, sizeof pointer, "/boundaries/%zu/wall", index);
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "\"keep\" leaves particles their velocity against the wall, and a "
                               "share of PIC takes it from them: use \"stop\", or pure FLIP");
    }
    return TALUS_OK;
}

/* The slope of a particle that has just entered a cell is that of a node which carries hardly any
 * mass, so the nodes' velocities come back whole: what keeps FLIP stable there is gone. */
static enum talus_status check_affine(const struct talus_scene *scene, struct talus_error *error)
{
    const struct talus_solver_options *solver = &scene->solver;
    const struct shape *shape = shape_table[solver->shape_index];
    if (!transfer_of(solver)->affine || !shape->light_nodes || solver->allow_unstable)
        return TALUS_OK;
    return talus_error_set(error, TALUS_INVALID, "unstable", "/solver/transfer",
                           "\"%s\" with the shape \"%s\" is unstable where a body's edge moves "
                           "through cells: use a smoother shape such as \"bspline2\", or "
                           "\"allow_unstable\": true",
                           transfer_of(solver)->name, shape->name);
}

/* Elements of two cells of the solver an axis: averages over its cells would change nothing, and
 * functions that reproduce squares have no second moment, over which slopes are found. */
static enum talus_status check_elements(const struct talus_scene *scene, struct talus_error *error)
{
    const struct talus_solver_options *solver = &scene->solver;
    const struct shape *shape = shape_table[solver->shape_index];
    if (!shape->halves_cells)
        return TALUS_OK;
    if (solver->anti_locking != TALUS_CONTROL_NONE)
        return talus_error_set(error, TALUS_INVALID, "contradiction", "/solver/anti_locking",
                               "shape \"%s\" works in half cells, over which averages would change "
                               "nothing",
                               shape->name);
    if (transfer_of(solver)->affine)
        return talus_error_set(error, TALUS_INVALID, "contradiction", "/solver/transfer",
                               "\"%s\" finds slopes by second moments, which the weights of shape "
                               "\"%s\" do not have",
                               transfer_of(solver)->name, shape->name);
    return TALUS_OK;
}

/* Straining with anything but the velocity at the end of the step amplifies every wave by
 * sqrt(1 + (s - theta) (w dt)^2) per step with `last`, where s <= 1 is what a transfer leaves of
 * it, and by sqrt(1 + (1 - theta) s (w dt)^2) with `modified_last`. */
static enum talus_status check_theta(const struct talus_scene *scene, struct talus_error *error)
{
    static const char pointer[] = "/solver/strain_theta";
    const struct talus_solver_options *solver = &scene->solver;
    if (solver->strain_theta == 1)
        return TALUS_OK;
    if (solver->stress_update == TALUS_STRESS_FIRST)
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "\"first\" strains with the velocity at the start of the step: "
                               "there is nothing to choose");
    if (transfer_blends(solver))
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "a share of PIC needs the velocity at the end of the step at the "
                               "nodes");
    if (!solver->allow_unstable)
        return talus_error_set(error, TALUS_INVALID, "unstable", pointer,
                               "below 1 every wave grows from step to step unless viscous_damping "
                               "takes it away: needs \"allow_unstable\": true");
    return TALUS_OK;
}

/* Neighbours take the force of a node only where they share every cell with it. */
static enum talus_status check_small_mass(const struct talus_scene *scene,
                                          struct talus_error *error)
{
    const struct shape *shape = shape_table[scene->solver.shape_index];
    if (scene->solver.small_mass != TALUS_SMALL_MASS_REDISTRIBUTE || shape->light_nodes)
        return TALUS_OK;
    return talus_error_set(error, TALUS_INVALID, "contradiction", "/solver/stabilise/small_mass",
                           "the pull of a particle at the nodes of shape \"%s\" shrinks with their "
                           "mass: there is nothing to redistribute",
                           shape->name);
}

/* Particles are smoothed where the strain of a step is worked out once, from the end of the step,
 * and where the share of a node's support that is full is a share of a cell. */
static enum talus_status check_front(const struct talus_scene *scene, struct talus_error *error)
{
    static const char pointer[] = "/solver/stabilise/front_smoothing";
    const struct talus_solver_options *solver = &scene->solver;
    const struct shape *shape = shape_table[solver->shape_index];
    if (!(solver->front_threshold > 0))
        return TALUS_OK;
    if (solver->stress_update == TALUS_STRESS_FIRST)
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "\"first\" strains with the velocity at the start of the step "
                               "everywhere: there is nothing to smooth");
    if (solver->stress_update == TALUS_STRESS_MODIFIED_LAST &&
        solver->front_reading == TALUS_FRONT_START_VELOCITY)
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "\"start_velocity\" needs \"stress_update\": \"last\": "
                               "\"modified_last\" maps velocities to the nodes after the forces "
                               "have acted, and has none of the start of the step");
    if (shape->halves_cells)
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "the nodes of shape \"%s\" do not all have a cell's volume, of "
                               "which a share could be full",
                               shape->name);
    if (scene->dimension == TALUS_AXISYMMETRIC)
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "is not made for \"axisymmetric\" scenes: the hoop strain would "
                               "still be of the end of the step");
    if (solver->anti_locking == TALUS_CONTROL_NODE || solver->anti_locking == TALUS_CONTROL_HYBRID)
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "cannot be combined with anti_locking over nodes, which works out "
                               "strain and motion more than once; \"cell\" can");
    return TALUS_OK;
}

enum talus_status method_check(const struct talus_scene *scene, struct talus_error *error)
{
    enum talus_status status = check_share(scene, error);
    if (status == TALUS_OK)
        status = check_walls(scene, error);
    if (status == TALUS_OK)
        status = check_affine(scene, error);
    if (status == TALUS_OK)
        status = check_elements(scene, error);
    if (status == TALUS_OK)
        status = check_theta(scene, error);
    if (status == TALUS_OK)
        status = check_small_mass(scene, error);
    if (status == TALUS_OK)
        status = check_front(scene, error);
    return status;
}
