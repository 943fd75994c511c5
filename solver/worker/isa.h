/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_ISA_H
#define TALUS_ISA_H

/* Replaces this process by the worker for the best instruction set of the processor, if there is a
 * better one beside it. TALUS_ISA ("x86-64", "x86-64-v3") forces one. Returns if there is nothing
 * to do, or if the other program cannot be started. */
void isa_switch(char **arguments);

#endif
