#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates trilinear_cell.csv: a ray through one trilinear cell.

The transfer function is piecewise linear or Gaussian.

The cubic along the ray is interpolated exactly; it is cut at its extrema and at its crossings with
the control values, bracketed on monotone stretches, at 60 digits. With a piecewise-linear table the
depth is then a sum of exact quartics. Radiance, and the depth of Gaussians, come from adaptive
quadrature at 45 digits.
"""
import sys

from mpmath import mp, mpf

import common
from piecewise_linear_segment import TRANSFER_FUNCTION, TransferFunction, transfer_function
from quadrature import integrate

NAME = "trilinear_cell"
INPUTS = ["corners", "entry", "exit", "D", "tf_kind"] + TRANSFER_FUNCTION + ["tf_k"]
OUTPUTS = ["optical_depth", "opacity", "radiance_r", "radiance_g", "radiance_b"]
ROWS = 400
DIGITS = 45


def trilinear(corners, x, y, z):
    value = mpf(0)
    for i, corner in enumerate(corners):
        value += (corner * (x if i & 1 else 1 - x) * (y if i & 2 else 1 - y)
                  * (z if i & 4 else 1 - z))
    return value


def cubic_along(corners, entry, leave):
    """Coefficients, constant first, of the cubic of t in [0, 1] from entry to leave."""
    f0, f1, f2, f3 = (trilinear(corners, *(a + t * (b - a) for a, b in zip(entry, leave)))
                      for t in (mpf(k) / 3 for k in range(4)))
    return [f0, (-11 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 2,
            9 * (2 * f0 - 5 * f1 + 4 * f2 - f3) / 2, 9 * (-f0 + 3 * f1 - 3 * f2 + f3) / 2]


def evaluate(c, t):
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]))


def extrema(c):
    """The zeros of the derivative in (0, 1). Coefficients that are zero but for rounding are
    zero."""
    noise = mp.eps * mpf("1e6") * max(abs(x) for x in c)
    a, b, d = (x if abs(x) > noise else mpf(0) for x in (3 * c[3], 2 * c[2], c[1]))
    if a == 0:
        roots = [-d / b] if b != 0 else []
    else:
        radicand = b * b - 4 * a * d
        if radicand < 0:
            return []
        w = -(b + (1 if b >= 0 else -1) * mp.sqrt(radicand)) / 2
        roots = [w / a] + ([d / w] if w != 0 else [])
    return sorted(t for t in roots if 0 < t < 1)


def crossings(c, values):
    """Extrema and crossings with the values, ascending, with 0 and 1."""
    ends = [mpf(0)] + extrema(c) + [mpf(1)]
    points = set(ends)
    for a, b in zip(ends, ends[1:]):
        fa, fb = evaluate(c, a), evaluate(c, b)
        for value in values:
            if min(fa, fb) < value < max(fa, fb):
                low, high = (a, b) if fa < fb else (b, a)
                t = (a + b) / 2
                for _ in range(400):
                    error = evaluate(c, t) - value
                    if error == 0:
                        break
                    low, high = (t, high) if error < 0 else (low, t)
                    slope = c[1] + t * (2 * c[2] + t * 3 * c[3])
                    step = t - error / slope if slope != 0 else low
                    if not min(low, high) < step < max(low, high):
                        step = (low + high) / 2
                    if abs(step - t) <= mp.eps * 4:
                        break
                    t = step
                points.add(t)
    return sorted(points)


def rates_of(c, values, length):
    """Rates of the quadrature from values(f) = (τ, r, g, b)."""
    def rates(t):
        tau, *color = values(evaluate(c, t))
        return [length * tau] + [length * tau * x for x in color]
    return rates


def piecewise_linear(row, c, length):
    transfer = TransferFunction(row)
    cuts = crossings(c, transfer.x)
    parts, depth = [], mpf(0)
    for a, b in zip(cuts, cuts[1:]):
        f = evaluate(c, (a + b) / 2)
        k = sum(1 for x in transfer.x if x <= f)
        if 0 < k < len(transfer.x):
            x0, x1 = transfer.x[k - 1], transfer.x[k]
            low, high = transfer.values[k - 1], transfer.values[k]
        else:
            x0, x1 = mpf(0), mpf(1)
            low = high = transfer.values[0 if k == 0 else -1]

        def values(f, x0=x0, x1=x1, low=low, high=high):
            return [p + (q - p) * (f - x0) / (x1 - x0) for p, q in zip(low, high)]

        # ∫ τ: the mean of a cubic by Simpson's rule, which is exact for it.
        tau = [values(evaluate(c, t))[0] for t in (a, (a + b) / 2, b)]
        m = length * (b - a) * (tau[0] + 4 * tau[1] + tau[2]) / 6
        parts.append((a, b, m, values))
        depth += m
    radiance, before = [mpf(0)] * 3, mpf(0)
    for a, b, m, values in parts:
        if m > common.SMALLEST and before < 140:
            part = integrate(rates_of(c, values, length), [a, b], m, mpf("1e-30"))
            radiance = [x + mp.exp(-before) * y for x, y in zip(radiance, part[1:])]
        before += m
    return [depth] + radiance


def gaussians(row, c, length):
    centers, taus = common.numbers(row, "tf_x"), common.numbers(row, "tf_tau")
    sharpness = common.numbers(row, "tf_k")
    colors = list(zip(*(common.numbers(row, column) for column in TRANSFER_FUNCTION[2:])))

    def rates(t):
        f = evaluate(c, t)
        rho = [length * tau * mp.exp(-(k * (f - x)) ** 2)
               for tau, k, x in zip(taus, sharpness, centers)]
        return [sum(rho)] + [sum(r * color[i] for r, color in zip(rho, colors)) for i in range(3)]

    ladder = {x + s * w / k for x, k in zip(centers, sharpness) if k != 0
              for w in (0, mpf("0.5"), 1, 2, 3, 5, 8, 13) for s in (-1, 1)}
    cuts = crossings(c, ladder)
    estimate = sum((b - a) * rates((a + b) / 2)[0] for a, b in zip(cuts, cuts[1:]))
    return integrate(rates, cuts, estimate, mpf("1e-28"))


def outputs(row):
    with mp.workdps(DIGITS + 15):
        corners, entry, leave = (common.numbers(row, c) for c in ("corners", "entry", "exit"))
        c = cubic_along(corners, entry, leave)
        length = common.number(row, "D")
        method = {"piecewise_linear": piecewise_linear, "gaussian": gaussians}[row["tf_kind"]]
        depth, *radiance = method(row, c, length) if length > 0 else [mpf(0)] * 4
        return dict(zip(OUTPUTS, [depth, -mp.expm1(-depth), *radiance]))


def random_ray(rng, regime):
    """Corner values, entry and exit."""
    corners = [common.uniform(rng, 0, 1) for _ in range(8)]
    if regime == "saddle":
        corners = [float(bin(i).count("1") % 2) for i in range(8)]
    elif regime == "linear_field":
        corners = [common.binary32(0.125 * (i & 1) + 0.25 * (i >> 1 & 1) + 0.5 * (i >> 2))
                   for i in range(8)]
    elif regime == "constant":
        corners = [corners[0]] * 8
    elif regime == "large_values":
        corners = [common.binary32(2e5 * x) for x in corners]
    entry, leave = ([common.uniform(rng, 0, 1) for _ in range(3)] for _ in range(2))
    entry[rng.randrange(3)], leave[rng.randrange(3)] = 0.0, 1.0
    if regime == "axis":
        entry, leave = [0.0] + entry[1:], [1.0] + entry[1:]
    elif regime == "face":
        entry[2] = leave[2] = 0.0
    elif regime == "short":
        leave = [common.binary32(min(1.0, x + 1e-3 * rng.random())) for x in entry]
    return corners, entry, leave


def inputs(rng, count):
    regimes = ("generic", "saddle", "linear_field", "constant", "large_values", "axis", "face",
               "short")
    for i in range(count):
        regime = regimes[i % len(regimes)]
        corners, entry, leave = random_ray(rng, regime)
        length = common.log_uniform(rng, 1e-2, 10)
        scale = 2e5 if regime == "large_values" else 1.0
        row, x = transfer_function(rng, 0, scale, rng.choice((0.01, 1, 30)) / length)
        row.update(tf_kind="piecewise_linear", tf_k="")
        if i // len(regimes) % 2:
            widths = [common.binary32(common.log_uniform(rng, 0.5, 40) / scale) for _ in x]
            row.update(tf_kind="gaussian", tf_k=common.text_list(widths))
        yield regime, {"corners": common.text_list(corners), "entry": common.text_list(entry),
                       "exit": common.text_list(leave), "D": common.text_in(length), **row}


if __name__ == "__main__":
    common.main(sys.modules[__name__])
