/* SPDX-License-Identifier: Apache-2.0 */
#include "talus/simulation.h"

/* By what the compiler may use: the flags of the build, not the processor that runs it. */
const char *talus_simulation_isa(void)
{
#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512VL__)
    return "x86-64-v4";
#elif defined(__AVX2__) && defined(__FMA__)
    return "x86-64-v3";
#elif defined(__x86_64__)
    return "x86-64-v2";
#elif defined(__aarch64__)
    return "aarch64";
#else
    return "generic";
#endif
}

enum talus_precision talus_simulation_precision(void)
{
#ifdef TALUS_SINGLE
    return TALUS_PRECISION_SINGLE;
#else
    return TALUS_PRECISION_DOUBLE;
#endif
}
