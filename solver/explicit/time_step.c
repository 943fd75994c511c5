/* SPDX-License-Identifier: Apache-2.0 */
/* The critical step: the smallest h / (c + |v|) of a particle times the limit of shape and stress
 * ordering (spectral radius of the step of full cells), reduced by viscosity and bulk damping.
 *
 * c and v are of the same particle: no mode of the grid is faster than the fastest one of its
 * elements (Irons and Treharne 1971), so a stiff body at rest and a soft one that flies each limit
 * the step for themselves; where they meet, in one block, the larger of both counts. |v| is there
 * for the particles that change cells, which makes the modes of the next step other ones. */
#include "explicit/run.h"
#include "math/sticky.h"

#include <math.h>

/* Shorter remainders than this share of a step are given to the last step: what the sum of many
 * thousand fixed steps has lost to rounding is no step of its own. */
#define REMAINDER 1e-4
/* Automatic steps share the remainder among this many last ones: walls take impulses that do not
 * shrink with the step, so a very short last step would read as a peak of force. */
#define LAST_STEPS 10

static double viscous_limit(const struct run *run, double width, uint64_t materials)
{
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    double limit = INFINITY;
    for (size_t index = 0; index < run->scene.material_count; index++) {
        const struct run_material *material = &run->materials[index];
        /* The longitudinal viscosity is 2 mu. */
        if ((materials >> index & 1) != 0 && material->viscosity > 0)
            limit = fmin(limit, material->density * width * width /
                                    ((last ? 8 : 4) * material->viscosity));
    }
    return limit;
}

double run_critical_time_step(const struct run *run, double signal_speed, uint64_t materials)
{
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    const double width = domain_smallest_cell(&run->grid.domain);
    const double damping = run->scene.solver.viscous_damping;
    const double courant = run->courant_limit;
    const double damped = last ? 1 + 2 * damping : sqrt(1 + damping * damping) + damping;
    return fmin(courant * width / signal_speed / damped, viscous_limit(run, width, materials));
}

void run_note_speed(const struct run *run, uint64_t materials, double speed_squared,
                    struct tile_sums *sums)
{
    double wave = 0;
    for (uint64_t left = materials; left != 0; left &= left - 1) {
        const double speed = run->materials[__builtin_ctzll(left)].wave_speed;
        wave = speed > wave ? speed : wave;
    }
    const double signal = wave + sqrt(speed_squared);
    sums->speed_squared = sticky_maximum(sums->speed_squared, speed_squared);
    sums->signal_speed = signal > sums->signal_speed ? signal : sums->signal_speed;
    sums->materials |= materials;
}

void run_choose_time_step(struct run *run)
{
    /* Settling ends at t = 0, to the last bit. */
    const double remaining = (run_is_settling(run) ? 0.0 : run->scene.duration) - run->time;
    /* Without particles nothing limits the step: as it was. */
    if (run->signal_speed > 0)
        run->critical_time_step =
            run_critical_time_step(run, run->signal_speed, run->materials_present);
    const double fixed = run->scene.solver.time_step;
    double step = fixed > 0 ? fixed : run->scene.solver.courant * run->critical_time_step;
    const double count = ceil(remaining / step - REMAINDER);
    if (count <= 1)
        step = fmax(remaining, 0);
    else if (fixed <= 0 && count <= LAST_STEPS)
        step = remaining / count;
    run->time_step = step;
}
