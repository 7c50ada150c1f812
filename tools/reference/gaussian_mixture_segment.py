#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates gaussian_mixture_segment.csv: sums of Gaussian primitives along linear data.

The depth is the sum of the closed forms of gaussian_segment.py at 200 digits; the radiance, which
has no closed form, comes from adaptive quadrature at 45 digits. The depth of the quadrature must
agree.
"""
import sys

from mpmath import mp, mpf

import common
from gaussian_segment import PRECISION, along, density_integral, ends
from quadrature import integrate

NAME = "gaussian_mixture_segment"
INPUTS = ["n", "primitives", "K", "c", "tau", "colour", "v1", "v2", "length"]
OUTPUTS = ["optical_depth", "opacity", "radiance_r", "radiance_g", "radiance_b"]
ROWS = 400
DIGITS = 45


def breaks(lines):
    """0, 1, and around the closest approach of each primitive a ladder of its widths."""
    points = {mpf(0), mpf(1)}
    for p1, d in lines:
        squared = sum(x * x for x in d)
        if squared > 0:
            center = -sum(x * y for x, y in zip(d, p1)) / squared
            for k in (0, mpf("0.5"), 1, 2, 3, 5, 8, 13, 21):
                for u in (center - k / mp.sqrt(squared), center + k / mp.sqrt(squared)):
                    if 0 < u < 1:
                        points.add(u)
    return sorted(points)


def outputs(row):
    n, count = int(row["n"]), int(row["primitives"])
    with mp.workdps(PRECISION):
        v1, v2 = common.numbers(row, "v1"), common.numbers(row, "v2")
        length, taus = common.number(row, "length"), common.numbers(row, "tau")
        lines = [along(common.matrix(k, n), common.matrix(c, 1)[0], v1, v2)
                 for k, c in zip(row["K"].split("|"), row["c"].split("|"))]
        colors = [common.matrix(c, 1)[0] for c in row["colour"].split("|")]
        if not count == len(lines) == len(taus) == len(colors):
            raise ValueError("the lists differ in length")
        depth = sum(tau * length * density_integral(*line) for tau, line in zip(taus, lines))
        opacity = -mp.expm1(-depth)
    with mp.workdps(DIGITS):
        # |p1 + u d|² = a + b u + c u² with every cancellation left to the 200 digits.
        quadratics = [(sum(x * x for x in p1), 2 * sum(x * y for x, y in zip(p1, d)),
                       sum(x * x for x in d)) for p1, d in lines]

        def rates(u):
            with mp.workdps(DIGITS + 25):
                exponents = [a + u * (b + u * c) for a, b, c in quadratics]
            densities = [tau * length * mp.exp(-e) for tau, e in zip(taus, exponents)]
            return [sum(densities)] + [sum(rho * color[c] for rho, color in zip(densities, colors))
                                       for c in range(3)]

        result = ([depth] + [mpf(0)] * 3 if depth < common.SMALLEST else
                  integrate(rates, breaks(lines), depth, mpf("1e-30")))
        if abs(result[0] - depth) > mpf("1e-25") * depth:
            raise ArithmeticError("closed form and quadrature disagree on the depth")
        return {"optical_depth": depth, "opacity": opacity, "radiance_r": result[1],
                "radiance_g": result[2], "radiance_b": result[3]}


def inputs(rng, count):
    regimes = ("overlap", "separate", "dense", "opaque", "nested", "tiny_depth", "point")
    for i in range(count):
        n, primitives = rng.choice((1, 2, 3, 4)), rng.choice((2, 3, 5))
        regime = regimes[i % len(regimes)]
        sharp = {"overlap": (1, 5), "separate": (8, 30), "nested": (1, 40)}.get(regime, (1, 15))
        depth = {"dense": 30, "opaque": 1e4, "tiny_depth": 1e-6}.get(regime, 2)
        length = common.log_uniform(rng, 0.1, 10)
        center = [common.uniform(rng, 0.2, 0.8) for _ in range(n)]
        groups = {c: [] for c in ("K", "c", "colour")}
        for _ in range(primitives):
            k = common.log_uniform(rng, *sharp)
            groups["K"].append(common.text_list(k if a == b else 0.0
                                                for a in range(n) for b in range(n)))
            groups["c"].append(common.text_list(
                center if regime == "nested" else [common.uniform(rng, 0, 1) for _ in range(n)]))
            groups["colour"].append(common.text_list(common.uniform(rng, 0, 1) for _ in range(3)))
        v1, v2 = ends(rng, n, regime, center)
        yield regime, {
            "n": str(n), "primitives": str(primitives),
            "tau": common.text_list(common.binary32(depth / length * rng.uniform(0.1, 2))
                                    for _ in range(primitives)),
            "v1": common.text_list(v1), "v2": common.text_list(v2),
            "length": common.text_in(length), **{c: "|".join(g) for c, g in groups.items()}}


if __name__ == "__main__":
    common.main(sys.modules[__name__])
