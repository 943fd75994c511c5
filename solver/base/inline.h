/* SPDX-License-Identifier: Apache-2.0 */
/* For the small parts of a kernel's loop: the compiler must see the whole, with the numbers of axes
 * and components as constants. Also for functions that only fetch memory, whose calls gcc drops as
 * having no effect. */
#ifndef TALUS_INLINE_H
#define TALUS_INLINE_H

#define TALUS_INLINE static inline __attribute__((always_inline, unused))

#endif
