/* SPDX-License-Identifier: Apache-2.0 */
#include "health/health.h"

#include <math.h>
#include <stdio.h>

/* Energy may exceed the books by this share of the turnover before the run is called unstable; the
 * audit at the end is far stricter. */
#define GROWTH_LIMIT 0.5
enum { ENERGY_CHECK_INTERVAL = 16 };
/* A speed that has grown by this factor since the last check calls for one at once. */
#define SPEED_JUMP 1.5

/* "particle 12 (body 'column') at (0.1, 0.2, 0)" */
static void name_particle(const struct run *run, uint32_t id, size_t body, const double position[3],
                          char *text, size_t size)
{
    (void)snprintf(text, size, "particle %u (body '%s') at (%.6g, %.6g, %.6g)", id,
                   run->scene.bodies[body].name, position[0], position[1], position[2]);
}

static const char *advice(const struct run *run)
{
    if (run->scene.solver.stress_update == TALUS_STRESS_LAST)
        return "try \"stress_update\": \"modified_last\", or a smaller time_step";
    return "try a smaller time_step or courant, viscous_damping, or more particles per cell";
}

enum talus_status health_check_crosser(const struct run *run, const struct particle_block *block,
                                       size_t slot, struct talus_error *error)
{
    double position[3];
    char name[256];
    bool finite = true, far = false;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double x = particle_values(&run->grid.layout, block, PARTICLE_POSITION, axis)[slot];
        const double v = particle_values(&run->grid.layout, block, PARTICLE_VELOCITY, axis)[slot];
        finite = finite && isfinite(x) && isfinite(v);
        far = far || fabs(x) > 1.5;
    }
    if (finite && !far)
        return TALUS_OK;
    sparse_grid_slot_position(&run->grid, block, slot, position);
    name_particle(run, block->id[slot], block->body == NULL ? 0 : block->body[slot], position, name,
                  sizeof name);
    if (!finite)
        return talus_error_set(
            error, TALUS_UNSTABLE, "non_finite", "",
            "position or velocity of %s is not a number at t = %.6g s, step %llu; %s", name,
            run->time, (unsigned long long)run->step, advice(run));
    return talus_error_set(
        error, TALUS_UNSTABLE, "too_fast", "",
        "%s moved by more than a cell in one step of %.3g s at t = %.6g s, step %llu; %s", name,
        run->time_step, run->time, (unsigned long long)run->step, advice(run));
}

enum talus_status health_check_outside(const struct run *run, const struct particle_record *record,
                                       const double position[3], struct talus_error *error)
{
    char name[256];
    if (run->scene.grid.outside == TALUS_OUTSIDE_ELIMINATE) {
        const double limit = run->scene.grid.outside_mass_limit * run->audit.initial_mass;
        if (run->audit.outside_mass <= limit)
            return TALUS_OK;
        return talus_error_set(
            error, TALUS_UNSTABLE, "outside_mass", "/grid/outside_mass_limit",
            "%.6g kg have left the grid by t = %.6g s, more than %.3g of the mass; "
            "enlarge the grid, or raise outside_mass_limit",
            run->audit.outside_mass, run->time, run->scene.grid.outside_mass_limit);
    }
    name_particle(run, record->id, record->body, position, name, sizeof name);
    return talus_error_set(
        error, TALUS_UNSTABLE, "outside", "/grid",
        "%s left the grid at t = %.6g s, step %llu; enlarge the grid, add a boundary, "
        "or set \"outside\": \"eliminate\"",
        name, run->time, (unsigned long long)run->step);
}

/* Names the particle of that id, or with PARTICLE_NONE the first one whose velocity is not finite.
 */
static void name_bad_particle(const struct run *run, uint32_t id, char *text, size_t size)
{
    (void)snprintf(text, size, "a particle");
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            bool found = id != PARTICLE_NONE && block->id[slot] == id;
            for (uint32_t axis = 0; id == PARTICLE_NONE && axis < run->grid.domain.axis_count;
                 axis++)
                found = found || !isfinite(particle_values(&run->grid.layout, block,
                                                           PARTICLE_VELOCITY, axis)[slot]);
            if (!found || block->id[slot] == PARTICLE_NONE)
                continue;
            double position[3];
            sparse_grid_slot_position(&run->grid, block, slot, position);
            name_particle(run, block->id[slot], block->body == NULL ? 0 : block->body[slot],
                          position, text, size);
            return;
        }
    }
}

bool health_checks_energy(uint64_t step)
{
    return step <= 1 || step % ENERGY_CHECK_INTERVAL == 0;
}

/* Potential per mass of a cell's height [J/kg]: positions are rounded to a share of their cell. */
static double cell_lift(const struct run *run)
{
    double lift = 0;
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        lift += fmax(fabs(run->scene.gravity[axis]), fabs(run->gravity[axis])) *
                run->grid.domain.cell[axis];
    return lift;
}

/* The second pass has measured along with the step where that was known before. A measurement for a
 * sample does not count: looking must not change what is found here, not by one bit. */
static enum talus_status check_energy(struct run *run, struct talus_error *error)
{
    if (!health_checks_energy(run->step))
        run_measure_energy(run);
    const double turnover = run_energy_turnover(run);
    /* A body that has just begun to move has turned over less than rounding can hide. */
    const double hidden = REAL_EPSILON * run->audit.initial_mass * cell_lift(run);
    const double growth = turnover > 0 ? -run_numerical_loss(run) / (turnover + hidden) : 0.0;
    if (growth > run->audit.largest_growth)
        run->audit.largest_growth = growth;
    if (growth <= GROWTH_LIMIT)
        return TALUS_OK;
    return talus_error_set(
        error, TALUS_UNSTABLE, "energy_growth", "",
        "energy has grown by %.3g of the energy turned over beyond the work done at "
        "t = %.6g s, step %llu; %s",
        growth, run->time, (unsigned long long)run->step, advice(run));
}

static enum talus_status report_inverted(const struct run *run, const struct tile_sums *sums,
                                         struct talus_error *error)
{
    char name[256];
    name_bad_particle(run, sums->bad_particle, name, sizeof name);
    return talus_error_set(
        error, TALUS_UNSTABLE, "inverted", "",
        "det of the deformation increment of %s is %.3g at t = %.6g s, step %llu; %s", name,
        sums->least_jacobian, run->time, (unsigned long long)run->step, advice(run));
}

static enum talus_status report_speed(const struct run *run, struct talus_error *error)
{
    char name[256];
    name_bad_particle(run, PARTICLE_NONE, name, sizeof name);
    return talus_error_set(error, TALUS_UNSTABLE, "non_finite", "",
                           "the velocity of %s is not a number at t = %.6g s, step %llu; %s", name,
                           run->time, (unsigned long long)run->step, advice(run));
}

enum talus_status health_check_deformation(const struct run *run, const struct tile_sums *sums,
                                           struct talus_error *error)
{
    return sums->least_jacobian <= 0 ? report_inverted(run, sums, error) : TALUS_OK;
}

enum talus_status health_check_step(struct run *run, const struct tile_sums *sums,
                                    struct talus_error *error)
{
    if (!(sums->least_jacobian > 0))
        return report_inverted(run, sums, error);
    const double speed = sqrt(sums->speed_squared);
    if (!isfinite(speed))
        return report_speed(run, error);
    const bool jumped = speed > SPEED_JUMP * run->checked_speed && run->checked_speed > 0;
    run->largest_speed = speed;
    if (!jumped && !health_checks_energy(run->step))
        return TALUS_OK;
    run->checked_speed = speed;
    return check_energy(run, error);
}
