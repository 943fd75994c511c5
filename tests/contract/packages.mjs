// SPDX-License-Identifier: Apache-2.0
// Packages lie in the build folder: with_packages says where.
import { createRequire } from "node:module";

export const load = createRequire(`${process.env.TALUS_NODE_PACKAGES}/`);
