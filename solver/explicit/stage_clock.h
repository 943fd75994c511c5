/* SPDX-License-Identifier: Apache-2.0 */
/* Where the time of a step goes, stage by stage: one clock a thread, read in laps. Off (a null
 * pointer in block_scratch.clock) it costs one predictable branch per stage and block. Ticks are of
 * the processor's time counter, which whoever sets the clock compares with a clock of seconds; a
 * lap is counted, so that the cost of reading can be taken off. */
#ifndef TALUS_STAGE_CLOCK_H
#define TALUS_STAGE_CLOCK_H

#include <stdint.h>
#include <time.h>

/* STAGE(ENUM, name) in the order of a step. Of the second pass, laps inside of it take what is
 * theirs; what no lap takes is SECOND_PASS. WAIT is the time of a thread between its tiles. */
#define TALUS_STAGES(STAGE)                                                                        \
    STAGE(HOUSEKEEPING, housekeeping)                                                              \
    STAGE(KICK_NODES, kick_nodes)                                                                  \
    STAGE(FIRST_PASS, first_pass)                                                                  \
    STAGE(UPDATE_NODES, update_nodes)                                                              \
    STAGE(GATHER, gather)                                                                          \
    STAGE(KINEMATICS, kinematics)                                                                  \
    STAGE(ANTI_LOCKING, anti_locking)                                                              \
    STAGE(MATERIAL, material)                                                                      \
    STAGE(STORE, store)                                                                            \
    STAGE(MOVE, move)                                                                              \
    STAGE(SCATTER, scatter)                                                                        \
    STAGE(SECOND_PASS, second_pass)                                                                \
    STAGE(WAIT, wait)                                                                              \
    STAGE(REBIN, rebin)                                                                            \
    STAGE(ENERGY_CHECK, energy_check)                                                              \
    STAGE(TIME_STEP, time_step)

enum stage {
#define STAGE(ENUM, name) STAGE_##ENUM,
    TALUS_STAGES(STAGE)
#undef STAGE
        STAGE_COUNT
};

struct stage_clock {
    uint64_t last;               /* reading at the last lap */
    uint64_t ticks[STAGE_COUNT]; /* since the caller last cleared them */
    uint64_t laps[STAGE_COUNT];
    uint64_t crossers; /* particles that left their cell; in the clock of thread 0 */
};

static inline uint64_t stage_clock_read(void)
{
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#elif defined(__aarch64__)
    uint64_t ticks;
    __asm__ volatile("mrs %0, cntvct_el0" : "=r"(ticks));
    return ticks;
#else
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
#endif
}

/* Starts a lap: time until now belongs to nobody. clock may be NULL here and below. */
static inline void stage_clock_start(struct stage_clock *clock)
{
    if (clock != NULL)
        clock->last = stage_clock_read();
}

/* Ends a lap and starts the next: time since the last reading belongs to `stage`. */
static inline void stage_clock_lap(struct stage_clock *clock, enum stage stage)
{
    if (clock == NULL)
        return;
    const uint64_t now = stage_clock_read();
    clock->ticks[stage] += now - clock->last;
    clock->laps[stage]++;
    clock->last = now;
}

#endif
