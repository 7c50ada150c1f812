#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every function of the core that is marked PELLUCID_HD is called by another one, by a device test
or by what src/cuda compiles, so that nvcc really compiles it: a template that nothing calls
compiles everywhere.

  check_complete.py ROOT
"""
import collections
import pathlib
import re
import sys

CORE = ("simd", "math", "geometry", "field", "transfer", "segment", "traverse", "render")
MARKED = re.compile(r"PELLUCID_HD\b[^;{]*?\b([A-Za-z_]\w*)\s*\(")
MACRO = re.compile(r"^#define(?:[^\n]*\\\n)*[^\n]*", flags=re.M)


def code(path):
    return MACRO.sub("", re.sub(r"//[^\n]*", "", path.read_text()))


def main():
    root = pathlib.Path(sys.argv[1])
    headers = [path for folder in CORE
               for path in sorted((root / "include/pellucid" / folder).glob("*.h"))]
    marked = {name: path for path in headers for name in MARKED.findall(code(path))
              if name != "operator"}
    words = collections.Counter()
    for path in headers:
        words.update(re.findall(r"\w+", code(path)))
        words.subtract(MARKED.findall(code(path)))
    callers = [*(root / "tests/device").glob("*.cu"), *(root / "include/pellucid/cuda").glob("*.h")]
    for path in callers:
        words.update(re.findall(r"\w+", code(path)))
    missing = [f"{path.relative_to(root)}: {name}() is called by no kernel "
               "and by no file of tests/device"
               for name, path in marked.items() if words[name] <= 0]
    print("\n".join(missing) if missing
          else f"{len(marked)} functions, all reached by the device tests")
    return 1 if missing or not marked else 0


if __name__ == "__main__":
    sys.exit(main())
