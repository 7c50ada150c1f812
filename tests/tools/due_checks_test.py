#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks are due where their files changed, and nothing else is left out."""
import contextlib
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(REPOSITORY / "tools"))
import due_checks  # noqa: E402

CHECKS = """
[one]
tests = ^one\\.
paths = a src/*/list.txt
[script]
paths = tool
[page.{name}]
tests = ^page\\.{name}$
each = docs/*.md
paths = a
"""
FILES = ["a/x.h", "a/y.h", "a_b/z.h", "src/m/list.txt", "src/m/code.cpp", "tool",
         "docs/Some-Page.md", "docs/other.md", "docs/deep/no.md"]
ALL = {"one", "script", "page.some-page", "page.other", "page.no"}


class DueChecks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write(".ci/checks", CHECKS)
        for name in FILES:
            self.write(name, name)
        subprocess.run(["git", "init", "-q", self.root], check=True)
        self.git("add", "-A")

    def git(self, *arguments):
        subprocess.run(["git", "-C", self.root, *arguments], check=True)

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def run_tool(self, *arguments):
        """What it ends with, and what it prints."""
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
            status = due_checks.main(["--root", str(self.root), *map(str, arguments)])
        return status, said.getvalue()

    def status(self, *arguments):
        return self.run_tool(*arguments)[0]

    def due(self):
        return set(self.run_tool("due")[1].split())

    def pass_all(self):
        due_checks.note_passed(self.root, lambda check: True)
        self.assertEqual(self.due(), set())

    def test_everything_is_due_at_first(self):
        self.assertEqual(self.due(), ALL - {"page.no"})
        self.assertEqual(self.run_tool("left-out")[1], "\n")
        self.pass_all()
        self.assertEqual(self.run_tool("due-tests")[1], "\n")

    def test_what_changed_is_due(self):
        pages = {"page.some-page", "page.other"}
        for change, due in (
                (lambda: self.write("a/x.h", "other"), {"one"} | pages),
                (lambda: self.write("a/new/file.h", ""), {"one"} | pages),  # not known to git
                (lambda: (self.root / "a/y.h").unlink(), {"one"} | pages),
                (lambda: os.chmod(self.root / "a/x.h", 0o755), {"one"} | pages),
                (lambda: self.git("mv", "a/x.h", "a/w.h"), {"one"} | pages),
                (lambda: self.write("src/m/list.txt", ""), {"one"}),
                (lambda: self.write("src/n/list.txt", ""), {"one"}),
                (lambda: self.write("docs/other.md", ""), {"page.other"}),
                (lambda: self.write("docs/new.md", ""), {"page.new"}),
                (lambda: self.write("tool", ""), {"script"}),
                (lambda: self.write("src/m/code.cpp", ""), set()),
                (lambda: self.write("a_b/z.h", ""), set())):
            self.pass_all()
            change()
            self.assertEqual(self.due(), due)

    def test_what_is_not_due_is_left_out_and_nothing_else(self):
        self.pass_all()
        self.write("docs/other.md", "new")
        left_out = re.compile(self.run_tool("left-out")[1].strip())
        due = re.compile(self.run_tool("due-tests")[1].strip())
        for name, is_left_out in (("one.a", True), ("page.some-page", True), ("page.other", False),
                                  ("none.a", False), ("bone.a", False), ("page.some-page2", False),
                                  ("page.somex-page", False)):
            self.assertEqual(bool(left_out.search(name)), is_left_out, name)
            self.assertEqual(bool(due.search(name)), name == "page.other", name)

    def test_a_script_asks_for_itself(self):
        self.assertEqual(self.status("due", "script"), 0)
        self.assertEqual(self.status("passed", "script"), 0)
        self.assertEqual(self.status("due", "script"), 1)
        self.assertEqual(self.due(), ALL - {"page.no", "script"})
        self.assertEqual(self.status("due", "script", "one"), 0)
        self.assertEqual(self.status("passed", "script", "one"), 0)
        self.assertEqual(self.status("due", "script", "one"), 1)
        self.assertEqual(self.status("due", "script", "scrypt"), 2)
        for command in ("due", "passed"):
            self.assertEqual(self.status(command, "scrypt"), 2)

    def test_only_tests_that_ran_and_passed_are_noted(self):
        case = '<testcase name="{}" status="{}">{}</testcase>'
        names = ("one.a", "one.b", "page.other", "page.some-page", "bone.a")
        self.write("tests.json", json.dumps({"tests": [{"name": name} for name in names]}))
        files = (self.root / "results.xml", self.root / "tests.json")
        for results, noted in (
                ([("one.a", "run", ""), ("one.b", "run", "")], {"one"}),
                ([("one.a", "run", ""), ("one.b", "fail", "<failure/>")], set()),
                ([("one.a", "run", ""), ("one.b", "notrun", "<skipped/>")], set()),
                ([("one.a", "run", ""), ("one.b", "run", "<skipped/>")], set()),
                ([("one.a", "run", "")], set()),  # the other one was not asked for
                ([("page.other", "run", ""), ("bone.a", "run", "")], {"page.other"}),
                ([], set())):
            (self.root / ".ci/passed").unlink(missing_ok=True)
            self.write("results.xml", "<testsuite>" + "".join(case.format(*r) for r in results)
                       + "</testsuite>")
            self.assertEqual(self.status("note", *files), 0)
            self.assertEqual(self.due(), ALL - {"page.no"} - noted)
        self.write("results.xml", "<testsuite>")
        self.assertEqual(self.status("note", *files), 2)
        self.assertEqual(self.status("note", files[0]), 2)
        self.write("results.xml", "<testsuite/>")
        self.write("tests.json", "[]")
        self.assertEqual(self.status("note", *files), 2)

    def test_a_damaged_record_is_an_error(self):
        self.pass_all()
        whole = (self.root / ".ci/passed").read_text()
        line = [text for text in whole.splitlines() if text.startswith("one ")][0]
        for damaged in (whole[:-3], whole + line, whole.replace("one ", "one  "), "<<<<<<< HEAD\n"):
            self.write(".ci/passed", damaged)
            for command in (["due"], ["left-out"], ["due", "script"]):
                self.assertEqual(self.status(*command), 2, damaged)

    def test_paths_that_match_nothing_are_an_error(self):
        for text in (CHECKS.replace("= tool", "= tools"), CHECKS.replace("docs/*.md", "doc/*.md")):
            self.write(".ci/checks", text)
            self.assertEqual(self.status("left-out"), 2)


class OwnChecks(unittest.TestCase):
    """.ci/checks of this repository."""

    def setUp(self):
        self.checks = {check.name: check for check in due_checks.read_checks(REPOSITORY)}

    def included(self, starts, folders):
        """The repository's files that these include, and that those include …"""
        found, waiting = set(), list(starts)
        while waiting:
            name = waiting.pop()
            if name in found:
                continue
            found.add(name)
            text = (REPOSITORY / name).read_text()
            for header in re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.MULTILINE):
                for folder in (Path(name).parent, *folders):
                    if (REPOSITORY / folder / header).is_file():
                        waiting.append(str(Path(folder) / header))
        return found

    def test_what_nvcc_compiles_is_in_their_paths(self):
        for name, folder in (("device", "tests/device"), ("cards", "src/cuda")):
            starts = [str(file.relative_to(REPOSITORY))
                      for file in (REPOSITORY / folder).rglob("*.cu")]
            files = self.included(starts, ["", "include", "src/cuda"])
            self.assertGreater(len(files), 50)
            self.assertEqual(files - self.checks[name].files, set(), name)

    def test_the_record_is_whole(self):
        self.assertLessEqual(set(due_checks.read_passed(REPOSITORY)), set(self.checks))


if __name__ == "__main__":
    unittest.main()
