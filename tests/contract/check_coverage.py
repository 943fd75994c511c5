# SPDX-License-Identifier: Apache-2.0
"""Every operation of the OpenAPI document, and every status that it names, was seen by prism in the
notes of the contract tests:   check_coverage.py DOCUMENT NOTES..."""
import json
import re
import sys

# What prism only validates, because it cannot carry it: (what, reason).
VALIDATED_ONLY = (
    (re.compile(r"^HEAD "), "the proxy drops the length that the answer is for"),
    (re.compile(r"/events$"), "a stream that is carried whole would never begin"),
    (re.compile(r"/(files|frames)/"), "bytes, which the proxy would read as text"),
)
# Statuses that no test can make: (operation, status, reason).
NEVER_SEEN = ()


def pattern(path):
    """Names of files have slashes."""
    text = re.escape(path).replace(r"/files/\{name\}", "/files/.+")
    return re.compile(re.sub(r"\\\{\w+\\\}", "[^/]+", text) + r"(\?|$)")


def place_of(paths, method, target):
    """The place that a request goes to, as the document writes it, or None."""
    found = [path for path, (expression, methods) in paths.items()
             if method in methods and expression.match(target)]
    # A place without parameters comes first, and that of pictures before that of frames.
    return min(found, key=lambda path: (path.count("{"), -len(path)), default=None)


def read_notes(files):
    for name in files:
        with open(name, encoding="utf-8") as file:
            for line in file:
                yield json.loads(line)


def main(document, *files):
    with open(document, encoding="utf-8") as file:
        entries = json.load(file)["paths"]
    paths = {path: (pattern(path), {method.upper() for method in entry})
             for path, entry in entries.items()}
    seen, carried = set(), set()
    for entry in read_notes(files):
        path = place_of(paths, entry["method"], entry["path"])
        if entry["routed"] and path is not None:
            seen.add((f"{entry['method']} {path}", str(entry["status"])))
            if entry["through"]:
                carried.add(f"{entry['method']} {path}")
    named = {(f"{method.upper()} {path}", status) for path, entry in entries.items()
             for method, operation in entry.items() for status in operation["responses"]}
    operations = {operation for operation, _ in named}
    exempt = {(operation, status) for operation, status, _ in NEVER_SEEN}
    missing = [f"{operation} was never answered with {status}"
               for operation, status in sorted(named - seen - exempt)]
    missing += [f"{operation}, {status}: was seen, and is on the list of what cannot be"
                for operation, status in sorted(exempt & seen)]
    missing += [f"{operation} never went through the proxy" for operation in sorted(operations - carried)
                if not any(expression.search(operation) for expression, _ in VALIDATED_ONLY)]
    print(f"{len(operations)} operations, {len(carried & operations)} of them through the proxy; "
          f"{len(named & seen)} of {len(named)} statuses seen")
    print("\n".join(missing))
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
