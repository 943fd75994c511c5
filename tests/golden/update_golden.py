# SPDX-License-Identifier: Apache-2.0
"""Rewrites the steps of golden curves: update_golden.py TALUS-WORKER FILE.json ...

A golden file is {"document": what `talus-worker point` reads, "steps": what it answered}. Run this
only after a deliberate change of a model, and look at the difference before committing it."""
import json
import subprocess
import sys
import tempfile

KEPT = ("strain", "stress", "plastic_strain", "dissipation", "strain_energy", "state")


def run(worker, document):
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(document, file)
        file.flush()
        output = subprocess.run([worker, "point", file.name], check=True, capture_output=True)
    return [json.loads(line) for line in output.stdout.splitlines()]


def main(worker, paths):
    for path in paths:
        with open(path) as file:
            document = json.load(file)["document"]
        steps = [{key: step[key] for key in KEPT} for step in run(worker, document)]
        with open(path, "w") as file:
            file.write('{"document": ' + json.dumps(document, indent=1) + ',\n"steps": [\n')
            file.write(",\n".join(json.dumps(step) for step in steps) + "\n]}\n")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
