/* SPDX-License-Identifier: Apache-2.0 */
#include "explicit/passes.h"

#include "explicit/stage_clock.h"

#include <omp.h>

/* Tiles that a thread takes at once: neighbours, so that what it fetches ahead is its own, and few
 * enough that the threads end together. */
static int tiles_at_once(const struct run *run, size_t colour)
{
    enum { MOST = 16, SHARES = 8 };
    const size_t count = run->grid.colour_begin[colour + 1] - run->grid.colour_begin[colour];
    const size_t share = count / ((size_t)run->threads * SHARES);
    return share < 1 ? 1 : share > MOST ? MOST : (int)share;
}

/* All tiles on the calling thread, which lie colour after colour. libgomp would set up a team for
 * one thread too, and a small step feels it. */
static void pass_alone(struct run *run, pass_tile *pass)
{
    struct block_scratch *scratch = &run->scratch[0];
    stage_clock_start(scratch->clock);
    for (size_t index = 0; index < run->grid.tile_count; index++)
        pass(run, index, scratch);
    stage_clock_lap(scratch->clock, STAGE_WAIT);
}

void run_pass(struct run *run, pass_tile *pass)
{
    if (run->threads == 1) {
        pass_alone(run, pass);
        return;
    }
#pragma omp parallel num_threads(run->threads)
    {
        struct block_scratch *scratch = &run->scratch[omp_get_thread_num()];
        stage_clock_start(scratch->clock);
        for (size_t colour = 0; colour < TILE_COLOURS; colour++) {
#pragma omp for schedule(dynamic, tiles_at_once(run, colour))
            for (size_t index = run->grid.colour_begin[colour];
                 index < run->grid.colour_begin[colour + 1]; index++)
                pass(run, index, scratch);
        }
        stage_clock_lap(scratch->clock, STAGE_WAIT);
    }
}
