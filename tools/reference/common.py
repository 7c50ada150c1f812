# SPDX-License-Identifier: Apache-2.0
"""Numbers, files and command line that the generators share.

A table's module has NAME, INPUTS, OUTPUTS (column names), ROWS (its usual number of rows),
`inputs(random, count)` that yields `(regime, {column: text})`, and `outputs(row) -> {column: mpf}`,
where row maps columns to texts. Whatever `inputs` writes, `outputs` reads back from the text:
generating and verifying a table are the same computation.
"""
import argparse
import csv
import math
import random
import struct
import sys

from mpmath import mp, mpf

DIGITS = 25
SMALLEST = mpf(2) ** -1022  # below the smallest normal binary64 a table says 0.0


def binary32(x):
    """The nearest binary32 number, as a float."""
    return struct.unpack("f", struct.pack("f", x))[0]


def log_uniform(rng, low, high):
    return binary32(math.exp(rng.uniform(math.log(low), math.log(high))))


def uniform(rng, low, high):
    return binary32(rng.uniform(low, high))


def text_in(x):
    """A binary32 number so that reading it as binary64 gives exactly it."""
    if binary32(x) != x:
        raise ValueError(f"{x!r} is not a binary32 number")
    return repr(float(x))


def text_list(numbers):
    return ";".join(text_in(x) for x in numbers)


def text_out(x, strip_zeros=False):
    if abs(x) < SMALLEST:
        return "0.0"
    return mp.nstr(x, DIGITS, strip_zeros=strip_zeros)


def number(row, column):
    """The exact value of an input."""
    return mpf(float(row[column]))


def numbers(row, column, separator=";"):
    return [mpf(float(x)) for x in row[column].split(separator)] if row[column] else []


def matrix(cell, rows):
    values = [mpf(float(x)) for x in cell.split(";")]
    columns = len(values) // rows
    return [values[i * columns:(i + 1) * columns] for i in range(rows)]


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def write(file, columns, rows):
    file.write(",".join(columns) + "\n")
    for row in rows:
        file.write(",".join(row[c] for c in columns) + "\n")


def generate(module, count, seed):
    rng = random.Random(seed)
    for i, (regime, row) in enumerate(module.inputs(rng, count)):
        row = {"id": str(i), "regime": regime, **row}
        row.update({c: text_out(x) for c, x in module.outputs(row).items()})
        yield row


def main(module):
    """The command line of every generator of a table with rows of inputs and outputs."""
    parser = argparse.ArgumentParser(description=module.__doc__.strip().split("\n")[0])
    parser.add_argument("--rows", type=int, default=module.ROWS)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", help="file to write; standard output if not given")
    arguments = parser.parse_args()
    columns = ["id", "regime"] + module.INPUTS + module.OUTPUTS
    file = open(arguments.output, "w", newline="") if arguments.output else sys.stdout
    with file:
        write(file, columns, generate(module, arguments.rows, arguments.seed))
