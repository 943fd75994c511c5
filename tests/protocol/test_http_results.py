# SPDX-License-Identifier: Apache-2.0
"""What a job leaves: files with ranges, series, log, pictures."""
import csv
import io
import os
import unittest

from talus_harness import DaemonTest, sha256, wait_for

ROWS = 4000
SPIKE = 1777


class Results(DaemonTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        client = cls.daemon.client()
        cls.job = client.submit({"rows": ROWS, "spike": SPIKE, "flush": 500, "checkpoint": 0,
                                 "frames": 3, "seconds": 0.1, "frame_bytes": 300000})["id"]
        assert client.finish(cls.job)["state"] == "succeeded"
        cls.base = f"/v1/jobs/{cls.job}"

    # ---- files ----
    def files(self):
        reply = self.client.get(self.base + "/files")
        self.assertEqual(reply.status, 200, reply)
        listing = reply.json()
        listing = listing["files"] if isinstance(listing, dict) else listing
        return {file["name"]: file for file in listing}

    def test_listing_agrees_with_the_contents(self):
        files = self.files()
        expected = {"scene.json", "events.ndjson", "history.bin", "history.json", "history.csv",
                    "receipt.json", "frames/frame_000000.hdf", "frames/frame_000003.hdf"}
        self.assertLessEqual(expected, set(files))
        for name, file in files.items():
            with self.subTest(name=name):
                self.assertFalse(name.endswith((".part", ".tmp", "~")), name)
                reply = self.client.get(f"{self.base}/files/{name}")
                self.assertEqual(reply.status, 200)
                size = file.get("bytes", file.get("size"))
                self.assertEqual(len(reply.body), size)
                if file.get("sha256"):
                    self.assertEqual(sha256(reply.body), file["sha256"])
        self.assertTrue(any(file.get("sha256") for file in files.values()))
        self.assertNotIn("job.lock", files)

    def test_ranges(self):
        path = self.base + "/files/frames/frame_000001.hdf"
        whole = self.client.get(path)
        size = len(whole.body)
        self.assertEqual(whole.headers["accept-ranges"], "bytes")
        for text, begin, end in (("bytes=0-99", 0, 100), ("bytes=100-", 100, size),
                                 ("bytes=-50", size - 50, size), ("bytes=0-0", 0, 1),
                                 (f"bytes={size - 1}-{size + 5}", size - 1, size),
                                 (f"bytes=-{size * 2}", 0, size)):
            with self.subTest(range=text):
                part = self.client.get(path, range=text)
                self.assertEqual(part.status, 206, part)
                self.assertEqual(part.body, whole.body[begin:end])
                self.assertEqual(part.headers["content-range"], f"bytes {begin}-{end - 1}/{size}")
                self.assertEqual(part.headers["etag"], whole.headers["etag"])

    def test_ranges_that_cannot_be(self):
        path = self.base + "/files/frames/frame_000001.hdf"
        size = len(self.client.get(path).body)
        for text in (f"bytes={size}-", f"bytes={size + 10}-{size + 20}", "bytes=-0"):
            with self.subTest(range=text):
                reply = self.client.get(path, range=text)
                self.assertEqual(reply.status, 416, reply)
                self.assertEqual(reply.headers["content-range"], f"bytes */{size}")
        # RFC 9110, 14.2: a range that is not understood is ignored.
        for text in ("bytes=9-5", "lines=1-2", "bytes=a-b", "bytes", "bytes=99999999999999999999-"):
            with self.subTest(range=text):
                reply = self.client.get(path, range=text)
                self.assertIn(reply.status, (200, 416), reply)
                if reply.status == 200:
                    self.assertEqual(len(reply.body), size)

    def test_several_ranges_never_lie(self):
        path = self.base + "/files/frames/frame_000001.hdf"
        whole = self.client.get(path)
        reply = self.client.get(path, range="bytes=0-9,20-29")
        self.assertIn(reply.status, (200, 206))
        if reply.status == 200:
            self.assertEqual(reply.body, whole.body)
        else:
            self.assertIn("multipart/byteranges", reply.headers["content-type"])

    def test_conditions(self):
        path = self.base + "/files/frames/frame_000002.hdf"
        whole = self.client.get(path)
        etag = whole.headers["etag"]
        self.assertRegex(etag, r'^"[^"]+"$')
        self.assertEqual(self.client.get(path, if_none_match=etag).status, 304)
        self.assertEqual(self.client.get(path, if_none_match=f'"x", {etag}').status, 304)
        self.assertEqual(self.client.get(path, if_none_match="*").status, 304)
        self.assertEqual(self.client.get(path, if_none_match='"x"').status, 200)
        part = self.client.get(path, range="bytes=5-9", if_range=etag)
        self.assertEqual((part.status, part.body), (206, whole.body[5:10]))
        full = self.client.get(path, range="bytes=5-9", if_range='"other"')
        self.assertEqual((full.status, len(full.body)), (200, len(whole.body)))
        weak = self.client.get(path, range="bytes=5-9", if_range="W/" + etag)
        self.assertEqual(weak.status, 200)

    def test_head(self):
        path = self.base + "/files/frames/frame_000002.hdf"
        whole = self.client.get(path)
        head = self.client.request("HEAD", path)
        self.assertEqual((head.status, head.body), (200, b""))
        for name in ("content-length", "etag", "content-type", "accept-ranges"):
            self.assertEqual(head.headers[name], whole.headers[name])

    def test_names_that_must_not_be_served(self):
        secret = os.path.join(self.daemon.state, "secret.txt")
        with open(secret, "w", encoding="utf-8") as file:
            file.write("secret")
        folder = self.daemon.job_folder(self.job)
        os.symlink(secret, os.path.join(folder, "link.txt"))
        try:
            for name in ("../secret.txt", "..%2fsecret.txt", "%2e%2e/secret.txt", "frames/../../secret.txt",
                         "/etc/passwd", "%2fetc%2fpasswd", "frames", "frames/", "nosuchfile", "link.txt",
                         "scene.json%00.txt", "", ".", "..", "./scene.json", "frames//frame_000000.hdf",
                         "..%5csecret.txt", "job.lock"):
                with self.subTest(name=name):
                    reply = self.client.get(f"{self.base}/files/{name}")
                    if name == "":
                        self.assertIn(reply.status, (200, 308, 404))
                    else:
                        self.assertIn(reply.status, (400, 403, 404), reply)
                    self.assertNotIn(b"secret", reply.body[:100] if reply.status == 200 else b"")
        finally:
            os.unlink(os.path.join(folder, "link.txt"))

    def test_scene_is_the_effective_one(self):
        reply = self.client.get(self.base + "/files/scene.json")
        self.assertEqual(reply.headers["content-type"].split(";")[0], "application/json")
        self.assertEqual(reply.json()["dimension"], "plane_strain")
        self.assertIn("fake", reply.json()["title"])

    def test_file_grows_while_it_is_read(self):
        job = self.client.submit({"rows": 200, "seconds": 1.0})["id"]
        path = f"/v1/jobs/{job}/files/history.bin"
        wait_for(lambda: self.client.get(path).status == 200, 10, "history.bin")
        sizes = []
        while self.client.job(job)["state"] not in ("succeeded", "failed"):
            reply = self.client.get(path)
            self.assertEqual(int(reply.headers["content-length"]), len(reply.body))
            sizes.append(len(reply.body))
        self.assertEqual(sizes, sorted(sizes))
        self.assertEqual(len(self.client.get(path).body), 201 * 32)

    # ---- series ----
    def series(self, name, query="", **headers):
        reply = self.client.get(f"{self.base}/series/{name}{query}", **headers)
        self.assertEqual(reply.status, 200, reply)
        return reply

    def test_names(self):
        reply = self.client.get(self.base + "/series")
        self.assertEqual(reply.status, 200)
        text = reply.body.decode()
        for name in ("energy.kinetic", "reaction.wall.force.x", "probe.runout"):
            self.assertIn(f'"{name}"', text)
        self.assert_problem(self.client.get(self.base + "/series/probe.nothing"), 404)

    def test_whole(self):
        data = self.series("probe.runout").json()
        self.assertEqual(data["name"], "probe.runout")
        self.assertEqual(data["unit"], "m")
        self.assertIs(data["decimated"], False)
        self.assertEqual(data["time"], [k / ROWS for k in range(ROWS + 1)])
        self.assertEqual(data["value"], [2.0 * k for k in range(ROWS + 1)])

    def test_decimation_keeps_the_peaks(self):
        full = self.series("reaction.wall.force.x").json()
        for points in (10, 64, 100, 999, 3999):
            with self.subTest(max_points=points):
                data = self.series("reaction.wall.force.x", f"?max_points={points}").json()
                self.assertIs(data["decimated"], True)
                self.assertLessEqual(len(data["time"]), points)
                self.assertGreaterEqual(len(data["time"]), points // 4)
                self.assertEqual(data["time"], sorted(set(data["time"])))
                pairs = set(zip(full["time"], full["value"]))
                self.assertLessEqual(set(zip(data["time"], data["value"])), pairs)
                self.assertIn((SPIKE / ROWS, 1e6), set(zip(data["time"], data["value"])))
                self.assertEqual(min(data["value"]), min(full["value"]))
        data = self.series("reaction.wall.force.x", "?max_points=4001").json()
        self.assertIs(data["decimated"], False)

    def test_window(self):
        data = self.series("probe.runout", "?from=0.25&to=0.5").json()
        self.assertEqual(data["time"], [k / ROWS for k in range(1000, 2001)])
        data = self.series("probe.runout", "?from=0.9").json()
        self.assertEqual(data["time"][0], 0.9)
        data = self.series("probe.runout", "?from=5").json()
        self.assertEqual((data["time"], data["value"]), ([], []))
        data = self.series("reaction.wall.force.x", "?from=0.4&to=0.5&max_points=20").json()
        self.assertIn(1e6, data["value"])
        self.assertGreaterEqual(min(data["time"]), 0.4)

    def test_bad_window(self):
        for query in ("?from=x", "?to=", "?max_points=0", "?max_points=-5", "?max_points=abc",
                      "?from=nan", "?form=0.1"):
            with self.subTest(query=query):
                reply = self.client.get(f"{self.base}/series/probe.runout{query}")
                self.assert_problem(reply, reply.status)
                self.assertIn(reply.status, (400, 422))

    def test_csv(self):
        reply = self.series("probe.runout", accept="text/csv")
        self.assertEqual(reply.headers["content-type"].split(";")[0], "text/csv")
        rows = list(csv.reader(io.StringIO(reply.body.decode())))
        self.assertEqual(len(rows), ROWS + 2)
        self.assertIn("time", rows[0][0])
        self.assertEqual([float(x) for x in rows[-1]], [1.0, 2.0 * ROWS])
        self.assertEqual([float(x) for x in rows[2]], [1 / ROWS, 2.0])

    def test_accept_that_cannot_be_met(self):
        reply = self.client.get(self.base + "/series/probe.runout", accept="image/png")
        self.assertIn(reply.status, (200, 406))

    def test_series_of_a_job_that_has_not_begun(self):
        busy = [self.client.submit({"seconds": 30})["id"] for _ in range(2)]
        job = self.client.submit()["id"]
        reply = self.client.get(f"/v1/jobs/{job}/series")
        self.assertEqual(reply.status, 200, reply)
        reply = self.client.get(f"/v1/jobs/{job}/series/probe.runout")
        self.assertIn(reply.status, (200, 404))
        for other in busy + [job]:
            self.client.post(f"/v1/jobs/{other}/cancel")
        for other in busy + [job]:
            self.client.finish(other)

    # ---- pictures ----
    def test_picture(self):
        reply = self.client.get(self.base + "/frames/1.png?width=320")
        self.assertEqual(reply.status, 200, reply)
        self.assertEqual(reply.headers["content-type"], "image/png")
        self.assertTrue(reply.body.startswith(b"\x89PNG\r\n\x1a\n"))
        self.assertEqual(self.client.get(self.base + "/frames/1.png?width=320").body, reply.body)

    def test_pictures_that_cannot_be(self):
        self.assert_problem(self.client.get(self.base + "/frames/99.png"), 404)
        for name in ("x.png", "-1.png", "1e3.png", "99999999999999999999.png"):
            with self.subTest(name=name):
                self.assertIn(self.client.get(f"{self.base}/frames/{name}").status, (400, 404, 422))
        for query in ("?width=0", "?width=1000000", "?width=x", "?style=cubes", "?colour=red"):
            with self.subTest(query=query):
                reply = self.client.get(self.base + "/frames/1.png" + query)
                self.assertIn(reply.status, (400, 422), reply)


if __name__ == "__main__":
    unittest.main()
