/* SPDX-License-Identifier: Apache-2.0 */
/* What is measured: the cases, and the setup of one measurement. */
#ifndef BENCHMARK_CASE_H
#define BENCHMARK_CASE_H

#include <stdbool.h>
#include <stddef.h>

enum benchmark_body {
    BENCHMARK_COMPACT, /* a free box, strained by a smooth field of velocities (benchmark_motion.h)
                        */
    BENCHMARK_FLOW,    /* a column that is collapsing under gravity; elastic: a box that is also
                          drifting through the grid */
};

struct benchmark_case {
    const char *name;
    size_t axis_count;
    const char *material;      /* JSON of the material of the compact body */
    const char *flow_material; /* the same, weak enough to flow; NULL: cannot flow, drifts */
    size_t per_axis;           /* particles per cell and axis */
    bool plastic;              /* must dissipate */
    bool locks;                /* a case for anti-locking */
};

extern const struct benchmark_case benchmark_cases[];
extern const size_t benchmark_case_count;
/* The case of that name, or NULL. */
const struct benchmark_case *benchmark_case_find(const char *name);

/* One measurement. */
struct benchmark_setup {
    const struct benchmark_case *subject;
    enum benchmark_body body;
    size_t particles; /* about so many: whole cells, whole blocks along x */
    size_t per_axis;  /* particles per cell and axis */
    int threads;
    const char *shape;    /* shape functions; NULL: linear */
    const char *transfer; /* NULL: flip */
    bool last;            /* stress_update "last", otherwise "modified_last" */
    const char *control;  /* of anti-locking; NULL: none */
    const char *field;    /* that it fits; NULL: volumetric */
    double domain_factor; /* cells of the grid over cells of the body, at least */
    double courant;       /* share of the critical step; 0: the default of scenes */
    bool tracked;         /* also stores total and plastic strain, to look at them */
};

/* Words of a setup for tables and files. */
const char *benchmark_body_word(const struct benchmark_setup *setup);
const char *benchmark_shape_word(const struct benchmark_setup *setup);
const char *benchmark_transfer_word(const struct benchmark_setup *setup);
const char *benchmark_ordering_word(const struct benchmark_setup *setup);
const char *benchmark_control_word(const struct benchmark_setup *setup);
const char *benchmark_field_word(const struct benchmark_setup *setup);

#endif
