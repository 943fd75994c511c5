# SPDX-License-Identifier: Apache-2.0
"""The files of the source tree, for the checks in this folder.

A tree is a dict from the path (relative to the root, with slashes) to the text; a check is a
function that takes a tree and returns a list of problems, so that the same function judges the
repository and the small wrong trees of test_rules.py. The tree is walked, not asked from git: the
checks also run on an unpacked archive.
"""
import os
import sys

SKIPPED_FOLDERS = {".git", "build", "__pycache__", "node_modules", "vendor"}


def read_tree(root):
    """Every text file below root; binary files map to None."""
    tree = {}
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(
            name for name in folders
            if name not in SKIPPED_FOLDERS and not (folder == root and name.startswith("build")))
        for name in sorted(names):
            path = os.path.join(folder, name)
            if os.path.islink(path) or name == ".git":  # .git is a file in a worktree
                continue
            with open(path, "rb") as stream:
                content = stream.read()
            try:
                text = None if b"\0" in content else content.decode("utf-8")
            except UnicodeDecodeError:
                text = None
            tree[os.path.relpath(path, root).replace(os.sep, "/")] = text
    return tree


def report(problems):
    """Prints the problems and gives the exit code."""
    for problem in problems:
        print(problem)
    if problems:
        print(f"{len(problems)} problem(s)")
    return 1 if problems else 0


def main(check):
    """Runs one check over the tree named on the command line."""
    if len(sys.argv) != 2:
        print(f"usage: {sys.argv[0]} ROOT", file=sys.stderr)
        return 2
    tree = read_tree(sys.argv[1])
    if "CMakeLists.txt" not in tree:
        print(f"{sys.argv[1]} is not the root of the source tree", file=sys.stderr)
        return 2
    return report(check(tree))
