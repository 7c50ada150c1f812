#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Says which checks of .ci/checks are due, and notes those that passed.

  due_checks.py due [NAME...]   prints the checks whose files differ from those that passed; with
                                names, ends with 0 if one of these is due and with 1 if none is
  due_checks.py left-out        prints a regular expression of ctest names that are not due
  due_checks.py due-tests       prints one of those that are
  due_checks.py passed NAME...  notes in .ci/passed that these passed for the files as they are
  due_checks.py note RESULTS TESTS
                                the same for every check whose tests all ran and passed, by the file
                                that ctest --output-junit wrote, and of all tests, what
                                ctest --show-only=json-v1 prints

A check's files are known by a hash of their names, modes and contents as they lie in the working
tree. A check is due if .ci/passed has another hash for it, or none. .ci/passed that cannot be read,
and paths that match no file, are errors: nothing is left out then.
"""
import argparse
import configparser
import fnmatch
import functools
import hashlib
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree
from pathlib import Path, PurePosixPath

REPOSITORY = Path(__file__).resolve().parent.parent


class Check:
    """A name, the regular expression of its tests in ctest or None, and its files."""

    def __init__(self, name, tests, patterns, files):
        self.name, self.tests = name, tests
        self.files = set()
        for pattern in patterns:
            found = matching(pattern, files)
            if not found:
                raise ValueError(f".ci/checks: {name}: no file matches {pattern}")
            self.files |= found

    def hash(self, root):
        total = hashlib.sha256()
        for name in sorted(self.files):
            path = root / name
            if path.is_symlink():
                mode, content = "link", os.readlink(path).encode()
            else:
                mode = "run" if os.access(path, os.X_OK) else "file"
                content = path.read_bytes()
            total.update(f"{name}\0{mode}\0{len(content)}\0".encode())
            total.update(content)
        return total.hexdigest()[:40]


@functools.cache
def matching(pattern, files):
    """The files that are the pattern, match it part by part, or lie in such a folder."""
    parts = PurePosixPath(pattern).parts
    return {file for file in files
            if len(PurePosixPath(file).parts) >= len(parts)
            and all(fnmatch.fnmatchcase(have, want)
                    for have, want in zip(PurePosixPath(file).parts, parts))}


def list_files(root):
    """Files that git has or would add; of a deleted one nothing is left to hash."""
    listed = subprocess.run(
        ["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        check=True, capture_output=True, text=True).stdout.split("\0")
    return frozenset(name for name in listed if name and os.path.lexists(root / name)
                     and not (root / name).is_dir())


def read_checks(root):
    files = list_files(root)
    parser = configparser.ConfigParser(interpolation=None)
    parser.read_string((root / ".ci/checks").read_text())
    checks = []
    for section in parser.sections():
        values = parser[section]
        tests, paths = values.get("tests"), values["paths"].split()
        if "each" not in values:
            checks.append(Check(section, tests, paths, files))
            continue
        for pattern in values["each"].split():
            pages = matching(pattern, files)
            if not pages:
                raise ValueError(f".ci/checks: {section}: no file matches {pattern}")
            for page in sorted(pages):
                name = PurePosixPath(page).stem.lower()
                checks.append(Check(section.replace("{name}", name),
                                    tests.replace("{name}", re.escape(name)), [page, *paths],
                                    files))
    return checks


def read_passed(root):
    file = root / ".ci/passed"
    passed = {}
    for number, line in enumerate(file.read_text().splitlines() if file.exists() else [], 1):
        if line.startswith("#") or not line.strip():
            continue
        match = re.fullmatch(r"(\S+) ([0-9a-f]{40})", line)
        if not match or match[1] in passed:
            raise ValueError(f".ci/passed:{number}: not a check's name and a hash: {line}")
        passed[match[1]] = match[2]
    return passed


def write_passed(root, passed):
    head = ("# Checks of .ci/checks and the hash of the files for which they passed. Written by\n"
            "# `scripts/check release` and `scripts/check due` (tools/due_checks.py).\n")
    part = root / ".ci/passed.part"
    part.write_text(head + "".join(f"{name} {passed[name]}\n" for name in sorted(passed)))
    part.replace(root / ".ci/passed")


def due(root):
    """The checks that are due, and those that are not."""
    checks, passed = read_checks(root), read_passed(root)
    late = [check for check in checks if passed.get(check.name) != check.hash(root)]
    return late, [check for check in checks if check not in late]


def note_passed(root, is_passed):
    checks, passed = read_checks(root), read_passed(root)
    kept = {check.name: passed[check.name] for check in checks if check.name in passed}
    noted = {check.name: check.hash(root) for check in checks if is_passed(check)}
    write_passed(root, kept | noted)
    return noted


def results_of(file):
    """(name, whether it ran and passed) of each test of ctest."""
    for case in xml.etree.ElementTree.parse(file).getroot().iter("testcase"):
        ran = case.get("status") == "run" and not any(
            case.find(tag) is not None for tag in ("failure", "error", "skipped"))
        yield case.get("name"), ran


def names_of(file):
    """The names of all tests of ctest."""
    return {test["name"] for test in json.loads(Path(file).read_text())["tests"]}


def passed_in(results, names):
    """Tells of a check whether it has tests among all names, and all of them ran and passed."""
    passed = {name for name, ran in results if ran}
    passed -= {name for name, ran in results if not ran}

    def is_passed(check):
        if check.tests is None:
            return False
        mine = {name for name in names if re.search(check.tests, name)}
        return bool(mine) and mine <= passed
    return is_passed


def run(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--root", type=Path, default=REPOSITORY)
    parser.add_argument("command", choices=["due", "left-out", "due-tests", "passed", "note"])
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args(arguments)
    root, names = arguments.root, arguments.names
    if arguments.command == "note":
        if len(names) != 2:
            raise ValueError("note takes two files: results, and what there is to test")
        noted = note_passed(root, passed_in(list(results_of(names[0])), names_of(names[1])))
        print(f"{len(noted)} noted in .ci/passed: {' '.join(noted)}")
        return 0
    known = {check.name for check in read_checks(root)}
    for name in names:
        if name not in known:
            raise ValueError(f"{name}: not in .ci/checks")
    if arguments.command == "passed":
        note_passed(root, lambda check: check.name in names)
        return 0
    late, rest = due(root)
    if arguments.command in ("left-out", "due-tests"):
        # Without parentheses: CMake takes nine of them.
        print("|".join(check.tests for check in (late if arguments.command == "due-tests" else rest)
                       if check.tests))
    elif names:
        return 0 if any(check.name in names for check in late) else 1
    else:
        print("\n".join(check.name for check in late))
    return 0


def main(arguments):
    try:
        return run(arguments)
    except (ValueError, OSError, KeyError, TypeError, configparser.Error,
            subprocess.CalledProcessError, xml.etree.ElementTree.ParseError) as error:
        print(f"due_checks.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
