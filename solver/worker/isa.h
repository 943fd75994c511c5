/* SPDX-License-Identifier: Apache-2.0 */
/* talus-worker is built once per instruction set: the plain program for the lowest one, and beside
 * it talus-worker-x86-64-v3, -v4 (see CMakeLists.txt). */
#ifndef TALUS_ISA_H
#define TALUS_ISA_H

#include <stdbool.h>

/* Replaces the plain program by the best one beside it that the processor can run. TALUS_ISA
 * ("x86-64-v2", "x86-64-v3", "x86-64-v4") forces one. Returns true if this program is the one to go
 * on with; false, after a message on stderr, if the processor cannot run it, or if TALUS_ISA asks
 * for what is unknown or not to be had. To be called before anything of the solver. */
bool isa_switch(char **arguments);

#endif
