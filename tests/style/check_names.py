# SPDX-License-Identifier: Apache-2.0
"""File names are unique across the repository, so that a name alone finds its file."""
import collections
import sys

from source_tree import main

SHARED_NAMES = {"main.c", "README.md", "CMakeLists.txt", ".gitignore", ".clang-tidy", "__init__.py",
                "index.html"}


def check_names(tree):
    places = collections.defaultdict(list)
    for path in tree:
        name = path.rsplit("/", 1)[-1]
        if name not in SHARED_NAMES:
            places[name].append(path)
    return [f"{name} is the name of several files: {', '.join(paths)}"
            for name, paths in places.items() if len(paths) > 1]


if __name__ == "__main__":
    sys.exit(main(check_names))
