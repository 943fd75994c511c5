/* SPDX-License-Identifier: Apache-2.0 */
/* Manufactured solutions: motions chosen in advance, and the body force with which a Hencky solid
 * (linear_elastic at finite strain, plane strain) follows them. */
#ifndef MANUFACTURED_H
#define MANUFACTURED_H

#include <stdbool.h>
#include <stddef.h>

struct elastic {
    double density, lambda, shear; /* [kg/m^3], Lame's first constant and shear modulus [Pa] */
};

struct manufactured {
    const char *name, *what;
    /* All three at a reference place [m] and a time [s]: displacement [m], velocity [m/s], body
     * force [m/s^2]. */
    void (*displacement)(const double reference[2], double time, double out[2]);
    void (*velocity)(const double reference[2], double time, double out[2]);
    void (*body_force)(const struct elastic *elastic, const double reference[2], double time,
                       double out[2]);
    bool (*counts)(const double reference[2]); /* the place takes part in the error */
    double amplitude;                          /* largest displacement [m] */
};

extern const struct manufactured axis_aligned, vortex;

#endif
