/* SPDX-License-Identifier: Apache-2.0 */
#include "transfers/velocity_transfer.h"

#include <math.h>

/* A ratio per step is what the sources use; a rate makes results independent of the step. */
static double pic_share(const struct talus_solver_options *options, double time_step)
{
    if (!isnan(options->flip_ratio))
        return 1.0 - options->flip_ratio;
    return -expm1(-options->pic_rate * time_step);
}

const struct transfer flip = {
    .name = "flip",
    .reference = "Brackbill and Ruppel 1986; Mast 2013, eq. 2.22",
    .summary = "particles take the nodes' velocity increment: hardly dissipates; `pic_rate` or "
               "`flip_ratio` mix PIC in",
    .pic_share = pic_share,
};
