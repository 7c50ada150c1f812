#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gives check_folders.py lists of files with one fault each, and sees it find the fault.

  check_folders_test.py
"""
import sys
from pathlib import PurePosixPath

import check_folders


def files(folder, count, readme):
    names = [PurePosixPath(folder, f"file_{i}.cpp") for i in range(count)]
    return names + ([PurePosixPath(folder, "README.md")] if readme else [])


# (what is planted, files, LARGE, UNEXPLAINED, what the one message must say; None: there is none)
CASES = [
    ("a folder as it should be", files("src/io", 40, True), {}, set(), None),
    ("a small one without a README.md", files("src/io", 10, False), {}, set(), None),
    ("a sub-folder beside", files("src/io", 40, True) + files("src/io/a", 10, False), {}, set(),
     None),
    ("a file too many", files("src/io", 41, True), {}, set(), "has 41 source files, more than 40"),
    ("no README.md", files("src/io", 11, False), {}, set(), "no README.md"),
    ("a README.md elsewhere", files("src/io", 11, False) + files("src/cpu", 1, True), {}, set(),
     "no README.md"),
    ("a large one on the list", files("src/io", 45, True), {"src/io": 45}, set(), None),
    ("a large one that grows", files("src/io", 46, True), {"src/io": 45}, set(), "more than 45"),
    ("a large one that shrinks", files("src/io", 44, True), {"src/io": 45}, set(), "say so"),
    ("one that is large no more", files("src/io", 40, True), {"src/io": 45}, set(), "take it off"),
    ("one that is gone", files("src/io", 40, True), {"src/cpu": 45}, set(), "take it off"),
    ("an unexplained one on the list", files("src/io", 11, False), {}, {"src/io"}, None),
    ("one that is explained now", files("src/io", 11, True), {}, {"src/io"}, "take it off"),
    ("one that is small now", files("src/io", 10, False), {}, {"src/io"}, "take it off"),
    ("no files", [], {}, set(), "no source file"),
    ("data beside sources", files("tests/fuzz", 10, False)
     + [PurePosixPath("tests/fuzz", f"seed_{i}.json") for i in range(90)], {}, set(), None),
]


def main():
    failures = 0
    for what, names, large, unexplained, message in CASES:
        found = list(check_folders.check(names, large, unexplained))
        if (message is None and found) or (message and (len(found) != 1
                                                        or message not in found[0])):
            failures += 1
            print(f"{what}: expected {message}, found {found}")
    print(f"{len(CASES)} planted, {failures} not found as they should be")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
