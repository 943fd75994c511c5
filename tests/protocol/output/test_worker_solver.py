# SPDX-License-Identifier: Apache-2.0
"""The real worker: the promises of a run hold with the real solver behind it."""
import copy
import json
import os
import random
import resource
import signal
import time
import unittest

import h5py

import worker_run

SANITIZED = os.environ.get("TALUS_SANITIZE") == "ON"

# A heap of capped-cone soil that slides against an obstacle and in part out of the scene: contact,
# plastic flow, one-sided walls, elimination, anti-locking and automatic steps at once.
SCENE = {
    "title": "heap against an obstacle",
    "dimension": "solid",
    "duration": 0.4,
    "grid": {
        "cell": 0.5,
        "min": [0, 0, 0],
        "max": [8, 5, 3],
        "outside": "eliminate",
        "outside_mass_limit": 0.9,
    },
    "solver": {"shape": "linear", "anti_locking": {"control": "cell", "field": "volumetric"}},
    "materials": {
        "soil": {
            "model": "drucker_prager_cap",
            "density": 1950,
            "bulk_modulus": 8.33e6,
            "shear_modulus": 3.85e6,
            "friction_angle": 20,
            "cone_strength": 10,
            "flow_ratio": 0.05,
        }
    },
    "bodies": [
        {
            "name": "soil",
            "material": "soil",
            "box": {"min": [0, 0, 0], "max": [4, 2, 3]},
            "particles_per_cell": [2, 2, 2],
            "velocity": [3, 0, 0],
            "initial_stress": {"geostatic": {"k0": "auto"}},
        }
    ],
    "gravity": [0, -10, 0],
    "boundaries": [
        {
            "name": "bed",
            "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]},
            "condition": "friction",
            "friction_angle": 30,
        },
        {
            "name": "back",
            "plane": {"point": [0, 0, 0], "normal": [1, 0, 0]},
            "condition": "slip",
            "tension_release": True,
        },
        {
            "name": "column",
            "box": {"min": [4.5, 0, 1], "max": [5.5, 4, 2]},
            "condition": "slip",
            "tension_release": True,
        },
        {
            "name": "outlet",
            "plane": {"point": [5, 0, 0], "normal": [-1, 0, 0]},
            "condition": "eliminate",
        },
    ],
    "probes": [{"name": "load", "kind": "reaction", "boundary": "column", "component": "x"}],
    "output": {
        "frames": {"every": 0.1, "fields": ["velocity", "stress", "plastic_strain", "id"]},
        "history": {"every": 0.005},
        "checkpoints": {"every": 0.02},
    },
}


def scene(**changes):
    made = copy.deepcopy(SCENE)
    for path, value in changes.items():
        keys = path.split("__")
        place = made
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] = value
    return made


class SolverTest(worker_run.RunTest):
    def test_killed_and_resumed(self):
        # Sanitizers make a run several times slower.
        killed, most = (scene(duration=0.1), 3) if SANITIZED else (SCENE, 10)
        begin = time.monotonic()
        self.run_job(killed, "whole")
        whole = time.monotonic() - begin
        moments = random.Random(20261122)
        kills, options = 0, []
        while kills < most:
            process = self.start(killed, "job", *options)
            # Shares of a whole run, so that a fast machine is interrupted as often as a slow one.
            time.sleep(moments.uniform(0.1, 0.5) * whole)
            process.send_signal(signal.SIGKILL)
            process.communicate()
            if process.returncode == 0:
                break
            kills += 1
            options = ["--resume"]
        self.assertGreater(kills, 0)
        if process.returncode != 0:
            self.run_job(killed, "job", "--resume")
        self.assert_same_results("whole", "job")
        receipts = [
            json.loads((self.folder / job / "receipt.json").read_text()) for job in ("whole", "job")
        ]
        self.assertEqual(receipts[0]["state_hash"], receipts[1]["state_hash"])
        same = [name for name in receipts[0]["metrics"] if name.startswith(("reaction", "probe"))]
        self.assertGreater(len(same), 10)
        for name in same:
            self.assertEqual(receipts[0]["metrics"][name], receipts[1]["metrics"][name], name)

    def test_any_number_of_threads_gives_the_same_bits(self):
        short = scene(duration=0.05)
        self.run_job(short, "one")
        self.run_job(short, "two", "--threads", "2", "--all-threads")
        self.assert_same_results("one", "two")

    def test_looking_does_not_change_the_run(self):
        short = scene(duration=0.1)
        self.run_job(short, "one")
        short["output"]["frames"]["every"] = 0.01
        short["output"]["frames"]["grid_fields"] = ["mass", "velocity", "reaction"]
        short["output"]["checkpoints"]["every"] = 0.001
        self.run_job(short, "two")
        self.assertEqual(self.digest("one", "history.bin"), self.digest("two", "history.bin"))

    def test_every_field_can_be_written(self):
        described = (
            "displacement velocity stress mean_stress von_mises strain plastic_strain volume "
            "density deformation_gradient body material id mass"
        ).split()
        self.run_job(scene(duration=0.01, output__frames__fields=described))
        with h5py.File(self.folder / "job/frames/frame_000001.hdf") as file:
            data = file["VTKHDF/PointData"]
            self.assertEqual(sorted(data), sorted(described))
            for name in described:
                self.assertTrue(data[name].attrs["units"], name)
            self.assertAlmostEqual(float(data["mass"][:].sum()), 1950 * 24, 1)
            self.assertEqual(list(data["id"][:]), sorted(data["id"][:]))

    def test_steered_end(self):
        process = self.start(scene(duration=1000.0))
        self.wait_for("job", "progress")
        (self.folder / "job/control.json").write_text('{"end_time": 0.0}')
        process.send_signal(signal.SIGUSR1)
        self.wait_for("job", "warning")
        text = (self.folder / "job/history.json").read_text()
        self.assertIn("reaction.column.x_min.force.x", text)
        process.terminate()
        process.communicate(timeout=10)
        self.assertEqual(process.returncode, 12)

    def test_over_critical_step_is_refused(self):
        self.run_job(scene(solver__time_step=0.5), expect=10)

    def test_unknown_key_is_refused(self):
        errors = self.run_job(scene(gravitee=1), expect=10)
        self.assertIn("/gravitee", errors)

    @unittest.skipIf(SANITIZED, "sanitizers need address space")
    def test_out_of_memory(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (400 << 20, 400 << 20))

        # 7 million particles.
        big = scene(grid__cell=0.06)
        big["bodies"][0]["particles_per_cell"] = [4, 4, 4]
        self.run_job(big, expect=13, preexec_fn=limit)
        self.assertEqual(self.events()[-1]["reason"], "memory_limit")


if __name__ == "__main__":
    worker_run.main()
