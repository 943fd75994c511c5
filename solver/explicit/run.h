/* SPDX-License-Identifier: Apache-2.0 */
/* Everything a running explicit simulation holds, in the order in which a step uses it.
 *
 * One step of `modified_last` in its kick-drift form (Mast 2013, sec. 2.2.3, with the velocity that
 * strains the material mapped back from the particles after their update):
 *   kick nodes      dv_i = dt f_i / m_i, constrained components held back
 *   first pass      v_p += sum N dv_i;  P_i = sum N m_p v_p
 *                   (twice with local damping: then with what brakes as dv_i, local_damping.c)
 *   update nodes    v_i = contact(P_i / m_i + what was held back); correction c_i = v_i - P_i / m_i
 *   second pass     v_p += sum N c_i; strain and move with v_i; stress; m_i and f_i at the new
 *                   positions for the next step
 *   re-bin          particles that left their cell
 * and of `last`: update nodes from the P_i, m_i, f_i of the step before, then the second pass,
 * which scatters P_i too. `first` strains before that with the P_i and m_i of the step before:
 *   start velocities v_i = what walls let pass of P_i / m_i
 *   stress pass      strain with v_i; stress; f_i at the same positions
 *   update nodes     as `last`
 *   move pass        v_p += sum N c_i; move with v_i; m_i and P_i at the new positions */
#ifndef TALUS_RUN_H
#define TALUS_RUN_H

#include "antilocking/node_fit.h"
#include "boundaries/boundary.h"
#include "materials/material.h"
#include "shapes/shape.h"
#include "state/scratch.h"
#include "state/sparse_grid.h"
#include "talus/simulation.h"
#include "talus/status.h"

#include <stdbool.h>

/* A model with its constants, ready for the kernels. */
struct run_material {
    const struct material *model;
    void *constants;   /* owned */
    double density;    /* reference density [kg/m^3] */
    double wave_speed; /* [m/s] */
    double bulk_speed; /* sqrt(K / rho) [m/s], for bulk damping */
    double viscosity;  /* [Pa s] */
    double thinning;   /* plane stress: -e_zz over e_xx + e_yy, nu / (1 - nu) */
};

/* A particle that left its cell in the second pass, with what it must still give to the nodes. */
struct outbox_record {
    uint32_t block, slot;
    bool eliminated; /* by a boundary */
    real force_stress[6];
};

/* A node with boundary conditions. */
struct wall_node {
    uint32_t block;
    uint8_t lane;
    struct node_faces faces;
    double position[3];
    double impulse[3]; /* of the walls on the material in the last step [N s] */
};

/* Sums over one face, or boundary. Impulses and moments are of the material on the boundary. */
struct wall_record {
    double step_impulse[3], step_moment[3];         /* of the last step [N s], [N m s] */
    double interval_impulse[3], interval_moment[3]; /* since the last sample */
    double contact_area;                            /* [m^2] now */
    double peak, peak_time, peak_force[3];          /* largest |force| of one step or window */
    double window_impulse[3], window_time;          /* running mean over the peak window */
};

/* Fixed-size chunk of the ring that a running mean over `peak_window` needs. */
struct peak_window {
    size_t capacity, first, count;
    double *entries; /* [capacity][4]: impulse, time step; owned */
};

/* What one tile adds up in the second pass; summed over the tiles in order. */
struct tile_sums {
    double speed_squared;                  /* largest [m^2/s^2] */
    double signal_speed;                   /* largest c + |v| [m/s] */
    uint64_t materials;                    /* bit set: with particles */
    double least_jacobian;                 /* smallest det of an incremental deformation gradient */
    uint32_t bad_particle;                 /* id of one where that is not positive, or NONE */
    double plastic_energy, viscous_energy; /* dissipated in the step [J] */
    struct domain_findings domains;
    uint64_t fall_backs;               /* of anti-locking: control volumes without a linear fit */
    double kinetic, strain, potential; /* where run->measures, and by run_measure_energy [J] */
    double hoop_force;                 /* of the hoop stress on the nodes, along x [N] */
    double settled_momentum[3], settled_energy; /* taken by run_damp_settling [N s], [J] */
};

/* What a chunk of node blocks adds up in the node update; summed over the chunks in order. */
struct node_sums {
    double mass;               /* of nodes that move [kg] */
    double damping_impulse[3]; /* of local damping on the material [N s] */
    double damping_energy;     /* that it takes [J] */
};

struct run_energy {
    double kinetic, strain, potential;                  /* [J] now */
    double plastic, viscous, damping, wall, eliminated; /* [J] accumulated */
    double external;  /* [J] accumulated work of forces that the potential does not know */
    double exchanged; /* [J] the same, given and taken added up */
};

struct run_audit {
    double initial_mass, eliminated_mass; /* [kg] */
    double outside_mass;                  /* [kg] the part of it that left the grid */
    double initial_momentum[3];           /* [N s] */
    double impulse[3];                    /* of gravity, walls and damping on the material */
    double eliminated_momentum[3];
    double exchanged;                                         /* sum of |impulses| */
    double initial_energy, initial_potential, initial_stored; /* stored: kinetic + strain [J] */
    double largest_growth; /* of energy beyond the books, relative to the turnover */
    double hoop_force;     /* along x, of the hoop stresses that act in the next step [N] */
};

struct run;

/* A force on particles other than stress and constant gravity, as an acceleration. */
struct particle_force {
    /* Adds the accelerations [m/s^2] at `time` of the slots begin ... end - 1 of a block; empty
     * slots may be given anything finite. Several threads call it at once. */
    void (*add)(const void *source, const struct run *run, const struct particle_block *block,
                size_t begin, size_t end, double time, real *const acceleration[3]);
    const void *source; /* the owner's; handed to add */
};
enum { PARTICLE_FORCE_MAX = 4 };

/* What the embedding program adds to a scene. */
struct run_callbacks {
    talus_particle_function *body_force, *initial_velocity;
    void *context;
};

struct run {
    struct talus_scene scene; /* own copy */
    int threads;              /* of the next step */
    int thread_capacity;      /* at most so many; what is per thread has room for them */
    struct sparse_grid grid;
    struct run_material *materials; /* [scene.material_count] owned */
    uint16_t *body_material;        /* [scene.body_count] owned */
    bool finite_strain, any_volumetric, any_tensor, any_plastic, any_spin;
    bool any_rate;            /* a material or the damping wants d */
    bool strains_across;      /* a plane body with strain along zz (out_of_plane.h) */
    size_t strain_components; /* that the materials see: 3, 4 or 6 */
    size_t normal_components; /* that anti-locking fits: 3, in plane stress 2 */
    size_t
        stored_components; /* of PARTICLE_STRAIN: the same, or 1 if all materials are volumetric */

    double gravity[3];        /* uniform, in this step, without the ramp [m/s^2] */
    bool gravity_deviates;    /* from that of the scene, which the potential energy knows */
    struct node_fit node_fit; /* of anti-locking */
    bool reloads_gradient;    /* a material wants d or the spin; for passes that are split */

    struct run_callbacks callbacks;
    struct particle_force forces[PARTICLE_FORCE_MAX];
    size_t force_count;

    const struct shape *shape;
    const struct shape_kernels *kernels;
    struct shape_context context; /* of a step of no length */
    double courant_limit;         /* largest stable c dt / h of the method */
    unsigned scatters; /* what the last pass of a step leaves at the nodes for the next */

    struct wall_set walls;
    struct wall_node *wall_nodes; /* [wall_node_count] owned, in order of node blocks */
    size_t wall_node_count, wall_node_capacity;
    size_t walled_block_count; /* node blocks already looked at */
    size_t marked_block_count; /* particle blocks that know whether they have walls */
    bool *block_walled;        /* [walled_block_count]: has wall nodes; owned */
    size_t block_walled_capacity;
    struct wall_record *faces;      /* [walls.face_count] owned */
    struct wall_record *boundaries; /* [scene.boundary_count] owned */
    struct peak_window *windows;    /* [face_count + boundary_count] owned */
    double *wall_partials;          /* owned, see node_passes.h */
    size_t wall_partial_capacity;
    struct node_sums *node_sums; /* [node_sums_capacity] owned */
    size_t node_sums_capacity;

    struct block_scratch *scratch; /* [threads] owned */
    struct outbox_record *outbox;  /* [initial particle count] owned; touched only where used */
    struct tile_sums *tile_sums;   /* [tile_sums_capacity] owned */
    size_t tile_sums_capacity;
    struct particle_record carried; /* one particle on its way from block to block */
    size_t initial_particle_count;

    double time, time_step, critical_time_step, last_time_step, interval;
    double pic_share; /* of the present step, 0..1 */
    uint64_t step;
    double largest_speed;       /* of particles, after the last step [m/s] */
    double signal_speed;        /* largest c + |v| of particles, after the last step [m/s] */
    uint64_t materials_present; /* bit set: with particles, after the last step */
    double checked_speed;       /* when energy was last checked */
    double least_mass;          /* of a particle at the start [kg] */
    double mass_cutoff;         /* nodes lighter than this carry no motion [kg] */
    double reference_density;   /* smallest of the scene, for contact areas [kg/m^3] */
    bool over_critical_warned, failed;
    uint64_t fall_backs;       /* of anti-locking since the start, over all steps */
    uint64_t fall_backs_worst; /* in one step */
    bool fall_back_warned;
    struct domain_findings domains; /* after the last step */
    bool capped_warned, stretched_warned;

    bool sample_expected; /* at the end of the next step */
    bool measures;        /* the second pass adds up the energies */
    uint64_t energy_step; /* whose state the kinetic, strain and potential energy are of */
    struct run_energy energy;
    struct run_audit audit;
};

/* What does not change from step to step; once the grid is there. */
static inline void run_make_context(struct run *run)
{
    run->context =
        shape_context_make(&run->grid.layout, &run->grid.nodes, run->grid.domain.cell, 0.0);
    run->context.grid = &run->grid;
    run->context.hybrid_scale = run->scene.solver.hybrid_scale;
    run->context.hybrid_count = run->scene.solver.hybrid_count;
}

static inline struct shape_context run_shape_context(const struct run *run, double time_step)
{
    struct shape_context context = run->context;
    shape_context_set_step(&context, run->grid.domain.cell, time_step);
    return context;
}

/* Particles take the nodes' increment before the nodes' new velocity is known; otherwise after. So
 * do those of `first` where they are braked (local_damping.c). */
static inline bool run_kicks(const struct run *run)
{
    const struct talus_solver_options *solver = &run->scene.solver;
    return solver->stress_update == TALUS_STRESS_MODIFIED_LAST ||
           (solver->stress_update == TALUS_STRESS_FIRST && solver->local_damping > 0);
}

/* Index of the material of a slot. */
static inline size_t material_of_slot(const struct run *run, const struct particle_block *block,
                                      size_t slot)
{
    return run->body_material[block->body == NULL ? 0 : block->body[slot]];
}

/* Share of gravity that acts now: 1, or less during the force ramp. */
double run_force_factor(const struct run *run);

/* ---- wall_nodes.c ---- */
/* Finds the walls of node blocks that are new, and which blocks touch them. 0, or -1. */
int run_find_walls(struct run *run);
/* Which sides of a block's cells are walls, for shapes that fold there. */
void run_find_folds(const struct run *run, struct particle_block *block);
/* Before a step: walls that move, or act in a part of the time only, are where the step needs them;
 * if that changes grid lines, the wall nodes are found again. Momentum stays in the books: nodes
 * carry none from step to step, and what a new wall node takes is a reaction. 0, or -1. */
int run_prepare_walls(struct run *run);
/* After it, with the time step that was taken. */
void run_move_walls(struct run *run);

/* ---- gravity.c ---- */
/* Gravity of the step that begins. */
void run_set_gravity(struct run *run);
/* The forces of slopes, if the scene has any. Before there are nodes. */
void run_add_slopes(struct run *run);
/* Work of what acts beyond the gravity that the potential knows, or short of it: tables over time,
 * and the ramp. After the walls. */
void run_book_gravity(struct run *run, double factor);

/* ---- tractions.c ---- */
/* The forces of loaded faces, if the scene has any. Before there are nodes. */
void run_add_tractions(struct run *run);

/* ---- particle_forces.c ---- */
/* Takes over what the embedding program adds. Before there are nodes. */
void run_set_callbacks(struct run *run, const struct talus_simulation_options *options);
/* Adds a force; at most PARTICLE_FORCE_MAX. Before there are nodes. */
void run_add_force(struct run *run, struct particle_force force);
/* external_i += sum N m a of the slots begin ... end - 1, a multiple of LANE_COUNT slots, at the
 * end of the step; slots of mass 0 take no part. */
void run_scatter_forces(struct run *run, const struct particle_block *block, const real *mass,
                        size_t begin, size_t end, struct block_scratch *scratch, double time);
/* The same for one particle that has changed blocks. */
void run_scatter_forces_one(struct run *run, const struct particle_block *block, size_t slot,
                            double time);
/* Impulse and work of the external forces of the step, after the walls, for the audit. */
void run_book_forces(struct run *run, double factor);

/* ---- settle.c ---- */
static inline bool run_is_settling(const struct run *run)
{
    return run->time < 0;
}
/* Before a step that ends at t = 0 at the latest: damps all velocities, and books it. */
void run_damp_settling(struct run *run);
/* At t = 0: what is measured from then on starts anew - displacement and plastic strain (the
 * fields; materials keep their state), reactions and peaks, energy and momentum. */
void run_end_settling(struct run *run);

/* ---- node_update.c ---- */
void run_kick_nodes(struct run *run);
/* Velocity at the start of the step, which strains the material of `first`. */
void run_start_nodes(struct run *run);
void run_update_nodes(struct run *run);

/* ---- local_damping.c ---- */
/* Between the two first passes of `modified_last` with local damping: the brakes as kicks. */
void run_brake_nodes(struct run *run);

/* ---- small_mass.c ---- */
/* Internal forces of nodes that carry hardly any mass, once they are complete. */
void run_treat_light_nodes(struct run *run);

/* ---- start_velocity.c ---- */
/* Makes room at the nodes for the velocity at the start of a step, if the scene needs it. */
void run_keep_start_velocity(struct run *run);

/* ---- front_smoothing.c ---- */
/* Makes room at the nodes for volumes and marks, if the scene smooths fronts. */
void run_keep_volume(struct run *run);
/* Before the passes of a step: marks the nodes of whose support hardly anything is full, and clears
 * the volumes for the next step. */
void run_mark_empty_nodes(struct run *run);

/* ---- rebin.c ---- */
/* Moves the particles of the outboxes to their new blocks. */
TALUS_MUST_CHECK enum talus_status run_rebin(struct run *run, struct talus_error *error);
/* Drops empty blocks if they are many. Before a step: between steps the nodes still show what the
 * walls did in the last one. */
TALUS_MUST_CHECK enum talus_status run_purge(struct run *run, struct talus_error *error);

/* Energy that a particle takes along when it is taken out. */
void run_book_eliminated_energy(struct run *run, const struct particle_record *record,
                                const double position[3]);

/* ---- time_step.c ---- */
/* Critical step for the largest sum of wave speed and velocity, and for a bit set of materials,
 * whose viscosities count. */
double run_critical_time_step(const struct run *run, double signal_speed, uint64_t materials);
/* Books the fastest particle of a block with these materials. */
void run_note_speed(const struct run *run, uint64_t materials, double speed_squared,
                    struct tile_sums *sums);
void run_choose_time_step(struct run *run);

/* ---- split_passes.c ---- */
/* What advance_tile (`still`: start_tile) does for all tiles, in passes of their own with fits over
 * nodes between strain and stress, and between stress and forces. */
void run_split_advance(struct run *run, bool still);
/* Before, and before the nodes are updated: clears what is fitted over nodes and takes their
 * masses, which are there but when the run is started (`still`). */
void run_split_begin(struct run *run, bool still);

/* ---- step.c ---- */
TALUS_MUST_CHECK enum talus_status run_take_step(struct run *run, struct talus_error *error);
/* Sorts new blocks into tiles and makes room for what a step writes per tile. 0, or -1. */
int run_prepare_tiles(struct run *run);
int run_reserve_scratch(struct run *run);
/* Mass and forces of the initial state. */
TALUS_MUST_CHECK enum talus_status run_start(struct run *run, struct talus_error *error);

/* ---- affine_start.c ---- */
/* PARTICLE_AFFINE of the initial state, out of the masses at the nodes and the velocities. */
void run_start_affine(struct run *run);

/* ---- energy.c ---- */
/* Kinetic, strain and potential energy of the present state into run->energy: a pass over all
 * particles, of about half a step. */
void run_measure_energy(struct run *run);
/* Adds the energies of a block whose elastic strains and initial volumes are in scratch. */
void run_add_energy(const struct run *run, const struct particle_block *block,
                    struct block_scratch *scratch, struct tile_sums *sums);
/* The sums of the tiles into run->energy. */
void run_book_energy(struct run *run);
/* Energy that the method itself has lost so far (negative: gained), and the turnover [J]. */
double run_numerical_loss(const struct run *run);
double run_energy_turnover(const struct run *run);
void run_measure_momentum(const struct run *run, double momentum[3], double *mass);
/* The audit starts from the present state. */
void run_open_books(struct run *run);

#endif
