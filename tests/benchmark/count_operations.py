# SPDX-License-Identifier: Apache-2.0
"""Counts the floating-point operations of a step, and writes operation_counts.def.

callgrind counts how often the program for x86-64-v3 executes each of its instructions within
run_take_step; objdump says what they are. Additions, subtractions, multiplications, divisions and
square roots count one for each lane of the vector, fused multiply-adds two; comparisons, minima,
conversions and logic count nothing. The number is per slot walked, so lanes without a particle do
not count as work done.

usage: count_operations.py FOLDER_OF_PROGRAMS [CASE ...]
"""
import collections
import csv
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE / "operation_counts.def"
STEPS, PARTICLES, PASSES = 16, 4000, 3  # a measurement of one repeat: warm-up, plain, by stages
LOCKING = ("drucker_prager_cap_2d", "newtonian_fluid_2d", "drucker_prager_cap_3d")
ARITHMETIC = re.compile(r"v?(?:(fn?m(?:add|sub|addsub|subadd)(?:132|213|231))|"
                        r"(?:add|sub|mul|div|sqrt|addsub|hadd|hsub))([ps])([ds])$")
BYTES = {"xmm": 16, "ymm": 32, "zmm": 64}


def operations_of(mnemonic, operands):
    """Floating-point operations of one instruction."""
    match = ARITHMETIC.match(mnemonic)
    if not match:
        return 0
    fused, packed, precision = match.groups()
    width = max((BYTES[name] for name in re.findall(r"%([xyz]mm)", operands)), default=16)
    lanes = width // (8 if precision == "d" else 4) if packed == "p" else 1
    return lanes * (2 if fused else 1)


def disassemble(program):
    """Address -> operations, of the instructions that have any."""
    if not os.path.exists(program):
        return {}  # "???"
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", program], check=True,
                          capture_output=True, text=True).stdout
    found = {}
    for address, mnemonic, operands in re.findall(r"^ +([0-9a-f]+):\t(\S+)\s*(.*)$", text, re.M):
        count = operations_of(mnemonic, operands)
        if count:
            found[int(address, 16)] = count
    return found


def executed(profile):
    """(program, function, address) -> times executed, out of a callgrind profile."""
    counts = collections.Counter()
    program = function = None
    inclusive = False
    for line in pathlib.Path(profile).read_text().splitlines():
        if line.startswith("ob="):
            program = line[3:]
        elif line.startswith("fn="):
            function = line[3:]
        elif line.startswith("calls="):
            inclusive = True  # the next line is what the call cost
        elif line.startswith("0x"):
            if not inclusive:
                address, _, *cost = line.split()
                counts[program, function, int(address, 16)] += int(cost[0]) if cost else 0
            inclusive = False
    return counts


def measure(program, arguments, folder):
    """Operations per slot and step, and the functions in which they are."""
    profile, table = folder / "profile", folder / "row.csv"
    subprocess.run(
        ["valgrind", "--tool=callgrind", "--dump-instr=yes", "--compress-strings=no",
         "--compress-pos=no", "--collect-atstart=no", "--toggle-collect=run_take_step",
         f"--callgrind-out-file={profile}", program, *arguments, "--csv", table],
        check=True, env=dict(os.environ, TALUS_BENCHMARK_STARTED="1", OMP_NUM_THREADS="1"),
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    row = next(csv.DictReader(line for line in table.open() if not line.startswith("#")))
    slots = int(row["particles"]) / float(row["lane_fill"])
    programs, functions = {}, collections.Counter()
    for (name, function, address), count in executed(profile).items():
        if name not in programs:
            programs[name] = disassemble(name)
        functions[function] += count * programs[name].get(address, 0)
    steps = PASSES * STEPS
    return {name: count / slots / steps for name, count in functions.items() if count > 0}


def main():
    program = pathlib.Path(sys.argv[1]) / "talus-benchmark-x86-64-v3"
    listed = (HERE / "benchmark_case.c").read_text()
    cases = sys.argv[2:] or re.findall(r'^    \{"(\w+)", [23], ', listed, re.M)
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        for case in cases:
            for ordering in ("last", "modified_last"):
                for control in ("none", "cell") if case in LOCKING else ("none",):
                    functions = measure(
                        program, ["--case", case, "--ordering", ordering, "--anti-locking", control,
                                  "--particles", str(PARTICLES), "--steps", str(STEPS),
                                  "--repeats", "1"], pathlib.Path(folder))
                    total = sum(functions.values())
                    print(f"{case} {ordering} {control}: {total:.1f}")
                    for name, count in sorted(functions.items(), key=lambda item: -item[1])[:12]:
                        print(f"    {count:8.1f}  {name}")
                    lines.append(f"OPERATIONS({case}, {ordering}, {control}, {total:.1f})\n")
    if not sys.argv[2:]:
        head = [line for line in TABLE.read_text().splitlines(True) if line.startswith("/*")]
        TABLE.write_text("".join(head + lines))


main()
