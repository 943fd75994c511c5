# SPDX-License-Identifier: Apache-2.0
"""What advice claims to save, against what it saves, and what that does to the answer."""
import json
import math
import subprocess

from verification import FULL, Verification, on_linear_shapes, shipped_scene, worker

RUBBER = {"model": "linear_elastic", "density": 1000, "young_modulus": 1e6, "poisson_ratio": 0.3}
WAVE = math.sqrt(1e6 * 0.7 / (1.3 * 0.4) / 1000)  # [m/s] of the fastest wave in it

verification = Verification("advice-savings")


def plane(name, point, normal, condition="slip"):
    return {"name": name, "plane": {"point": point, "normal": normal}, "condition": condition}


def checked(scene):
    path = verification.new_folder() / "scene.json"
    path.write_text(json.dumps(on_linear_shapes(scene)))
    return json.loads(subprocess.run([worker(), "check", str(path), "--json"],
                                     capture_output=True, text=True, check=True).stdout)


def advised(scene, code):
    """The item of that code and the effective scene, followed where the item says how."""
    answer = checked(scene)
    item = next(each for each in answer["advice"] if each["code"] == code)
    effective = answer["effective"]
    for pointer, value in item.get("set", {}).items():
        place = effective
        *parents, last = pointer.split("/")[1:]
        for key in parents:
            place = place[int(key)] if isinstance(place, list) else place[key]
        place[int(last) if isinstance(place, list) else last] = value
    return item, effective


def particle_steps(run):
    return run.metrics["particles"] * run.metrics["steps"]


def factor(item):
    return next(iter(item["saving"].values()))


def saving(quantity, item, full, reduced, tolerance):
    """The factor that is claimed against the one of particle-steps, which are exact."""
    verification.relative(f"{quantity}: particle-steps saved, claimed for measured",
                          factor(item), particle_steps(full) / particle_steps(reduced), tolerance)
    verification.note(f"{quantity}: ratio of processor time",
                      full.metrics["cpu_seconds"] / reduced.metrics["cpu_seconds"],
                      "time on a busy machine")


def block(dimension, cells, **changes):
    """A rubber block of 1 m that lands on a floor, between smooth walls along z in 3D."""
    axes = 3 if dimension == "solid" else 2
    scene = {
        "title": f"block, {dimension}", "dimension": dimension, "duration": 0.12,
        "grid": {"cell": 1 / cells, "min": [0] * axes, "max": [4, 3, 1][:axes]},
        "materials": {"rubber": RUBBER}, "gravity": [0, -10, 0][:axes],
        "bodies": [{"name": "block", "material": "rubber", "particles_per_cell": 2,
                    "velocity": [0, -3, 0][:axes],
                    "box": {"min": [1, 0, 0][:axes], "max": [3, 1, 1][:axes]}}],
        "boundaries": [plane("floor", [0] * axes, [0, 1, 0][:axes], "stick")],
        "probes": [{"name": "middle", "kind": "centre_of_mass", "component": "y"}],
        "output": {"frames": {"every": 0}, "history": {"every": 1e-3}},
    }
    if dimension == "solid":
        scene["boundaries"] += [plane("near", [0, 0, 0], [0, 0, 1]),
                                plane("far", [0, 0, 1], [0, 0, -1])]
    scene.update(changes)
    return scene


def largest_gap(first, second, name, scale):
    """Largest difference of a series over the largest value of the first; the second is scaled."""
    pairs = list(zip(first.series[name], second.series[name], strict=True))
    return max(abs(a - scale * b) for a, b in pairs) / max(abs(a) for a, _ in pairs)


def check_uniform():
    scene = block("solid", 16 if FULL else 8)
    item, _ = advised(scene, "uniform_axis")
    solid = verification.run(scene)
    flat = verification.run(block("plane_strain", 16 if FULL else 8))
    saving("uniform along z", item, solid, flat, 1e-12)
    for name in ("reaction.floor.force.y", "energy.strain", "probe.middle"):
        verification.below(f"uniform along z: {name} per metre, largest difference",
                           largest_gap(solid, flat, name, 1.0), 1e-9)


def line_of(scene):
    """The shipped column, along its height only."""
    line = {key: scene[key] for key in ("duration", "solver", "materials")}
    body = dict(scene["bodies"][0], box={"min": [0], "max": [2]}, particles_per_cell=2)
    return dict(line, title="column on a line", dimension="line",
                grid={"cell": 0.25, "min": [0], "max": [2.5]}, gravity=[-10], bodies=[body],
                boundaries=[plane("floor", [0], [1])], output=scene["output"],
                probes=[{"name": "middle", "kind": "centre_of_mass", "component": "x"}])


def check_line():
    scene = shipped_scene("column-at-rest")
    scene["probes"].append({"name": "middle", "kind": "centre_of_mass", "component": "y"})
    item, _ = advised(scene, "uniform_axis")
    solid, line = verification.run(scene), verification.run(line_of(scene))
    saving("uniform along x and z", item, solid, line, 1e-12)
    verification.relative("uniform along x and z: floor [N]",
                          line.series["reaction.floor.force.x"][-1],
                          solid.series["reaction.floor.force.y"][-1], 1e-6)
    verification.relative("uniform along x and z: centre of mass [m]",
                          line.probe("middle")[-1], solid.probe("middle")[-1], 1e-6)


def check_mirror():
    cells = 32 if FULL else 8
    scene = block("plane_strain", cells)
    item, _ = advised(scene, "mirror_symmetry")
    half = block("plane_strain", cells, title="half of the block")
    half["bodies"][0]["box"] = {"min": [2, 0], "max": [3, 1]}
    half["boundaries"].append(plane("mirror", [2, 0], [1, 0]))
    whole, half = verification.run(scene), verification.run(half)
    saving("half", item, whole, half, 1e-12)
    verification.relative("half: twice the impulse on the floor [N s]",
                          2 * half.impulse("floor", "y"), whole.impulse("floor", "y"), 5e-3)
    verification.relative("half: twice the largest strain energy [J]",
                          2 * max(half.series["energy.strain"]),
                          max(whole.series["energy.strain"]), 1 / cells ** 3)


def check_revolution():
    cell, end = (0.05 if FULL else 0.1), 0.06
    common = {"duration": end, "materials": {"rubber": RUBBER},
              "output": {"frames": {"every": 0}, "history": {"every": 1e-3}}}
    quarter = dict(common, title="quarter of a cylinder", dimension="solid",
                   grid={"cell": cell, "min": [0, 0, 0], "max": [1, 1.5, 1]},
                   bodies=[{"material": "rubber", "particles_per_cell": 2, "velocity": [0, -3, 0],
                            "cylinder": {"from": [0, 0, 0], "to": [0, 0.5, 0], "radius": 0.5},
                            "clip": {"min": [0, None, 0], "max": [None, None, None]}}],
                   boundaries=[plane("floor", [0, 0, 0], [0, 1, 0]),
                               plane("x", [0, 0, 0], [1, 0, 0]), plane("z", [0, 0, 0], [0, 0, 1])])
    revolved = dict(common, title="cylinder, axisymmetric", dimension="axisymmetric",
                    grid={"cell": cell, "min": [0, 0], "max": [1, 1.5]},
                    bodies=[{"material": "rubber", "particles_per_cell": 2, "velocity": [0, -3],
                             "box": {"min": [0, 0], "max": [0.5, 0.5]}}],
                    boundaries=[plane("floor", [0, 0], [0, 1])])
    item, _ = advised(quarter, "body_of_revolution")
    solid, flat = verification.run(quarter), verification.run(revolved)
    saving("body of revolution", item, solid, flat, 0.1)
    verification.relative("body of revolution: impulse on the floor [N s]",
                          flat.impulse("floor", "y"), 4 * solid.impulse("floor", "y"), 0.03)


def bytes_of_frames(run):
    return sum(path.stat().st_size for path in (run.folder / "frames").iterdir())


def check_frames():
    """Frames of a block that flies: fewer, and of single precision."""
    scene = block("plane_strain", 8, output={"frames": {"every": 0.12 / 520},
                                             "history": {"every": 1e-2}})
    scene["solver"] = {"time_step": 1e-4}
    item, fewer = advised(scene, "many_frames")
    full, reduced = verification.run(scene), verification.run(fewer)
    count = [len(list((run.folder / "frames").glob("*.hdf"))) for run in (full, reduced)]
    verification.relative("fewer frames: files, claimed for measured", factor(item),
                          count[0] / count[1], 0.01)
    verification.relative("fewer frames: bytes, claimed for measured", factor(item),
                          bytes_of_frames(full) / bytes_of_frames(reduced), 0.1)
    verification.equal("fewer frames: the same run",
                       reduced.series["energy.strain"] == full.series["energy.strain"], True)

    scene = block("plane_strain", 64, duration=0.005,
                  output={"frames": {"every": 1e-4, "precision": "double"}})
    item, single = advised(scene, "double_frames")
    full, reduced = verification.run(scene), verification.run(single)
    ratio = bytes_of_frames(full) / bytes_of_frames(reduced)
    verification.between("single precision: bytes saved over claimed", ratio / factor(item),
                         0.9, 1.5)


def check_history():
    scene = block("plane_strain", 16, duration=1.2, output={"frames": {"every": 0},
                                                            "history": {"every": 1e-4}})
    item, coarser = advised(scene, "fine_history")
    full, reduced = verification.run(scene), verification.run(coarser)
    verification.relative("coarser history: rows, claimed for measured", factor(item),
                          len(full.time) / len(reduced.time), 0.1)
    verification.relative("coarser history: impulse on the floor [N s]",
                          reduced.impulse("floor", "y"), full.impulse("floor", "y"), 1e-9)


def check_time_step():
    scene = block("plane_strain", 8, duration=0.2, solver={"time_step": 0.02 * 1.26 / 8 / WAVE})
    item, automatic = advised(scene, "small_time_step")
    full, reduced = verification.run(scene), verification.run(automatic)
    saving("automatic step", item, full, reduced, 0.1)
    verification.relative("automatic step: impulse on the floor [N s]",
                          reduced.impulse("floor", "y"), full.impulse("floor", "y"), 0.01)
    verification.relative("automatic step: largest strain energy [J]",
                          max(reduced.series["energy.strain"]), max(full.series["energy.strain"]),
                          0.04)


def check_fine_grid():
    """A bar of 2,500 cells under its own weight, up to the turning point at 2 L / c."""
    wave = math.sqrt(1e6 / 1000)
    scene = {"title": "bar", "dimension": "line", "duration": 2 / wave,
             "grid": {"cell": 1 / 2500, "min": [0], "max": [1.1]},
             "materials": {"rubber": dict(RUBBER, poisson_ratio=0)}, "gravity": [-0.01],
             "bodies": [{"material": "rubber", "box": {"min": [0], "max": [1]},
                         "particles_per_cell": 2}],
             "boundaries": [plane("base", [0], [1], "stick")],
             "output": {"frames": {"every": 0}, "history": {"every": 1e-3}}}
    item, coarse = advised(scene, "fine_grid")
    full, reduced = verification.run(scene), verification.run(coarse)
    saving("coarser grid", item, full, reduced, 0.01)
    verification.relative("coarser grid: largest strain energy [J]",
                          max(reduced.series["energy.strain"]), max(full.series["energy.strain"]),
                          0.01)


def beam(control, duration=0.4):
    """A cantilever of 8 x 1 m in its first mode, cells of a quarter of its height."""
    return {"title": f"cantilever, {control}", "dimension": "plane_strain", "duration": duration,
            "grid": {"cell": 0.25, "min": [0, -4], "max": [10, 5]},
            "solver": {"anti_locking": {"control": control}},
            "materials": {"metal": dict(RUBBER, young_modulus=1e9)},
            "bodies": [{"material": "metal", "particles_per_cell": 2,
                        "box": {"min": [0, 0], "max": [8, 1]},
                        "velocity": {"beam_mode": {"mode": 1, "from": [0, 0.5], "to": [8, 0.5],
                                                   "tip": [0, 0.5]}}}],
            "boundaries": [plane("clamp", [0, 0], [1, 0], "stick")],
            "output": {"frames": {"every": 0}, "history": {"every": 5e-4}}}


def quarter_period(run):
    """Time of the first maximum of strain energy, by a parabola through three samples."""
    energy, time = run.series["energy.strain"], run.time
    k = next(k for k in range(1, len(energy) - 1) if energy[k - 1] < energy[k] >= energy[k + 1])
    bend = energy[k - 1] - 2 * energy[k] + energy[k + 1]
    return time[k] + (time[1] - time[0]) * 0.5 * (energy[k - 1] - energy[k + 1]) / bend


def check_superfluous():
    stiffness = 1e9 / (1 - 0.3 ** 2)
    theory = math.pi / 2 / (1.8751 ** 2 / 64 * math.sqrt(stiffness / 12 / 1000))
    times = {}
    for control in ("cell", "node"):
        item, plain = advised(beam(control), "superfluous_anti_locking")
        averaged = verification.run(beam(control))
        none = verification.run(dict(plain, title="cantilever, none"))
        times[control] = averaged.metrics["cpu_seconds"] / none.metrics["cpu_seconds"]
        verification.equal(f"without {control}: particle-steps", particle_steps(none),
                           particle_steps(averaged))
        if control == "cell":
            error = [abs(quarter_period(run) / theory - 1) for run in (none, averaged)]
            verification.below("without cell: quarter of a period against beam theory, error",
                               error[0], 0.05)
            verification.below("without cell: that error over the one with it",
                               error[0] / error[1], 1.0)
        else:
            kept = [(run.series["energy.strain"][-1] + run.series["energy.kinetic"][-1])
                    / run.series["energy.kinetic"][0] for run in (none, averaged)]
            verification.between("without node: energy after a period over that at the start",
                                 kept[0], 0.98, 1.02)
            verification.below("with node: the same", kept[1], 0.9)
        verification.note(f"processor time with {control} over none", times[control],
                          "time on a busy machine")


def check_slow_load():
    """A block that is pressed by a tenth of a per cent in 40 s."""
    scene = block("plane_strain", 4, duration=40)
    scene.update(title="pressed block", gravity=[0, 0])
    scene["bodies"][0].update(velocity=[0, 0], box={"min": [1, 0], "max": [2, 1]})
    scene["boundaries"] = [plane("floor", [0, 0], [0, 1]),
                           dict(plane("press", [0, 1], [0, -1], "velocity"),
                                velocity=[0, -2.5e-5], components=["y"], stays=False)]
    scene["output"]["history"]["every"] = 0.1
    item, fast = advised(scene, "quasi_static")
    slow, fast = verification.run(scene), verification.run(fast)
    saving("slow load", item, slow, fast, 0.01)
    exact = 1e6 / (1 - 0.3 ** 2) * 1e-3
    verification.relative("slow load: force at the end [N]",
                          abs(slow.series["reaction.press.force.y"][-1]), exact, 0.02)
    verification.relative("slow load, fast: force at the end [N]",
                          abs(fast.series["reaction.press.force.y"][-1]), exact, 0.02)


def swing(run, series):
    """Largest less smallest value in the last tenth of a run."""
    last = run.series[series][len(run.time) * 9 // 10:]
    return max(last) - min(last)


def check_constant_load():
    """The cantilever under a weight that is there at once. It may gain energy: as it is, it swings
    for fifty periods and more."""
    scene = beam("none", duration=40 if FULL else 21)
    scene.update(title="cantilever under its weight", gravity=[0, -1],
                 audits={"energy_growth": 1})
    scene["bodies"][0].pop("velocity")
    item, rest = advised(scene, "quasi_static")
    ringing, rest = verification.run(scene), verification.run(rest)
    saving("constant load", item, ringing, rest, 0.01)
    weight, length, shear = 8 * 1 * 1000, 8, 1e9 / 2.6
    bending = 1e9 / (1 - 0.3 ** 2) / 12
    energy = 1e6 * (length ** 5 / (40 * bending) + length ** 3 / (6 * 5 / 6 * shear))
    force = "reaction.clamp.force.y"
    verification.relative("constant load: force on the clamp at the end [N]",
                          -rest.series[force][-1], weight, 0.01)
    verification.below("constant load: its swing in the last tenth, over the weight",
                       swing(rest, force) / weight, 0.01)
    verification.above("without settling: the same", swing(ringing, force) / weight, 0.5)
    verification.relative("constant load: strain energy at the end [J]",
                          rest.series["energy.strain"][-1], energy, 0.03)


for check in (check_uniform, check_line, check_mirror, check_revolution, check_frames,
              check_history, check_time_step, check_fine_grid, check_superfluous, check_slow_load,
              check_constant_load):
    check()
verification.finish()
