/* SPDX-License-Identifier: Apache-2.0 */
/* One number per particle out of a field: a component or an invariant, by its suffix. */
#ifndef TALUS_RENDER_FIELD_H
#define TALUS_RENDER_FIELD_H

#include "talus/status.h"

#include <stddef.h>

/* Replaces values[count * components] by values[count]. suffix "": the default of that number of
 * components (see struct render_request). TALUS_INVALID (/field) lists the suffixes there are. */
TALUS_MUST_CHECK enum talus_status render_field_reduce(double *values, size_t count,
                                                       size_t components, const char *suffix,
                                                       struct talus_error *error);

/* "velocity magnitude", "stress xx", "density". */
void render_field_label(const char *name, size_t components, const char *suffix, char *label,
                        size_t size);

#endif
