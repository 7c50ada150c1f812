#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recomputes the outputs of a truth table and reports the largest disagreement.

    verify.py [--sample N] [--tolerance E] TABLE.csv ...

A table is known by its file name. --sample takes N rows spread over the table. Disagreement is
relative; where a table says 0.0, the recomputed number has to be below the smallest normal
binary64. Coefficients of approximations are compared with the largest one of their polynomial.
Exits with 1 when a disagreement exceeds the tolerance (1e-21; coefficients: the rounding of their
precision).
"""
import argparse
import importlib
import pathlib
import sys
import time

from mpmath import mp, mpf

import common


def disagreement(text, value):
    """Relative; a number that a table may write as 0.0 agrees with 0.0."""
    with mp.workdps(60):
        given = mpf(text)
        if given == 0:
            return mpf(0) if abs(value) < common.SMALLEST else mp.inf
        return abs(value / given - 1)


def verify_rows(module, table):
    """column -> (largest disagreement, id of its row)"""
    worst = {column: (mpf(0), "none") for column in module.OUTPUTS}
    for row in table:
        for column, value in module.outputs(row).items():
            worst[column] = max(worst[column], (disagreement(row[column], value), row["id"]),
                                key=lambda pair: pair[0])
    return worst


def verify_values(module, table):
    """The same for a table of single values that its module can enumerate."""
    worst = {}
    for key, text, value, scale in module.compare(table):
        with mp.workdps(60):
            error = abs(value - mpf(text)) / scale
        if error >= worst.get(key, (mpf(-1),))[0]:
            worst[key] = (error, text)
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__.strip().split("\n")[0])
    parser.add_argument("tables", nargs="+", type=pathlib.Path, metavar="TABLE.csv")
    parser.add_argument("--sample", type=int, help="rows to take")
    parser.add_argument("--tolerance", type=mpf, help="largest disagreement allowed")
    arguments = parser.parse_args()
    failed = False
    for path in arguments.tables:
        module = importlib.import_module(path.stem)
        table = common.read(path)
        start = time.time()
        if hasattr(module, "compare"):
            used, worst = len(table), verify_values(module, table)
        else:
            step = max(1, len(table) // arguments.sample) if arguments.sample else 1
            sample = table[::step]
            used, worst = len(sample), verify_rows(module, sample)
        tolerance = arguments.tolerance or getattr(module, "TOLERANCE", mpf("1e-21"))
        print(f"{path.name}: {used} of {len(table)} rows, {time.time() - start:.0f} s")
        for column, (error, where) in worst.items():
            limit = tolerance[column] if isinstance(tolerance, dict) else tolerance
            good = error <= limit
            failed = failed or not good
            print(f"  {column:22} {mp.nstr(error, 2):>9}  at {where}{'' if good else '  FAILED'}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
