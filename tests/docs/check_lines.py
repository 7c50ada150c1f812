#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No line of the sources and documents has more than 100 characters.

  check_lines.py ROOT

In docs/notes/ rows of tables may be longer, and all that a program writes between its marks
"<!-- NAME: begin -->" and "<!-- NAME: end -->". So may generated files: those of GENERATED, each of
which must name its generator in its first lines.
"""
import pathlib
import re
import sys

from documents import repository_files, run_check

LONGEST = 100
CHECKED = re.compile(r"\.(h|cpp|cu|py|md|cmake|cff)$|\.cmake\.in$|(^|/)CMakeLists\.txt$"
                     r"|^(scripts|\.ci)/[^/]+$|^examples/[^/]+\.json$")
GENERATED = {
    "include/pellucid/math/expm1_quotient_to_4.h": "tools/reference/write_headers.py",
    "include/pellucid/math/w0_minus.h": "tools/reference/write_headers.py",
    "include/pellucid/math/w1_minus.h": "tools/reference/write_headers.py",
}


def check(root, generated=None):
    generated = GENERATED if generated is None else generated
    checked = [name for name in repository_files(root) if CHECKED.search(str(name))]
    if not checked:
        yield "no file to check was found"
    for name, generator in generated.items():
        lines = (root / name).read_text().split("\n") if (root / name).exists() else []
        if not any(generator in line for line in lines[:20]):
            yield f"{name}: is listed as made by {generator}, which its first lines do not say"
        elif not (root / generator).exists():
            yield f"{name}: is listed as made by {generator}, which does not exist"
    for name in checked:
        if str(name) in generated:
            continue
        notes = str(name).startswith("docs/notes/")
        written = False  # by a program
        for number, line in enumerate((root / name).read_text(encoding="utf-8").split("\n"), 1):
            if notes and re.fullmatch(r"<!-- [\w-]+: (begin|end) -->", line):
                written = line.endswith("begin -->")
            if len(line) > LONGEST and not (notes and (written or line.startswith("|"))):
                yield f"{name}:{number}: has {len(line)} characters, more than {LONGEST}"


if __name__ == "__main__":
    sys.exit(run_check(check(pathlib.Path(sys.argv[1]).resolve()),
                       f"no line has more than {LONGEST} characters"))
