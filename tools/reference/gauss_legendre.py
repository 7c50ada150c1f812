#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generates gauss_legendre.csv: nodes, weights and collocation matrices on [0, 1], 1 to 12 nodes.

Truth is the zeros of the Legendre polynomials by Newton's method, and the integrals of the Lagrange
polynomials on them, at 60 digits.
"""
import argparse
import sys

from mpmath import mp, mpf

import common

NAME = "gauss_legendre"
COLUMNS = ["n", "kind", "i", "j", "value"]


def nodes(n):
    """Ascending zeros on [0, 1], at the working precision."""
    result = []
    for i in range(n, 0, -1):
        x = mp.cos(mp.pi * (i - mpf(1) / 4) / (n + mpf(1) / 2))
        for _ in range(100):
            before, p = mpf(1), x
            for k in range(2, n + 1):
                before, p = p, ((2 * k - 1) * x * p - (k - 1) * before) / k
            step = p * (x * x - 1) / (n * (x * p - before))
            x -= step
            if abs(step) < mp.eps * 16:
                break
        result.append((1 + x) / 2)
    if n % 2:
        result[n // 2] = mpf(1) / 2
    return result


def lagrange(points, k):
    """Coefficients, constant first, of the polynomial that is 1 at points[k] and 0 at the
    others."""
    c = [mpf(1)]
    for i, point in enumerate(points):
        if i != k:
            shifted = [mpf(0)] + c
            c = [(a - point * b) / (points[k] - point) for a, b in zip(shifted, c + [mpf(0)])]
    return c


def rule(n):
    """Nodes, weights and collocation matrix."""
    u = nodes(n)
    polynomials = [lagrange(u, k) for k in range(n)]

    def integral(c, end):
        return sum(a * end ** (d + 1) / (d + 1) for d, a in enumerate(c))

    return (u, [integral(c, mpf(1)) for c in polynomials],
            [[integral(c, end) for c in polynomials] for end in u])


def values():
    """Every row's key and value, in the order of the table."""
    with mp.workdps(60):
        for n in range(1, 13):
            u, weights, collocation = rule(n)
            for i in range(n):
                yield (n, "node", i, 0), u[i]
            for i in range(n):
                yield (n, "weight", i, 0), weights[i]
            for i in range(n):
                for j in range(n):
                    yield (n, "collocation", i, j), collocation[i][j]


def compare(table):
    """(kind, text, value, scale) of every row of an existing table, for verify.py."""
    known = dict(values())
    for row in table:
        key = (int(row["n"]), row["kind"], int(row["i"]), int(row["j"]))
        yield row["kind"], row["value"], known.pop(key), mpf(1)
    if known:
        raise ValueError(f"{len(known)} rows are missing, {next(iter(known))} among them")


def main():
    parser = argparse.ArgumentParser(description=__doc__.strip().split("\n")[0])
    parser.add_argument("-o", "--output", help="file to write; standard output if not given")
    arguments = parser.parse_args()
    file = open(arguments.output, "w", newline="") if arguments.output else sys.stdout
    with file:
        common.write(file, COLUMNS, (
            dict(zip(COLUMNS, [*map(str, key), common.text_out(value, strip_zeros=True)]))
            for key, value in values()))


if __name__ == "__main__":
    main()
