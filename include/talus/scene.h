/* SPDX-License-Identifier: Apache-2.0 */
/* A scene as plain C data: what a simulation is made from. Talus' JSON reader (solver/scene) fills
 * it; another program may fill it by hand. SI units, angles in degrees, tension positive.
 *
 * Invariants: everything is already defaulted and validated; NAN stands for "not given" only where
 * a member says so. Vectors always have three components; those beyond the dimension are 0.
 * The six components of a symmetric tensor are xx, yy, zz, xy, yz, xz; shear is tensorial.
 * Ownership: the scene owns every pointer in it; talus_scene_release() frees them. A simulation
 * copies what it needs. */
#ifndef TALUS_SCENE_H
#define TALUS_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum talus_dimension {
    TALUS_LINE,
    TALUS_PLANE_STRAIN,
    TALUS_PLANE_STRESS, /* sigma_zz = 0; linear elastic materials only */
    TALUS_AXISYMMETRIC, /* x is the distance from the axis, y runs along it; zz is the hoop */
    TALUS_SOLID,
};

enum talus_axis { TALUS_X, TALUS_Y, TALUS_Z, TALUS_NO_AXIS = -1 };

enum talus_outside { TALUS_OUTSIDE_ERROR, TALUS_OUTSIDE_ELIMINATE };

/* A quantity over time: linear between its points, constant outside. Beside a number that holds
 * while the table has no points; with a table, that number is the value at t = 0. */
struct talus_time_table {
    size_t count;
    double *time;  /* [count] s, growing */
    double *value; /* [count] */
};

struct talus_grid {
    double cell[3];        /* [m] per axis; 1 for axes beyond the dimension */
    double min[3];         /* [m] */
    int64_t cell_count[3]; /* per axis, `max` rounded up to whole cells; 1 beyond the dimension */
    enum talus_outside outside;
    double outside_mass_limit; /* [-] share of the initial mass that may be eliminated outside */
};

enum talus_stress_update {
    TALUS_STRESS_MODIFIED_LAST,
    TALUS_STRESS_LAST,
    TALUS_STRESS_FIRST,
    TALUS_STRESS_UPDATE_COUNT
};
enum talus_gimp_scaling { TALUS_GIMP_VOLUME, TALUS_GIMP_STRETCH };
enum talus_strain { TALUS_STRAIN_FINITE, TALUS_STRAIN_SMALL };
enum talus_small_mass {
    TALUS_SMALL_MASS_NONE,
    TALUS_SMALL_MASS_CUTOFF,
    TALUS_SMALL_MASS_REDISTRIBUTE
};
/* What particles do at nodes of whose support hardly anything is full. */
enum talus_front_reading {
    TALUS_FRONT_START_VELOCITY, /* strain with the velocity at the start of the step */
    TALUS_FRONT_FREE_FLIGHT     /* fly on with that of their own, without strain */
};
enum talus_precision { TALUS_PRECISION_DOUBLE, TALUS_PRECISION_SINGLE };
enum talus_anti_locking_control {
    TALUS_CONTROL_NONE,
    TALUS_CONTROL_CELL,
    TALUS_CONTROL_NODE,
    TALUS_CONTROL_HYBRID /* volumetric part over nodes, deviatoric part over cells */
};
enum talus_anti_locking_field {
    TALUS_FIT_VOLUMETRIC,
    TALUS_FIT_FULL,
    TALUS_FIT_FULL_CONSTANT_VOLUME
};
/* Weights of fits over nodes: N in the sums and on the way back; on the way back only; nowhere. */
enum talus_anti_locking_averaging {
    TALUS_AVERAGING_WEIGHTED,
    TALUS_AVERAGING_UNWEIGHTED_SUMS,
    TALUS_AVERAGING_UNWEIGHTED
};
enum talus_anti_locking_apply { TALUS_APPLY_STRAIN_AND_STRESS, TALUS_APPLY_STRAIN };

struct talus_solver_options {
    double time_step; /* [s]; 0: automatic */
    double courant;   /* [-] share of the critical step, for automatic steps */
    bool allow_unstable;
    size_t shape_index; /* into the table of shapes (solver/shapes); 0: linear (a scene file that
                           names none gets bspline2) */
    enum talus_gimp_scaling gimp_scaling; /* what the size of particles of gimp_scaled follows */
    size_t transfer_index; /* into the table of transfers (solver/transfers); 0: FLIP */
    double pic_rate;       /* FLIP: lambda [1/s]; 0: pure FLIP */
    double flip_ratio;     /* FLIP: share of FLIP per step, instead of pic_rate; NAN: not given */
    double hybrid_scale;   /* cpdi_hybrid: of the domains, in the search for the edge */
    double hybrid_count;   /* cpdi_hybrid: most particles of a cell at the edge */
    enum talus_stress_update stress_update;
    double theta;        /* share of the new velocity in the one that moves the material; 1 */
    double strain_theta; /* ... in the one that strains it; 1 */
    enum talus_strain strain;
    enum talus_anti_locking_control anti_locking;
    enum talus_anti_locking_field anti_locking_field;
    enum talus_anti_locking_apply anti_locking_apply;
    enum talus_anti_locking_averaging anti_locking_averaging;
    double viscous_damping;           /* C [-] of the viscous stress C rho h c tr(d) 1 */
    double local_damping;             /* [-] share of the out-of-balance force */
    enum talus_small_mass small_mass; /* what becomes of the pull at nodes of little mass */
    double front_threshold; /* [-] least volume fraction of a node for its particles not to be
                               smoothed; 0: none are */
    enum talus_front_reading front_reading;
    double force_ramp;              /* [s]; 0: none */
    double settle_time;             /* [s] before t = 0, in which walls stand still; 0: none */
    double settle_damping;          /* c [1/s] of that time: velocities fall by exp(-c dt) */
    enum talus_precision precision; /* of particles, nodes and kernels */
};

struct talus_material {
    char *name;
    size_t model_index; /* into the table of materials (solver/materials) */
    double *values; /* [parameter_count of the model], in the order of its table; defaults filled
                       in; NAN = not given and without default; choices as index, booleans 0/1 */
};

enum talus_body_shape {
    TALUS_BODY_BOX,
    TALUS_BODY_SPHERE,
    TALUS_BODY_CYLINDER,
    TALUS_BODY_POLYGON,
    TALUS_BODY_POINTS
};
enum talus_lattice { TALUS_LATTICE_PER_CELL, TALUS_LATTICE_SPACING, TALUS_LATTICE_COUNT };
enum talus_initial_stress {
    TALUS_INITIAL_NONE,
    TALUS_INITIAL_HYDROSTATIC,
    TALUS_INITIAL_GEOSTATIC,
    TALUS_INITIAL_GIVEN,
};
enum talus_velocity_field {
    TALUS_VELOCITY_UNIFORM,
    TALUS_VELOCITY_ROTATION,
    TALUS_VELOCITY_BEAM_MODE
};
enum talus_k0 { TALUS_K0_GIVEN, TALUS_K0_ELASTIC, TALUS_K0_JAKY, TALUS_K0_AUTO };

/* dead: the force keeps its direction and size. fibre: the direction goes along with the fibre of
 * material that had it, n = F n0 / |F n0|; the size stays. normal: a pressure on the surface as it
 * is now, n dA = J F^-T n0 dA0. */
enum talus_traction_kind { TALUS_TRACTION_DEAD, TALUS_TRACTION_FIBRE, TALUS_TRACTION_NORMAL };

/* A load on a part of the surface of a body, per area of that surface at t = 0. */
struct talus_traction {
    /* box: 0 ... 5 x_min, x_max, y_min, ...; polygon: the sides from one to another (on past the
     * last, if that is the smaller one), side k from vertex k to the next; sphere: 0, all of it;
     * cylinder: 0 outside, 1 the end `from`, 2 `to` */
    size_t face, last_face;
    enum talus_traction_kind kind;
    bool is_pressure;                 /* value[0] is a pressure, positive into the body */
    double value[3];                  /* [Pa], in the world, also on bodies that are turned */
    struct talus_time_table table[3]; /* of the same */
};

struct talus_body {
    char *name;
    size_t material_index;
    enum talus_body_shape shape;
    double box_min[3], box_max[3];
    double centre[3], radius; /* sphere (a disc in 2D); radius also of the cylinder */
    double from[3], to[3];    /* cylinder axis */
    size_t vertex_count;      /* polygon (2D): 3 or more */
    double *vertices;         /* [vertex_count][2] m, either way round, no side crosses
                                 another */
    size_t point_count;       /* points: the particles themselves, without a lattice */
    double *point_positions;  /* [point_count][3] m */
    double *point_volumes;    /* [point_count] m^3, m^2 x 1 m, m x 1 m^2 */
    double rotate_angle_deg;  /* all of the above, clip and lattice included, is turned by
                                 this angle ... */
    double rotate_about[3], rotate_axis[3]; /* ... about this point [m] and unit axis (in 2D z:
                                               counterclockwise) */
    double clip_min[3], clip_max[3];        /* -INFINITY/INFINITY: open */
    enum talus_lattice lattice;
    double lattice_value[3]; /* particles per cell, spacing [m] or count, per axis */
    enum talus_velocity_field velocity_field; /* at the start */
    double velocity[3];                       /* uniform [m/s]; else 0 */
    double rotation_about[3];                 /* rotation: v = rate x (x - about) [m] */
    double rotation_rate[3];                  /* [rad/s]; in 2D only the last component */
    double beam_mode;                         /* bending mode of the clamped-free beam: 1, 2, ... */
    double beam_from[3], beam_to[3]; /* its neutral axis from the clamp to the free end [m] */
    double beam_tip[3];              /* velocity of the free end, perpendicular to the axis [m/s] */
    enum talus_initial_stress initial_stress;
    double surface; /* hydrostatic: coordinate of the surface on the vertical axis; NAN: top of the
                       body */
    enum talus_k0 k0_rule;
    double k0;        /* TALUS_K0_GIVEN */
    double surcharge; /* [Pa] */
    double stress[6]; /* TALUS_INITIAL_GIVEN [Pa] */
    struct talus_traction *tractions;
    size_t traction_count;
};

enum talus_boundary_shape { TALUS_BOUNDARY_PLANE, TALUS_BOUNDARY_FACE, TALUS_BOUNDARY_BOX };
enum talus_wall { TALUS_WALL_STOP, TALUS_WALL_KEEP };

/* What one face of a boundary does. Planes and faces have one, boxes six (x_min, x_max, y_min,
 * ...). */
struct talus_boundary_face {
    size_t condition_index;      /* into the table of boundary conditions (solver/boundaries) */
    double friction_coefficient; /* [-] */
    double adhesion;             /* [Pa] */
    double turbulence;           /* xi of Voellmy [m/s^2]; 0: none */
};

struct talus_boundary {
    char *name;
    enum talus_boundary_shape shape;
    double point[3],
        normal[3]; /* plane and face: a point of it (face: centre), unit normal into the material */
    double axis_1[3], axis_2[3];         /* face: in-plane unit axes t1, t2 */
    double size[2];                      /* face: full lengths along t1, t2 [m] */
    double box_min[3], box_max[3];       /* box */
    struct talus_boundary_face faces[6]; /* [face_count] */
    size_t face_count;                   /* 1, or 2 x dimension for a box */
    enum talus_wall wall;
    bool tension_release;
    double tension_force; /* [N] contact is kept while the push exceeds this (slightly below 0 or as
                             given) */
    double peak_window;   /* [s]; 0: single steps */
    double moment_about[3]; /* [m] */
    bool area_source_rule;  /* h^2 a node (Mast 7.15) instead of tributary areas */
    int body_index;         /* acts on this body only; -1: on all */
    bool internal;          /* the solver's own, of which nothing is reported */
    unsigned prescribed;    /* bit set of the axes along which its faces with the condition
                               `velocity` prescribe it; 0: none has it */
    double velocity[3];     /* [m/s] of these faces, where no table has points */
    struct talus_time_table velocity_tables[3];
    bool stays;         /* does not move along */
    bool timed;         /* acts only ... */
    double from, until; /* ... in between [s]; may be infinite */
};

/* Fields that can be read from particles; the table is talus/fields.def. */
enum talus_field {
#define TALUS_FIELD(ENUM, name, components, unit, text) TALUS_FIELD_##ENUM,
#include "talus/fields.def"
#undef TALUS_FIELD
    TALUS_FIELD_COUNT
};

enum talus_probe_kind {
    TALUS_PROBE_FRONT,
    TALUS_PROBE_HEIGHT,
    TALUS_PROBE_EXTENT,
    TALUS_PROBE_POINT,
    TALUS_PROBE_ENERGY,
    TALUS_PROBE_MASS,
    TALUS_PROBE_CENTRE_OF_MASS,
    TALUS_PROBE_REACTION,
    TALUS_PROBE_INTEGRAL,
};
enum talus_probe_measure { TALUS_MEASURE_PARTICLE, TALUS_MEASURE_CENTRE_OF_MASS };
enum talus_energy_part {
    TALUS_ENERGY_TOTAL,
    TALUS_ENERGY_KINETIC,
    TALUS_ENERGY_STRAIN,
    TALUS_ENERGY_POTENTIAL,
    TALUS_ENERGY_DISSIPATED,
    TALUS_ENERGY_EXTERNAL,
    TALUS_ENERGY_NUMERICAL,
    TALUS_ENERGY_PART_COUNT,
};
enum talus_reaction_quantity {
    TALUS_REACTION_FORCE,
    TALUS_REACTION_MOMENT,
    TALUS_REACTION_CONTACT_AREA
};

struct talus_probe {
    char *name;
    enum talus_probe_kind kind;
    int body_index;                      /* -1: all */
    double within_min[3], within_max[3]; /* open: -INFINITY/INFINITY */
    int on_boundary;  /* only particles within h/2 of that boundary; -1: anywhere */
    double mean_from; /* [s]; NAN: no mean */
    double along[3];  /* front, height, extent: unit vector */
    enum talus_probe_measure measure;
    double at[3];           /* point */
    enum talus_field field; /* point, integral */
    int component;          /* -1: all (one column each) */
    enum talus_energy_part part;
    int boundary_index, face_index; /* reaction; face -1: the whole boundary */
    enum talus_reaction_quantity quantity;
};

struct talus_reference {
    char *name; /* defaults to its probe's */
    size_t probe_index;
    size_t point_count; /* 1 with time NAN: a final value */
    double *time;       /* [point_count] s */
    double *value;      /* [point_count] */
    char *of_job;       /* job whose probe of the same name is the reference, or NULL */
};

struct talus_output_options {
    double frames_every;     /* [s]; 0: only the first and the last */
    uint32_t frame_fields;   /* bit set of enum talus_field */
    uint32_t grid_fields;    /* bit 0 mass, 1 velocity, 2 reaction */
    bool frame_double;       /* double instead of single precision */
    double history_every;    /* [s] */
    double checkpoint_every; /* wall-clock [s] */
    bool vtu;                /* also write VTU files and a PVD list under vtk */
};

/* Gravity of one magnitude that is tilted where particles are: a slope on a flat grid. */
struct talus_slope {
    double along[3];  /* unit vector, perpendicular to gravity: downhill */
    double below;     /* [m] holds where the position along `along` is below; NAN: a radius */
    double about[3];  /* [m] ... or beyond a distance from this point, */
    double beyond;    /* [m] perpendicular to gravity */
    double angle_deg; /* by which gravity is tilted towards `along` */
};

struct talus_scene {
    char *title;
    enum talus_dimension dimension;
    size_t axis_count; /* 1, 2 or 3 */
    double duration;   /* [s] */
    struct talus_grid grid;
    struct talus_solver_options solver;
    struct talus_material *materials;
    size_t material_count;
    struct talus_body *bodies;
    size_t body_count;
    double gravity[3]; /* [m/s^2] with slopes: where none holds */
    struct talus_time_table gravity_table[3];
    struct talus_slope *slopes; /* the first that holds counts */
    size_t slope_count;
    struct talus_boundary *boundaries;
    size_t boundary_count;
    struct talus_probe *probes;
    size_t probe_count;
    struct talus_reference *references;
    size_t reference_count;
    struct talus_output_options output;
    double energy_growth_limit; /* audits: share of the energy turned over that energy may grow
                                   (0.01) */
};

/* Frees everything the scene owns and zeroes it; accepts a zeroed scene. */
void talus_scene_release(struct talus_scene *scene);

#endif
