# SPDX-License-Identifier: Apache-2.0
"""Job folders with one frame of known content, for the tests of pictures."""
import json
import os

import h5py
import numpy


def write_frame(folder, number, points, time, fields):
    """fields: name -> (array, unit)."""
    os.makedirs(os.path.join(folder, "frames"), exist_ok=True)
    with h5py.File(os.path.join(folder, "frames", f"frame_{number:06d}.hdf"), "w") as file:
        group = file.create_group("VTKHDF")
        group.create_dataset("Points", data=numpy.asarray(points, dtype="f4"))
        group.create_dataset("FieldData/Time", data=[float(time)])
        data = group.create_group("PointData")
        for name, (values, unit) in fields.items():
            dataset = data.create_dataset(name, data=numpy.asarray(values, dtype="f4"))
            dataset.attrs["units"] = numpy.bytes_(unit)


def write_scene(folder, **scene):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "scene.json"), "w", encoding="utf-8") as stream:
        json.dump(scene, stream)


def lattice(low, high, spacing):
    """Points of a lattice half a spacing inside a box; unused axes are 0."""
    axes = [numpy.arange(a + spacing / 2, b, spacing) if b > a else numpy.zeros(1)
            for a, b in zip(low, high)]
    grid = numpy.meshgrid(*axes, indexing="ij")
    return numpy.stack([axis.ravel() for axis in grid], axis=1)


def make_column(folder):
    """2D: a sheared column on a floor, with velocity, stress, volume and F."""
    spacing = 0.0025
    start = lattice([0, 0, 0], [0.05, 0.1, 0], spacing)
    shear = 0.6
    points = start + numpy.stack([shear * start[:, 1], 0 * start[:, 1], 0 * start[:, 1]], axis=1)
    count = len(points)
    gradient = numpy.tile(numpy.array([1, shear, 0, 0, 1, 0, 0, 0, 1.0]), (count, 1))
    stress = numpy.zeros((count, 6))
    stress[:, 1] = -2200 * 9.81 * (0.1 - points[:, 1])
    write_scene(folder, title="Column", dimension="plane_strain", duration=0.6, gravity=[0, -9.81],
                grid={"cell": [0.005, 0.005], "min": [0, 0], "max": [0.4, 0.15]},
                bodies=[{"particles_per_cell": [2, 2]}],
                boundaries=[{"plane": {"point": [0, 0], "normal": [1, 0]}},
                            {"plane": {"point": [0, 0], "normal": [0, 1]}},
                            {"box": {"min": [0.13, 0], "max": [0.15, 0.04]}}])
    write_frame(folder, 0, start, 0, {"velocity": (0 * start, "m/s")})
    write_frame(folder, 7, points, 0.125, {
        "velocity": (numpy.stack([points[:, 1] * 20, -points[:, 0], 0 * points[:, 0]], axis=1), "m/s"),
        "stress": (stress, "Pa"), "volume": (numpy.full(count, spacing ** 2), "m^3"),
        "deformation_gradient": (gradient, "1")})
    return count


def make_impact(folder, spacing=0.125):
    """3D: a slumped block of soil in front of a square column."""
    points = lattice([0, 0, 0], [8, 3, 6], spacing)
    points[:, 0] += (3 - points[:, 1]) * 0.35
    inside = (points[:, 0] > 9) & (abs(points[:, 2] - 3) < 1)
    points = points[~inside]
    speed = 1 - points[:, 0] / 12
    write_scene(folder, title="Debris flow against a column, w = 2 m, H = 3 m", dimension="solid",
                duration=3.5, gravity=[0, -10, 0],
                grid={"cell": [0.25] * 3, "min": [0, 0, 0], "max": [18, 12, 6]},
                bodies=[{"particles_per_cell": [2, 2, 2]}],
                boundaries=[{"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}},
                            {"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}},
                            {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
                            {"plane": {"point": [0, 0, 6], "normal": [0, 0, -1]}},
                            {"box": {"min": [9, 0, 2], "max": [11, 10, 4]}},
                            {"plane": {"point": [17, 0, 0], "normal": [-1, 0, 0]}}])
    write_frame(folder, 0, points, 1.5,
                {"velocity": (numpy.stack([speed, 0 * speed, 0 * speed], axis=1), "m/s")})
    return len(points)


def make_line(folder):
    points = lattice([0, 0, 0], [10, 0, 0], 0.25)
    write_scene(folder, title="Bar", dimension="line", duration=1,
                grid={"cell": [0.5], "min": [0], "max": [12]}, bodies=[{"spacing": 0.25}],
                boundaries=[{"plane": {"point": [0], "normal": [1]}}])
    write_frame(folder, 0, points, 0,
                {"density": (numpy.full(len(points), 1000.0), "kg/m^3")})
    return len(points)
