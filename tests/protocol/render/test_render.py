# SPDX-License-Identifier: Apache-2.0
"""talus-worker render: pictures of frames with known content."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy

import make_frame

WORKER = ""


def read_png(path):
    """Pixels [height, width, 3] of an 8-bit RGB picture."""
    with open(path, "rb") as stream:
        content = stream.read()
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    offset, packed = 8, b""
    while offset < len(content):
        length = int.from_bytes(content[offset:offset + 4], "big")
        kind, body = content[offset + 4:offset + 8], content[offset + 8:offset + 8 + length]
        if kind == b"IHDR":
            width, height = (int.from_bytes(body[i:i + 4], "big") for i in (0, 4))
            assert (body[8], body[9]) == (8, 2)
        elif kind == b"IDAT":
            packed += body
        offset += 12 + length
    rows = numpy.frombuffer(zlib.decompress(packed), "u1").reshape(height, 1 + 3 * width)
    picture = numpy.zeros((height + 1, 3 * width), int)
    for y in range(height):
        picture[y + 1] = unfilter(rows[y, 0], rows[y, 1:].astype(int), picture[y])
    return picture[1:].reshape(height, width, 3)


def unfilter(kind, row, above):
    """Undoes one row's filter (PNG specification, 9.2)."""
    if kind == 0:
        return row
    if kind == 1:
        return (row.reshape(-1, 3).cumsum(axis=0) & 255).ravel()
    if kind == 2:
        return (row + above) & 255
    out = [0, 0, 0]
    above = [0, 0, 0, *above.tolist()]
    for i, value in enumerate(row.tolist()):
        left, up, corner = out[i], above[i + 3], above[i]
        if kind == 3:
            guess = (left + up) // 2
        else:
            slope = left + up - corner
            guess = min((left, up, corner), key=lambda v: abs(slope - v))
        out.append((value + guess) & 255)
    return numpy.array(out[3:])


def count_near(picture, colour, distance=12):
    return int((abs(picture - numpy.array(colour)).max(axis=2) <= distance).sum())


VIRIDIS_LOW, VIRIDIS_HIGH = (71, 1, 85), (252, 231, 34)


class Render(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.picture = os.path.join(self.folder, "picture.png")

    def run_render(self, *arguments):
        return subprocess.run(
            [WORKER, "render", self.folder, "--output", self.picture, "--width", "320", *arguments],
            capture_output=True, text=True, check=False)

    def draw(self, *arguments):
        result = self.run_render(*arguments)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual([name for name in os.listdir(self.folder) if "part" in name], [])
        return read_png(self.picture)

    def test_plane_scene(self):
        make_frame.make_column(self.folder)
        points = self.draw("--frame", "7")
        self.assertEqual(points.shape[1], 320)
        self.assertGreater(count_near(points, VIRIDIS_LOW), 20)
        self.assertGreater(count_near(points, VIRIDIS_HIGH), 20)
        voxels = self.draw("--frame", "7", "--style", "voxels")
        # Voxels with F tile the parallelogram; discs leave 1 - pi/4 of it white.
        self.assertGreater((255 - voxels).sum(), 1.1 * (255 - points).sum())
        component = self.draw("--frame", "7", "--style", "voxels", "--field", "stress.yy")
        self.assertFalse((component == voxels).all())

    def test_solid_scene(self):
        make_frame.make_impact(self.folder, spacing=0.25)
        picture = self.draw()
        self.assertGreater(count_near(picture, (236, 236, 234), 4), 100)  # the floor
        again = self.draw()
        self.assertTrue((picture == again).all())
        cubes = self.draw("--style", "voxels")
        self.assertFalse((picture == cubes).all())

    def test_line_scene_and_constant_field(self):
        make_frame.make_line(self.folder)
        self.assertGreater(count_near(self.draw(), (33, 145, 140), 10), 50)  # middle of the bar

    def test_no_particle_is_left(self):
        make_frame.make_line(self.folder)
        make_frame.write_frame(self.folder, 0, numpy.zeros((0, 3)), 1,
                               {"velocity": (numpy.zeros((0, 3)), "m/s")})
        self.draw()

    def test_values_that_are_not_numbers(self):
        count = make_frame.make_line(self.folder)
        points = make_frame.lattice([0, 0, 0], [10, 0, 0], 0.25)
        points[3] = numpy.nan
        values = numpy.full(count, numpy.nan)
        make_frame.write_frame(self.folder, 0, points, 1, {"density": (values, "kg/m^3")})
        self.assertGreater(count_near(self.draw(), (153, 153, 153), 4), 50)

    def test_refusals(self):
        make_frame.make_column(self.folder)
        for arguments, text in (
                (["--frame", "3"], "no frame"),
                (["--frame", "7", "--field", "velocty"], "it has: deformation_gradient, stress"),
                (["--frame", "7", "--field", "stress.zx"], ".xz"),
                (["--frame", "x"], "--frame"),
                (["--frame", "7", "--style", "lines"], "points, voxels"),
                (["--frame", "7", "--width", "100"], "width"),
                (["--frame", "7", "--width", "99999"], "width"),
                (["--frame", "7", "--colour", "red"], "usage")):
            result = self.run_render(*arguments)
            self.assertEqual(result.returncode, 1, arguments)
            self.assertIn(text, result.stderr, arguments)
            self.assertFalse(os.path.exists(self.picture))

    def test_broken_files(self):
        make_frame.make_column(self.folder)
        frame = os.path.join(self.folder, "frames", "frame_000007.hdf")
        with open(frame, "r+b") as stream:
            stream.truncate(3000)
        self.assertEqual(self.run_render("--frame", "7").returncode, 1)
        os.remove(os.path.join(self.folder, "scene.json"))
        result = self.run_render("--frame", "0")
        self.assertEqual(result.returncode, 1)
        self.assertIn("scene.json", result.stderr)
        self.assertFalse(os.path.exists(self.picture))


if __name__ == "__main__":
    WORKER = sys.argv.pop(1)
    unittest.main()
