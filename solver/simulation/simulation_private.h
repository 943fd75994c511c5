/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of simulation/ share. */
#ifndef TALUS_SIMULATION_PRIVATE_H
#define TALUS_SIMULATION_PRIVATE_H

#include "explicit/run.h"
#include "simulation/probe_scan.h"
#include "simulation/thread_choice.h"
#include "talus/simulation.h"

enum { WARNING_CAPACITY = 32 };

struct probe_place {
    size_t block, slot;
};

struct talus_simulation {
    struct run run;
    struct thread_choice choice;
    bool all_threads;             /* whether they pay or not */
    size_t particle_count;        /* alive, as counted ... */
    double counted_without;       /* ... when so much mass had been eliminated [kg] */
    struct talus_column *columns; /* owned */
    size_t column_count;
    struct talus_metric *metrics; /* owned */
    size_t metric_count, metric_capacity;
    struct talus_warning warnings[WARNING_CAPACITY];
    size_t warning_first, warning_count;
    uint32_t *probe_ids;              /* [probe_count] id of the particle of a point probe; owned */
    struct probe_place *probe_places; /* [probe_count] where it was last found; owned */
    struct probe_sums *probe_sums;    /* [probe_count] of the sample at hand; owned */
    struct talus_blob *blobs;         /* owned, with what they point to in blob_memory */
    size_t blob_count;
    void *blob_memory;
};

__attribute__((format(printf, 4, 5))) void simulation_warn(struct talus_simulation *simulation,
                                                           const char *code, const char *pointer,
                                                           const char *format, ...);

/* ---- simulation.c ---- */
/* Begins a simulation, without particles. *simulation (NULL without memory) is the caller's, also
 * on failure. TALUS_UNSUPPORTED if the scene asks for the precision that this build does not have.
 */
TALUS_MUST_CHECK enum talus_status simulation_begin(const struct talus_scene *scene,
                                                    const struct talus_simulation_options *options,
                                                    struct talus_simulation **simulation,
                                                    struct talus_error *error);

/* ---- build.c: from the scene, without particles ---- */
TALUS_MUST_CHECK enum talus_status run_build(struct run *run, const struct talus_scene *scene,
                                             const struct talus_simulation_options *options,
                                             struct talus_error *error);
void run_release(struct run *run);
/* Which fields the scene stores. */
void run_layout(const struct talus_scene *scene, struct particle_layout *layout);

/* ---- memory.c ---- */
size_t simulation_memory(const struct talus_simulation *simulation);
/* What a particle stores, with numbers of so many bytes. */
double layout_particle_bytes(const struct particle_layout *layout, size_t number);
/* Bytes that so many particles in so many cells will take, with one thread. */
double simulation_memory_estimate(const struct run *run, size_t number, double particles,
                                  double cells);

/* ---- columns.c ---- */
int simulation_make_columns(struct talus_simulation *simulation);

/* ---- probes.c ---- */
/* Number of columns of a probe; with a simulation also their names and units. */
size_t probe_columns(const struct talus_scene *scene, const struct talus_probe *probe,
                     struct talus_column *columns);
/* Room for what probes need, without their particles. 0, or -1 when memory ran out. */
int probes_reserve(struct talus_simulation *simulation);
/* After probe_scan into probe_sums, and with the energies measured. */
void probe_sample(struct talus_simulation *simulation, size_t probe_index, double *values);
/* Finds the particles of point probes; at t = 0. */
void probes_locate(struct talus_simulation *simulation);
double run_energy_part(const struct run *run, enum talus_energy_part part);

/* ---- frames.c ---- */
/* Values of a field at one slot, components of it; the field must be available. */
void field_values(const struct run *run, const struct particle_block *block, size_t slot,
                  enum talus_field field, double *values);
size_t field_components(enum talus_field field);
bool field_is_stored(const struct run *run, enum talus_field field);

/* Axes in the units of extensive quantities: results are per metre in 2D and per square metre in
 * 1D, and for the whole circle in axisymmetric scenes. */
static inline size_t extensive_axis_count(const struct talus_scene *scene)
{
    return scene->dimension == TALUS_AXISYMMETRIC ? 3 : scene->axis_count;
}

/* ---- dimension_check.c ---- */
/* TALUS_INVALID, with a pointer into the scene, for what its dimension excludes. */
TALUS_MUST_CHECK enum talus_status scene_check_dimension(const struct talus_scene *scene,
                                                         struct talus_error *error);

/* ---- revolution_axis.c ---- */
/* The axis of an axisymmetric scene as a boundary of the run's own scene, behind the others: it
 * holds back motion along x as a slip wall does, and shape functions fold there. 0, or -1. */
int scene_add_axis(struct talus_scene *scene);

#endif
