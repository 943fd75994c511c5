/* SPDX-License-Identifier: Apache-2.0 */
#include "transfers/velocity_transfer.h"

static double pic_share(const struct talus_solver_options *options, double time_step)
{
    (void)options;
    (void)time_step;
    return 1.0;
}

const struct transfer pic = {
    .name = "pic",
    .reference = "Harlow 1964",
    .summary = "particles take the nodes' velocity: quiet, and damps motion and rotation strongly",
    .pic_share = pic_share,
};
