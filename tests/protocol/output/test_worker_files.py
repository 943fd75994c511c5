# SPDX-License-Identifier: Apache-2.0
"""Every file of a finished run: readable, complete, with units, and in agreement."""
import base64
import csv
import hashlib
import json
import os
import shutil
import struct
import tempfile
import xml.etree.ElementTree

import h5py
import numpy

import worker_run


class FilesTest(worker_run.RunTest):
    # One run for all tests, which only read it; made by the first.
    shared = None

    def setUp(self):
        super().setUp()
        # More particles than a dataset is stored unpacked for.
        self.count = 3000
        if FilesTest.shared is None:
            self.make_shared()
        self.job = self.folder / "job"
        shutil.copytree(FilesTest.shared, self.job)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.shared, ignore_errors=True)

    def make_shared(self):
        output = {
            "frames": {"every": 0.25, "grid_fields": 7},
            "history": {"every": 0.01},
            "vtu": True,
        }
        references = [
            {"probe": "h", "value": 0.3},
            {"probe": "h", "name": "at", "value": 0.3, "at": 0.2},
            {"probe": "h", "name": "curve", "curve": [[0, 0.5], [0.5, 0.2], [1.0, 0.1]]},
        ]
        content = worker_run.scene(
            title=f"particles={self.count} warn=20", output=output, references=references
        )
        self.run_job(content, "job", "--quiet")
        FilesTest.shared = tempfile.mkdtemp(prefix="talus-shared-")
        os.rmdir(FilesTest.shared)
        (self.folder / "job").rename(FilesTest.shared)

    def series(self, name):
        series = json.loads((self.job / name).read_text())
        self.assertEqual(series["file-series-version"], "1.0")
        return series["files"]

    def assert_units(self, file):
        datasets = []
        file.visititems(
            lambda name, item: datasets.append(item) if isinstance(item, h5py.Dataset) else None
        )
        self.assertGreater(len(datasets), 5)
        for dataset in datasets:
            self.assertIn("units", dataset.attrs, dataset.name)
            dataset[()]
            self.assertIn(dataset.compression, (None, "gzip"))

    def test_frames_are_vtkhdf(self):
        frames = self.series("frames.hdf.series")
        self.assertEqual(len(frames), 5)
        for index, entry in enumerate(frames):
            with h5py.File(self.job / entry["name"]) as file:
                self.assert_units(file)
                root = file["VTKHDF"]
                self.assertEqual(list(root.attrs["Version"]), [1, 0])
                self.assertEqual(root.attrs["Type"], b"UnstructuredGrid")
                kind = root.attrs.get_id("Type").get_type()
                self.assertFalse(kind.is_variable_str())
                self.assertEqual(kind.get_cset(), h5py.h5t.CSET_ASCII)
                for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
                    self.assertEqual(list(root[name]), [self.count])
                self.assertEqual(root["Points"].shape, (self.count, 3))
                self.assertEqual(root["Points"].dtype, numpy.float32)
                numpy.testing.assert_array_equal(root["Connectivity"], range(self.count))
                numpy.testing.assert_array_equal(root["Offsets"], range(self.count + 1))
                self.assertEqual(root["Types"].dtype, numpy.uint8)
                self.assertTrue((root["Types"][:] == 1).all())
                self.assertEqual(root["FieldData/Time"][0], entry["time"])
                self.assertEqual(root["PointData/velocity"].shape, (self.count, 3))
                self.assertEqual(root["PointData/stress"].shape, (self.count, 6))
                self.assertEqual(root["PointData/stress"].attrs["units"], b"Pa")
                self.assertEqual(root["PointData/stress"][2, 3], 23)
                self.assertEqual(root["PointData/stress"].compression, "gzip")
                self.assertTrue(root["PointData/stress"].shuffle)
                self.assertEqual(root["PointData/id"].dtype, numpy.int64)
            # Nearest step end to k x every, with its true time; the last at the end.
            self.assertLessEqual(abs(entry["time"] - 0.25 * index), 0.0015 + 1e-12)
        self.assertEqual(frames[-1]["time"], 1.0)

    def test_grid_frames(self):
        with h5py.File(self.job / self.series("grid.hdf.series")[2]["name"]) as file:
            self.assert_units(file)
            data = file["VTKHDF/PointData"]
            self.assertEqual(sorted(data), ["area", "mass", "reaction", "velocity"])
            self.assertEqual(data["area"][1], 0.25)
            self.assertEqual(data["reaction"].attrs["units"], b"N")

    def test_vtu_holds_the_same_numbers(self):
        collection = xml.etree.ElementTree.parse(self.job / "vtk/frames.pvd").getroot()
        entries = collection.findall("Collection/DataSet")
        self.assertEqual(len(entries), 5)
        root = xml.etree.ElementTree.parse(self.job / "vtk" / entries[3].get("file")).getroot()
        text = root.find("AppendedData").text.strip()[1:]
        with h5py.File(self.job / "frames/frame_000003.hdf") as file:
            for array in root.iter("DataArray"):
                if array.get("format") != "appended":
                    continue
                start = int(array.get("offset"))
                size = struct.unpack("<Q", base64.b64decode(text[start : start + 12])[:8])[0]
                encoded = text[start : start + (8 + size + 2) // 3 * 4]
                values = numpy.frombuffer(
                    base64.b64decode(encoded)[8:], array.get("type").lower().replace("uint8", "u1")
                )
                name = array.get("Name")
                place = {
                    "position": "Points",
                    "connectivity": "Connectivity",
                    "types": "Types",
                }.get(name, "PointData/" + name)
                if name == "offsets":
                    expected = numpy.arange(1, self.count + 1)
                else:
                    expected = file["VTKHDF/" + place][:].ravel()
                numpy.testing.assert_array_equal(values, expected, name)

    def test_histories_agree(self):
        columns = json.loads((self.job / "history.json").read_text())
        names = [column["name"] for column in columns["columns"]]
        self.assertEqual(names[0], "time")
        self.assertEqual(columns["row_bytes"], 8 * len(names))
        rows = numpy.fromfile(self.job / "history.bin", "<f8").reshape(-1, len(names))
        self.assertEqual(rows[0, 0], 0.0)
        self.assertEqual(rows[-1, 0], 1.0)
        self.assertEqual(len(rows), 101)
        with open(self.job / "history.csv", newline="") as stream:
            table = list(csv.reader(stream))
        self.assertEqual(table[0], names)
        numpy.testing.assert_array_equal(numpy.array(table[1:], float), rows)
        with open(self.job / "reactions.csv", newline="") as stream:
            table = list(csv.reader(stream))
        chosen = [name for name in names if name == "time" or name.startswith("reaction.")]
        self.assertEqual(table[0], chosen)
        with h5py.File(self.job / "results.h5") as file:
            self.assert_units(file)
            numpy.testing.assert_array_equal(file["time"][:], rows[:, 0])
            series = {}
            for group in ("probes", "reactions", "energies", "others"):
                for dataset in file[group].values():
                    series[dataset.attrs["series"].decode()] = dataset[:]
            self.assertEqual(sorted(series), sorted(names[1:]))
            for name, values in series.items():
                numpy.testing.assert_array_equal(values, rows[:, names.index(name)])
            self.assertEqual(
                json.loads(file["scene"][()]), json.loads((self.job / "scene.json").read_text())
            )
            self.assertEqual(json.loads(file["receipt"][()])["outcome"], "succeeded")

    def test_metrics(self):
        metrics = self.events(kind="finished")[0]["metrics"]
        rows = numpy.fromfile(self.job / "history.bin", "<f8").reshape(101, -1)
        time, height = rows[:, 0], rows[:, -1]
        self.assertEqual(metrics["probe.h.final"], height[-1])
        self.assertEqual(metrics["probe.h.min"], height.min())
        self.assertEqual(metrics["probe.h.max"], height.max())
        self.assertEqual(metrics["probe.h.time_of_max"], time[height.argmax()])
        fine = numpy.union1d(time[time >= 0.5], [0.5])
        mean = numpy.trapz(numpy.interp(fine, time, height), fine) / 0.5
        self.assertAlmostEqual(metrics["probe.h.mean"], mean, 12)
        self.assertAlmostEqual(metrics["error.h"], abs(height[-1] - 0.3) / 0.3, 12)
        at = numpy.interp(0.2, time, height)
        self.assertAlmostEqual(metrics["error.at"], abs(at - 0.3) / 0.3, 12)
        times, values = numpy.array([0, 0.5, 1.0]), numpy.array([0.5, 0.2, 0.1])
        difference = numpy.interp(times, time, height) - values
        expected = (numpy.trapz(difference**2, times) / numpy.trapz(values**2, times)) ** 0.5
        self.assertAlmostEqual(metrics["error.curve"], expected, 12)
        self.assertIsNone(metrics["energy_error"])  # JSON has no NaN
        self.assertGreater(metrics["reaction.floor.peak"], 0)
        self.assertEqual(metrics["particle_steps"], 333 * self.count)
        for name in ("wall_seconds", "cpu_seconds", "peak_memory_bytes"):
            self.assertGreater(metrics[name], 0, name)

    def test_receipt(self):
        receipt = json.loads((self.job / "receipt.json").read_text())
        self.assertEqual(receipt["outcome"], "succeeded")
        self.assertEqual(receipt["metrics"], self.events(kind="finished")[0]["metrics"])
        names = [entry["file"] for entry in receipt["results"]]
        self.assertEqual(len(names), 7)
        for entry in receipt["results"]:
            content = (self.job / entry["file"]).read_bytes()
            self.assertEqual(entry["sha256"], hashlib.sha256(content).hexdigest())
            self.assertEqual(entry["bytes"], len(content))
        for key in ("scene_hash", "build", "compiler", "isa", "precision", "threads", "command", "state_hash"):
            self.assertTrue(receipt[key], key)

    def test_events(self):
        events = self.events()
        self.assertEqual([events[0]["event"], events[-1]["event"]], ["started", "finished"])
        self.assertIsNone(events[0]["resumed_from"])
        for event in events:
            self.assertRegex(event["at"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z$")
            self.assertEqual(event["attempt"], 1)
        rows = [event["rows"] for event in events if event["event"] == "history"]
        self.assertEqual(rows, sorted(set(rows)))
        self.assertEqual(rows[-1], 101)
        frames = [event for event in events if event["event"] == "frame"]
        self.assertEqual([frame["n"] for frame in frames], list(range(5)))
        for frame in frames:
            content = (self.job / frame["file"]).read_bytes()
            self.assertEqual(frame["sha256"], hashlib.sha256(content).hexdigest())
            self.assertEqual(frame["bytes"], len(content))
        warning = self.events(kind="warning")[0]
        self.assertEqual(warning["code"], "time_step")
        self.assertEqual(warning["pointer"], "/solver/time_step")

    def test_nothing_is_left_aside(self):
        self.assertEqual(list(self.job.rglob(".*")), [])

    def test_reference_of_another_job(self):
        reference = [{"probe": "h", "of_job": "job"}]
        content = worker_run.scene(title=f"particles={self.count}", references=reference)
        self.run_job(content, "other")
        self.assertEqual(self.events("other", "finished")[0]["metrics"]["error.h"], 0.0)
        reference[0]["of_job"] = "../job"
        self.run_job(worker_run.scene(references=reference), "third")
        self.assertIsNone(self.events("third", "finished")[0]["metrics"]["error.h"])
        self.assertIn("not a job id", self.events("third", "warning")[0]["detail"])

    def test_mean_of_a_reaction_is_its_impulse(self):
        """Rows of a reaction are means over the interval that they end."""
        probes = [{"name": "force", "boundary": "floor", "mean_from": 0.5051}]
        self.run_job(worker_run.scene(probes=probes), "means")
        rows = numpy.fromfile(self.folder / "means/history.bin", "<f8").reshape(101, -1)
        lengths = numpy.diff(numpy.maximum(rows[:, 0], 0.5051))
        expected = (rows[1:, -1] * lengths).sum() / lengths.sum()
        metrics = self.events("means", "finished")[0]["metrics"]
        self.assertAlmostEqual(metrics["probe.force.mean"], expected, 12)

    def test_names_need_not_be_whole_characters(self):
        """A long name that is cut inside a character does not end the run."""
        probes = [{"name": "x" + "ä" * 100}]
        self.run_job(worker_run.scene(probes=probes), "names")
        columns = json.loads((self.folder / "names/history.json").read_text())["columns"]
        self.assertTrue(columns[-1]["name"].startswith("probe.x"))

    def test_double_precision(self):
        output = {"frames": {"every": 0.5, "precision": "double"}, "history": {"every": 0.1}}
        self.run_job(worker_run.scene(output=output), "double")
        with h5py.File(self.folder / "double/frames/frame_000000.hdf") as file:
            self.assertEqual(file["VTKHDF/Points"].dtype, numpy.float64)
            self.assertEqual(file["VTKHDF/Points"][1, 1], 0.1 + 0.01)

    def test_looking_does_not_change_the_run(self):
        output = {"frames": {"every": 0.02}, "history": {"every": 0.01}}
        output["checkpoints"] = {"every": 0.005}
        self.run_job(worker_run.scene(title=f"particles={self.count}", output=output), "looked")
        self.assertGreater(len(self.frame_names("looked")), 45)
        self.assertGreater(len(self.events("looked", "checkpoint")), 0)
        self.assertEqual(self.digest("job", "history.bin"), self.digest("looked", "history.bin"))


if __name__ == "__main__":
    worker_run.main()
