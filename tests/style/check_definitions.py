# SPDX-License-Identifier: Apache-2.0
"""Every line of a .def list has its file, and every such file has its line."""
import re
import sys

from source_tree import main

# .def file -> (macro of its lines, file of an entry, what a file of an entry defines)
LISTS = {
    "solver/materials/materials.def":
        ("MATERIAL", "solver/materials/{}.c", r"^const struct material (\w+) = "),
    "solver/shapes/shapes.def":
        ("SHAPE", "solver/shapes/{}.c", r"^const struct shape shape_(\w+) = "),
    "solver/boundaries/boundaries.def":
        ("BOUNDARY", "solver/boundaries/{}.c", r"^const struct boundary_condition boundary_(\w+) = "),
    "solver/transfers/transfers.def":
        ("TRANSFER", "solver/transfers/{}.c", r"^const struct transfer (\w+) = "),
    "solver/worker/commands.def":
        ("COMMAND", "solver/worker/command_{}.c", r"^int command_(\w+)\("),
    "clients/cli/subcommands.def":
        ("SUBCOMMAND", "clients/cli/subcommand_{}.c", r"^const struct subcommand subcommand_(\w+) = "),
}
# Lists of data, without a file for each line.
DATA_LISTS = {
    "include/talus/fields.def",
    "server/config.def",
    "server/job_columns.def",
    "server/job_states.def",
    "server/response_headers.def",
    "server/studies/row_states.def",
    "server/studies/study_columns.def",
    "server/studies/study_states.def",
    "server/sobol_directions.def",
    "solver/base/messages.def",
    "solver/explicit/courant_limits.def",
    "solver/scene/cost_rates.def",
    "solver/materials/cone_parameters.def",
    "solver/materials/hardening_parameters.def",
    "solver/materials/softening_parameters.def",
    "solver/materials/mobilised_parameters.def",
    "solver/scene/scene_codes.def",
    "solver/state/particle_fields.def",
    "tests/benchmark/operation_counts.def",
}


ROUTES = "server/routes.def"
HANDLERS = "server/handlers/"


def check_routes(tree):
    """Every route has its handler somewhere in server/handlers/, every handler its route."""
    routed = set(re.findall(r"^ROUTE\(.*, (\w+)\)", tree[ROUTES], re.MULTILINE))
    defined = {name for file, text in tree.items() if file.startswith(HANDLERS)
               for name in re.findall(r"^enum handled handle_(\w+)\(", text, re.MULTILINE)}
    return ([f"{ROUTES}: no handler handle_{name}" for name in sorted(routed - defined)] +
            [f"{HANDLERS}: handle_{name} has no route" for name in sorted(defined - routed)])


def check_list(path, tree):
    macro, pattern, definition = LISTS[path]
    names = re.findall(rf"^{macro}\((\w+)", tree[path], re.MULTILINE)
    problems = [] if names else [f"{path}: no line {macro}(...)"]
    for name in names:
        file = pattern.format(name)
        if file not in tree:
            problems.append(f"{path}: {macro}({name}) has no file {file}")
        elif name not in re.findall(definition, tree[file], re.MULTILINE):
            problems.append(f"{file}: does not define what {path} lists")
    folder = path.rsplit("/", 1)[0] + "/"
    for file, text in tree.items():
        if file.startswith(folder) and file.endswith(".c") and "/" not in file[len(folder):]:
            for name in re.findall(definition, text, re.MULTILINE):
                if name not in names:
                    problems.append(f"{file}: {name} has no line in {path}")
    return problems


def check_definitions(tree):
    problems = []
    for path in tree:
        if not path.endswith(".def") or path in DATA_LISTS:
            continue
        if path == ROUTES:
            problems.extend(check_routes(tree))
        elif path in LISTS:
            problems.extend(check_list(path, tree))
        else:
            problems.append(f"{path}: unknown list; give it a line in check_definitions.py")
    return problems


if __name__ == "__main__":
    sys.exit(main(check_definitions))
