/* SPDX-License-Identifier: Apache-2.0 */
/* Studies and their results as clients see them. */
#ifndef TALUS_STUDY_VIEW_H
#define TALUS_STUDY_VIEW_H

#include "service.h"
#include "studies/study.h"
#include "text.h"

#include <jansson.h>

/* The study; new reference. Scene and design are members if it was read with them. */
json_t *study_view(struct service *service, const struct study *study);
/* The metrics asked for, or those that chart and condition need, too. */
enum study_results_metrics { STUDY_RESULTS_ASKED, STUDY_RESULTS_WANTED };
/* The table of its rows, as JSON or as CSV (RFC 4180). */
TALUS_MUST_CHECK enum talus_status study_results_json(struct service *service,
                                                      const struct study *study,
                                                      enum study_results_metrics which,
                                                      struct text *text, struct talus_error *error);
TALUS_MUST_CHECK enum talus_status study_results_csv(struct service *service,
                                                     const struct study *study, struct text *text,
                                                     struct talus_error *error);

#endif
