/* SPDX-License-Identifier: Apache-2.0 */
#include "talus/version.h"

#ifndef TALUS_REVISION
#define TALUS_REVISION "unknown"
#endif
#if defined(__clang__)
#define TALUS_COMPILER "clang " __clang_version__
#else
#define TALUS_COMPILER "gcc " __VERSION__
#endif

const char *talus_build(void)
{
    return TALUS_VERSION "+" TALUS_REVISION " " TALUS_COMPILER;
}
