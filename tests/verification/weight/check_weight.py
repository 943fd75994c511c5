# SPDX-License-Identifier: Apache-2.0
"""A column at rest pushes its floor with its weight, and its walls with K0 times the overburden."""
from verification import Verification, shipped_scene


def check_settled(verification):
    """Unloaded at t = 0; gravity grows over 0.3 s, local damping takes the motion away."""
    run = verification.run(shipped_scene("column-at-rest"))
    weight = 1950.55 * 10 * 2
    floor = run.mean("probe.weight", 1.2)
    verification.relative("settled column: floor against weight [N]", floor, -weight, 0.005)
    thrust = weight * 0.3 / 0.7  # nu / (1 - nu) of the weight, as the wall is as high as wide 2 : 1
    verification.relative("settled column: wall against nu / (1 - nu) of the overburden [N]",
                          run.mean("probe.thrust", 1.2), thrust, 0.01)
    verification.below("settled column: |floor peak to peak| over weight, last 0.3 s",
                       _spread(run, "probe.weight", 1.2) / weight, 1e-4)
    opposite = run.reaction("x_low", "x")[-1] + run.reaction("x_high", "x")[-1]
    verification.below("settled column: net thrust of opposite walls over one",
                       abs(opposite) / thrust, 1e-12)


def check_prestressed(verification):
    """With the geostatic stress as initial state nothing may move from the first step on."""
    scene = shipped_scene("column-at-rest")
    scene["title"] = "column with geostatic stress"
    scene["duration"] = 0.3
    scene["solver"]["stabilise"] = {}
    scene["references"] = []
    for probe in scene["probes"]:
        probe.pop("mean_from", None)
    scene["bodies"][0]["initial_stress"] = {"geostatic": {"k0": "elastic"}}
    run = verification.run(scene)
    weight = 1950.55 * 10 * 2
    worst = max(abs(value + weight) / weight for value in run.reaction("floor", "y")[1:])
    verification.below("geostatic start: largest deviation of the floor force from weight",
                       worst, 0.005)
    verification.below("geostatic start: kinetic energy over weight times 1 mm",
                       max(run.probe("kinetic")) / (weight * 1e-3), 1e-3)


def _spread(run, series, begin):
    late = [value for time, value in zip(run.time, run.series[series]) if time >= begin]
    return max(late) - min(late)


verification = Verification("weight")
check_settled(verification)
check_prestressed(verification)
verification.finish()
