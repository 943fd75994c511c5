/* SPDX-License-Identifier: Apache-2.0 */
/* Life of a simulation: create, step, destroy. */
#include "talus/simulation.h"

#include "math/log_strain.h"
#include "seeding/seeding.h"
#include "simulation/simulation_private.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

void simulation_warn(struct talus_simulation *simulation, const char *code, const char *pointer,
                     const char *format, ...)
{
    if (simulation->warning_count == WARNING_CAPACITY)
        return;
    struct talus_warning *warning =
        &simulation->warnings[(simulation->warning_first + simulation->warning_count++) %
                              WARNING_CAPACITY];
    va_list arguments;
    va_start(arguments, format);
    (void)snprintf(warning->code, sizeof warning->code, "%s", code);
    (void)snprintf(warning->pointer, sizeof warning->pointer, "%s", pointer);
    (void)vsnprintf(warning->text, sizeof warning->text, format, arguments);
    va_end(arguments);
}

bool talus_simulation_take_warning(struct talus_simulation *simulation,
                                   struct talus_warning *warning)
{
    if (simulation->warning_count == 0)
        return false;
    *warning = simulation->warnings[simulation->warning_first];
    simulation->warning_first = (simulation->warning_first + 1) % WARNING_CAPACITY;
    simulation->warning_count--;
    return true;
}

/* Elastic strain of the initial stress, in the stored form. */
static void set_initial_strain(const struct run *run, const struct particle_seed *seed,
                               size_t particle, struct particle_record *record)
{
    const struct particle_layout *layout = &run->grid.layout;
    const struct run_material *material = &run->materials[run->body_material[seed->body[particle]]];
    double stress[6] = {0}, strain[6] = {0};
    real stored[6] = {0};
    for (size_t component = 0; seed->stress[0] != NULL && component < 6; component++)
        stress[component] = seed->stress[component][particle];
    material->model->strain_from_stress(material->constants, stress, strain);
    for (size_t component = 0; component < 6; component++)
        stored[component] = (real)strain[component];
    if (run->finite_strain && !material->model->volumetric) {
        real *arrays[6];
        for (size_t component = 0; component < 6; component++)
            arrays[component] = &stored[component];
        exp_strain_batch(1, run->strain_components, arrays, arrays);
    }
    for (size_t component = 0; component < run->stored_components; component++)
        record->values[layout->first_component[PARTICLE_STRAIN] + component] = stored[component];
    if (material->model->initialise == NULL)
        return;
    double history[SCRATCH_HISTORY_MAX] = {0};
    material->model->initialise(material->constants, strain, history);
    for (size_t state = 0; state < material->model->state_count; state++)
        record->values[layout->first_component[PARTICLE_HISTORY] + state] = (real)history[state];
}

static void set_velocity(const struct run *run, const struct particle_seed *seed, size_t particle,
                         struct particle_record *record)
{
    double velocity[3] = {0, 0, 0}, position[3] = {0, 0, 0};
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        velocity[axis] = seed->velocity[axis][particle];
        position[axis] = seed->position[axis][particle];
    }
    if (run->callbacks.initial_velocity != NULL)
        run->callbacks.initial_velocity(run->callbacks.context, (uint32_t)particle, position, 0,
                                        velocity);
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        record->values[run->grid.layout.first_component[PARTICLE_VELOCITY] + axis] =
            (real)velocity[axis];
}

/* The extent of a particle: that of its lattice, or a cube where that is turned or a list. */
static void set_domain(const struct run *run, const struct particle_seed *seed, size_t particle,
                       struct particle_record *record)
{
    const size_t axes = run->grid.domain.axis_count;
    const double *spacing = seed->spacing[seed->body[particle]];
    const double section =
        seed->volume[particle] / domain_circle(&run->grid.domain, seed->position[0][particle]);
    const bool aligned =
        spacing[0] > 0 && run->scene.bodies[seed->body[particle]].rotate_angle_deg == 0.0;
    double size[3] = {0};
    for (size_t axis = 0; axis < axes; axis++) {
        const double edge = aligned ? spacing[axis] : pow(section, 1.0 / (double)axes);
        size[axis] = edge * run->grid.domain.inverse_cell[axis];
    }
    run->shape->domain->initialise(
        axes, size, record->values + run->grid.layout.first_component[PARTICLE_DOMAIN]);
}

static enum talus_status place_particle(struct run *run, const struct particle_seed *seed,
                                        size_t particle, struct talus_error *error)
{
    const struct particle_layout *layout = &run->grid.layout;
    const struct domain *domain = &run->grid.domain;
    struct particle_record *record = &run->carried;
    int32_t cell[3] = {0, 0, 0};
    memset(record, 0, sizeof *record);
    record->id = (uint32_t)particle;
    record->body = seed->body[particle];
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        const double lines =
            (seed->position[axis][particle] - domain->min[axis]) * domain->inverse_cell[axis];
        const double limited = fmin(fmax(floor(lines), 0), (double)domain->cell_count[axis] - 1);
        cell[axis] = (int32_t)limited;
        record->values[layout->first_component[PARTICLE_POSITION] + axis] =
            (real)fmin(fmax(lines - limited - 0.5, -0.5), 0.5);
    }
    set_velocity(run, seed, particle, record);
    record->values[layout->first_component[PARTICLE_MASS]] = (real)seed->mass[particle];
    record->values[layout->first_component[PARTICLE_VOLUME]] = (real)seed->volume[particle];
    if (run->shape->domain != NULL)
        set_domain(run, seed, particle, record);
    for (size_t component = 0; component < seed->traction_components; component++)
        record->values[layout->first_component[PARTICLE_TRACTION] + component] =
            (real)seed->traction[component][particle];
    set_initial_strain(run, seed, particle, record);
    size_t slot = 0;
    if (sparse_grid_insert(&run->grid, cell, record, &slot) == BLOCK_NONE)
        return talus_error_set(error, TALUS_MEMORY, "memory", "",
                               "out of memory while placing particle %zu of %zu", particle,
                               seed->count);
    return TALUS_OK;
}

/* Nodes lighter than this share of a particle carry no motion, and what pushes them is lost. Linear
 * kernels find masses as differences of sums over whole cells, of which rounding leaves something;
 * wider ones add up what is positive but for the folds at walls, and need to lose less: with
 * N = q^2 or q^3 where the support ends, small masses are frequent. In single precision 1e-5 would
 * shorten the run-out of a sand column by 1 %, in double precision as in single. */
static double mass_cutoff(const struct shape *shape)
{
#ifdef TALUS_SINGLE
    (void)shape;
    return 1e-6;
#else
    return shape->reach > 0 ? 1e-15 : 1e-11;
#endif
}

static enum talus_status place_particles(struct run *run, struct talus_error *error)
{
    struct particle_seed seed = {0};
    enum talus_status status = seeding_create(&run->scene, &seed, error);
    double least_mass = INFINITY;
    if (status == TALUS_OK && run->grid.layout.double_count > PARTICLE_MAX_DOUBLES)
        status = talus_error_set(error, TALUS_INTERNAL, "layout", "", "a particle has %u values",
                                 run->grid.layout.double_count);
    for (size_t particle = 0; status == TALUS_OK && particle < seed.count; particle++) {
        status = place_particle(run, &seed, particle, error);
        least_mass = fmin(least_mass, seed.mass[particle]);
    }
    run->initial_particle_count = seed.count;
    run->least_mass = least_mass;
    run->mass_cutoff = mass_cutoff(run->shape) * least_mass;
    seeding_release(&seed);
    return status;
}

static enum talus_status prepare(struct talus_simulation *simulation, struct talus_error *error)
{
    struct run *run = &simulation->run;
    run->outbox = malloc((run->initial_particle_count + 1) * sizeof *run->outbox);
    if (run->outbox == NULL || probes_reserve(simulation) != 0 ||
        simulation_make_columns(simulation) != 0)
        return talus_error_memory(error);
    return TALUS_OK;
}

/* TALUS_UNSUPPORTED if the scene asks for the precision that this build does not have. */
static enum talus_status check_precision(const struct talus_scene *scene, struct talus_error *error)
{
    if (scene->solver.precision == talus_simulation_precision())
        return TALUS_OK;
    return talus_error_set(error, TALUS_UNSUPPORTED, "unsupported", "/solver/precision",
                           "this solver is built for %s precision",
                           talus_simulation_precision() == TALUS_PRECISION_SINGLE ? "single"
                                                                                  : "double");
}

enum talus_status simulation_begin(const struct talus_scene *scene,
                                   const struct talus_simulation_options *options,
                                   struct talus_simulation **simulation, struct talus_error *error)
{
    struct talus_simulation *created = calloc(1, sizeof *created);
    *simulation = created;
    if (created == NULL)
        return talus_error_memory(error);
    thread_choice_init(&created->choice);
    created->all_threads = options->all_threads;
    enum talus_status status = check_precision(scene, error);
    if (status == TALUS_OK)
        status = run_build(&created->run, scene, options, error);
    return status;
}

/* Once each, when it happens first. */
static void warn_of_domains(struct talus_simulation *simulation)
{
    struct run *run = &simulation->run;
    const struct domain_findings *found = &run->domains;
    if (found->capped > 0 && !run->capped_warned) {
        run->capped_warned = true;
        simulation_warn(simulation, "domain_capped", "/solver/shape",
                        "at t = %.6g s %llu particles, number %u among them, are longer than the "
                        "shape functions can be, and are taken as if they were just as long (the "
                        "metric domains.capped counts them at the end): use more particles a cell",
                        run->time, (unsigned long long)found->capped, found->capped_particle);
    }
    if (found->stretched > 0 && !run->stretched_warned) {
        run->stretched_warned = true;
        simulation_warn(
            simulation, "domain_stretched", "/solver/gimp_scaling",
            "at t = %.6g s %llu particles, number %u among them, are stretched to less "
            "than 0.7 or more than 1.4 times their length in some direction: sizes that "
            "follow the volume leave gaps there (the metric domains.stretched counts "
            "them at the end); \"stretch\" follows it",
            run->time, (unsigned long long)found->stretched, found->stretched_particle);
    }
}

enum talus_status talus_simulation_create(const struct talus_scene *scene,
                                          const struct talus_simulation_options *options,
                                          struct talus_simulation **simulation,
                                          struct talus_error *error)
{
    struct talus_simulation *created;
    enum talus_status status = simulation_begin(scene, options, &created, error);
    *simulation = NULL;
    if (status == TALUS_OK)
        status = place_particles(&created->run, error);
    if (status == TALUS_OK)
        status = prepare(created, error);
    if (status == TALUS_OK && !options->all_threads)
        created->run.threads =
            threads_that_pay(created->run.initial_particle_count, created->run.thread_capacity);
    if (status == TALUS_OK)
        status = run_start(&created->run, error);
    if (status != TALUS_OK) {
        talus_simulation_destroy(created);
        return status;
    }
    probes_locate(created);
    warn_of_domains(created);
    *simulation = created;
    return TALUS_OK;
}

void talus_simulation_destroy(struct talus_simulation *simulation)
{
    if (simulation == NULL)
        return;
    run_release(&simulation->run);
    free(simulation->columns);
    free(simulation->metrics);
    free(simulation->probe_ids);
    free(simulation->probe_places);
    free(simulation->probe_sums);
    free(simulation->blobs);
    free(simulation->blob_memory);
    free(simulation);
}

static size_t count_particles(struct talus_simulation *simulation)
{
    const struct run *run = &simulation->run;
    /* Particles only ever go, and take mass along. */
    if (simulation->particle_count == 0 ||
        simulation->counted_without != run->audit.eliminated_mass) {
        simulation->particle_count = sparse_grid_particle_count(&run->grid);
        simulation->counted_without = run->audit.eliminated_mass;
    }
    return simulation->particle_count;
}

static double clock_seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* With as many threads as pay. */
static enum talus_status take_step(struct talus_simulation *simulation, struct talus_error *error)
{
    struct run *run = &simulation->run;
    if (simulation->all_threads || run->thread_capacity == 1)
        return run_take_step(run, error);
    const int pay = threads_that_pay(count_particles(simulation), run->thread_capacity);
    run->threads = thread_choice_next(&simulation->choice, pay);
    const double begin = clock_seconds();
    const enum talus_status status = run_take_step(run, error);
    thread_choice_note(&simulation->choice, pay, clock_seconds() - begin);
    return status;
}

enum talus_status talus_simulation_step(struct talus_simulation *simulation,
                                        struct talus_error *error)
{
    struct run *run = &simulation->run;
    if (run->failed)
        return talus_error_set(error, TALUS_UNSTABLE, "failed", "",
                               "the simulation has become unstable and cannot go on");
    if (run->time_step <= 0)
        return TALUS_OK;
    const bool settles = run_is_settling(run);
    const enum talus_status status = take_step(simulation, error);
    if (status != TALUS_OK)
        return status;
    if (settles && !run_is_settling(run))
        probes_locate(simulation);
    const double fixed = run->scene.solver.time_step;
    if (fixed > run->critical_time_step && !run->over_critical_warned) {
        run->over_critical_warned = true;
        simulation_warn(simulation, "over_critical", "/solver/time_step",
                        "the fixed step of %.4g s has exceeded the critical step of %.4g s at "
                        "t = %.6g s (fastest particle %.4g m/s)",
                        fixed, run->critical_time_step, run->time, run->largest_speed);
    }
    if (run->fall_backs > 0 && !run->fall_back_warned) {
        run->fall_back_warned = true;
        simulation_warn(simulation, "anti_locking_fallback", "/solver/anti_locking/field",
                        "at t = %.6g s %llu control volumes have too few or too aligned particles "
                        "for the linear fits; there only the volumetric part is averaged (the "
                        "metric anti_locking.fallbacks counts them over all steps)",
                        run->time, (unsigned long long)run->fall_backs);
    }
    warn_of_domains(simulation);
    return TALUS_OK;
}

void talus_simulation_expect_sample(struct talus_simulation *simulation)
{
    simulation->run.sample_expected = true;
}

static struct talus_simulation_state clock_of(const struct run *run)
{
    return (struct talus_simulation_state){
        .time = run->time,
        .duration = run->scene.duration,
        .step = run->step,
        .time_step = run->time_step,
        .critical_time_step = run->critical_time_step,
        .initial_particle_count = run->initial_particle_count,
        .eliminated_mass = run->audit.eliminated_mass,
        .finished = run->time_step <= 0,
    };
}

void talus_simulation_get_clock(struct talus_simulation *simulation,
                                struct talus_simulation_state *state)
{
    const struct run *run = &simulation->run;
    *state = clock_of(run);
    state->particle_count = count_particles(simulation);
}

void talus_simulation_get_state(const struct talus_simulation *simulation,
                                struct talus_simulation_state *state)
{
    const struct run *run = &simulation->run;
    *state = clock_of(run);
    state->particle_count = sparse_grid_particle_count(&run->grid);
    state->active_cell_count = sparse_grid_active_cells(&run->grid);
    state->memory_bytes = simulation_memory(simulation);
}

enum talus_status talus_simulation_set_duration(struct talus_simulation *simulation,
                                                double duration, struct talus_error *error)
{
    if (!(duration >= fmax(simulation->run.time, 0)) || !isfinite(duration))
        return talus_error_set(error, TALUS_INVALID, "range", "/duration",
                               "the end %.6g s is before the present time %.6g s", duration,
                               simulation->run.time);
    simulation->run.scene.duration = duration;
    run_choose_time_step(&simulation->run);
    return TALUS_OK;
}

bool talus_simulation_is_nearest(const struct talus_simulation *simulation, double time)
{
    const struct run *run = &simulation->run;
    return run->time_step <= 0 || run->time + 0.5 * run->time_step > time;
}

/* Largest errors that an audit lets pass. */
#ifdef TALUS_SINGLE
static const double mass_limit = 1e-6, momentum_limit = 1e-4;
#else
static const double mass_limit = 1e-12, momentum_limit = 1e-9;
#endif

enum talus_status talus_simulation_audit(struct talus_simulation *simulation,
                                         struct talus_error *error)
{
    struct run *run = &simulation->run;
    size_t count = 0;
    double mass = 0, momentum = 0, growth = 0;
    const struct talus_metric *metrics = talus_simulation_metrics(simulation, &count);
    for (size_t index = 0; index < count; index++) {
        if (strcmp(metrics[index].name, "mass_error") == 0)
            mass = metrics[index].value;
        if (strcmp(metrics[index].name, "momentum_error") == 0)
            momentum = metrics[index].value;
        if (strcmp(metrics[index].name, "energy_error") == 0)
            growth = metrics[index].value;
    }
    const double limit = run->scene.energy_growth_limit;
    if (mass <= mass_limit && momentum <= momentum_limit && growth <= limit)
        return TALUS_OK;
    return talus_error_set(
        error, TALUS_AUDIT, "audit", "",
        "mass error %.3g (limit %g), momentum error %.3g (limit %g), energy "
        "growth %.3g (limit %.3g) of the energy turned over; if energy has grown, try a smaller "
        "courant or time_step, viscous_damping, or a pic_rate",
        mass, mass_limit, momentum, momentum_limit, growth, limit);
}
