/* SPDX-License-Identifier: Apache-2.0 */
#include "output/frame.h"

#include <stdlib.h>
#include <string.h>

struct field_entry {
    const char *name, *unit;
    size_t components;
};

static const struct field_entry field_entries[TALUS_FIELD_COUNT] = {
#define TALUS_FIELD(ENUM, name, components, unit, text)                                            \
    [TALUS_FIELD_##ENUM] = {#name, unit, components},
#include "talus/fields.def"
#undef TALUS_FIELD
};

static enum frame_number field_number(enum talus_field field)
{
    bool integer =
        field == TALUS_FIELD_BODY || field == TALUS_FIELD_MATERIAL || field == TALUS_FIELD_ID;
    return integer ? FRAME_INTEGER : FRAME_REAL;
}

/* Room for `components` values a point; NULL when memory ran out (never for 0 points). */
static double *allocate_values(size_t point_count, size_t components)
{
    return calloc(point_count == 0 ? 1 : point_count, components * sizeof(double));
}

static enum talus_status no_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a frame");
}

/* Appends an array to the frame; NULL when memory ran out. */
static double *add_array(struct frame *frame, const char *name, const char *unit, size_t components,
                         enum frame_number number)
{
    double *values = allocate_values(frame->point_count, components);
    if (values == NULL)
        return NULL;
    frame->arrays[frame->array_count++] = (struct frame_array){
        .name = name, .unit = unit, .components = components, .number = number, .values = values};
    return values;
}

static void start_frame(struct frame *frame, const struct talus_simulation *simulation)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(simulation, &state);
    memset(frame, 0, sizeof *frame);
    frame->time = state.time;
    frame->step = state.step;
    frame->point_count = state.particle_count;
}

enum talus_status frame_capture(struct frame *frame, const struct talus_simulation *simulation,
                                uint32_t fields, struct talus_error *error)
{
    start_frame(frame, simulation);
    frame->positions = allocate_values(frame->point_count, 3);
    if (frame->positions == NULL)
        return no_memory(error);
    talus_simulation_read_positions(simulation, frame->positions);
    for (unsigned index = 0; index < TALUS_FIELD_COUNT; index++) {
        if ((fields >> index & 1u) == 0)
            continue;
        enum talus_field field = (enum talus_field)index;
        const struct field_entry *entry = &field_entries[index];
        double *values =
            add_array(frame, entry->name, entry->unit, entry->components, field_number(field));
        if (values == NULL)
            return no_memory(error);
        enum talus_status status = talus_simulation_read_field(simulation, field, values, error);
        if (status != TALUS_OK)
            return status;
    }
    return TALUS_OK;
}

enum talus_status frame_capture_grid(struct frame *frame, const struct talus_simulation *simulation,
                                     uint32_t grid_fields, struct talus_error *error)
{
    double *mass = NULL, *velocity = NULL, *reaction = NULL, *area = NULL;
    start_frame(frame, simulation);
    frame->point_count = talus_simulation_read_nodes(simulation, NULL, NULL, NULL, NULL, NULL);
    frame->positions = allocate_values(frame->point_count, 3);
    if (frame->positions == NULL)
        return no_memory(error);
    if ((grid_fields & 1u) != 0 && (mass = add_array(frame, "mass", "kg", 1, FRAME_REAL)) == NULL)
        return no_memory(error);
    if ((grid_fields & 2u) != 0 &&
        (velocity = add_array(frame, "velocity", "m/s", 3, FRAME_REAL)) == NULL)
        return no_memory(error);
    if ((grid_fields & 4u) != 0 &&
        ((reaction = add_array(frame, "reaction", "N", 3, FRAME_REAL)) == NULL ||
         (area = add_array(frame, "area", "m^2", 1, FRAME_REAL)) == NULL))
        return no_memory(error);
    (void)talus_simulation_read_nodes(simulation, frame->positions, mass, velocity, reaction, area);
    return TALUS_OK;
}

void frame_release(struct frame *frame)
{
    free(frame->positions);
    for (size_t index = 0; index < frame->array_count; index++)
        free(frame->arrays[index].values);
    memset(frame, 0, sizeof *frame);
}
