#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds Talus and runs every test. Further arguments go to ctest (deploy/test.sh -L unit).
# TALUS_FULL=1 in the environment runs the physics checks at full size.
set -euo pipefail
cd "$(dirname "$0")/.."
deploy/install-dependencies.sh
cmake --preset release >/dev/null
cmake --build --preset release
exec ctest --preset release --parallel "$(nproc)" "$@"
