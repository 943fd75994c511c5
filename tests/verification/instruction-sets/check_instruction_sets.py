# SPDX-License-Identifier: Apache-2.0
"""The same energies from every instruction set that this processor has, and from each the same bits
for one thread and for two."""
import os
import subprocess
import sys

from verification import Verification, worker

INSTRUCTION_SETS = ("x86-64-v2", "x86-64-v3", "x86-64-v4")
STEPS = 1000
# What a step stores (a velocity, a strain) has been through some 100 roundings of at most 2^-53, which
# differ where multiplication and addition are fused: 1,000 steps differ by at most
# 1,000 * 100 * 2^-53 = 1.1e-11. A wave that runs a little faster turns that into a phase that grows
# with the number of radians, here fewer than ten: 1e-10 of the largest value that an energy takes.
TOLERANCE = 1e-10
# Energy -> the one whose largest value is its scale: what is lost is a small difference of large ones.
SCALES = {"energy.kinetic": "energy.kinetic", "energy.strain": "energy.strain",
          "energy.dissipated": "energy.dissipated", "energy.total": "energy.total",
          "energy.numerical": "energy.total"}


def scene(dimension, model, material, update):
    """A block, pushed against a wall, slumps under its weight between walls: nothing flies."""
    axes = 3 if dimension == "solid" else 2
    deep = [0.25][:axes - 2]
    planes = [("floor", 1, 0, {"condition": "friction", "friction_angle": 25}),
              ("left", 0, 0, {"condition": "slip"}), ("right", 0, 2, {"condition": "slip"}),
              ("low", 2, 0, {"condition": "slip"}), ("high", 2, 0.25, {"condition": "slip"})]
    boundaries = []
    for name, axis, place, rest in planes:
        if axis < axes:
            point, normal = [0] * axes, [0] * axes
            point[axis] = place
            normal[axis] = -1 if place else 1
            boundaries.append({"name": name, "plane": {"point": point, "normal": normal}, **rest})
    return {
        "title": f"{model}, {dimension}, {update}",
        "dimension": dimension,
        "duration": STEPS * 1e-4,
        "grid": {"cell": 0.125, "min": [0] * axes, "max": [2, 1.5] + deep},
        "solver": {"stress_update": update, "time_step": 1e-4,
                   "anti_locking": {"control": "cell", "field": "volumetric"}},
        "materials": {"m": {"model": model, **material}},
        "bodies": [{"material": "m", "box": {"min": [0] * axes, "max": [2, 1] + deep},
                    "particles_per_cell": [2] * axes, "velocity": [0.1] + [0] * (axes - 1)}],
        "gravity": [0, -9.81] + [0] * (axes - 2),
        "boundaries": boundaries,
        "output": {"history": {"every": 1e-3}, "frames": {"every": 0.1}},
    }


def run(verification, scene, isa, threads):
    os.environ["TALUS_ISA"] = isa
    result = verification.run(scene, threads)
    verification.equal("instruction set of the receipt", result.receipt["isa"], isa)
    verification.equal("steps", result.metrics["steps"], STEPS)
    return result


def energies_differ(a, b):
    """The largest difference of an energy over its scale, and which one it is."""
    return max((max(abs(x - y) for x, y in zip(a.series[name], b.series[name], strict=True)) /
                max(map(abs, a.series[scale])), name) for name, scale in SCALES.items())


def check(verification, available, scene):
    runs = []
    for isa in available:
        one = run(verification, scene, isa, 1)
        two = run(verification, scene, isa, 2)
        label = f"{scene['title']}, {isa}"
        verification.equal(f"{label}: state hash, 1 and 2 threads", two.receipt["state_hash"],
                           one.receipt["state_hash"])
        verification.equal(f"{label}: history.bin, 1 and 2 threads", two.digest("history.bin"),
                           one.digest("history.bin"))
        runs.append(one)
    for isa, other in zip(available[1:], runs[1:]):
        worst, name = energies_differ(runs[0], other)
        verification.below(f"{scene['title']}, {isa} and {available[0]}: largest difference of an "
                           f"energy over its largest value ({name})", worst, TOLERANCE)


def is_available(isa):
    """The worker says on its standard error why it cannot."""
    ended = subprocess.run([worker(), "version"], env={**os.environ, "TALUS_ISA": isa},
                           capture_output=True, text=True)
    if ended.returncode == 0 and not ended.stdout.rstrip().endswith(isa):
        sys.exit(f"TALUS_ISA={isa} gave {ended.stdout}")
    print(f"  {isa}: {ended.stderr.strip() or 'available'}")
    return ended.returncode == 0


os.environ["GOMP_SPINCOUNT"] = "0"  # threads that spin on a busy machine take each other's time
SOIL = {"density": 2000, "bulk_modulus": 8.33e6, "shear_modulus": 3.85e6}
verification = Verification("instruction sets")
available = [isa for isa in INSTRUCTION_SETS if is_available(isa)]
if len(available) < 2:
    print("only one instruction set: nothing to compare")
    sys.exit(77)
check(verification, available,
      scene("solid", "drucker_prager_cap",
            {**SOIL, "friction_angle": 20, "cone_strength": 1000, "flow_ratio": 0.05},
            "modified_last"))
check(verification, available,
      scene("plane_strain", "linear_elastic",
            {"density": 1000, "young_modulus": 5e5, "poisson_ratio": 0.3}, "last"))
check(verification, available,
      scene("plane_strain", "newtonian_fluid",
            {"density": 1000, "bulk_modulus": 2e6, "viscosity": 0.1}, "modified_last"))
verification.finish()
