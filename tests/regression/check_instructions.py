# SPDX-License-Identifier: Apache-2.0
"""Counts the instructions of the solver's steps with callgrind and compares them with the recorded
ones of this compiler. Seconds depend on what else the machine does, instructions do not.

usage: check_instructions.py PROGRAM INSTRUCTIONS.csv [--record]

Exit code 77: nothing was compared, because valgrind or figures for this compiler are missing; with
TALUS_REGRESSION=required in the environment that is a failure.
"""
import csv
import os
import re
import shutil
import subprocess
import sys

# More than a compiler's whims over unrelated changes of the source, less than anything that matters.
TOLERANCE = 0.03
SKIPPED = 77
COLUMNS = ("compiler", "scene", "instructions_per_particle_step")
RECORD = "tests/regression/record"


def skip(reason):
    required = os.environ.get("TALUS_REGRESSION") == "required"
    print(f"{'FAILED' if required else 'skipped'}: {reason}")
    sys.exit(1 if required else SKIPPED)


def measure(program, scene):
    """Compiler, and instructions per particle and step."""
    ended = subprocess.run(
        ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no",
         "--toggle-collect=regression_counted_steps", program, scene],
        env={**os.environ, "OMP_NUM_THREADS": "1"}, capture_output=True, text=True)
    counted = re.search(r"Collected : (\d+)", ended.stderr)
    if ended.returncode != 0 or counted is None or int(counted[1]) == 0:
        sys.exit(f"{scene}: exit code {ended.returncode}\n{ended.stdout}{ended.stderr[-2000:]}")
    build, isa, particle_steps = ended.stdout.splitlines()[-3:]
    return f"{build.partition(' ')[2].strip()} {isa}", int(counted[1]) / int(particle_steps)


def read_records(path):
    with open(path, newline="") as file:
        return {(row["compiler"], row["scene"]): float(row[COLUMNS[2]])
                for row in csv.DictReader(line for line in file if not line.startswith("#"))}


def write_records(path, records):
    with open(path, "w", newline="") as file:
        file.write("# SPDX-License-Identifier: Apache-2.0\n")
        file.write(f"# Written by {RECORD}.\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for (compiler, scene), figure in sorted(records.items()):
            writer.writerow((compiler, scene, f"{figure:.1f}"))


def judge(scene, figure, recorded):
    """Prints the comparison; False if it is a regression."""
    change = figure / recorded - 1
    verdict = "ok"
    if change > TOLERANCE:
        verdict = "FAILED"
    elif change < -TOLERANCE:
        verdict = "faster"
    print(f"{verdict:7} {scene:24} {figure:8.1f} instructions per particle and step, "
          f"recorded {recorded:8.1f}, {100 * change:+5.1f} %")
    if verdict == "faster":
        print(f"        keep the gain: {RECORD}, and commit what it writes")
    return verdict != "FAILED"


def check(program, scenes, records):
    good = True
    for scene in scenes:
        compiler, figure = measure(program, scene)
        if not any(known == compiler for known, _ in records):
            skip(f"no figures for {compiler}; {RECORD} writes them")
        recorded = records.get((compiler, scene))
        if recorded is None:
            print(f"FAILED  {scene}: no figure for {compiler}; {RECORD} writes it")
        good &= recorded is not None and judge(scene, figure, recorded)
    if not good:
        print(f"If what is gained is worth more than {100 * TOLERANCE:g} %, say so in the commit and "
              f"run {RECORD}.")
    return good


def record(program, scenes, records, path):
    measured = {}
    for scene in scenes:
        compiler, measured[scene] = measure(program, scene)
        before = records.get((compiler, scene))
        print(f"{scene:24} {measured[scene]:8.1f}" + (f", was {before:8.1f}" if before else ""))
    kept = {key: figure for key, figure in records.items() if key[0] != compiler}
    write_records(path, {**kept, **{(compiler, scene): figure
                                    for scene, figure in measured.items()}})


def main(program, path, is_recording):
    if shutil.which("valgrind") is None:
        skip("valgrind is not installed (deploy/install-dependencies.sh --checks)")
    scenes = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
    records = read_records(path)
    if is_recording:
        record(program, scenes, records, path)
        return 0
    return 0 if check(program, scenes, records) else 1


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["--record"]):
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(sys.argv[1], sys.argv[2], len(sys.argv) == 4))
