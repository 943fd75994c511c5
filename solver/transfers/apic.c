/* SPDX-License-Identifier: Apache-2.0 */
#include "transfers/velocity_transfer.h"

static double pic_share(const struct talus_solver_options *options, double time_step)
{
    (void)options;
    (void)time_step;
    return 1.0;
}

const struct transfer apic = {
    .name = "apic",
    .reference = "Jiang et al. 2015, The affine particle-in-cell method",
    .summary = "PIC whose particles also carry the slope of their velocity: quiet, and keeps "
               "rotation",
    .affine = true,
    .pic_share = pic_share,
};
