# SPDX-License-Identifier: Apache-2.0
"""talusd holds no symbol of the solver and loads neither HDF5 nor cairo: a scene can at worst take
down a worker, never the daemon.

usage: check_symbols.py TALUSD LIBRARY.a...
"""
import os
import subprocess
import sys

from source_tree import report

FOREIGN_LIBRARIES = ("libhdf5", "libcairo", "libgomp", "libomp")


def defined_symbols(path):
    """External symbols that a binary or an archive defines; sanitizers' own are left out."""
    output = subprocess.run(["nm", "--defined-only", "--extern-only", "--format=posix", path],
                            check=True, capture_output=True, text=True).stdout
    names = {line.split()[0] for line in output.splitlines() if len(line.split()) >= 2}
    return {name for name in names if not name.startswith(("__", "_fini", "_init", "_start"))}


def needed_libraries(path):
    output = subprocess.run(["readelf", "--dynamic", "--wide", path],
                            check=True, capture_output=True, text=True).stdout
    return [line.split("[")[1].rstrip("]") for line in output.splitlines() if "(NEEDED)" in line]


def check_symbols(daemon, libraries):
    missing = [path for path in [daemon, *libraries] if not os.path.exists(path)]
    if missing:
        return [f"{path} has not been built" for path in missing]
    own = defined_symbols(daemon)
    if "main" not in own:
        return [f"{daemon} is stripped: nothing to check"]
    problems = [f"{daemon} needs {name}" for name in needed_libraries(daemon)
                if name.startswith(FOREIGN_LIBRARIES)]
    for library in libraries:
        foreign = defined_symbols(library)
        if not foreign:
            problems.append(f"{library} defines no symbol")
        problems.extend(f"{daemon} holds {name} of {os.path.basename(library)}"
                        for name in sorted(own & foreign))
    return problems


if __name__ == "__main__":
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(report(check_symbols(sys.argv[1], sys.argv[2:])))
