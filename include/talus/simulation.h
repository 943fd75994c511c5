/* SPDX-License-Identifier: Apache-2.0 */
/* A running simulation: the C API of the solver. Knows no JSON, no files, no HTTP.
 *
 * Life: talus_simulation_create -> (talus_simulation_step, reading in between) -> _destroy.
 * Reading (samples, frames, checkpoints) never changes the run, not by one bit; only
 * talus_simulation_sample closes the interval over which reaction forces are averaged.
 * The result has the same bits for any thread count. One simulation may be used by one thread at a
 * time; it starts its own team. All calls but create/destroy work on a created simulation. */
#ifndef TALUS_SIMULATION_H
#define TALUS_SIMULATION_H

#include "talus/scene.h"
#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct talus_simulation;

/* Fills out[3] for the particle with that id, which is at `position` [m] at `time` [s]. Several
 * threads may call it at once. */
typedef void talus_particle_function(void *context, uint32_t id, const double position[3],
                                     double time, double out[3]);

struct talus_simulation_options {
    int threads;      /* at least 1; at most so many are used, fewer where more do not pay ... */
    bool all_threads; /* ... unless this asks for all of them */
    /* For manufactured solutions; NULL: none. A restored simulation must be given the same. */
    talus_particle_function *body_force;       /* [m/s^2] beside gravity */
    talus_particle_function *initial_velocity; /* [m/s] in the place of the bodies' */
    void *context;                             /* the caller's, handed to both */
};

/* Builds the simulation at t = 0, or as long before as the scene settles: particles seeded, initial
 * stress set, forces ready. What is measured starts at t = 0, where settling ends to the last bit.
 * The scene is copied. *simulation is owned by the caller (destroy it). */
TALUS_MUST_CHECK enum talus_status
talus_simulation_create(const struct talus_scene *scene,
                        const struct talus_simulation_options *options,
                        struct talus_simulation **simulation, struct talus_error *error);
void talus_simulation_destroy(struct talus_simulation *simulation);

/* One time step. TALUS_UNSTABLE when health finds the state bad: *error names particle, place, time
 * and what to try; the simulation can still be read, but not be stepped on. */
TALUS_MUST_CHECK enum talus_status talus_simulation_step(struct talus_simulation *simulation,
                                                         struct talus_error *error);

struct talus_simulation_state {
    double time;               /* [s]; negative while the scene settles */
    double duration;           /* [s] end of the run */
    uint64_t step;             /* steps taken */
    double time_step;          /* [s] of the next step */
    double critical_time_step; /* [s] now */
    size_t particle_count;     /* alive */
    size_t initial_particle_count;
    size_t active_cell_count;
    size_t memory_bytes;    /* held by the simulation, the last checkpoint included */
    double eliminated_mass; /* [kg] */
    bool finished;          /* time has reached duration */
};
void talus_simulation_get_state(const struct talus_simulation *simulation,
                                struct talus_simulation_state *state);

/* The same without what must be counted over the grid (active_cell_count and memory_bytes are 0):
 * for every step. */
void talus_simulation_get_clock(struct talus_simulation *simulation,
                                struct talus_simulation_state *state);

/* Moves the end of the run (steering); not before the present time. */
TALUS_MUST_CHECK enum talus_status
talus_simulation_set_duration(struct talus_simulation *simulation, double duration,
                              struct talus_error *error);

/* True if the present step end is the one nearest to `time` or later, that is if the next step end
 * would lie farther from `time` than this one does (always true at the end of the run). */
bool talus_simulation_is_nearest(const struct talus_simulation *simulation, double time);

/* ---- histories: one row of doubles per sample ---- */
struct talus_column {
    char name[128]; /* "time", "energy.kinetic", "reaction.wall.x_min.force.x", "probe.runout" */
    char unit[16];
};
/* Column 0 is time. The array belongs to the simulation. */
const struct talus_column *talus_simulation_columns(const struct talus_simulation *simulation,
                                                    size_t *count);
/* Fills row[column count] with the present values; reaction forces are impulse / length since the
 * last call (the last step's force at t = 0). Closes the interval. */
void talus_simulation_sample(struct talus_simulation *simulation, double *row);
/* Announces that the end of the next step will be sampled: the step then adds up the energies along
 * the way, for a small part of what a sample needs for them on its own. The sampled energies are
 * the same up to rounding; nothing else depends on it. */
void talus_simulation_expect_sample(struct talus_simulation *simulation);

/* ---- metrics, warnings ---- */
struct talus_metric {
    char name[160]; /* "reaction.wall.peak", "energy_error", "mass_error", "anti_locking.fallbacks"
                     */
    double value;
};
/* Final figures that are not in the history; the array lives until the next call. */
const struct talus_metric *talus_simulation_metrics(struct talus_simulation *simulation,
                                                    size_t *count);

struct talus_warning {
    char code[32];
    char pointer[128];
    char text[512];
};
/* Takes the oldest warning not yet taken; false if there is none. */
bool talus_simulation_take_warning(struct talus_simulation *simulation,
                                   struct talus_warning *warning);

/* At the end: TALUS_AUDIT with the figures in *error if mass, momentum or energy fail their limits
 * (mass 1e-12, momentum 1e-9 of the impulse exchanged, energy growth 1 %; in single precision
 * 1e-6, 1e-4, 1 %). */
TALUS_MUST_CHECK enum talus_status talus_simulation_audit(struct talus_simulation *simulation,
                                                          struct talus_error *error);

/* ---- frames: flat arrays over the living particles, in order of id ---- */
/* Positions: out[3 * particle_count] (interleaved x, y, z) [m]. */
void talus_simulation_read_positions(const struct talus_simulation *simulation, double *out);
/* out[components * particle_count], interleaved. TALUS_UNSUPPORTED if the scene did not ask for a
 * field that must be tracked (see talus_scene.output.frame_fields). */
TALUS_MUST_CHECK enum talus_status
talus_simulation_read_field(const struct talus_simulation *simulation, enum talus_field field,
                            double *out, struct talus_error *error);

/* Grid nodes that carry mass: position[3n], mass[n], velocity[3n]; and boundary nodes: reaction[3n]
 * (force on the boundary in the last step [N]) and area[n]. Any pointer may be NULL. Returns n;
 * with all NULL only counts. */
size_t talus_simulation_read_nodes(const struct talus_simulation *simulation, double *position,
                                   double *mass, double *velocity, double *reaction, double *area);

/* ---- checkpoints: the state as named arrays of raw bytes ---- */
struct talus_blob {
    char name[64];
    const void *data; /* a copy, valid until the next checkpoint or the end of the simulation */
    size_t bytes;
};
/* The complete state. The array belongs to the simulation. NULL when memory ran out. */
const struct talus_blob *talus_simulation_checkpoint(struct talus_simulation *simulation,
                                                     size_t *count);
/* Creates a simulation from the same scene and the blobs of a checkpoint: goes on bit for bit (same
 * build and ISA). TALUS_INVALID if the blobs do not belong to this scene or build. */
TALUS_MUST_CHECK enum talus_status
talus_simulation_restore(const struct talus_scene *scene,
                         const struct talus_simulation_options *options,
                         const struct talus_blob *blobs, size_t blob_count,
                         struct talus_simulation **simulation, struct talus_error *error);

/* Instruction set that the solver was compiled for ("x86-64-v3", ...; static storage). Results have
 * the same bits on the same build and instruction set. */
const char *talus_simulation_isa(void);

/* What particles, nodes and kernels of this build compute in. A simulation of a scene that asks for
 * the other precision is TALUS_UNSUPPORTED; a scene is estimated by any build. */
enum talus_precision talus_simulation_precision(void);

/* 64-bit hash of the particle state (all fields, storage order): equal states have equal hashes. */
uint64_t talus_simulation_state_hash(const struct talus_simulation *simulation);

/* ---- before a run ---- */
struct talus_estimate {
    uint64_t particle_count;
    uint64_t active_cell_count;
    double critical_time_step; /* [s] at t = 0, with the method's limit */
    double time_step;          /* [s] that the run would start with */
    uint64_t step_count;       /* expected */
    /* Automatic steps follow the speeds that the scene reaches: if nothing moves, and if the
     * fastest particle has all energy at hand all the time. */
    uint64_t step_count_low, step_count_high;
    double crossing_share; /* [-] of the particles of the fastest body that change cells in a step
                            */
    uint64_t memory_bytes;
    uint64_t bytes_per_particle;
    int useful_threads; /* as many as pay, on a machine that has them */
    /* In single precision, else 0; refused where they are too large. */
    double motion_error; /* [-] share of its motion that the slowest body may lose to rounding */
    double force_noise;  /* [-] of stresses and forces, over those of the weight or an impact */
};
/* What a scene would cost, in milliseconds and without allocating its particles. TALUS_INVALID for
 * a fixed step above the critical one (pointer /solver/time_step) unless the scene allows it, and
 * for single precision where it is not safe (/solver/precision). */
TALUS_MUST_CHECK enum talus_status talus_simulation_estimate(const struct talus_scene *scene,
                                                             struct talus_estimate *estimate,
                                                             struct talus_error *error);

#endif
