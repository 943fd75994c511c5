# SPDX-License-Identifier: Apache-2.0
"""Frames as arrays of float32, against the HDF5 files they are cut from; and conditional reading of
everything that a job leaves behind."""
import io
import json
import struct
import unittest

import h5py
import numpy

from talus_harness import DaemonTest
from test_real_run import falling_block


def slice_of(data):
    """(header, {name: array}) of a slice; checks its layout."""
    length, = struct.unpack("<I", data[:4])
    assert length % 4 == 0
    header, base, arrays = json.loads(data[4:4 + length]), 4 + length, {}
    end = base
    for field in header["fields"]:
        assert base + field["offset"] == end, "arrays follow each other"
        values = numpy.frombuffer(data, "<f4", header["count"] * field["components"], end)
        end += values.nbytes
        shape = (header["count"], field["components"])
        arrays[field["name"]] = values.reshape(shape if field["components"] > 1 else shape[:1])
    assert end == len(data)
    return header, arrays


class Results(DaemonTest):
    real = True

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        client = cls.daemon.client()
        scene = falling_block()
        scene["output"]["frames"]["fields"] = ["velocity", "stress", "id", "mass"]
        reply = client.post("/v1/jobs", {"scene": scene})
        assert reply.status == 201, reply
        cls.base = f"/v1/jobs/{reply.json()['id']}"
        cls.job = client.finish(reply.json()["id"], 60)

    def get(self, path, **headers):
        reply = self.client.get(self.base + path, **headers)
        self.assertEqual(reply.status, 200, reply)
        return reply

    def file(self, number):
        data = self.get(f"/files/frames/frame_{number:06d}.hdf").body
        with h5py.File(io.BytesIO(data)) as file:
            group = file["VTKHDF"]
            arrays = {name: group["PointData"][name][...] for name in group["PointData"]}
            units = {name: group["PointData"][name].attrs["units"] for name in arrays}
            return dict(arrays, position=group["Points"][...]), units

    def test_members_of_a_job(self):
        """Every name that is promised is there."""
        for name in ("id", "name", "labels", "state", "reason", "detail", "created_at", "started_at",
                     "finished_at", "attempts", "progress", "forecast", "advice", "metrics", "receipt",
                     "links", "priority", "threads", "limits", "retries", "cancel_requested"):
            self.assertIn(name, self.job)
        for name in ("fraction", "time", "step", "time_step", "particles",
                     "particle_steps_per_second", "eta_seconds"):
            self.assertIn(name, self.job["progress"])
        for name in ("particles", "active_cells", "critical_time_step", "steps", "memory_bytes",
                     "disk_bytes", "wall_seconds"):
            self.assertIn(name, self.job["forecast"])
        for name in ("probe.top.final", "probe.top.min", "probe.top.max", "probe.top.time_of_max",
                     "reaction.floor.peak", "reaction.floor.peak_time", "energy_error",
                     "energy_numerical", "momentum_error", "mass_error", "wall_seconds",
                     "cpu_seconds", "peak_memory_bytes", "particle_steps_per_second"):
            self.assertIn(name, self.job["metrics"])
        receipt = self.job["receipt"]
        for name in ("scene_hash", "build", "compiler", "isa", "threads", "results", "command"):
            self.assertTrue(receipt[name], name)
        self.assertEqual(receipt, self.get("/files/receipt.json").json())

    def test_list(self):
        frames = self.get("/frames").json()
        self.assertEqual([frame["n"] for frame in frames], [0, 1, 2, 3])
        for frame in frames:
            self.assertEqual(set(frame), {"n", "time", "step", "particles", "fields", "bytes", "sha256"})
            self.assertEqual(frame["particles"], 256)
            self.assertEqual(set(frame["fields"]), {"velocity", "stress", "id", "mass"})
        self.assertEqual(frames[0]["time"], 0)

    def test_whole_frames(self):
        for number in (0, 3):
            reply = self.get(f"/frames/{number}?format=f32")
            self.assertEqual(reply.headers["content-type"], "application/octet-stream")
            header, arrays = slice_of(reply.body)
            stored, units = self.file(number)
            self.assertEqual((header["frame"], header["count"], header["stride"]), (number, 256, 1))
            self.assertEqual(header["fields"][0]["name"], "position")
            self.assertEqual(set(arrays), set(stored))
            for field in header["fields"][1:]:
                unit = units[field["name"]]
                self.assertEqual(field["unit"], unit.decode() if isinstance(unit, bytes) else unit)
            for name, values in arrays.items():
                numpy.testing.assert_array_equal(values, stored[name].astype("<f4"), name)

    def test_fields_and_stride(self):
        stored, _ = self.file(2)
        for stride, count in ((1, 256), (3, 86), (255, 2), (256, 1), (100000, 1)):
            header, arrays = slice_of(self.get(f"/frames/2?fields=stress,id&stride={stride}").body)
            self.assertEqual((header["count"], header["stride"]), (count, stride))
            self.assertEqual([field["name"] for field in header["fields"]],
                             ["position", "stress", "id"])
            for name, values in arrays.items():
                numpy.testing.assert_array_equal(values, stored[name][::stride].astype("<f4"), name)
        _, arrays = slice_of(self.get("/frames/2?fields=position").body)
        self.assertEqual(set(arrays), {"position"})

    def test_refusals(self):
        problem = self.assert_problem(self.client.get(self.base + "/frames/0?fields=velocity,colour"),
                                      422, "unknown_value")
        error, = problem["errors"]
        self.assertEqual((error["parameter"], error["given"]), ("fields", "colour"))
        self.assertEqual(set(error["allowed"]), {"velocity", "stress", "id", "mass"})
        for query in ("fields=", "fields=velocity,", "stride=0", "stride=-1", "stride=1.5", "stride=x",
                      "format=f64", "field=velocity", "fields=../x", "stride=1&stride=2"):
            with self.subTest(query):
                self.assert_problem(self.client.get(f"{self.base}/frames/0?{query}"), 422)
        for number in ("4", "-1", "x", "99999999999999999999"):
            self.assert_problem(self.client.get(f"{self.base}/frames/{number}"), 404)

    def test_conditions(self):
        for path in ("", "/series", "/series/probe.top", "/series/probe.top?max_points=10", "/frames",
                     "/frames/1", "/frames/1?stride=2", "/frames/1.png", "/files",
                     "/files/history.csv", "/files/receipt.json"):
            with self.subTest(path):
                first = self.get(path)
                etag = first.headers["etag"]
                self.assertRegex(etag, r'^"[^"]+"$')
                again = self.client.get(self.base + path, if_none_match=etag)
                self.assertEqual((again.status, again.body), (304, b""), again)
                self.assertEqual(again.headers["etag"], etag)
                self.assertEqual(self.get(path, if_none_match='"another"').body, first.body)
                many = self.client.get(self.base + path, if_none_match=f'"x", W/{etag}')
                self.assertEqual(many.status, 304)
                head = self.client.request("HEAD", self.base + path)
                self.assertEqual((head.status, head.headers["etag"]), (200, etag))
        etag = self.get("/series/probe.top", accept="text/csv").headers["etag"]
        self.assertNotEqual(etag, self.get("/series/probe.top").headers["etag"])
        self.assertNotEqual(self.get("/frames/1").headers["etag"],
                            self.get("/frames/2").headers["etag"])
        for path in ("/frames/1", "/files/history.csv"):
            self.assert_problem(self.client.get(self.base + path, if_match='"other"'), 412)

    def test_schema_is_conditional(self):
        for path in ("/v1/schema/scene",):
            etag = self.client.get(path).headers["etag"]
            self.assertEqual(self.client.get(path, if_none_match=etag).status, 304)


if __name__ == "__main__":
    unittest.main()
