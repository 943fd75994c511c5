/* SPDX-License-Identifier: Apache-2.0 */
/* The velocity of a body at the start: uniform, rigid rotation, bending mode of a beam. */
#include "scene/scene_body.h"

#include "talus/scene.h"

#include <stddef.h>

#define AT(member) offsetof(struct talus_body, member)

static const struct scene_field uniform_field = {
    .key = "velocity",
    .kind = SCENE_VECTOR,
    .unit = "m/s",
    .minimum = -1e6,
    .maximum = 1e6,
    .meaning = "velocity of the whole body",
};

static const struct scene_field rate_field = {.key = "rate", .unit = "rad/s"};

/* In 2D a number (counterclockwise), in 3D a vector. */
static void read_rate(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    json_t *value = NULL;
    if (reader->axis_count == 3) {
        if (!scene_vector_read(reader, path, &rate_field, given, body->rotation_rate, &value))
            return;
    } else {
        if (!scene_number_read(reader, path, &rate_field, given, &body->rotation_rate[2]))
            return;
        value = json_real(body->rotation_rate[2]);
    }
    scene_put(reader, effective, path->key, value);
}

static json_t *rate_schema(void)
{
    return scene_turn_schema(json_pack(
        "{s:[o, {s:s, s:i, s:i, s:o}]}", "oneOf", scene_number_schema(&rate_field), "type", "array",
        "minItems", 3, "maxItems", 3, "items", scene_number_schema(&rate_field)));
}

static const struct scene_field rotation_fields[] = {
    {.key = "about",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = AT(rotation_about),
     .meaning = "a point that rests"},
    {.key = "rate",
     .kind = SCENE_CUSTOM,
     .unit = "rad/s",
     .required = true,
     .read = read_rate,
     .schema = rate_schema,
     .meaning = "angular velocity: a number in 2D (counterclockwise), a vector in 3D"},
    {.key = NULL},
};

static const struct scene_field beam_fields[] = {
    {.key = "mode",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 1.0,
     .maximum = 50.0,
     .required = true,
     .whole = true,
     .default_value = NAN,
     .offset = AT(beam_mode),
     .meaning = "bending mode of the clamped-free beam, from 1"},
    {.key = "from",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = AT(beam_from),
     .meaning = "neutral axis at the clamp"},
    {.key = "to",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = AT(beam_to),
     .meaning = "neutral axis at the free end"},
    {.key = "tip",
     .kind = SCENE_VECTOR,
     .unit = "m/s",
     .minimum = -1e6,
     .maximum = 1e6,
     .required = true,
     .default_value = NAN,
     .offset = AT(beam_tip),
     .meaning = "velocity of the free end, perpendicular to the axis"},
    {.key = NULL},
};

#define FIELD(NAME, FIELDS, MEANING)                                                               \
    {                                                                                              \
        .key = NAME, .kind = SCENE_OBJECT, .unit = "1", .required = true, .alternative = "field",  \
        .fields = FIELDS, .meaning = MEANING                                                       \
    }
static const struct scene_field velocity_fields[] = {
    FIELD("rotation", rotation_fields, "rigid rotation"),
    FIELD("beam_mode", beam_fields, "bending mode of a beam that is clamped at one end"),
    {.key = NULL},
};

/* False for what was not readable (NAN): that is reported already. */
static void check_beam(struct scene_reader *reader, const struct scene_path *path,
                       const struct talus_body *body)
{
    struct scene_path beam = {.parent = path, .key = "beam_mode"};
    struct scene_path end = {.parent = &beam, .key = "to"};
    struct scene_path tip = {.parent = &beam, .key = "tip"};
    double length = 0.0, speed = 0.0, along = 0.0;
    for (size_t k = 0; k < 3; k++) {
        const double step = body->beam_to[k] - body->beam_from[k];
        length += step * step;
        speed += body->beam_tip[k] * body->beam_tip[k];
        along += step * body->beam_tip[k];
    }
    if (length == 0.0)
        scene_mistake(reader, &end, "direction", NULL, NULL, "'from' and 'to' are the same point");
    else if (along * along > 1e-18 * length * speed)
        scene_mistake(reader, &tip, "contradiction", NULL, NULL,
                      "the free end moves perpendicular to the axis of the beam");
}

static void read_field(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, struct talus_body *body, json_t *effective)
{
    json_t *inner = json_object();
    if (reader->axis_count == 1)
        scene_mistake(reader, path, "contradiction", NULL, NULL,
                      "in one dimension nothing rotates or bends");
    scene_fields_read(reader, path, velocity_fields, given, body, inner);
    scene_put(reader, effective, path->key, inner);
    body->velocity_field = TALUS_VELOCITY_ROTATION;
    if (json_object_get(given, "beam_mode") == NULL)
        return;
    body->velocity_field = TALUS_VELOCITY_BEAM_MODE;
    check_beam(reader, path, body);
}

void scene_body_velocity_read(struct scene_reader *reader, const struct scene_path *path,
                              const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    json_t *value = NULL;
    if (json_is_object(given)) {
        read_field(reader, path, given, body, effective);
        return;
    }
    if (given != NULL) {
        if (!scene_vector_read(reader, path, &uniform_field, given, body->velocity, &value))
            return;
    } else {
        value = scene_zero_vector(reader);
    }
    scene_put(reader, effective, path->key, value);
}

json_t *scene_body_velocity_schema(void)
{
    return json_pack("{s:[o, o]}", "oneOf", scene_field_schema(&uniform_field),
                     scene_fields_schema(velocity_fields));
}
