# SPDX-License-Identifier: Apache-2.0
"""The first bending mode of a clamped-free beam, and scenes of it (Mast 2013, sec. 6.2).

Length and depth are in a figure of the source that is not at hand; 10 m and 1 m are what its particle
counts say at 2 x 2 particles a cell. The velocity of the free end is not given; 0.1 m/s makes
displacements of 2 mm, small as the theory."""
import numpy

LENGTH, DEPTH, TIP_SPEED, DENSITY = 10.0, 1.0, 0.1, 2710.0
ROOT, SIGMA = 1.875104068711961, 0.7340955137589128


class Beam:
    """Young's modulus as the theory wants it: E in plane stress, E / (1 - nu^2) in plane strain."""

    def __init__(self, bulk, shear, plane_strain=False):
        self.young = 9 * bulk * shear / (3 * bulk + shear)
        self.poisson = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))
        self.modulus = self.young / (1 - self.poisson ** 2) if plane_strain else self.young
        self.shear = shear
        inertia = DEPTH ** 3 / 12
        self.euler = (ROOT / LENGTH) ** 2 * numpy.sqrt(self.modulus * inertia / (DENSITY * DEPTH))
        self.timoshenko = self._timoshenko_frequency()
        self.amplitude = TIP_SPEED / self.euler

    def _timoshenko_frequency(self):
        """First frequency of the Timoshenko beam with rotary inertia and a shear factor of 5/6: the
        determinant of clamped w, psi and free M, Q over the two roots of its equation."""
        area, inertia = DEPTH, DEPTH ** 3 / 12
        stiff, shear = self.modulus * inertia, 5 / 6 * self.shear * area

        def determinant(omega):
            # w = exp(k x), psi = r(k) w:  S (w'' - psi') = -rho A om^2 w,  B psi'' + S (w' - psi)
            # = -rho I om^2 psi
            a = DENSITY * area * omega ** 2
            j = DENSITY * inertia * omega ** 2
            squares = numpy.roots([stiff * shear, stiff * a + shear * j, a * j - shear * a])
            roots = [sign * numpy.sqrt(complex(s)) for s in squares for sign in (1, -1)]
            rows = []
            for k in roots:
                turn = (shear * k * k + a) / (shear * k)
                grow = numpy.exp(k * LENGTH)
                rows.append([1, turn, turn * k * grow, (k - turn) * grow])
            return numpy.linalg.det(numpy.array(rows).T)

        low, high = 0.7 * self.euler, 1.001 * self.euler
        reference = determinant(low)
        for _ in range(60):
            middle = 0.5 * (low + high)
            if (determinant(middle) / reference).real > 0:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)

    def shape(self, x, derivative=0):
        """The mode and its derivatives by x, over its value at the free end."""
        z = ROOT * numpy.asarray(x) / LENGTH
        cosine = [numpy.cos(z), -numpy.sin(z), -numpy.cos(z), numpy.sin(z)]
        sine = [numpy.sin(z), numpy.cos(z), -numpy.sin(z), -numpy.cos(z)]
        even, odd = (numpy.cosh(z), numpy.sinh(z))[::1 if derivative % 2 == 0 else -1]
        value = even - cosine[derivative] - SIGMA * (odd - sine[derivative])
        end = (numpy.cosh(ROOT) - numpy.cos(ROOT)
               - SIGMA * (numpy.sinh(ROOT) - numpy.sin(ROOT)))
        return value * (ROOT / LENGTH) ** derivative / end

    def stress(self, x, y, deflection):
        """sigma_11 and sigma_12 with the free end at that deflection; y from the neutral axis."""
        normal = -self.modulus * y * deflection * self.shape(x, 2)
        share = 1 - (2 * y / DEPTH) ** 2
        return normal, -self.modulus * DEPTH ** 2 / 8 * deflection * self.shape(x, 3) * share

    def largest_stress(self):
        """Of sigma_11 and sigma_12, at the clamp and the largest deflection."""
        return (self.stress(0.0, -DEPTH / 2, self.amplitude)[0],
                abs(self.stress(0.0, 0.0, self.amplitude)[1]))


def scene(title, dimension, moduli, cell, time_step, duration, anti_locking, frames,
          control="cell"):
    """`cell`: one number, or one an axis; 2 x 2 particles a cell. anti_locking: a field, or None."""
    widths = cell if isinstance(cell, list) else [cell, cell]
    solver = {"time_step": time_step, "strain": "small"}
    if anti_locking:
        solver["anti_locking"] = {"control": control, "field": anti_locking}
    return {
        "title": title,
        "dimension": dimension,
        "duration": duration,
        "grid": {"cell": widths, "min": [0, -1], "max": [LENGTH + 1, 2]},
        "solver": solver,
        "materials": {"metal": {"model": "linear_elastic", "density": DENSITY,
                                "bulk_modulus": moduli[0], "shear_modulus": moduli[1]}},
        "bodies": [{"name": "beam", "material": "metal",
                    "box": {"min": [0, 0], "max": [LENGTH, DEPTH]},
                    "particles_per_cell": [2, 2],
                    "velocity": {"beam_mode": {"mode": 1, "from": [0, DEPTH / 2],
                                               "to": [LENGTH, DEPTH / 2],
                                               "tip": [0, TIP_SPEED]}}}],
        "boundaries": [{"name": "clamp", "plane": {"point": [0, 0], "normal": [1, 0]},
                        "condition": "stick"}],
        "output": {"frames": {"every": duration / frames, "fields": ["displacement", "stress", "mass"],
                              "precision": "double"},
                   "history": {"every": duration / frames}},
    }


class Motion:
    """The frames of a run: places at the start, and stresses and deflections over time."""

    def __init__(self, run):
        count = len(list((run.folder / "frames").glob("frame_*.hdf")))
        frames = [run.frame(k) for k in range(count)]
        self.time = numpy.array([frame["time"] for frame in frames])
        self.x, self.y = (frames[0]["position"][:, axis] for axis in (0, 1))
        self.y = self.y - DEPTH / 2
        self.volume = frames[0]["mass"].reshape(-1) / DENSITY
        self.stress = [frame["stress"] for frame in frames]
        self.deflection = numpy.array([frame["displacement"][:, 1] for frame in frames])

    def tip(self):
        """Deflection over time of the particles nearest to the free end of the centre line, and
        where they are."""
        end = self.x > self.x.max() - 1e-9
        middle = end & (abs(self.y) < abs(self.y[end]).min() + 1e-9)
        return self.deflection[:, middle].mean(axis=1), self.x.max()


def fit_sine(time, values, omega):
    """Least squares of A sin(omega t); returns A and omega: the best of many, then Gauss-Newton."""
    def misfit(trial):
        sine = numpy.sin(trial * time)
        return ((values - sine * (values @ sine) / (sine @ sine)) ** 2).sum()

    omega = min(omega * numpy.linspace(0.4, 1.6, 241), key=misfit)
    amplitude = abs(values).max()
    for _ in range(30):
        sine, cosine = numpy.sin(omega * time), numpy.cos(omega * time)
        jacobian = numpy.stack([sine, amplitude * time * cosine], axis=1)
        step, *_ = numpy.linalg.lstsq(jacobian, values - amplitude * sine, rcond=None)
        amplitude, omega = amplitude + step[0], omega + step[1]
    return amplitude, omega
