/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_metric.h"

#include "reply.h"
#include "suggest.h"

#include <stddef.h>
#include <string.h>

static const char *const own_metrics[] = {"wall_seconds",
                                          "cpu_seconds",
                                          "peak_memory_bytes",
                                          "particle_steps_per_second",
                                          "energy_error",
                                          "energy_numerical",
                                          "momentum_error",
                                          "mass_error",
                                          "time",
                                          "steps",
                                          "particles",
                                          "particle_steps",
                                          "eliminated_mass",
                                          NULL};

/* Metrics that something with a name in the scene has: PREFIX NAME [.PART] SUFFIX. */
static const struct family {
    const char *prefix, *section; /* of the scene: an array of objects with a name */
    const char *other;            /* what names it when it has no name, or NULL */
    const char *suffixes[9];      /* NULL-terminated; none: the name is the end */
    bool parts;                   /* a component or a face may follow the name */
    const char *what;
} families[] = {
    {"probe.",
     "probes",
     NULL,
     {".final", ".min", ".max", ".time_of_max", ".mean", NULL},
     true,
     "probe.NAME.final, .min, .max, .time_of_max or .mean of a probe of the scene"},
    {"reaction.",
     "boundaries",
     NULL,
     {".peak", ".peak_time", ".peak.x", ".peak.y", ".peak.z", NULL},
     true,
     "reaction.NAME[.FACE].peak or .peak_time of a boundary of the scene"},
    {"error.", "references", "probe", {NULL}, false, "error.NAME of a reference of the scene"},
};
enum { FAMILY_COUNT = sizeof families / sizeof families[0] };

static const struct family *family_of(const char *name)
{
    for (size_t index = 0; index < FAMILY_COUNT; index++) {
        if (strncmp(name, families[index].prefix, strlen(families[index].prefix)) == 0)
            return &families[index];
    }
    return NULL;
}

/* The length of a name without the longest suffix of its family; 0 if it has none of them. */
static size_t suffix_cut(const struct family *family, const char *name)
{
    size_t length = strlen(name), cut = family->suffixes[0] == NULL ? length : 0;
    for (size_t index = 0; family->suffixes[index] != NULL; index++) {
        size_t suffix = strlen(family->suffixes[index]);
        if (length > suffix && strcmp(name + length - suffix, family->suffixes[index]) == 0 &&
            (cut == 0 || length - suffix < cut))
            cut = length - suffix;
    }
    return cut;
}

static bool own_metric(const char *name)
{
    for (size_t index = 0; own_metrics[index] != NULL; index++) {
        if (strcmp(own_metrics[index], name) == 0)
            return true;
    }
    return strncmp(name, "anti_locking.", 13) == 0 || strncmp(name, "domains.", 8) == 0;
}

bool study_metric_like(const char *name)
{
    const struct family *family = family_of(name);
    return family == NULL ? own_metric(name) : suffix_cut(family, name) > strlen(family->prefix);
}

/* Whether `length` bytes of a text are the name of something in a section, with a part behind it if
 * the family has parts. */
static bool named(const struct family *family, const char *text, size_t length,
                  const json_t *effective)
{
    size_t index;
    const json_t *item;
    json_array_foreach(json_object_get(effective, family->section), index, item)
    {
        const char *name = json_string_value(json_object_get(item, "name"));
        if (name == NULL && family->other != NULL)
            name = json_string_value(json_object_get(item, family->other));
        size_t own = name == NULL ? 0 : strlen(name);
        if (own == 0 || own > length || strncmp(text, name, own) != 0)
            continue;
        if (own == length || (family->parts && text[own] == '.'))
            return true;
    }
    return false;
}

void study_metric_check(const char *name, const json_t *effective, const char *pointer,
                        json_t *errors)
{
    const struct family *family = family_of(name);
    if (family == NULL) {
        const char *near = suggest(name, own_metrics);
        if (!own_metric(name))
            issue_add(errors, pointer, "unknown_value", NULL, NULL, "no metric is called %s%s%s%s",
                      name, near == NULL ? "" : "; did you mean \"", near == NULL ? "" : near,
                      near == NULL ? "" : "\"?");
        return;
    }
    size_t prefix = strlen(family->prefix), end = suffix_cut(family, name);
    if (end <= prefix ||
        (effective != NULL && !named(family, name + prefix, end - prefix, effective)))
        issue_add(errors, pointer, "unknown_value", NULL, NULL, "%s is not %s", name, family->what);
}
