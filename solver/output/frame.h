/* SPDX-License-Identifier: Apache-2.0 */
/* A frame: what a simulation looks like at one moment, copied out of it, so that it can be written
 * while the simulation goes on. Points with named arrays: particles, or nodes of the grid. */
#ifndef TALUS_FRAME_H
#define TALUS_FRAME_H

#include "talus/simulation.h"

enum { FRAME_ARRAY_MAX = TALUS_FIELD_COUNT };

enum frame_number { FRAME_REAL, FRAME_INTEGER };

struct frame_array {
    const char *name, *unit; /* static */
    size_t components;
    enum frame_number number; /* integers are stored as such whatever the precision */
    double *values;           /* [points * components] */
};

struct frame {
    double time; /* [s] */
    uint64_t step;
    size_t point_count;
    double *positions; /* [3 * point_count] m */
    struct frame_array arrays[FRAME_ARRAY_MAX];
    size_t array_count;
};

/* Copies positions and the fields of the bit set `fields` (enum talus_field), in order of particle
 * id. Release the frame in any case. TALUS_MEMORY; TALUS_UNSUPPORTED for a field not tracked. */
TALUS_MUST_CHECK enum talus_status frame_capture(struct frame *frame,
                                                 const struct talus_simulation *simulation,
                                                 uint32_t fields, struct talus_error *error);

/* The same of the grid: bit 0 mass, 1 velocity, 2 reaction (force on the boundary and area). */
TALUS_MUST_CHECK enum talus_status frame_capture_grid(struct frame *frame,
                                                      const struct talus_simulation *simulation,
                                                      uint32_t grid_fields,
                                                      struct talus_error *error);
void frame_release(struct frame *frame);

/* Writes a frame as a VTKHDF 1.0 unstructured grid of vertices (VTK file formats documentation,
 * "VTKHDF format specification"): /VTKHDF with Version, Type, NumberOfPoints, NumberOfCells,
 * NumberOfConnectivityIds, Points [n,3], Connectivity, Offsets, Types, PointData, and FieldData
 * with Time [s] and Step. Reals as double or single precision. Published at once. */
TALUS_MUST_CHECK enum talus_status frame_write_vtkhdf(const struct frame *frame, const char *path,
                                                      bool double_precision,
                                                      struct talus_error *error);

/* The same as a VTK XML unstructured grid (.vtu), appended base64, readable by any VTK. */
TALUS_MUST_CHECK enum talus_status frame_write_vtu(const struct frame *frame, const char *path,
                                                   bool double_precision,
                                                   struct talus_error *error);

#endif
