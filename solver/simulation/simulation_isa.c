/* SPDX-License-Identifier: Apache-2.0 */
#include "talus/simulation.h"

const char *talus_simulation_isa(void)
{
#if defined(__x86_64__) && defined(__AVX2__) && defined(__FMA__)
    return "x86-64-v3";
#elif defined(__x86_64__)
    return "x86-64";
#elif defined(__aarch64__)
    return "aarch64";
#else
    return "generic";
#endif
}
