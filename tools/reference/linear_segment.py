#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates linear_segment.csv: extinction and color (or source) linear along the segment.

Truth is the classical closed form with erfcx and Dawson's function (specification, equations 6 and
7) at 300 digits, which leaves more than 100 after all its cancellation; constant extinction is a
case of its own, chosen by exact comparison.
"""
import sys

from mpmath import mp, mpf

import common
from special_functions import dawson, erfcx

NAME = "linear_segment"
INPUTS = ["tau_f", "tau_b", "C_f", "C_b", "D"]
OUTPUTS = ["optical_depth", "opacity", "transparency", "psi", "weight_f", "weight_b", "radiance",
           "radiance_independent"]
ROWS = 1500
PRECISION = 300


def integrals(x_f, x_b):
    """Optical depth, opacity, transparency, and the integrals of T(u) and u T(u) over [0, 1] for
    the rate x_f + (x_b - x_f) u, at the working precision (less what cancels)."""
    m = (x_f + x_b) / 2
    opacity, transparency = -mp.expm1(-m), mp.exp(-m)
    if m == 0:
        return m, opacity, transparency, mpf(1), mpf(1) / 2
    if x_f == x_b:
        return m, opacity, transparency, opacity / m, (opacity - m * transparency) / (m * m)
    sigma = mp.sqrt(abs(x_b - x_f) / 2)
    front, back = x_f / (2 * sigma), x_b / (2 * sigma)
    if x_b > x_f:
        psi = mp.sqrt(mp.pi) / (2 * sigma) * (erfcx(front) - transparency * erfcx(back))
    else:
        psi = (dawson(front) - transparency * dawson(back)) / sigma
    # 2 q Ψ₁ + x_f Ψ = 1 - T, from integrating T' = -τ T.
    return m, opacity, transparency, psi, (opacity - x_f * psi) / (x_b - x_f)


def outputs(row):
    with mp.workdps(PRECISION):
        tau_f, tau_b, c_f, c_b, d = (common.number(row, c) for c in INPUTS)
        m, opacity, transparency, psi, psi_1 = integrals(tau_f * d, tau_b * d)
        weight_f, weight_b = 1 - psi, psi - transparency
        if m == 0:
            weight_f = weight_b = mpf(0)
        return {"optical_depth": m, "opacity": opacity, "transparency": transparency, "psi": psi,
                "weight_f": weight_f, "weight_b": weight_b,
                "radiance": c_f * weight_f + c_b * weight_b,
                "radiance_independent": d * (c_f * (psi - psi_1) + c_b * psi_1)}


def end_rates(rng, regime):
    """Extinction at both ends and length for one regime."""
    length = common.log_uniform(rng, 1e-3, 1e3)
    mean = {"thin": (1e-9, 1e-2), "moderate": (1e-2, 2), "thick": (1.9, 30), "opaque": (30, 1e6)}
    low, high = mean.get(regime, (1e-6, 1e3))
    tau = common.log_uniform(rng, low, high) / length
    contrast = rng.uniform(-1, 1)
    if regime == "constant":
        contrast = 0
    elif regime == "near_constant":
        contrast = rng.choice((-1, 1)) * 10 ** rng.uniform(-7.2, -2)
    elif regime == "one_end_zero":
        contrast = rng.choice((-1, 1))
    elif regime == "one_end_small":
        contrast = rng.choice((-1, 1)) * (1 - 10 ** rng.uniform(-7, -2))
    return (common.binary32(tau * (1 - contrast)), common.binary32(tau * (1 + contrast)), length)


def inputs(rng, count):
    edges = [(f, b, d) for d in (0.0, 1.0, 100.0) for f in (0.0, 1.0) for b in (0.0, 1.0)]
    edges += [(1e-30, 0.0, 1e-3), (1e6, 1e6, 1e6), (0.0, 1e6, 1e6), (1e6, 0.0, 1e6)]
    regimes = ("thin", "moderate", "thick", "opaque", "constant", "near_constant", "one_end_zero",
               "one_end_small")
    for i in range(count):
        if i < len(edges):
            regime, (tau_f, tau_b, d) = "edge", map(common.binary32, edges[i])
        else:
            regime = regimes[i % len(regimes)]
            tau_f, tau_b, d = end_rates(rng, regime)
        colors = common.uniform(rng, 0, 1), common.uniform(rng, 0, 1)
        yield regime, dict(zip(INPUTS, map(common.text_in, (tau_f, tau_b, *colors, d))))


if __name__ == "__main__":
    common.main(sys.modules[__name__])
