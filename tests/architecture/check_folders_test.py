#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gives check_folders.py lists of files with faults, and sees it find these and no others.

  check_folders_test.py
"""
import sys
from pathlib import PurePosixPath

import check_folders
import planted


def files(folder, count, readme):
    names = [PurePosixPath(folder, f"file_{i}.cpp") for i in range(count)]
    return names + ([PurePosixPath(folder, "README.md")] if readme else [])


# (what is planted, files, what each of the messages must say)
CASES = [
    ("a folder as it should be", files("src/io", 40, True), []),
    ("a small one without a README.md", files("src/io", 10, False), []),
    ("a sub-folder beside", files("src/io", 40, True) + files("src/io/a", 10, False), []),
    ("a file too many", files("src/io", 41, True), ["src/io: has 41 source files, more than 40"]),
    ("no README.md", files("src/io", 11, False), ["src/io: has 11 source files and no README.md"]),
    ("a README.md elsewhere", files("src/io", 11, False) + files("src/cpu", 1, True),
     ["no README.md"]),
    ("a README.md of the folder above", files("src/io", 1, True) + files("src/io/a", 11, False),
     ["src/io/a: has 11 source files and no README.md"]),
    ("both faults", files("src/io", 41, False), ["more than 40", "no README.md"]),
    ("two folders", files("src/io", 41, True) + files("src/cpu", 11, False),
     ["src/cpu: has 11", "src/io: has 41"]),
    ("no files", [], ["no source file"]),
    ("files of no folder that is checked", files("docs", 50, False), ["no source file"]),
    ("data beside sources", files("tests/fuzz", 10, False)
     + [PurePosixPath("tests/fuzz", f"seed_{i}.json") for i in range(90)], []),
]


if __name__ == "__main__":
    sys.exit(planted.status_of(CASES, check_folders.check))
