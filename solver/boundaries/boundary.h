/* SPDX-License-Identifier: Apache-2.0 */
/* The seam for boundary conditions: one file per condition, one line in boundaries.def.
 *
 * At a node a condition is a constraint - of the velocity along the normal, or of a prescribed
 * velocity along some axes; two-sided, or one-sided with `tension_release` - and what it can do
 * against sliding. Everything else - corners, impulses, reactions - is the same for all
 * (contact.c). */
#ifndef TALUS_BOUNDARY_H
#define TALUS_BOUNDARY_H

#include "base/parameter.h"
#include "state/domain.h"
#include "talus/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct wall_face;

/* What a condition may know of a node that it holds. */
struct wall_grip {
    double push;      /* normal impulse [N s], at least 0 */
    double area;      /* that the material touches [m^2]: the tributary area, less where the half
                         cell at the wall is not full */
    double density;   /* of what lies on that area [kg/m^3] */
    double gravity;   /* magnitude [m/s^2] */
    double time_step; /* [s] */
};

struct boundary_condition {
    const char *name, *reference, *summary;
    const struct parameter *parameters; /* ends with key NULL */
    bool eliminates;                    /* takes out the particles behind it; constrains no node */
    bool prescribes;                    /* the velocity of its boundary, along that one's axes */
    /* Largest tangential impulse [N s] that it can hold. NULL: none. */
    double (*tangential_limit)(const struct wall_face *face, const struct wall_grip *grip);
    /* With a limit only: tangential impulse beyond it, per squared sliding speed
     * [N s / (m/s)^2]. NULL: none. */
    double (*tangential_drag)(const struct wall_face *face, const struct wall_grip *grip);
};

extern const struct boundary_condition *const boundary_table[];
extern const size_t boundary_count;
const struct boundary_condition *boundary_find(const char *name);

/* One face of one boundary, as the node update needs it. */
struct wall_face {
    const struct boundary_condition *condition;
    double friction_coefficient, adhesion, turbulence; /* [-], [Pa], [m/s^2] (0: none) */
    double normal[3];                                  /* unit, into the material */
    double half_cell;                                  /* [m] half the cell width along it */
    double velocity[3];                                /* [m/s] of the face in this step */
    unsigned prescribed; /* bit set of the axes along which it prescribes it; 0: the normal */
    bool moves;          /* its boundary has a velocity */
    enum talus_wall wall;
    bool release;
    double tension_force; /* [N] */
    uint16_t boundary_index;
    int8_t face_index; /* -1: inside of a box, where nodes are held */
};

/* All faces of a scene, and the boundaries snapped to grid lines. */
struct wall_set {
    size_t axis_count;
    struct wall_face *faces; /* owned */
    size_t face_count;
    struct wall_shape *shapes; /* [boundary_count] owned */
    size_t boundary_count;
    bool timed; /* some boundary moves, or acts in a part of the time only */
    /* Grows whenever a boundary moved to other grid lines, began or ended to act; what was worked
     * out from node_faces() or cell_folds() before is then void. */
    uint64_t change_count;
};

/* Share of a cell within which something counts as lying on a grid line. */
#define LINE_TOLERANCE 0.01

/* What of a boundary changes over time. No padding: stored as bytes. */
struct wall_motion {
    double moved[3];   /* [m] way from where the scene puts it */
    double snapped[3]; /* [m] the same, of the nodes on which it acts */
    uint64_t acts;     /* 1 or 0: in the present step */
};

/* Geometry of one boundary on the grid. Places are present ones; `held_point`, `line`, `box_low`
 * and `box_high` say which nodes it acts on. */
struct wall_shape {
    enum talus_boundary_shape kind;
    struct wall_motion motion;
    bool eliminates;
    int body_index;   /* eliminates particles of this body only; -1: of all */
    bool source_rule; /* contact area h^2 a node */
    int axis;         /* axis-aligned plane or face: the axis of the normal; else -1 */
    int32_t line;     /* its grid line */
    bool lower;       /* the normal points to larger coordinates */
    int32_t box_low[3], box_high[3];
    double point[3], held_point[3], normal[3], axis_1[3], axis_2[3], size[2];
    double box_min[3], box_max[3];
    size_t first_face; /* into wall_set.faces; a box has its interior after its faces */
    bool face_exists[6];
};

enum { NODE_FACE_MAX = 8 };
/* Faces that act on one node. */
struct node_faces {
    size_t count;
    uint16_t face[NODE_FACE_MAX];
    double area[NODE_FACE_MAX]; /* tributary area of the node on that face */
};

/* 0, or -1 when memory ran out. */
int wall_set_create(struct wall_set *walls, const struct talus_scene *scene,
                    const struct domain *domain);
void wall_set_release(struct wall_set *walls);
/* Puts a shape where its motion says. */
void wall_shape_place(struct wall_shape *shape, const struct talus_boundary *boundary,
                      const struct domain *domain);

/* ---- wall_motion.c; `scene` and `domain` as at creation ---- */
/* Before a step from `time` on: which boundaries act in it, how fast they are at its end (at rest
 * up to t = 0) and on which nodes. */
void wall_set_prepare(struct wall_set *walls, const struct talus_scene *scene,
                      const struct domain *domain, double time, double time_step);
/* After it: the boundaries have moved. The nodes follow when the next step is prepared. */
void wall_set_move(struct wall_set *walls, const struct talus_scene *scene,
                   const struct domain *domain, double time_step);
/* For checkpoints: motions[boundary_count]. */
void wall_set_get_motions(const struct wall_set *walls, struct wall_motion *motions);
void wall_set_set_motions(struct wall_set *walls, const struct talus_scene *scene,
                          const struct domain *domain, const struct wall_motion *motions);

/* ---- wall_set.c, wall_folds.c, wall_distance.c ---- */
/* Which faces act on node (i, j, k). */
void wall_set_node_faces(const struct wall_set *walls, const struct domain *domain,
                         const int32_t node[3], struct node_faces *faces);

/* The sides of a cell (not negative) that are walls: bit 2 axis for its lower side along an axis,
 * with the normal up, bit 2 axis + 1 for its upper side, with the normal down. Planes, faces and
 * boxes (seen from outside) along grid lines that hold nodes; a face counts where it covers the
 * side. Shape functions fold there. Void when change_count has grown. */
unsigned wall_set_cell_folds(const struct wall_set *walls, const struct domain *domain,
                             const int32_t cell[3]);

/* True if a particle of that body at `position` is behind an eliminating boundary. */
bool wall_set_eliminates(const struct wall_set *walls, const double position[3], int body_index);
/* True if some point of the box [low, high] may be behind one. */
bool wall_set_may_eliminate(const struct wall_set *walls, const double low[3],
                            const double high[3]);

/* Distance of a point from a boundary's surface [m], for probes "on" it (a box: from its outside).
 */
double wall_set_distance(const struct wall_set *walls, size_t boundary_index,
                         const double position[3]);

#endif
