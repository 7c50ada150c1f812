#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the headers of include/pellucid/math that are nothing but a table.

    write_headers.py [--check] [FOLDER]

FOLDER holds approximation_coefficients.csv (w0_plus.h, w0_minus.h, w1_plus.h, w1_minus.h,
erf_over_x.h, expm1_quotient_to_4.h) and gauss_legendre.csv (gauss_legendre_rules.h). --check writes
nothing and exits with 1 if a header differs from the tables.
"""
import argparse
import csv
import pathlib
import struct
import sys
from collections import defaultdict

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLES = ROOT / "tests/reference_tables"
HEADERS = ROOT / "include/pellucid/math"

# function of the table -> (file and function name, argument, comment)
FITS = {
    "W0_plus": ("w0_plus", "t", r"""
Returns W0+(t) = (δ + 2) (√π / 2) erfcx(δ), δ = 2 (1 - t) / t, on t in [0, 1] (δ = ∞ … 0):
erfcx scaled to be smooth and bounded, from 1/2 at t = 0 (erfcx(x) ~ 1 / (√π x)) to √π at t = 1.
"""),
    "W0_minus": ("w0_minus", "t", r"""
Returns W0-(t) = (δ + 2) Daw(δ), δ = 2 (1 - t) / t, on t in [0, 1] (δ = ∞ … 0): Dawson's
function scaled to be smooth and bounded, from 1/2 at t = 0 (Daw(x) ~ 1 / (2 x)) to 0 at t = 1.
That zero is a simple one: near it only the absolute error is small, and dawson() uses a series.
"""),
    "W1_plus": ("w1_plus", "t", r"""
Returns W1+(t) = (δ + 2)² (1 - √π δ erfcx(δ)) / 2, δ = 2 (1 - t) / t, on t in [0, 1]
(δ = ∞ … 0): from 1/4 at t = 0 to 2 at t = 1. The counterpart of W0+ for the first moment. The
polynomials avoid the formula's bracket, which loses all digits for large δ."""),
    "W1_minus": ("w1_minus", "t", r"""
Returns W1-(t) = (δ + 2)² (2 δ Daw(δ) - 1) / 2, δ = 2 (1 - t) / t, on t in [0, 1]
(δ = ∞ … 0): from 1/4 at t = 0 to -2 at t = 1. The counterpart of W0- for the first moment. The
polynomials avoid the formula's bracket, which loses all digits for large δ. It changes sign at
2 δ Daw(δ) = 1 (δ = 0.924): near there only the absolute error is small."""),
    "erf_over_x": ("erf_over_x", "x_squared", r"""
Returns erf(x) / x as a function of x² in [0, 1]."""),
    "expm1_quotient_to_4": ("expm1_quotient_to_4", "t", r"""
Returns (1 - e^(-x)) / x, x = 4 t, as a function of t in [0, 1]: expm1_quotient(x) for optical
depths of at most 4, without an exponential, whose difference from 1 would cancel for small x. A
Chebyshev series, truncated where the remainder is 0.6 u (float), 0.1 u (double).

Largest relative error 4.2 u (float), 3.6 u (double), near t = 0.98; not valid outside of
[0, 1]. Asserted in tests/math/exponential.cpp and, in lanes, tests/simd."""),
}


def read_fits(path):
    """function -> precision -> interval -> coefficients; and the intervals' ends."""
    fits = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            intervals = fits[row["function"]][row["precision"]]
            interval, degree = int(row["interval"]), int(row["degree"])
            if degree != len(intervals[interval]):
                raise SystemExit(f"{path}: {row['function']}: degrees are not in order")
            intervals[interval].append((row["coefficient"], float(row["lo"]), float(row["hi"])))
    return fits


def literal(text, precision):
    value = float(text)
    if precision == "double":
        return repr(value)
    if struct.unpack("f", struct.pack("f", value))[0] != value:
        raise SystemExit(f"{text} is no binary32 number")
    return f"{value:.9g}f" if "." in f"{value:.9g}" else f"{value:.9g}.0f"


def array(precision, intervals):
    count = len(intervals)
    size = {len(c) for c in intervals.values()}
    if len(size) != 1 or sorted(intervals) != list(range(count)):
        raise SystemExit("intervals differ in degree or are not in order")
    for i, coefficients in intervals.items():
        if any((lo, hi) != (i / count, (i + 1) / count) for _, lo, hi in coefficients):
            raise SystemExit("intervals are not equal parts of [0, 1]")
    lines = [f"    static constexpr {precision} c[{count}][{size.pop()}] = {{"]
    for i in range(count):
        text = ", ".join(literal(c, precision) for c, _, _ in intervals[i])
        line = "        {"
        for word in text.split(" "):
            if len(line) + len(word) + 1 > 99:
                lines.append(line.rstrip())
                line = "         "
            line += word + " "
        lines.append(line.rstrip() + "},")
    return lines + ["    };"]


def evaluation(argument, intervals):
    """The call; more intervals than one are also laid out by coefficient, for batches."""
    if len(intervals) == 1:
        return [f"    return interval_polynomial<T>(c, {argument});"]
    return ["    static constexpr auto by_coefficient = transposed(c);",
            f"    return interval_polynomial<T>(c, by_coefficient, {argument});"]


def fit_header(function, fit):
    name, argument, comment = FITS[function]
    lines = ["// SPDX-License-Identifier: Apache-2.0",
             "// Written by tools/reference/write_headers.py from approximation_coefficients.csv.",
             "#pragma once", "", '#include "pellucid/math/polynomial.h"', "",
             "namespace pellucid {", "", "// clang-format off"]
    lines += [("/// " + line).rstrip() for line in comment.strip().split("\n")]
    lines += ["template <class T>", f"PELLUCID_HD inline T {name}(T {argument}) noexcept {{",
              "  if constexpr (is_single<T>) {"]
    lines += array("float", fit["float"]) + evaluation(argument, fit["float"]) + ["  } else {"]
    lines += array("double", fit["double"]) + evaluation(argument, fit["double"])
    lines += ["  }", "}", "// clang-format on", "", "}  // namespace pellucid", ""]
    return f"{name}.h", "\n".join(lines)


def read_rules(path):
    """n -> kind -> values in the order of the table, row by row."""
    rules = defaultdict(lambda: defaultdict(list))
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            values = rules[int(row["n"])][row["kind"]]
            n, i, j = int(row["n"]), int(row["i"]), int(row["j"])
            if len(values) != (i * n + j if row["kind"] == "collocation" else i):
                raise SystemExit(f"{path}: n = {n}, {row['kind']}: not in order")
            values.append(repr(float(row["value"])))
    return rules


def wrapped(values, indent):
    lines, line = [], indent + "{"
    for i, value in enumerate(values):
        word = value + (", " if i + 1 < len(values) else "}")
        if len(line) + len(word.rstrip()) > 98:
            lines.append(line.rstrip())
            line = indent + " "
        line += word
    return lines + [line]


def rules_header(rules):
    lines = ["// SPDX-License-Identifier: Apache-2.0",
             "// Written by tools/reference/write_headers.py from gauss_legendre.csv.",
             "#pragma once", "", "namespace pellucid {", "", "// clang-format off",
             "/// Nodes, weights and collocation matrix of one Gauss-Legendre rule on [0, 1].",
             "template <class S, int N>", "struct GaussLegendre {",
             "  static_assert(N >= 1 && N <= 12);", "  S node[N];", "  S weight[N];",
             "  S collocation[N][N];", "};", "",
             "/// The rules in double; kernels use gauss_legendre<S, N>() of gauss_legendre.h.",
             "template <int N>", "inline constexpr GaussLegendre<double, N> gauss_legendre_rule{};"]
    for n in sorted(rules):
        rule = rules[n]
        if [len(rule[kind]) for kind in ("node", "weight", "collocation")] != [n, n, n * n]:
            raise SystemExit(f"the rule with {n} nodes is incomplete")
        lines += ["", "template <>",
                  f"inline constexpr GaussLegendre<double, {n}> gauss_legendre_rule<{n}> = {{"]
        for kind in ("node", "weight"):
            lines += wrapped(rule[kind], "    ")
            lines[-1] += ","
        matrix = [wrapped(rule["collocation"][i * n:(i + 1) * n], "     ") for i in range(n)]
        matrix[0][0] = "    {" + matrix[0][0].lstrip()
        for row in matrix:
            row[-1] += ","
        matrix[-1][-1] = matrix[-1][-1][:-1] + "}};"
        lines += [line for row in matrix for line in row]
    return "gauss_legendre_rules.h", "\n".join(lines + ["// clang-format on", "",
                                                        "}  // namespace pellucid", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", nargs="?", default=TABLES, type=pathlib.Path)
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    arguments = parser.parse_args()
    fits = read_fits(arguments.folder / "approximation_coefficients.csv")
    headers = [fit_header(function, fit) for function, fit in fits.items()]
    headers.append(rules_header(read_rules(arguments.folder / "gauss_legendre.csv")))
    stale = []
    for name, text in headers:
        path = HEADERS / name
        if not arguments.check:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            stale.append(name)
    if stale:
        sys.exit(f"not what the tables give: {', '.join(stale)}; run write_headers.py")


if __name__ == "__main__":
    main()
