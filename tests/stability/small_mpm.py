# SPDX-License-Identifier: Apache-2.0
"""A small Material Point Method of its own, in plain numpy: plane strain, linear elastic at small
strain, hat functions, FLIP, strain from velocities that are mapped back from the particles. It carries
the rules that Talus does not offer, so that a check can show how they fail; the rule is a function.

    rule(nodes, velocity, force, mass, step) -> new velocity, impulse that is recorded

works on the nodes named by `nodes` (indices into flat arrays) and replaces v + dt f / m there.
"""
import numpy as np


class SmallMpm:
    def __init__(self, cell, columns, rows, density, young, poisson, gravity):
        self.cell, self.columns, self.rows = cell, columns, rows
        self.lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        self.shear = young / (2 * (1 + poisson))
        self.density, self.gravity = density, np.array(gravity, float)
        self.position = np.zeros((0, 2))
        self.rules = []  # (nodes, rule, function that constrains velocities mapped back)
        self.recorded = np.zeros(2)

    def fill(self, low, high, per_cell, velocity=(0.0, 0.0)):
        counts = [round((high[k] - low[k]) / self.cell * per_cell) for k in range(2)]
        axes = [low[k] + (np.arange(counts[k]) + 0.5) * self.cell / per_cell for k in range(2)]
        grid = np.meshgrid(*axes, indexing="ij")
        self.position = np.stack([axis.ravel() for axis in grid], axis=1)
        count = len(self.position)
        self.velocity = np.tile(np.array(velocity, float), (count, 1))
        self.stress = np.zeros((count, 3))  # xx, yy, xy
        self.volume = np.full(count, (self.cell / per_cell) ** 2)
        self.mass = self.density * self.volume

    def node(self, column, row):
        return row * (self.columns + 1) + column

    def stencil(self):
        """Nodes, weights and gradients of every particle."""
        place = self.position / self.cell
        corner = np.floor(place).astype(int)
        part = place - corner
        nodes, weights, gradients = [], [], []
        for j in range(2):
            for i in range(2):
                wx = part[:, 0] if i else 1 - part[:, 0]
                wy = part[:, 1] if j else 1 - part[:, 1]
                gx = (1 if i else -1) / self.cell * wy
                gy = (1 if j else -1) / self.cell * wx
                nodes.append(self.node(corner[:, 0] + i, corner[:, 1] + j))
                weights.append(wx * wy)
                gradients.append(np.stack([gx, gy], axis=1))
        return np.array(nodes), np.array(weights), np.array(gradients)

    def to_nodes(self, nodes, values):
        out = np.zeros(((self.columns + 1) * (self.rows + 1),) + values.shape[2:])
        np.add.at(out, nodes, values)
        return out

    def step(self, length):
        nodes, weights, gradients = self.stencil()
        share = (weights * self.mass)[:, :, None]
        mass = self.to_nodes(nodes, share)[:, 0]
        heavy = np.maximum(mass, 1e-300)[:, None]
        momentum = self.to_nodes(nodes, share * self.velocity)
        sxx, syy, sxy = self.stress.T
        pull = np.stack([gradients[..., 0] * sxx + gradients[..., 1] * sxy,
                         gradients[..., 0] * sxy + gradients[..., 1] * syy], axis=-1)
        force = -self.to_nodes(nodes, self.volume[None, :, None] * pull) + mass[:, None] * self.gravity
        before = momentum / heavy
        after = before + length * force / heavy
        for held, rule, _ in self.rules:
            after[held], impulse = rule(before[held], force[held], mass[held], length)
            self.recorded += impulse
        self.velocity += (weights[..., None] * (after - before)[nodes]).sum(axis=0)
        self.position += length * (weights[..., None] * after[nodes]).sum(axis=0)
        back = self.to_nodes(nodes, share * self.velocity) / heavy
        for held, _, constrain in self.rules:
            back[held] = constrain(back[held])
        rate = np.einsum("npa,npb->pab", back[nodes], gradients)
        self.stretch(length * rate)

    def stretch(self, gradient):
        """Stress after a step, from the gradient of its displacement."""
        trace = gradient[:, 0, 0] + gradient[:, 1, 1]
        self.stress[:, 0] += self.lame * trace + 2 * self.shear * gradient[:, 0, 0]
        self.stress[:, 1] += self.lame * trace + 2 * self.shear * gradient[:, 1, 1]
        self.stress[:, 2] += self.shear * (gradient[:, 0, 1] + gradient[:, 1, 0])

    @property
    def momentum(self):
        return (self.mass[:, None] * self.velocity).sum(axis=0)
