# SPDX-License-Identifier: Apache-2.0
"""What every text file of the repository must and must not hold."""
import re
import sys

from source_tree import main

LICENSED = (".c", ".h", ".def", ".inc", ".py", ".sh", ".cmake", "CMakeLists.txt", ".js", ".css",
            ".service")
# Paths that exist on one person's machine only.
MACHINE_PATH = re.compile(r"(?<![\w./:-])/(?:home|Users|root|work|mnt)/\w")
OUTSIDE_PATH = re.compile(r"\.\./shared\b")
# A source is cited by author and year; a note that is not in the repository helps nobody.
NOTE = re.compile(r"\b(?:THEORY|DESIGN)(?:[:,.)]|,? \d)|\bINTERFACE(?:[:,.]|,? \d)")
DOCUMENT = re.compile(r"\b([A-Z][A-Z_]{3,}\.md)\b")


def check_line(path, number, line, tree):
    if MACHINE_PATH.search(line) or OUTSIDE_PATH.search(line):
        yield f"{path}:{number}: a path of somebody's machine"
    if NOTE.search(line):
        yield f"{path}:{number}: cites a note that is not in the repository"
    for document in DOCUMENT.findall(line):
        if not any(other.rsplit("/", 1)[-1] == document for other in tree):
            yield f"{path}:{number}: {document} is not in the repository"
    if line != line.rstrip():
        yield f"{path}:{number}: white space at the end of the line"


def check_text(tree):
    problems = []
    for path, text in tree.items():
        if text is None or path.startswith("tests/style/"):
            continue
        lines = text.split("\n")
        if path.endswith(LICENSED) or path == ".ci/run":
            if not any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:3]):
                problems.append(f"{path}: no SPDX licence line at the top")
        if text and not text.endswith("\n"):
            problems.append(f"{path}: no newline at the end")
        if path == "LICENSE":
            continue
        for number, line in enumerate(lines, 1):
            problems.extend(check_line(path, number, line, tree))
    return problems


if __name__ == "__main__":
    sys.exit(main(check_text))
