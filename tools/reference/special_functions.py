#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates special_functions.csv: erf, erfc, erfcx, Dawson's function and (1 - e^-x) / x.

Truth is mpmath's erf, erfc and erfi at 60 digits, with the scaled functions by their asymptotic
series from x = 40 on.
"""
import sys

from mpmath import mp, mpf

import common

NAME = "special_functions"
INPUTS = ["x"]
OUTPUTS = ["erf", "erfc", "erfcx", "dawson", "expm1_quotient"]
ROWS = 900


def asymptotic(x, sign):
    """1 + sum_k (2k-1)!! (sign / (2 x²))^k until it no longer changes the sum."""
    factor = sign / (2 * x * x)
    term = total = mpf(1)
    k = 0
    while abs(term) > mp.eps * mpf("1e-5"):
        k += 1
        term *= (2 * k - 1) * factor
        total += term
        if k > x * x:
            raise ValueError("the asymptotic series diverges before it reaches this precision")
    return total


def far(x):
    """Whether the asymptotic series reaches the working precision: its best term is e^(-x²)."""
    return x * x > mp.dps * 2.5 + 20


def erfcx(x):
    if x > 0 and far(x):
        return asymptotic(x, -1) / (x * mp.sqrt(mp.pi))
    return mp.exp(x * x) * mp.erfc(x)


def dawson(x):
    if far(abs(x)):
        return asymptotic(x, +1) / (2 * x)
    return mp.sqrt(mp.pi) / 2 * mp.exp(-x * x) * mp.erfi(x)


def outputs(row):
    with mp.workdps(60):
        x = common.number(row, "x")
        return {"erf": mp.erf(x), "erfc": mp.erfc(x) if x < 40 else mpf(0), "erfcx": erfcx(x),
                "dawson": dawson(x), "expm1_quotient": -mp.expm1(-x) / x if x != 0 else mpf(1)}


def inputs(rng, count):
    for x in (0.0, 0.25, 0.5, 1.0, 2.0, -0.25, -0.5, -1.0, -2.0, -26.0, 26.0, 88.0):
        yield "edge", {"x": common.text_in(x)}
    for i in range(count - 12):
        kind = ("moderate", "negative", "tiny", "huge")[i % 4]
        x = {"moderate": lambda: common.uniform(rng, 0, 30),
             "negative": lambda: common.uniform(rng, -26, 0),
             "tiny": lambda: common.log_uniform(rng, 1e-30, 1) * rng.choice((-1, 1)),
             "huge": lambda: common.log_uniform(rng, 1, 1e30)}[kind]()
        yield kind, {"x": common.text_in(x)}


if __name__ == "__main__":
    common.main(sys.modules[__name__])
