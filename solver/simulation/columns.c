/* SPDX-License-Identifier: Apache-2.0 */
/* Histories: the columns of a scene and the values of one row. */
#include "simulation/simulation_private.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char axis_names[3] = {'x', 'y', 'z'};
static const char *const face_names[6] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
static const char *const energy_names[TALUS_ENERGY_PART_COUNT] = {
    [TALUS_ENERGY_TOTAL] = "total",           [TALUS_ENERGY_KINETIC] = "kinetic",
    [TALUS_ENERGY_STRAIN] = "strain",         [TALUS_ENERGY_POTENTIAL] = "potential",
    [TALUS_ENERGY_DISSIPATED] = "dissipated", [TALUS_ENERGY_EXTERNAL] = "external",
    [TALUS_ENERGY_NUMERICAL] = "numerical"};

static const char *extensive_unit(const struct talus_scene *scene, const char *solid,
                                  const char *plane, const char *line)
{
    const size_t axes = extensive_axis_count(scene);
    return axes == 3 ? solid : axes == 2 ? plane : line;
}

struct column_writer {
    const struct talus_scene *scene;
    struct talus_column *columns; /* NULL: only count */
    size_t count;
};

__attribute__((format(printf, 3, 4))) static void
add_column(struct column_writer *writer, const char *unit, const char *format, ...)
{
    if (writer->columns != NULL) {
        struct talus_column *column = &writer->columns[writer->count];
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(column->name, sizeof column->name, format, arguments);
        va_end(arguments);
        (void)snprintf(column->unit, sizeof column->unit, "%s", unit);
    }
    writer->count++;
}

/* Moments have all components in 3D, the one out of plane in 2D, none in 1D. */
static size_t first_moment(const struct talus_scene *scene)
{
    return scene->axis_count == 3 ? 0 : scene->axis_count == 2 ? 2 : 3;
}

static void add_reaction(struct column_writer *writer, const char *name)
{
    const struct talus_scene *scene = writer->scene;
    assert(scene->axis_count >= 1 && scene->axis_count <= 3);
    const char *force = extensive_unit(scene, "N", "N/m", "N/m^2");
    for (size_t axis = 0; axis < scene->axis_count; axis++)
        add_column(writer, force, "reaction.%s.force.%c", name, axis_names[axis]);
    for (size_t axis = 0; axis < scene->axis_count; axis++)
        add_column(writer, force, "reaction.%s.instant.%c", name, axis_names[axis]);
    for (size_t axis = first_moment(scene); axis < 3; axis++)
        add_column(writer, extensive_unit(scene, "N m", "N", "N/m"), "reaction.%s.moment.%c", name,
                   axis_names[axis]);
    add_column(writer, extensive_unit(scene, "m^2", "m", "1"), "reaction.%s.contact_area", name);
}

static void add_reactions(struct column_writer *writer)
{
    for (size_t index = 0; index < writer->scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &writer->scene->boundaries[index];
        if (boundary->internal)
            continue;
        add_reaction(writer, boundary->name);
        for (size_t face = 0; boundary->shape == TALUS_BOUNDARY_BOX && face < boundary->face_count;
             face++) {
            char name[128];
            (void)snprintf(name, sizeof name, "%s.%s", boundary->name, face_names[face]);
            add_reaction(writer, name);
        }
    }
}

static void write_columns(struct column_writer *writer)
{
    add_column(writer, "s", "time");
    for (size_t part = 0; part < TALUS_ENERGY_PART_COUNT; part++)
        add_column(writer, extensive_unit(writer->scene, "J", "J/m", "J/m^2"), "energy.%s",
                   energy_names[part]);
    add_reactions(writer);
    for (size_t probe = 0; probe < writer->scene->probe_count; probe++)
        writer->count +=
            probe_columns(writer->scene, &writer->scene->probes[probe],
                          writer->columns == NULL ? NULL : writer->columns + writer->count);
}

int simulation_make_columns(struct talus_simulation *simulation)
{
    struct column_writer writer = {.scene = &simulation->run.scene};
    write_columns(&writer);
    simulation->column_count = writer.count;
    simulation->columns = calloc(writer.count, sizeof *simulation->columns);
    if (simulation->columns == NULL)
        return -1;
    writer =
        (struct column_writer){.scene = &simulation->run.scene, .columns = simulation->columns};
    write_columns(&writer);
    return 0;
}

const struct talus_column *talus_simulation_columns(const struct talus_simulation *simulation,
                                                    size_t *count)
{
    *count = simulation->column_count;
    return simulation->columns;
}

static double *sample_record(const struct run *run, struct wall_record *record, double *value)
{
    const size_t axes = run->scene.axis_count;
    const double step = run->last_time_step, interval = run->interval;
    for (size_t axis = 0; axis < axes; axis++)
        *value++ = interval > 0 ? record->interval_impulse[axis] / interval : 0.0;
    for (size_t axis = 0; axis < axes; axis++)
        *value++ = step > 0 ? record->step_impulse[axis] / step : 0.0;
    for (size_t axis = first_moment(&run->scene); axis < 3; axis++)
        *value++ = interval > 0 ? record->interval_moment[axis] / interval : 0.0;
    *value++ = record->contact_area;
    return value;
}

static double *sample_reactions(struct run *run, double *value)
{
    for (size_t index = 0; index < run->scene.boundary_count; index++) {
        const struct talus_boundary *boundary = &run->scene.boundaries[index];
        if (boundary->internal)
            continue;
        value = sample_record(run, &run->boundaries[index], value);
        for (size_t face = 0; boundary->shape == TALUS_BOUNDARY_BOX && face < boundary->face_count;
             face++)
            value =
                sample_record(run, &run->faces[run->walls.shapes[index].first_face + face], value);
    }
    return value;
}

static void close_interval(struct wall_record *record)
{
    memset(record->interval_impulse, 0, sizeof record->interval_impulse);
    memset(record->interval_moment, 0, sizeof record->interval_moment);
}

void talus_simulation_sample(struct talus_simulation *simulation, double *row)
{
    struct run *run = &simulation->run;
    double *value = row;
    if (run->energy_step != run->step)
        run_measure_energy(run);
    *value++ = run->time;
    for (size_t part = 0; part < TALUS_ENERGY_PART_COUNT; part++)
        *value++ = run_energy_part(run, (enum talus_energy_part)part);
    value = sample_reactions(run, value);
    probe_scan(run, simulation->probe_sums);
    for (size_t probe = 0; probe < run->scene.probe_count; probe++) {
        probe_sample(simulation, probe, value);
        value += probe_columns(&run->scene, &run->scene.probes[probe], NULL);
    }
    for (size_t face = 0; face < run->walls.face_count; face++)
        close_interval(&run->faces[face]);
    for (size_t index = 0; index < run->scene.boundary_count; index++)
        close_interval(&run->boundaries[index]);
    run->interval = 0;
}
