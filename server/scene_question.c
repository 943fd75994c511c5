/* SPDX-License-Identifier: Apache-2.0 */
#include "scene_question.h"

#include "calibration.h"
#include "supervisor.h"

#include <math.h>

json_t *scene_question_calibration(struct service *service, int64_t threads)
{
    const double own = threads > 0 ? (double)threads : 1.0;
    /* All jobs together never take more than the workers. */
    double busy = fmin((double)supervisor_threads(service->supervisor),
                       (double)service->config->workers - own);
    return calibration_question(service->calibration, fmax(busy, 0.0));
}

json_t *scene_question(struct service *service, const json_t *scene, int64_t threads)
{
    const json_int_t most = threads > 0 ? threads : (json_int_t)service->config->workers;
    return json_pack("{s:s, s:O, s:I, s:o}", "op", "check", "scene", scene, "threads", most,
                     "calibration", scene_question_calibration(service, threads));
}
