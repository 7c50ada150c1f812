#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates piecewise_linear_segment.csv: linear data through a piecewise-linear transfer function.

Truth is the sum of the closed forms of linear_segment.py over the pieces between control values,
cut exactly (the cuts are quotients of exact numbers at 300 digits).
"""
import sys

from mpmath import mp, mpf

import common
from linear_segment import PRECISION, integrals

NAME = "piecewise_linear_segment"
TRANSFER_FUNCTION = ["tf_x", "tf_tau", "tf_r", "tf_g", "tf_b"]
INPUTS = TRANSFER_FUNCTION + ["v_f", "v_b", "D"]
OUTPUTS = ["optical_depth", "opacity", "radiance_r", "radiance_g", "radiance_b"]
ROWS = 500


class TransferFunction:
    """Extinction and color, linear between control points, constant outside; of two points at one
    value the later holds at the value itself."""

    def __init__(self, row):
        self.x = common.numbers(row, "tf_x")
        self.values = list(zip(*(common.numbers(row, c) for c in TRANSFER_FUNCTION[1:])))

    def inside(self, low, high):
        """The four values at both ends of [low, high], an interval without control values inside,
        approached from its inside."""
        middle = (low + high) / 2
        k = sum(1 for x in self.x if x <= middle)
        if k == 0:
            return self.values[0], self.values[0]
        if k == len(self.x):
            return self.values[-1], self.values[-1]
        x0, x1 = self.x[k - 1], self.x[k]
        return tuple([a + (b - a) * (v - x0) / (x1 - x0)
                      for a, b in zip(self.values[k - 1], self.values[k])] for v in (low, high))

    def at(self, v):
        k = sum(1 for x in self.x if x <= v)
        if 0 < k < len(self.x):
            return self.inside(v, v)[0]
        return self.values[0] if k == 0 else self.values[-1]


def outputs(row):
    with mp.workdps(PRECISION):
        transfer = TransferFunction(row)
        v_f, v_b, d = (common.number(row, c) for c in ("v_f", "v_b", "D"))
        low, high = min(v_f, v_b), max(v_f, v_b)
        cuts = [low] + sorted({x for x in transfer.x if low < x < high}) + [high]
        pieces = [(a, b) for a, b in zip(cuts, cuts[1:]) if a < b]
        if v_f == v_b:
            here = transfer.at(v_f)
            segments = [(here, here, d)]
        else:
            segments = [(*transfer.inside(a, b), d * (b - a) / (high - low)) for a, b in pieces]
            if v_b < v_f:
                segments = [(back, front, length) for front, back, length in reversed(segments)]
        depth, radiance = mpf(0), [mpf(0)] * 3
        for front, back, length in segments:
            m, _, transparency, psi, _ = integrals(front[0] * length, back[0] * length)
            before = mp.exp(-depth)
            for c in range(3):
                if m > 0:
                    radiance[c] += before * (front[c + 1] * (1 - psi)
                                             + back[c + 1] * (psi - transparency))
            depth += m
        return {"optical_depth": depth, "opacity": -mp.expm1(-depth), "radiance_r": radiance[0],
                "radiance_g": radiance[1], "radiance_b": radiance[2]}


def transfer_function(rng, low, high, depth_scale, jumps=True):
    """Columns of a random one with 2 to 9 control points on [low, high], a jump now and then, and
    stretches without extinction."""
    n = rng.randint(2, 9)
    x = sorted(common.uniform(rng, low, high) for _ in range(n))
    if jumps and n > 2 and rng.random() < 0.4:
        k = rng.randrange(n - 1)
        x[k + 1] = x[k]
        x.sort()
    tau = [0.0 if rng.random() < 0.25 else common.binary32(depth_scale * rng.random() ** 2)
           for _ in range(n)]
    row = {"tf_x": common.text_list(x), "tf_tau": common.text_list(tau)}
    for column in TRANSFER_FUNCTION[2:]:
        row[column] = common.text_list(common.uniform(rng, 0, 1) for _ in range(n))
    return row, x


def inputs(rng, count):
    regimes = ("generic", "thin", "dense", "opaque", "constant", "short", "outside", "at_control")
    for i in range(count):
        regime = regimes[i % len(regimes)]
        length = 0.0 if i == 0 else common.log_uniform(rng, 1e-2, 1e2)
        depth = {"thin": 1e-6, "dense": 10, "opaque": 1e4}.get(regime, 1)
        row, x = transfer_function(rng, 0, 1, depth / max(length, 1e-2))
        v_f, v_b = common.uniform(rng, -0.2, 1.2), common.uniform(rng, -0.2, 1.2)
        if regime == "constant":
            v_b = v_f
        elif regime == "short":
            v_b = common.binary32(v_f * (1 + rng.choice((-1, 1)) * 2.0 ** -rng.randint(15, 23)))
        elif regime == "outside":
            v_f, v_b = common.uniform(rng, 1, 3), common.uniform(rng, 1.5, 1e6)
        elif regime == "at_control":
            v_f, v_b = rng.choice(x), rng.choice(x)
        yield regime, {**row, "v_f": common.text_in(v_f), "v_b": common.text_in(v_b),
                       "D": common.text_in(length)}


if __name__ == "__main__":
    common.main(sys.modules[__name__])
