# SPDX-License-Identifier: Apache-2.0
"""The truth tables and tools/reference: samples of the committed tables are recomputed, fresh
tables are generated and verified, and a table with a wrong digit is refused."""
import importlib
import pathlib
import random
import sys
import unittest

TABLES = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(TABLES.parents[1] / "tools/reference"))
import common  # noqa: E402
import verify  # noqa: E402
from mpmath import mpf  # noqa: E402

# table -> (rows of the committed table to recompute, rows to generate)
WITH_ROWS = {"special_functions": (60, 40), "linear_segment": (60, 40),
             "gaussian_segment": (40, 30),
             "piecewise_linear_segment": (40, 30), "gaussian_mixture_segment": (3, 2),
             "trilinear_cell": (5, 4)}
OF_VALUES = ("gauss_legendre", "approximation_coefficients")


def largest(worst):
    return max(error for error, _ in worst.values())


class Tables(unittest.TestCase):
    def test_committed_tables_are_recomputed(self):
        for name, (count, _) in WITH_ROWS.items():
            with self.subTest(name):
                table = common.read(TABLES / f"{name}.csv")
                sample = random.Random(7).sample(table, count)
                worst = verify.verify_rows(importlib.import_module(name), sample)
                self.assertLess(largest(worst), mpf("1e-21"), worst)

    def test_committed_values_are_recomputed(self):
        for name in OF_VALUES:
            with self.subTest(name):
                module = importlib.import_module(name)
                worst = verify.verify_values(module, common.read(TABLES / f"{name}.csv"))
                for key, (error, where) in worst.items():
                    limit = getattr(module, "TOLERANCE", {}).get(key, mpf("1e-21"))
                    self.assertLess(error, limit, f"{key} at {where}")

    def test_generators_write_the_columns_of_the_tables(self):
        for name, (_, count) in WITH_ROWS.items():
            with self.subTest(name):
                module = importlib.import_module(name)
                committed = list(common.read(TABLES / f"{name}.csv")[0])
                self.assertEqual(committed, ["id", "regime"] + module.INPUTS + module.OUTPUTS)
                rows = list(common.generate(module, count, seed=11))
                self.assertEqual(len(rows), count)
                self.assertEqual(sorted(rows[0]), sorted(committed))
                again = list(common.generate(module, count, seed=11))
                self.assertEqual(rows, again)
                self.assertNotEqual(rows, list(common.generate(module, count, seed=12)))

    def test_inputs_are_binary32(self):
        for name in WITH_ROWS:
            module = importlib.import_module(name)
            for row in common.read(TABLES / f"{name}.csv"):
                for column in module.INPUTS:
                    if column in ("n", "primitives", "tf_kind") or not row[column]:
                        continue
                    for text in row[column].replace("|", ";").split(";"):
                        self.assertEqual(common.text_in(float(text)), text, (name, row["id"]))

    def test_a_wrong_digit_is_found(self):
        for name in WITH_ROWS:
            module = importlib.import_module(name)
            column = module.OUTPUTS[0]
            row = next(r for r in reversed(common.read(TABLES / f"{name}.csv"))
                       if len(r[column]) > 25 and r[column].strip("-01.") != "")
            digits = row[column]
            place = next(i for i, c in enumerate(digits) if c in "123456789") + 18
            while not digits[place].isdigit():
                place -= 1
            wrong = digits[:place] + str((int(digits[place]) + 5) % 10) + digits[place + 1:]
            worst = verify.verify_rows(module, [{**row, column: wrong}])
            self.assertGreater(worst[column][0], mpf("1e-21"), name)

    def test_a_lost_row_and_a_wrong_coefficient_are_found(self):
        module = importlib.import_module("gauss_legendre")
        table = common.read(TABLES / "gauss_legendre.csv")
        with self.assertRaises(ValueError):
            verify.verify_values(module, table[:-1])
        module = importlib.import_module("approximation_coefficients")
        table = common.read(TABLES / "approximation_coefficients.csv")
        table[20]["coefficient"] = repr(float(table[20]["coefficient"]) + 1e-15)
        worst = verify.verify_values(module, table)
        key = f"{table[20]['function']} {table[20]['precision']}"
        self.assertGreater(worst[key][0], module.TOLERANCE[key])


if __name__ == "__main__":
    unittest.main()
