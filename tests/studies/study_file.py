# SPDX-License-Identifier: Apache-2.0
"""Study files that programs write: how they look, and whether they are what would be written."""
import json
import sys

WIDTH = 120


def text_of(value, indent=0):
    """JSON with everything on one line that fits there."""
    flat = json.dumps(value)
    if not isinstance(value, (dict, list)) or not value or indent + len(flat) <= WIDTH:
        return flat
    inner = " " * (indent + 2)
    if isinstance(value, dict):
        parts = [f"{json.dumps(key)}: {text_of(part, indent + 2)}" for key, part in value.items()]
        brackets = "{}"
    else:
        parts = [text_of(part, indent + 2) for part in value]
        brackets = "[]"
    return f"{brackets[0]}\n{inner}" + f",\n{inner}".join(parts) + f"\n{' ' * indent}{brackets[1]}"


def write_or_check(folder, studies, check):
    """studies: file name -> study. With `check`, nothing is written and a difference ends the program."""
    stale = []
    for name, study in studies.items():
        path = folder / name
        text = text_of(study) + "\n"
        if not check:
            path.write_text(text)
        elif not path.exists() or path.read_text() != text:
            stale.append(name)
    if stale:
        sys.exit(f"not what {sys.argv[0]} writes: {', '.join(stale)}")
