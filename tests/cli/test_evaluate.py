# SPDX-License-Identifier: Apache-2.0
"""Tables in, tables out: held against the truth tables at the limits of the specification."""

import csv
import os
import struct
import unittest
from decimal import Decimal

from program import SOURCE_DIR, ProgramTest

TABLES = os.path.join(SOURCE_DIR, "tests", "reference_tables")
ROUNDING_UNIT = {"float": Decimal(2) ** -24, "double": Decimal(2) ** -53}
SMALLEST = {"float": Decimal("1e-30"), "double": Decimal("1e-290")}
LINEAR = "id,tau_f,tau_b,C_f,C_b,D\n"
SEGMENT = "id,K,c,v1,v2,tau,length\n"
MIXTURE = "id,K,c,tau,colour,v1,v2,length\n"


def as_binary32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


class Worst:
    """The largest error in units of its limit, and where it is."""

    def __init__(self):
        self.ratio, self.where = Decimal(0), "nowhere"

    def take(self, error, limit, where):
        ratio = error / limit if limit > 0 else (Decimal(0) if error == 0 else Decimal("inf"))
        if ratio > self.ratio:
            self.ratio, self.where = ratio, where


class Evaluate(ProgramTest):
    def evaluate(self, kind, precision, *arguments, own_kind=None):
        """Pairs of rows (truth, own), as dictionaries of text."""
        table = os.path.join(TABLES, kind + ".csv")
        if not os.path.exists(table):
            self.skipTest(table + " not found")
        self.succeed("evaluate", own_kind or kind, table, "-o", "own.csv", "--precision", precision,
                     *arguments)
        with open(table, newline="") as file:
            truth = list(csv.DictReader(file))
        with open(self.path("own.csv"), newline="") as file:
            own = list(csv.DictReader(file))
        self.assertEqual([row["id"] for row in own], [row["id"] for row in truth])
        return truth, own

    def columns_of(self, name):
        return self.read(name).decode().split("\n")[0]

    def check(self, kind, precision, limit_of, *arguments, own_kind=None, least=800):
        """limit_of(column, truth row, true value) is the error allowed; None: not looked at."""
        truth, own = self.evaluate(kind, precision, *arguments, own_kind=own_kind)
        worst, looked_at = {}, 0
        for true_row, own_row in zip(truth, own):
            for column in own_row:
                if column == "id":
                    continue
                true = Decimal(true_row[column])
                limit = limit_of(column, true_row, true)
                if limit is None:
                    continue
                looked_at += 1
                if precision == "float":
                    self.assertEqual(float(own_row[column]), as_binary32(float(own_row[column])))
                error = abs(Decimal(float(own_row[column])) - true)
                worst.setdefault(column, Worst()).take(error, limit, true_row["id"])
        self.assertGreaterEqual(looked_at, least)
        for column, w in worst.items():
            print(f"{kind} {precision} {column}: {float(w.ratio):.3f} of the limit, row {w.where}")
            self.assertLessEqual(w.ratio, 1, f"{kind} {precision} {column}, row {w.where}")

    def test_linear_segment(self):
        for precision, u in ROUNDING_UNIT.items():
            def limit(column, row, true):
                if column == "transparency":
                    return 16 * u
                if abs(true) < SMALLEST[precision]:
                    return SMALLEST[precision]
                return (32 if column == "radiance_independent" else 16) * u * abs(true)
            self.check("linear_segment", precision, limit)
        self.assertEqual(self.columns_of("own.csv"), "id,optical_depth,opacity,transparency,psi,"
                         "weight_f,weight_b,radiance,radiance_independent")

    def test_piecewise_linear_segment(self):
        for precision, u in ROUNDING_UNIT.items():
            def limit(column, row, true):
                if column == "optical_depth":
                    return None
                return max(16 * u * Decimal(row["opacity"]), SMALLEST[precision])
            self.check("piecewise_linear_segment", precision, limit)
        self.assertEqual(self.columns_of("own.csv"),
                         "id,optical_depth,opacity,radiance_r,radiance_g,radiance_b")

    def test_trilinear_cell(self):
        for precision, tolerance in (("float", "1e-3"), ("float", "1e-6"), ("double", "1e-10")):
            # Rounding of the data themselves comes on top of the tolerance in float.
            margin = 64 * ROUNDING_UNIT[precision]
            self.check("trilinear_cell", precision,
                       lambda column, row, true: None if column == "optical_depth"
                       else Decimal(tolerance) + margin, "--tolerance", tolerance)
        self.assertEqual(self.columns_of("own.csv"),
                         "id,optical_depth,opacity,radiance_r,radiance_g,radiance_b")

    def test_special_functions(self):
        # Twice the figures of section 4.3; erfcx of negative x and expm1_quotient as 4.1 has them.
        limits = {"float": {"erf": 4.4, "erfc": 9.2, "erfcx": 8.8, "dawson": 24,
                            "expm1_quotient": 16},
                  "double": {"erf": 4.6, "erfc": 7.8, "erfcx": 8.8, "dawson": 32,
                             "expm1_quotient": 16}}
        largest = {"float": Decimal("3.4e38"), "double": Decimal("1.79e308")}
        smallest_normal = {"float": Decimal("1.2e-38"), "double": Decimal("2.3e-308")}
        for precision, u in ROUNDING_UNIT.items():
            def limit(column, row, true):
                if abs(true) > largest[precision]:
                    return None
                if abs(true) < smallest_normal[precision]:
                    return smallest_normal[precision]
                return Decimal(limits[precision][column]) * u * abs(true)
            self.check("special_functions", precision, limit)
        self.assertEqual(self.columns_of("own.csv"), "id,erf,erfc,erfcx,dawson,expm1_quotient")

    def test_gaussian_segment(self):
        for precision, u in ROUNDING_UNIT.items():
            # The mean density is within 8 u, whatever the row; opacity is held in tests/segment.
            self.check("gaussian_segment", precision,
                       lambda column, row, true: 8 * u if column == "mean_density" else None,
                       least=1000)
        self.assertEqual(self.columns_of("own.csv"), "id,mean_density,optical_depth,opacity")

    def test_gaussian_mixture_segment(self):
        for precision, tolerance in (("float", "1e-5"), ("double", "1e-3"), ("double", "1e-9")):
            margin = 64 * ROUNDING_UNIT[precision]
            self.check("gaussian_mixture_segment", precision,
                       lambda column, row, true: None if column == "optical_depth"
                       else Decimal(tolerance) + margin, "--tolerance", tolerance)
        self.assertEqual(self.columns_of("own.csv"),
                         "id,optical_depth,opacity,radiance_r,radiance_g,radiance_b")

    def test_kniss_is_near_and_not_the_same(self):
        self.evaluate("gaussian_segment", "double")
        accurate = self.read("own.csv")
        self.check("gaussian_segment", "double",
                   lambda column, row, true: Decimal("1e-3") if column == "mean_density" else None,
                   own_kind="gaussian_segment_kniss", least=1000)
        self.assertNotEqual(self.read("own.csv"), accurate)
        self.check("gaussian_mixture_segment", "double",
                   lambda column, row, true: Decimal("1e-3") if column == "opacity" else None,
                   own_kind="gaussian_mixture_segment_kniss", least=400)

    def test_columns_in_any_order_and_others_ignored(self):
        self.write("a.csv", LINEAR + "first,1,2,0.5,0.25,3\nsecond,0,0,1,1,1\n")
        self.write("b.csv", "D,note,C_b,C_f,tau_b,tau_f,id\r\n3,n,0.25,0.5,2,1,first\r\n"
                            "1,,1,1,0,0,second\r\n")
        self.succeed("evaluate", "linear_segment", "a.csv", "-o", "own_a.csv")
        self.succeed("evaluate", "linear_segment", "b.csv", "-o", "own_b.csv")
        self.assertEqual(self.read("own_a.csv"), self.read("own_b.csv"))
        self.assertTrue(self.read("own_a.csv").endswith(b"\nsecond,0,0,1,1,0,0,0,1\n"))

    def test_a_table_without_rows(self):
        self.write("a.csv", LINEAR)
        self.succeed("evaluate", "linear_segment", "a.csv", "-o", "own.csv")
        self.assertEqual(self.read("own.csv").count(b"\n"), 1)

    def test_bad_tables(self):
        cell = "id,corners,entry,exit,D,tf_kind,tf_x,tf_tau,tf_r,tf_g,tf_b\n"
        eight, ends = "0;0;0;0;1;1;1;1", "0;0;0,1;1;1"
        for kind, text, pattern in (
                ("linear_segment", "", "empty"),
                ("linear_segment", "id,tau_f,tau_b,C_f,C_b\n1,1,1,1,1\n", "no column 'D'"),
                ("linear_segment", "tau_f,tau_b,C_f,C_b,D\n1,1,1,1,1\n", "no column 'id'"),
                ("linear_segment", LINEAR + "1,1,1,1,1,1\n2,1,x,1,1,1\n",
                 "line 3, column 'tau_b': 'x'"),
                ("linear_segment", LINEAR + "1,1,1,1,1\n", "line 2: 5 cells"),
                ("linear_segment", LINEAR + "1,1,1,1,1,1,1\n", "line 2: 7 cells"),
                ("linear_segment", LINEAR + "1,-1,1,1,1,1\n",
                 "line 2, column 'tau_f': -1 is negative"),
                ("linear_segment", LINEAR + "1,1,1,1,1,nan\n", "column 'D': 'nan' is not finite"),
                ("linear_segment", LINEAR + "1,1,1,1,1,inf\n", "column 'D': 'inf' is not finite"),
                ("special_functions", "id,x\n1,2\n1,\n", "line 3, column 'x': ''"),
                ("trilinear_cell", cell + f"1,0;1,{ends},1,piecewise_linear,0,1,1,1,1\n",
                 "column 'corners': 2 numbers where 8"),
                ("trilinear_cell", cell + f"1,{eight},0;0;0,1;1;2,1,piecewise_linear,0,1,1,1,1\n",
                 "column 'exit': 2 is outside"),
                ("trilinear_cell", cell + f"1,{eight},{ends},1,cubic,0,1,1,1,1\n",
                 "column 'tf_kind': 'cubic'"),
                ("trilinear_cell", cell + f"1,{eight},{ends},1,gaussian,0,1,1,1,1\n",
                 "no column 'tf_k'"),
                ("trilinear_cell",
                 cell[:-1] + f",tf_k\n1,{eight},{ends},1,gaussian,0,1,1,1,1,2;3\n",
                 "column 'tf_k': 2 numbers where 1"),
                ("trilinear_cell", cell[:-1] + f",tf_k\n1,{eight},{ends},1,gaussian,0,-1,1,1,1,2\n",
                 "line 2: .*extinction"),
                ("gaussian_segment", SEGMENT + "1,1;2;3,0;0,0;0,1;1,1,1\n",
                 "line 2: K has 3 numbers"),
                ("gaussian_segment", SEGMENT + "1,1,0;0,0,1,1,1\n", "line 2: c has 2 numbers"),
                ("gaussian_segment", SEGMENT + "1,1,0,0,1;2,1,1\n",
                 "column 'v2': 2 numbers where 1"),
                ("gaussian_segment", SEGMENT + "1,1,0,,,1,1\n", "column 'v1': 0 numbers"),
                ("gaussian_segment", SEGMENT + "1,1,0,0,1,-1,1\n", "column 'tau': -1 is negative"),
                ("gaussian_segment", SEGMENT + "1,1e30,0,1e300,1,1,1\n",
                 "out of the range of double"),
                ("gaussian_segment_kniss", SEGMENT + "1,1,0,0,1,1e200,1e200\n",
                 "tau times length is out of the range"),
                ("gaussian_mixture_segment", MIXTURE + "1,1|1,0,1;1,1;1;1|1;1;1,0,1,1\n",
                 "2 lists in K, 1 in c"),
                ("gaussian_mixture_segment", MIXTURE + "1,1,0,1,1;1,0,1,1\n",
                 "primitive 0: colour has 2"),
                ("gaussian_mixture_segment_kniss", MIXTURE + "1,,,,,0,1,1\n", "0 lists in K"),
                ("trilinear_cell", cell + f"1,{eight},{ends},1,piecewise_linear,,,,,\n",
                 "line 2: "),
                ("trilinear_cell",
                 cell + f"1,{eight},{ends},1,piecewise_linear,1;0,1;1,1;1,1;1,1;1\n", "line 2: "),
                ("trilinear_cell",
                 cell + f"1,{eight},{ends},1,piecewise_linear,0;1,1,1;1,1;1,1;1\n",
                 "column 'tf_tau': 1 numbers where 2")):
            with self.subTest(text=text):
                self.write("t.csv", text)
                self.fail_with(pattern, "evaluate", kind, "t.csv", "-o", "own.csv")

    def test_float_says_what_it_cannot_hold(self):
        self.write("t.csv", "id,x\n1,1e300\n")
        self.fail_with("use double", "evaluate", "special_functions", "t.csv", "-o", "own.csv",
                       "--precision", "float")
        self.succeed("evaluate", "special_functions", "t.csv", "-o", "own.csv")

    def test_bad_arguments(self):
        self.write("t.csv", "id,x\n1,2\n")
        run = ("evaluate", "special_functions", "t.csv")
        self.fail_with("-o|--output", *run, code=2)
        self.fail_with("closed form", *run, "-o", "o.csv", "--tolerance", "1e-3", code=2)
        self.fail_with("--tolerance", "evaluate", "trilinear_cell", "t.csv", "-o", "o.csv",
                       "--tolerance", "0", code=2)
        self.fail_with("half", *run, "-o", "o.csv", "--precision", "half", code=2)
        self.fail_with("KIND", "evaluate", "cubic_segment", "t.csv", "-o", "o.csv", code=2)
        self.fail_with("missing.csv", "evaluate", "special_functions", "missing.csv", "-o", "o.csv")
        self.fail_with("missing", *run, "-o", "missing/o.csv")

    def test_a_failure_leaves_the_earlier_output(self):
        self.write("t.csv", "id,x\n1,2\n")
        self.succeed("evaluate", "special_functions", "t.csv", "-o", "own.csv")
        self.write("t.csv", "id,x\n1,2\n2,y\n")
        self.fail_with("'y'", "evaluate", "special_functions", "t.csv", "-o", "own.csv")


if __name__ == "__main__":
    unittest.main()
