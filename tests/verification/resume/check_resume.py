# SPDX-License-Identifier: Apache-2.0
"""A run that is stopped or killed and resumed from its checkpoint ends with the same bits as one
that was left alone: state, history, frames."""
import signal

from verification import Run, Verification

EVERY = 0.05


def scene():
    return {
        "title": "column that collapses, stopped on the way",
        "dimension": "plane_strain",
        "duration": 0.5,
        "grid": {"cell": 0.05, "min": [0, 0], "max": [5, 2.5]},
        "solver": {"anti_locking": {"control": "cell", "field": "volumetric"}},
        "materials": {
            "sand": {"model": "matsuoka_nakai", "density": 2000, "bulk_modulus": 8e6,
                     "shear_modulus": 4e6,
                     "friction": {"a0": 35, "a1": 9, "a3": 0.3, "a4": 10, "strain_scale": 100}}},
        "bodies": [{"material": "sand", "box": {"min": [0, 0], "max": [1, 2]},
                    "particles_per_cell": [3, 3], "initial_stress": {"geostatic": {"k0": "auto"}}}],
        "gravity": [0, -9.81],
        "boundaries": [
            {"name": "axis", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip"},
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
             "condition": "friction", "friction_angle": 65, "peak_window": 0.01}],
        "probes": [{"name": "front", "kind": "front", "along": [1, 0], "mean_from": 0.2}],
        "output": {"history": {"every": 0.002}, "frames": {"every": EVERY},
                   "checkpoints": {"every": 0.2}},
    }


def compare(verification, label, whole, resumed):
    verification.equal(f"{label}: state hash", resumed.receipt["state_hash"],
                       whole.receipt["state_hash"])
    verification.equal(f"{label}: history.bin", resumed.digest("history.bin"),
                       whole.digest("history.bin"))
    frames = sorted(path.name for path in (whole.folder / "frames").glob("frame_*.hdf"))
    different = [name for name in frames
                 if resumed.digest("frames/" + name) != whole.digest("frames/" + name)]
    verification.equal(f"{label}: frames that differ, of {len(frames)}", len(different), 0)
    physical = {name: value for name, value in whole.metrics.items()
                if not name.endswith(("_seconds", "_bytes", "_per_second"))}
    other = {name: value for name, value in physical.items() if resumed.metrics[name] != value}
    verification.equal(f"{label}: physical metrics that differ", sorted(other), [])


def resume(verification, label, whole, signal_number, is_time, threads):
    folder = verification.new_folder()
    verification.interrupt(scene(), folder, signal_number, is_time)
    verification.equal(f"{label}: unfinished before it is resumed",
                       (folder / "receipt.json").exists() and
                       Run(folder, 0, "").receipt.get("outcome") == "succeeded", False)
    compare(verification, label, whole,
            verification.run(scene(), threads=threads, folder=folder, options=["--resume"]))


def frame_exists(number):
    return lambda folder: (folder / "frames" / f"frame_{number:06d}.hdf").exists()


def checkpoint_and_frame(number):
    return lambda folder: (folder / "checkpoint.h5").exists() and frame_exists(number)(folder)


verification = Verification("resume")
whole = verification.run(scene())
resume(verification, "stopped by SIGTERM early", whole, signal.SIGTERM, frame_exists(1), 1)
resume(verification, "stopped by SIGTERM late, resumed with 2 threads", whole, signal.SIGTERM,
       frame_exists(6), 2)
resume(verification, "killed after a checkpoint", whole, signal.SIGKILL, checkpoint_and_frame(4), 1)
resume(verification, "killed before a checkpoint", whole, signal.SIGKILL, frame_exists(0), 1)
verification.finish()
