#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cases that did not run are found, and what was skipped is counted."""
import contextlib
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "tools"))
import test_cases  # noqa: E402


class Cases(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        # What a program of GoogleTest lists: a suite of parameters, and one that is disabled.
        self.program = self.folder / "program"
        self.program.write_text("#!/bin/sh\necho 'Running main() from gtest_main.cc'\necho 'A.'\n"
                                "echo '  x'\necho '  y/0  # GetParam() = 3'\n"
                                "echo '  DISABLED_z'\necho 'P/B.'\necho '  w'\n")
        self.program.chmod(0o755)
        self.write("p.1", {"A": {"x": "COMPLETED"}, "P/B": {"w": "SKIPPED"}})
        self.write("p.2", {"A": {"y/0": "COMPLETED"}})

    def write(self, name, suites):
        (self.folder / f"{name}.json").write_text(json.dumps({"testsuites": [
            {"name": suite, "testsuite": [
                {"name": case, "status": "NOTRUN" if result == "NOTRUN" else "RUN",
                 **({"failures": []} if result == "FAILED" else {}),
                 "result": "COMPLETED" if result == "FAILED" else result}
                for case, result in cases.items()]} for suite, cases in suites.items()]}))

    def run_tool(self, function, *arguments):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            status = function(self.folder, *arguments)
        return status, said.getvalue()

    def check(self, tests="p.1,p.2"):
        return self.run_tool(test_cases.check, ["p", str(self.program), tests])

    def test_all_cases_once(self):
        self.assertEqual(self.check(), (0, "every case ran once\n"))

    def test_a_case_that_no_shard_ran(self):
        self.write("p.2", {"A": {"y/0": "NOTRUN"}})
        self.assertEqual(self.check(), (1, "p: A.y/0 ran 0 times\n"))

    def test_a_case_that_two_shards_ran(self):
        self.write("p.2", {"A": {"x": "COMPLETED", "y/0": "COMPLETED"}})
        self.assertEqual(self.check(), (1, "p: A.x ran 2 times\n"))

    def test_a_shard_that_said_nothing(self):
        (self.folder / "p.2.json").unlink()
        self.assertEqual(self.check(), (1, "p: A.y/0 ran 0 times\n"))
        self.assertEqual(self.check("p")[0], 1)

    def test_the_count(self):
        self.write("p.2", {"A": {"y/0": "FAILED"}})
        self.assertEqual(self.run_tool(test_cases.count), (0,
            "3 cases in the programs above: 1 passed, 1 failed, 1 skipped\n"
            "  skipped: p.P/B: 1\n"))


if __name__ == "__main__":
    unittest.main()
