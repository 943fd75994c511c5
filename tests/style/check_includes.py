# SPDX-License-Identifier: Apache-2.0
"""The include rule: which folder may use what, of our own headers and of libraries.

ARCHITECTURE.md gives the reasons; a new folder under solver/ needs its line here, so that its
place in the order is decided and not an accident.
"""
import re
import sys

from source_tree import main

# Folder under solver/ -> folders under solver/ whose headers it may include besides its own.
CORE = {"base", "math", "state"}
KINDS = {"shapes", "materials", "boundaries"}
STAGES = {"transfers", "antilocking", "kernels"}
ALLOWED = {
    "base": set(),
    "math": {"base"},
    "state": {"base", "math"},
    "shapes": CORE,
    "materials": CORE,
    "boundaries": CORE,
    "seeding": CORE | {"materials"},
    "transfers": CORE | KINDS,
    "antilocking": CORE | KINDS,
    "kernels": CORE | KINDS,
    # What health judges is the run that the time step owns, and the step asks it: one layer.
    "health": CORE | KINDS | {"explicit"},
    "explicit": CORE | KINDS | STAGES | {"health"},
    "simulation": CORE | KINDS | STAGES | {"seeding", "explicit", "health"},
    "scene": CORE | KINDS | {"seeding", "transfers"},
    "output": CORE,
    "worker": {"base", "math", "shapes", "materials", "boundaries", "scene", "output"},
}
# What is not in solver/: headers outside its own folder that it may include.
ALLOWED_ELSEWHERE = {
    "server/": re.compile(r"^(base/|talus/(status|version)\.h$)"),
    "clients/cli/": re.compile(r"^(base/|talus/(status|version|client)\.h$)"),
    "include/": re.compile(r"^talus/"),
}
# Library header -> folders that may include it (tests may include any).
LIBRARIES = {
    r"jansson\.h": ("solver/scene/", "solver/output/", "solver/worker/", "server/", "clients/cli/"),
    r"hdf5(_hl)?\.h": ("solver/output/",),
    r"cairo.*": ("solver/output/",),
    r"openssl/.*": ("solver/base/", "solver/scene/", "solver/output/", "server/"),
    r"microhttpd\.h": ("server/",),
    r"sqlite3\.h": ("server/",),
    r"curl/.*": ("clients/cli/",),
    r"omp\.h": ("solver/",),
}
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]', re.MULTILINE)


def check_own_header(path, header, tree):
    """One quoted include of a file under solver/, server/, clients/cli/ or include/."""
    folder = path.rsplit("/", 1)[0] + "/"
    if folder + header in tree:
        return None  # a neighbour in the same folder
    for prefix, allowed in ALLOWED_ELSEWHERE.items():
        if path.startswith(prefix):
            if allowed.match(header) or prefix + header in tree:
                return None
            return f"{path}: {prefix} must not include {header}"
    own = path.split("/")[1]
    if header.startswith("talus/"):
        return None
    if own not in ALLOWED:
        return f"{path}: solver/{own} has no place in the include order (check_includes.py)"
    target = header.split("/")[0]
    if target == own or target in ALLOWED[own]:
        return None
    return f"{path}: solver/{own} must not include {header}"


def check_library_header(path, header):
    for pattern, folders in LIBRARIES.items():
        if re.fullmatch(pattern, header) and not path.startswith(folders):
            return f"{path}: only {', '.join(folders)} may include <{header}>"
    return None


def check_includes(tree):
    problems = []
    for path, text in tree.items():
        if not path.endswith((".c", ".h", ".def", ".inc")) or text is None:
            continue
        if not path.startswith(("solver/", "server/", "clients/cli/", "include/")):
            continue
        for kind, header in INCLUDE.findall(text):
            if kind == '"':
                problems.append(check_own_header(path, header, tree))
            else:
                problems.append(check_library_header(path, header))
    return [problem for problem in problems if problem]


if __name__ == "__main__":
    sys.exit(main(check_includes))
