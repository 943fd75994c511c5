# SPDX-License-Identifier: Apache-2.0
"""Every operation of the OpenAPI document, called as it should be and in each way that any call can be
refused. Run by run_through_prism.py, which holds the answers against the document."""
import re
import threading
import unittest

from talus_harness import Daemon, DaemonTest, PATIENCE, fake_scene, wait_for
from test_real_run import falling_block

NOWHERE = {"id": "0" * 26, "study": "0" * 26, "name": "nothing", "n": "0"}


def operations(document):
    """(method, path, operation) of all."""
    for path, entry in document["paths"].items():
        for method, operation in entry.items():
            yield method.upper(), path, operation


def fill(path, values):
    return re.sub(r"\{(\w+)\}", lambda match: values[match.group(1)], path)


def study_body(scene):
    return {"name": "two rows", "scene": scene, "metrics": ["wall_seconds"], "reuse": False,
            "chart": {"x": "/duration", "y": "wall_seconds"},
            "design": {"list": {"rows": [{"/duration": 0.01}, {"/duration": 0.02}]}}}


class Operations(DaemonTest):
    def both(self, target, **headers):
        """The answers to GET and HEAD have the same status and the same ETag."""
        fields = {name.replace("_", "-"): value for name, value in headers.items()}
        replies = [self.client.request(method, target, headers=fields) for method in ("GET", "HEAD")]
        self.assertEqual(replies[1].body, b"")
        self.assertEqual(replies[0].status, replies[1].status, target)
        self.assertEqual(replies[0].headers.get("etag"), replies[1].headers.get("etag"), target)
        return replies[0]


class Refused(Operations):
    """What every call can be answered with, whatever it asks for."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.document = cls.daemon.client().get("/openapi.json").json()

    def refuse(self, status, headers=None, query="", body=None, only=lambda operation: True):
        count = 0
        for method, path, operation in operations(self.document):
            if not only(operation):
                continue
            count += 1
            with self.subTest(method=method, path=path):
                reply = self.client.request(method, fill(path, NOWHERE) + query, body, headers)
                self.assertEqual(reply.status, status, reply)
                self.assertIn(str(status), operation["responses"])
        return count

    def test_everywhere(self):
        for status, headers, query in (
                (400, {}, "?token=secret"),
                (401, {"Authorization": "Bearer nobody"}, ""),
                (403, {"Origin": "https://evil.example"}, ""),
                (413, {"Content-Length": str(1 << 30)}, ""),
                (414, {}, "?x=" + "x" * 4200),
                (422, {}, "?no_such_parameter=1"),
                (431, {"X-Large": "x" * 5500}, "")):
            with self.subTest(status=status):
                self.assertGreater(self.refuse(status, headers, query), 50)

    def test_nothing_there(self):
        self.assertGreater(self.refuse(404, only=lambda operation: "404" in operation["responses"]), 20)

    def test_another_type_of_body(self):
        self.assertGreater(self.refuse(415, {"Content-Type": "text/plain"}, body="{}",
                                       only=lambda operation: "requestBody" in operation), 3)

    def test_a_study_that_has_changed(self):
        study = self.client.post("/v1/studies", study_body(fake_scene({"seconds": 600}))).json()["id"]
        path = f"/v1/studies/{study}/cancel"
        self.assertEqual(self.client.post(path, if_match='"another"').status, 412)
        self.assertEqual(self.client.post(path).status, 200)

    def test_a_chart_that_cannot_be_drawn(self):
        body = dict(study_body(fake_scene()), name="no chart")
        study = self.client.post("/v1/studies", body).json()["id"]
        self.assertEqual(self.both(f"/v1/studies/{study}/chart.svg").status, 409)


class Stopping(unittest.TestCase):
    """While the last answer is being made, everything else is refused with 503."""

    def test_all_operations(self):
        daemon = Daemon(config={"drain_seconds": 0, "helper_seconds": 12 * PATIENCE}).start()
        client = daemon.client()
        document = client.get("/openapi.json").json()
        daemon.switch("helper-hang")
        last = threading.Thread(target=lambda: daemon.client(60).post(
            "/v1/forecast", {"scene": fake_scene()}))
        last.start()
        wait_for(lambda: self.under_way(client), 20, "the last answer")
        daemon.process.terminate()
        try:
            wait_for(lambda: client.get("/healthz").status == 503, 20, "the daemon stops")
            for method, path, operation in operations(document):
                with self.subTest(method=method, path=path):
                    reply = client.request(method, fill(path, NOWHERE),
                                           {} if "requestBody" in operation else None)
                    self.assertEqual(reply.status, 503, reply)
                    self.assertIn("retry-after", reply.headers)
        finally:
            last.join()
            daemon.process.wait(30 * PATIENCE)
            self.assertEqual(daemon.close(), "")

    @staticmethod
    def under_way(client):
        """The metrics' own request counts too."""
        text = client.get("/metrics").body.decode()
        return float(re.search(r"^talus_requests_under_way (\S+)$", text, re.M).group(1)) > 1


class Answered(Operations):
    """What a finished job and a finished study give."""
    real = True

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        client = cls.daemon.client()
        cls.document = client.get("/openapi.json").json()
        scene = falling_block()
        scene["duration"] = 0.02
        job = client.post("/v1/jobs", {"scene": scene}).json()["id"]
        study = client.post("/v1/studies", study_body(scene))
        assert study.status == 201, study
        study = study.json()["id"]
        assert client.finish(job, 60)["state"] == "succeeded"
        wait_for(lambda: client.get(f"/v1/studies/{study}").json()["state"] == "finished", 60, "study")
        series = client.get(f"/v1/jobs/{job}/series").json()
        cls.values = {"id": job, "study": study, "n": "0", "name": series[0]["name"]}

    def places(self):
        """(path, operation of GET) with values; files have names of their own."""
        for path, entry in self.document["paths"].items():
            if "get" in entry:
                values = dict(self.values, **({"name": "scene.json"} if "/files/" in path else {}))
                yield path, fill(path, values), entry["get"]

    def test_reading(self):
        for path, target, operation in self.places():
            if path == "/v1/events":  # never ends
                self.assertEqual(self.client.request("HEAD", target).status, 200)
                continue
            with self.subTest(path=path):
                reply = self.both(target)
                self.assertEqual(reply.status, 200, reply)
                if "304" in operation["responses"]:
                    unchanged = self.both(target, if_none_match=reply.headers["etag"])
                    self.assertEqual(unchanged.status, 304, unchanged)
                # Where the document has no 412 the field is ignored.
                other = self.both(target, if_match='"another"')
                self.assertEqual(other.status, 412 if "412" in operation["responses"] else 200)

    def test_stories_that_are_told(self):
        for path in (f"/v1/jobs/{self.values['id']}/events",
                     f"/v1/studies/{self.values['study']}/events"):
            story = self.client.get(path).body.decode()
            last = [line[4:] for line in story.splitlines() if line.startswith("id: ")][-1]
            self.assertEqual(self.both(path, last_event_id=last).status, 204, path)

    def test_parts_of_a_file(self):
        path = f"/v1/jobs/{self.values['id']}/files/scene.json"
        for status, headers in ((206, {"range": "bytes=0-9"}), (416, {"range": "bytes=9999999-"}),
                                (412, {"if_match": '"another"'})):
            self.assertEqual(self.both(path, **headers).status, status)

    def test_series_as_a_table(self):
        path = f"/v1/jobs/{self.values['id']}/series/{self.values['name']}"
        self.assertEqual(self.client.get(path, accept="text/csv").status, 200)


if __name__ == "__main__":
    unittest.main()
