#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates gaussian_segment.csv: one Gaussian primitive along linear data of any dimension.

Truth is the closed form with erf or erfc (specification, 3.4, without its rearrangements) at 200
digits; the data's ends enter exactly.
"""
import sys

from mpmath import mp

import common

NAME = "gaussian_segment"
INPUTS = ["n", "K", "c", "v1", "v2", "tau", "length"]
OUTPUTS = ["mean_density", "optical_depth", "opacity"]
ROWS = 1000
PRECISION = 200


def along(k, c, v1, v2):
    """p1 = K (v1 - c) and d = K (v2 - v1): the primitive is exp(-|p1 + u d|²)."""
    def times(vector):
        return [sum(a * x for a, x in zip(line, vector)) for line in k]
    return times([a - b for a, b in zip(v1, c)]), times([b - a for a, b in zip(v1, v2)])


def density_integral(p1, d, end=1):
    """Integral of exp(-|p1 + u d|²) over [0, end]."""
    squared = sum(x * x for x in p1)
    width = mp.sqrt(sum(x * x for x in d))
    if width == 0:
        return end * mp.exp(-squared)
    front = sum(x * y for x, y in zip(d, p1)) / width
    back = front + end * width
    closest = squared - front * front  # of all of the line, not only of the segment
    if front > 0:
        difference = mp.erfc(front) - mp.erfc(back)
    elif back < 0:
        difference = mp.erfc(-back) - mp.erfc(-front)
    else:
        difference = mp.erf(back) - mp.erf(front)
    return mp.exp(-closest) * mp.sqrt(mp.pi) / (2 * width) * difference


def outputs(row):
    with mp.workdps(PRECISION):
        n = int(row["n"])
        k = common.matrix(row["K"], n)
        p1, d = along(k, *(common.numbers(row, c) for c in ("c", "v1", "v2")))
        density = density_integral(p1, d)
        depth = common.number(row, "tau") * common.number(row, "length") * density
        return {"mean_density": density, "optical_depth": depth, "opacity": -mp.expm1(-depth)}


def random_matrix(rng, n):
    """(kind, K row by row): isotropic, diagonal, full or singular, about 1 to 30 per unit."""
    kind = rng.choice(("isotropic", "diagonal", "full", "singular"))
    scale = common.log_uniform(rng, 1, 30)
    k = [[0.0] * n for _ in range(n)]
    for i in range(n):
        for j in range(n):
            if kind in ("full", "singular"):
                k[i][j] = common.binary32(scale * rng.gauss(0, 1))
            elif i == j:
                k[i][j] = scale if kind == "isotropic" else common.log_uniform(rng, 0.1, 30)
    if kind == "singular":
        k[-1] = [2 * x for x in k[0]] if n > 1 else [0.0]
    return kind, k


def ends(rng, n, regime, c):
    """Data at front and back, in units in which a primitive is about 0.1 wide."""
    v1 = [common.uniform(rng, 0, 1) for _ in range(n)]
    v2 = [common.uniform(rng, 0, 1) for _ in range(n)]
    step = {"short": 1e-2, "very_short": 1e-6}.get(regime)
    if step:
        v2 = [common.binary32(x + step * rng.uniform(-1, 1)) for x in v1]
    elif regime == "point":
        v2 = list(v1)
    elif regime == "cross":  # through the center
        v2 = [common.binary32(2 * b - a) for a, b in zip(v1, c)]
    elif regime == "long":
        v2 = [common.binary32(a + 100 * (b - a)) for a, b in zip(v1, v2)]
    elif regime == "far":
        v1 = [common.binary32(x + 2) for x in v1]
        v2 = [common.binary32(x + 2) for x in v2]
    return v1, v2


def inputs(rng, count):
    regimes = ("generic", "short", "very_short", "point", "cross", "long", "far")
    for i in range(count):
        n, regime = rng.choice((1, 2, 3, 4, 8)), regimes[i % len(regimes)]
        kind, k = random_matrix(rng, n)
        c = [common.uniform(rng, 0, 1) for _ in range(n)]
        v1, v2 = ends(rng, n, regime, c)
        yield f"{regime}/{kind}", {
            "n": str(n), "K": common.text_list(x for line in k for x in line),
            "c": common.text_list(c), "v1": common.text_list(v1), "v2": common.text_list(v2),
            "tau": common.text_in(common.log_uniform(rng, 1e-3, 1e3)),
            "length": common.text_in(common.log_uniform(rng, 1e-2, 1e2))}


if __name__ == "__main__":
    common.main(sys.modules[__name__])
