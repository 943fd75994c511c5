/* SPDX-License-Identifier: Apache-2.0 */
/* Final figures: audits and peaks. */
#include "simulation/simulation_private.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const face_names[6] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
static const char axis_names[3] = {'x', 'y', 'z'};

static void add_metric(struct talus_simulation *simulation, const char *prefix, const char *name,
                       double value)
{
    if (simulation->metric_count == simulation->metric_capacity) {
        const size_t capacity = simulation->metric_capacity * 2 + 32;
        struct talus_metric *larger = realloc(simulation->metrics, capacity * sizeof *larger);
        if (larger == NULL)
            return;
        simulation->metrics = larger;
        simulation->metric_capacity = capacity;
    }
    struct talus_metric *metric = &simulation->metrics[simulation->metric_count++];
    (void)snprintf(metric->name, sizeof metric->name, "%.143s%.16s", prefix, name);
    metric->value = value;
}

static void add_peaks(struct talus_simulation *simulation, const char *name,
                      const struct wall_record *record)
{
    char prefix[144], part[16];
    assert(simulation->run.scene.axis_count <= 3);
    (void)snprintf(prefix, sizeof prefix, "reaction.%.120s.", name);
    add_metric(simulation, prefix, "peak", record->peak);
    add_metric(simulation, prefix, "peak_time", record->peak_time);
    for (size_t axis = 0; axis < simulation->run.scene.axis_count; axis++) {
        (void)snprintf(part, sizeof part, "peak.%c", axis_names[axis]);
        add_metric(simulation, prefix, part, record->peak_force[axis]);
    }
}

static void add_audit(struct talus_simulation *simulation)
{
    struct run *run = &simulation->run;
    const struct run_audit *audit = &run->audit;
    double momentum[3], mass = 0, gap = 0, start = 0;
    run_measure_energy(run);
    run_measure_momentum(run, momentum, &mass);
    for (size_t axis = 0; axis < 3; axis++) {
        const double difference = momentum[axis] + audit->eliminated_momentum[axis] -
                                  audit->initial_momentum[axis] - audit->impulse[axis];
        gap += difference * difference;
        start += audit->initial_momentum[axis] * audit->initial_momentum[axis];
    }
    /* What moves without a net momentum, a body that spins, has a scale of its own: sqrt(2 K m). Of
     * what it started with too: a transfer may have brought it to rest. */
    const double energy = fmax(run->energy.kinetic, audit->initial_stored);
    const double scale = audit->exchanged + sqrt(start) + sqrt(2 * energy * audit->initial_mass);
    const double turnover = run_energy_turnover(run), loss = run_numerical_loss(run);
    add_metric(simulation, "", "mass_error",
               fabs(mass + audit->eliminated_mass - audit->initial_mass) / audit->initial_mass);
    add_metric(simulation, "", "momentum_error", scale > 0 ? sqrt(gap) / scale : 0.0);
    add_metric(simulation, "", "energy_error", turnover > 0 ? fmax(0, -loss) / turnover : 0.0);
    add_metric(simulation, "", "energy_numerical", turnover > 0 ? loss / turnover : 0.0);
    add_metric(simulation, "", "eliminated_mass", audit->eliminated_mass);
    if (run->shape->domain != NULL) {
        add_metric(simulation, "domains.", "capped", (double)run->domains.capped);
        add_metric(simulation, "domains.", "stretched", (double)run->domains.stretched);
    }
    if (run->scene.solver.anti_locking == TALUS_CONTROL_NONE ||
        run->scene.solver.anti_locking_field == TALUS_FIT_VOLUMETRIC)
        return;
    add_metric(simulation, "anti_locking.", "fallbacks", (double)run->fall_backs);
    add_metric(simulation, "anti_locking.", "fallbacks_worst", (double)run->fall_backs_worst);
}

const struct talus_metric *talus_simulation_metrics(struct talus_simulation *simulation,
                                                    size_t *count)
{
    const struct run *run = &simulation->run;
    simulation->metric_count = 0;
    add_audit(simulation);
    for (size_t index = 0; index < run->scene.boundary_count; index++) {
        const struct talus_boundary *boundary = &run->scene.boundaries[index];
        if (boundary->internal)
            continue;
        add_peaks(simulation, boundary->name, &run->boundaries[index]);
        for (size_t face = 0; boundary->shape == TALUS_BOUNDARY_BOX && face < boundary->face_count;
             face++) {
            char name[136];
            (void)snprintf(name, sizeof name, "%s.%s", boundary->name, face_names[face]);
            add_peaks(simulation, name, &run->faces[run->walls.shapes[index].first_face + face]);
        }
    }
    *count = simulation->metric_count;
    return simulation->metrics;
}

uint64_t talus_simulation_state_hash(const struct talus_simulation *simulation)
{
    const struct run *run = &simulation->run;
    uint64_t hash = 0xcbf29ce484222325u; /* FNV-1a */
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        const size_t slots = (size_t)block->row_count * LANE_COUNT;
        for (uint32_t component = 0; component < run->grid.layout.double_count; component++) {
            const unsigned char *bytes =
                (const unsigned char *)(block->data +
                                        (size_t)component * block->row_capacity * LANE_COUNT);
            for (size_t byte = 0; byte < slots * sizeof(real); byte++)
                hash = (hash ^ bytes[byte]) * 0x100000001b3u;
        }
        for (size_t slot = 0; slot < slots; slot++)
            hash = (hash ^ block->id[slot]) * 0x100000001b3u;
    }
    return hash;
}
