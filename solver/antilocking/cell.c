/* SPDX-License-Identifier: Apache-2.0 */
#include "antilocking/anti_locking.h"

#include "state/lanes.h"

void cell_average(size_t count, const real *weight, real *values)
{
    lanes total = {0}, sum = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lanes w = lanes_load(weight + slot);
        total += w;
        sum += w * lanes_load(values + slot);
    }
    const lanes mean = sum / lanes_select(total > 0, total, lanes_splat(1));
    for (size_t slot = 0; slot < count; slot += LANE_COUNT) {
        const lane_mask takes_part = lanes_load(weight + slot) > 0;
        lanes_store(values + slot, lanes_select(takes_part, mean, lanes_load(values + slot)));
    }
}
