#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No folder has more than 40 source files, and one of more than ten has a README.md.

  check_folders.py ROOT

A README.md of a folder says in some ten lines what goes in, what comes out, who calls it, and which
file is which. LARGE and UNEXPLAINED list the folders that are not so yet. The lists only shrink: an
entry that is no longer needed is an error too, and so is a large folder that grows.
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

# Folders with more files, and how many they may have.
LARGE = {}
# Folders of more than ten files that have no README.md.
UNEXPLAINED = {
    "apps/view/page",
    "benchmarks/frames",
    "benchmarks/kernels",
    "benchmarks/meshes",
    "benchmarks/vtk",
    "include/pellucid/math",
    "include/pellucid/packet/cells",
    "include/pellucid/render",
    "include/pellucid/segment",
    "include/pellucid/simd",
    "include/pellucid/traverse",
    "python/pellucid",
    "python/src",
    "src/cpu/frame",
    "src/cpu/gaussians",
    "src/cpu/grid",
    "src/cpu/layers",
    "src/cpu/projection",
    "src/cpu/sample",
    "tests/cli",
    "tests/cpu",
    "tests/cuda",
    "tests/device",
    "tests/fuzz",
    "tests/io/arrays",
    "tests/io/grids",
    "tests/io/vtk",
    "tests/math",
    "tests/packet",
    "tests/python",
    "tests/reference",
    "tests/scene/tetrahedra",
    "tests/scenes",
    "tests/segment",
    "tests/simd",
    "tests/traverse",
    "tests/view",
}


def check(names, large, unexplained):
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
        allowed = large.get(folder, MOST)
        if count > allowed:
            yield (f"{folder}: has {count} source files, more than {allowed}; put those that "
                   "belong together into a folder")
        if count > EXPLAINED and folder not in explained and folder not in unexplained:
            yield (f"{folder}: has {count} source files and no README.md that says which is which")
    for folder in sorted(large):
        if counts[folder] <= MOST:
            yield f"{folder}: has {counts[folder]} source files; take it off LARGE"
        elif counts[folder] < large[folder]:
            yield f"{folder}: has {counts[folder]} source files; say so in LARGE"
    for folder in sorted(unexplained):
        if folder in explained or counts[folder] <= EXPLAINED:
            yield f"{folder}: needs no entry in UNEXPLAINED; take it off"


def main():
    found = list(check(repository_files(pathlib.Path(sys.argv[1])), LARGE, UNEXPLAINED))
    print("\n".join(found) if found else "no folder is too large, or large without a README.md")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
