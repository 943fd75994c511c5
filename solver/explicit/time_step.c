/* SPDX-License-Identifier: Apache-2.0 */
/* The critical step: h / (c + |v|) times the limit of shape and stress ordering (spectral radius of
 * the step of full cells), reduced by viscosity and bulk damping. */
#include "explicit/run.h"

#include <math.h>

/* Shorter remainders than this share of a step are given to the last step. */
#define REMAINDER 1e-9
/* Automatic steps share the remainder among this many last ones: walls take impulses that do not
 * shrink with the step, so a very short last step would read as a peak of force. */
#define LAST_STEPS 10

static double viscous_limit(const struct run *run, double width)
{
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    double limit = INFINITY;
    for (size_t index = 0; index < run->scene.material_count; index++) {
        const struct run_material *material = &run->materials[index];
        /* The longitudinal viscosity is 2 mu. */
        if (material->viscosity > 0)
            limit = fmin(limit, material->density * width * width /
                                    ((last ? 8 : 4) * material->viscosity));
    }
    return limit;
}

double run_critical_time_step(const struct run *run, double speed)
{
    const bool last = run->scene.solver.stress_update == TALUS_STRESS_LAST;
    const double width = domain_smallest_cell(&run->grid.domain);
    const double damping = run->scene.solver.viscous_damping;
    double wave = 0;
    for (size_t index = 0; index < run->scene.material_count; index++)
        wave = fmax(wave, run->materials[index].wave_speed);
    const double courant = run->shape->courant_limit[run->scene.solver.stress_update];
    const double damped = last ? 1 + 2 * damping : sqrt(1 + damping * damping) + damping;
    return fmin(courant * width / (wave + speed) / damped, viscous_limit(run, width));
}

void run_choose_time_step(struct run *run)
{
    const double remaining = run->scene.duration - run->time;
    run->critical_time_step = run_critical_time_step(run, run->largest_speed);
    const double fixed = run->scene.solver.time_step;
    double step = fixed > 0 ? fixed : run->scene.solver.courant * run->critical_time_step;
    const double count = ceil(remaining / step * (1 - REMAINDER));
    if (count <= 1)
        step = fmax(remaining, 0);
    else if (fixed <= 0 && count <= LAST_STEPS)
        step = remaining / count;
    run->time_step = step;
}
