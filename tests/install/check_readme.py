#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every block of C++ and CMake in README.md stands, line for line, in a file that a test compiles, and
every file that README.md, CONTRIBUTING.md and docs/ link to exists.

  check_readme.py ROOT
"""
import pathlib
import re
import sys

COMPILED = ["tests/install/core.cpp", "tests/install/render.cpp",
            "tests/install/find_package/CMakeLists.txt", "tests/install/find_package_core/CMakeLists.txt"]


def check(root):
    compiled = [(root / name).read_text() for name in COMPILED]
    blocks = re.findall(r"```(?:cpp|cmake)\n(.*?)```", (root / "README.md").read_text(), flags=re.S)
    if not blocks:
        yield "README.md: no block of C++ or CMake was found"
    for block in blocks:
        if not any(block.strip() in text for text in compiled):
            yield f"README.md: this block stands in none of {', '.join(COMPILED)}:\n{block}"
    pages = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    for page in pages:
        prose = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
        for link in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", prose):
            if not re.match(r"[a-z]+:", link) and not (page.parent / link).exists():
                yield f"{page.relative_to(root)}: links to {link}, which does not exist"


if __name__ == "__main__":
    violations = list(check(pathlib.Path(sys.argv[1])))
    print("\n".join(violations) if violations else "README.md shows what is compiled")
    sys.exit(1 if violations else 0)
