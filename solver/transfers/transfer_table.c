/* SPDX-License-Identifier: Apache-2.0 */
#include "transfers/velocity_transfer.h"

#define TRANSFER(symbol) extern const struct transfer symbol;
#include "transfers/transfers.def"
#undef TRANSFER

const struct transfer *const transfer_table[] = {
#define TRANSFER(symbol) &symbol,
#include "transfers/transfers.def"
#undef TRANSFER
};
const size_t transfer_count = sizeof transfer_table / sizeof transfer_table[0];

bool transfer_blends(const struct talus_solver_options *options)
{
    return transfer_of(options)->pic_share(options, 1.0) > 0;
}
