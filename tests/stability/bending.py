# SPDX-License-Identifier: Apache-2.0
"""A cantilever in its first mode for one period, with what its fit of strains makes of it."""
import math

import numpy

import beam_theory


class Bending:
    def __init__(self, verification, title, dimension, moduli, cell, anti_locking=None):
        """moduli: bulk and shear; cell: a width or one an axis; anti_locking: as in a scene."""
        beam = beam_theory.Beam(*moduli, plane_strain=dimension == "plane_strain")
        period = 2 * math.pi / beam.timoshenko
        width = min(cell) if isinstance(cell, list) else cell
        step = 0.4 * width / math.sqrt((moduli[0] + 4 / 3 * moduli[1]) / beam_theory.DENSITY)
        scene = beam_theory.scene(title, dimension, moduli, cell, step, period, None, 48)
        if anti_locking:
            scene["solver"]["anti_locking"] = anti_locking
        motion = beam_theory.Motion(verification.run(scene))
        tip, place = motion.tip()
        omega = beam_theory.fit_sine(motion.time, tip, beam.timoshenko)[1]
        self.period = 2 * math.pi / abs(omega) / period
        self.amplitude = abs(tip).max() / (beam.amplitude * float(beam.shape(place)))
        frame = int(numpy.argmin(abs(motion.time - period / 4)))
        far = motion.x > beam_theory.DEPTH
        shear = beam.stress(motion.x, motion.y, beam.amplitude)[1][far]
        found = motion.stress[frame][far, 3]
        self.shear = math.sqrt(((found - shear) ** 2).mean()) / beam.largest_stress()[1]
        self.reversed = float((found * shear < 0).mean())
