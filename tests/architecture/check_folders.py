#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No folder has more than 40 source files, and one of more than ten has a README.md.

  check_folders.py ROOT

A README.md of a folder says in some ten lines what goes in, what comes out, who calls it, and which
file is which.
"""
import collections
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "docs"))
from documents import repository_files  # noqa: E402 (tests/docs is no package)

MOST = 40       # source files of a folder
EXPLAINED = 10  # more than these need a README.md
SUFFIXES = (".h", ".cpp", ".cu", ".py", ".js")
TOP = ("apps", "benchmarks", "examples", "include", "plugins", "python", "src", "tests", "tools")


def check(names):
    """Yields a line for each folder that is not as it should be. `names` are the paths of all
    files, relative to the repository."""
    counts = collections.Counter()
    explained = set()
    for path in names:
        if path.parts[0] not in TOP:
            continue
        if path.name == "README.md":
            explained.add(str(path.parent))
        if path.suffix in SUFFIXES:
            counts[str(path.parent)] += 1
    if not counts:
        yield "no source file was found"
    for folder, count in sorted(counts.items()):
        if count > MOST:
            yield (f"{folder}: has {count} source files, more than {MOST}; put those that belong "
                   "together into a folder")
        if count > EXPLAINED and folder not in explained:
            yield (f"{folder}: has {count} source files and no README.md that says which is which")


def main():
    found = list(check(repository_files(pathlib.Path(sys.argv[1]))))
    print("\n".join(found) if found else "no folder is too large, or large without a README.md")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
