/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/helper_chart.h"

#include "output/chart.h"
#include "worker/check_answer.h"

#include <stdlib.h>

json_t *helper_chart(const json_t *question)
{
    struct talus_error error = {.status = TALUS_OK};
    char *svg = NULL;
    if (chart_svg(question, &svg, &error) != TALUS_OK)
        return check_answer_error(error.pointer, error.code, error.text);
    json_t *answer = json_pack("{s:b, s:s}", "ok", 1, "svg", svg);
    free(svg);
    return answer;
}
