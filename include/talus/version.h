/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_VERSION_H
#define TALUS_VERSION_H

#define TALUS_VERSION "0.1.0"

/* Version, git revision and compiler of this build, for receipts ("0.1.0+abcdef1 gcc 12.2.0"). */
const char *talus_build(void);

#endif
