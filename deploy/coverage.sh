#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds Talus with counters, runs the unit and protocol tests, and prints how many of its lines have
# run, per folder; build/coverage/coverage.csv has the same per file. Processes that a test kills
# leave no counts. Arguments go to ctest (deploy/coverage.sh -L unit).
set -euo pipefail
cd "$(dirname "$0")/.."
deploy/install-dependencies.sh --coverage
cmake --preset coverage >/dev/null
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
ctest --preset coverage --parallel "$(nproc)" "$@"

gcovr --root . --filter 'solver/' --filter 'server/' --filter 'clients/' --filter 'include/' \
    --gcov-ignore-parse-errors --csv --output build/coverage/coverage.csv build/coverage
awk -F, '
    NR > 1 {
        folder = $1
        sub("/[^/]*$", "", folder)
        total[folder] += $2; covered[folder] += $3
        total["all"] += $2; covered["all"] += $3
    }
    END {
        for (folder in total)
            printf "%-24s %6d of %6d lines %6.1f %%\n", folder, covered[folder], total[folder],
                100 * covered[folder] / (total[folder] ? total[folder] : 1)
    }' build/coverage/coverage.csv | sort
