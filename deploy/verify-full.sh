#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds Talus and runs the physics checks at full size, one after the other, with both cores for each.
# The figures go to build/verification.md as rows of a Markdown table, and their totals to
# build/verification-totals.md. Arguments go to ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset release >/dev/null
cmake --build --preset release
table=$PWD/build/verification.md
printf '| problem | quantity | tolerance | result | form | verdict |\n|---|---|---|---|---|---|\n' >"$table"
ended=0
TALUS_FULL=1 TALUS_VERIFICATION_TABLE=$table ctest --preset release -L verification "$@" || ended=$?
totals=$PWD/build/verification-totals.md
tests/verification/verification_totals.py "$table" >"$totals"
echo "figures: $table, totals: $totals"
exit "$ended"
