#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates approximation_coefficients.csv: the polynomials of include/pellucid/math.

They stand in w0_plus.h, w0_minus.h, w1_plus.h, w1_minus.h, erf_over_x.h and expm1_quotient_to_4.h.

Each is the truncated Chebyshev series of its function on an interval, at 60 digits, written as a
monomial in s in [-1, 1] and then rounded to the precision it is for.
"""
import argparse
import sys

from mpmath import mp, mpf

import common
from special_functions import dawson, erfcx

NAME = "approximation_coefficients"
COLUMNS = ["function", "precision", "interval", "lo", "hi", "degree", "coefficient"]


def scaled_tail(order, sign):
    """W_order with the sign of q (specification, 3.3), as a function of t."""
    def function(t):
        if t == 0:
            return mpf(1) / 2 if order == 0 else mpf(1) / 4
        delta = 2 * (1 - t) / t
        # The brackets of order 1 cancel like 1 / δ²; everything else is benign.
        with mp.extraprec(2 * max(0, int(mp.mag(delta))) + 20):
            if sign > 0:
                tail = mp.sqrt(mp.pi) / 2 * erfcx(delta)
                bracket = (1 - 2 * delta * tail) / 2
            else:
                tail = dawson(delta)
                bracket = (2 * delta * tail - 1) / 2
            return (delta + 2) * tail if order == 0 else (delta + 2) ** 2 * bracket
    return function


def erf_over_x(y):
    x = mp.sqrt(y)
    return mp.erf(x) / x if x != 0 else 2 / mp.sqrt(mp.pi)


def expm1_quotient_to_4(t):
    return -mp.expm1(-4 * t) / (4 * t) if t != 0 else mpf(1)


FUNCTIONS = {"W0_plus": scaled_tail(0, +1), "W0_minus": scaled_tail(0, -1),
             "W1_plus": scaled_tail(1, +1), "W1_minus": scaled_tail(1, -1),
             "erf_over_x": erf_over_x, "expm1_quotient_to_4": expm1_quotient_to_4}

EXTRA_NODES = 20

# function, precision -> equal intervals of [0, 1], degree
FITS = {("W0_plus", "float"): (1, 11), ("W0_plus", "double"): (16, 9),
        ("W0_minus", "float"): (16, 8), ("W0_minus", "double"): (16, 15),
        ("W1_plus", "float"): (1, 13), ("W1_plus", "double"): (16, 10),
        ("W1_minus", "float"): (16, 8), ("W1_minus", "double"): (16, 15),
        ("erf_over_x", "float"): (1, 6), ("erf_over_x", "double"): (1, 13),
        ("expm1_quotient_to_4", "float"): (1, 9), ("expm1_quotient_to_4", "double"): (1, 17)}


def truncated_chebyshev_series(function, lo, hi, degree):
    """Monomial coefficients in s, constant first. The Chebyshev coefficients come from more nodes
    than are kept, so that the tail of the series does not alias into them."""
    n = degree + 1 + EXTRA_NODES
    values = [function((lo + hi + mp.cos(mp.pi * (2 * k + 1) / (2 * n)) * (hi - lo)) / 2)
              for k in range(n)]
    result = [mpf(0)] * (degree + 1)
    before, current = [mpf(1)], [mpf(0), mpf(1)]  # T_0, T_1
    for j in range(degree + 1):
        weight = mpf(2 if j else 1) / n * mp.fsum(
            v * mp.cos(mp.pi * j * (2 * k + 1) / (2 * n)) for k, v in enumerate(values))
        for i, c in enumerate(before):
            result[i] += weight * c
        following = [mpf(0)] + [2 * c for c in current]
        for i, c in enumerate(before):
            following[i] -= c
        before, current = current, following
    return result


def fits():
    """(function, precision, interval, lo, hi, coefficients) of every polynomial, unrounded."""
    with mp.workdps(60):
        for (name, precision), (count, degree) in FITS.items():
            for i in range(count):
                lo, hi = mpf(i) / count, mpf(i + 1) / count
                yield name, precision, i, lo, hi, truncated_chebyshev_series(
                    FUNCTIONS[name], lo, hi, degree)


def rows():
    for name, precision, i, lo, hi, coefficients in fits():
        for degree, c in enumerate(coefficients):
            value = common.binary32(float(c)) if precision == "float" else float(c)
            yield dict(zip(COLUMNS, [name, precision, str(i), repr(float(lo)), repr(float(hi)),
                                     str(degree), repr(value)]))


def compare(table):
    """(kind, text, value, scale) of every row of an existing table, for verify.py."""
    known = {}
    for name, precision, i, _, _, coefficients in fits():
        scale = max(abs(c) for c in coefficients)
        for degree, c in enumerate(coefficients):
            known[name, precision, i, degree] = c, scale
    for row in table:
        key = (row["function"], row["precision"], int(row["interval"]), int(row["degree"]))
        value, scale = known.pop(key)
        yield f"{row['function']} {row['precision']}", row["coefficient"], value, scale
    if known:
        raise ValueError(f"{len(known)} rows are missing, {next(iter(known))} among them")


# Relative to the largest coefficient: a rounding to binary32; one to 16 decimal digits, which is
# how the table prints binary64.
TOLERANCE = {f"{name} {precision}": mpf(2) ** -24 if precision == "float" else mpf("2.5e-16")
             for name, precision in FITS}


def main():
    parser = argparse.ArgumentParser(description=__doc__.strip().split("\n")[0])
    parser.add_argument("-o", "--output", help="file to write; standard output if not given")
    arguments = parser.parse_args()
    file = open(arguments.output, "w", newline="") if arguments.output else sys.stdout
    with file:
        common.write(file, COLUMNS, rows())


if __name__ == "__main__":
    main()
