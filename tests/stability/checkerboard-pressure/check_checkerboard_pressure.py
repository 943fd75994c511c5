# SPDX-License-Identifier: Apache-2.0
"""Volumetric strain averaged over cells leaves a checkerboard of pressures in water that moves, which
means over nodes do not: a dam that breaks onto a barrier, about t = 0.4 s (Mast 2013, sec. 6.1.2)."""
import numpy as np

from barrier_scene import CELL, DENSITY, GRAVITY, HEIGHT, LENGTH, scene
from verification import Verification

# What is left of a field after this mean of a cell and its eight neighbours: nothing of a hydrostatic
# pressure, all of a checkerboard.
MEAN = np.outer([1, 2, 1], [1, 2, 1]) / 16
# Neighbours of noise without a pattern, cell by cell, are correlated by that mean alone: by the product
# of 1 - MEAN with itself moved by a cell, over its square. A checkerboard has -1.
REST = -MEAN
REST[1, 1] += 1
NOISE = float((REST[1:] * REST[:-1]).sum() / (REST**2).sum())


class Roughness:
    """How the pressures of cells inside the water differ from the means of their neighbourhoods."""

    def __init__(self, frame):
        column, row = np.floor(frame["position"][:, :2] / CELL).astype(int).T
        shape = (column.max() + 1, row.max() + 1)
        count, pressure = np.zeros(shape), np.zeros(shape)
        np.add.at(count, (column, row), 1)
        np.add.at(pressure, (column, row), -frame["mean_stress"].reshape(-1))
        mean = pressure / np.maximum(count, 1)
        filled = len(column) * CELL**2 / (LENGTH * HEIGHT)
        rest = np.full(shape, np.nan)
        for i, j in np.ndindex(shape[0] - 2, shape[1] - 2):
            around = slice(i, i + 3), slice(j, j + 3)
            if (count[around] >= filled / 2).all():  # the surface is not among them
                rest[i + 1, j + 1] = (REST * mean[around]).sum()
        pairs = np.concatenate([(rest[1:] * rest[:-1]).ravel(), (rest[:, 1:] * rest[:, :-1]).ravel()])
        self.size = float(np.sqrt(np.nanmean(rest**2)))
        self.correlation = float(np.nanmean(pairs) / np.nanmean(rest**2))


def roughness(control, field):
    given = scene(control, duration=0.41, stiff=True)
    given["title"] += ", " + field
    given["solver"]["anti_locking"]["field"] = field
    return Roughness(verification.run(given).frame(20))


verification = Verification("checkerboard-pressure")
cell = roughness("cell", "volumetric")
print(f"  RMS over the pressure at the bottom of the dam: {cell.size / (DENSITY * GRAVITY * HEIGHT):.3f}")
# Half-way between noise and a perfect checkerboard, and more than that.
verification.below("cell: correlation of neighbours' deviations of pressure", cell.correlation,
                   (NOISE - 1) / 2)
for control, field in (("node", "volumetric"), ("hybrid", "full")):
    smooth = roughness(control, field)
    verification.below(f"{control}, {field}: RMS deviation of pressure over that of cell",
                       smooth.size / cell.size, 0.5)
verification.finish()
