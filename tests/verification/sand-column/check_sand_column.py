# SPDX-License-Identifier: Apache-2.0
"""The collapse of a dry sand column (Mast 2013, sec. 7.2, a = 2, case 2) with both models, against
the band of the source's runs."""
from verification import FULL, Verification, shipped_scene

A = 2.0
CELL, LENGTH = 0.005, 0.05
# Lower and upper fit of the source for L = (l - l0) / l0 and H = h / l0, a > 1.5.
BANDS = {
    "drucker-prager": ((0.778 * A**0.725, 1.235 * A**0.754), (0.820 * A**0.381, 0.911 * A**0.461)),
    "matsuoka-nakai": ((1.089 * A**0.742, 1.518 * A**0.760), (0.741 * A**0.353, 0.860 * A**0.450)),
}


def scene(model):
    scene = shipped_scene("mast-7.2-sand-column-a2-case2-" + model)
    # The source's rule, "touching", read as within one cell, whose nodes the boundary holds.
    scene["probes"] += [
        {"name": "runout_cell", "kind": "front", "along": [1, 0], "measure": "centre_of_mass",
         "within": {"min": [None, None], "max": [None, CELL]}},
        {"name": "ridge_cell", "kind": "height", "measure": "centre_of_mass",
         "within": {"min": [None, None], "max": [CELL, None]}}]
    scene["output"]["frames"] = {"every": 1}
    if not FULL:
        scene["solver"]["time_step"] = "auto"
        scene["duration"] = 0.45
        for probe in scene["probes"]:
            probe.pop("mean_from", None)
    return scene


def check(verification, model):
    run = verification.run(scene(model))
    (low, high), (lowest, highest) = BANDS[model]
    settled = run.time[-1] - 0.1
    runout = run.probe("runout_cell")[-1] / LENGTH - 1
    verification.between(f"{model}: L of the floor cells, band +- 15 %", runout,
                         0.85 * low, 1.15 * high)
    verification.between(f"{model}: H of the cells at the axis, band +- 10 %",
                         run.probe("ridge_cell")[-1] / LENGTH, 0.9 * lowest, 1.1 * highest)
    for name, series in (("L, particles within h / 2 of the floor", "runout"),
                         ("H, particles within h / 2 of the axis", "ridge")):
        value = run.probe(series)[-1] / LENGTH - (series == "runout")
        verification.note(f"{model}: {name}", value, "the source does not define touching")
    verification.note(f"{model}: L of the outermost particle", run.probe("front")[-1] / LENGTH - 1,
                      "the source's L is twice a mean")
    verification.relative(f"{model}: floor force at rest against the weight [N/m]",
                          run.mean("reaction.floor.force.y", settled),
                          -2200 * 9.81 * LENGTH * A * LENGTH, 0.01)
    return runout, run


verification = Verification("sand-column")
short, dp = check(verification, "drucker-prager")
long, mn = check(verification, "matsuoka-nakai")
verification.above("Matsuoka-Nakai runs out further than Drucker-Prager: ratio of L", long / short, 1.1)
verification.below("Matsuoka-Nakai ends lower than Drucker-Prager: ratio of H",
                   mn.probe("ridge_cell")[-1] / dp.probe("ridge_cell")[-1], 0.97)
verification.finish()
