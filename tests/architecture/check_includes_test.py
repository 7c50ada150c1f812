#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants wrong lines in a copy of the sources, one by one, and sees check_includes.py find each.

  check_includes_test.py ROOT MODULES
"""
import pathlib
import shutil
import sys
import tempfile

import check_includes

HEAD = "// SPDX-License-Identifier: Apache-2.0\n#pragma once\n"

# (file to plant, a wrong line, what the message must say)
PLANTS = [
    ("include/pellucid/segment/planted.h", '#include "pellucid/field/structured_grid.h"',
     "never sees field"),
    ("include/pellucid/field/planted.h", '#include "pellucid/transfer/piecewise_linear.h"',
     "siblings"),
    ("include/pellucid/transfer/planted.h", '#include "pellucid/field/structured_grid.h"',
     "siblings"),
    ("include/pellucid/math/planted.h", '#include "pellucid/geometry/vec3.h"',
     "to the right of math"),
    ("include/pellucid/render/planted.h", '#include "pellucid/scene/error.h"',
     "to the right of render"),
    ("src/cpu/planted.h", '#include "pellucid/io/image_files.h"', "siblings"),
    ("src/io/planted.h", '  #  include "pellucid/cpu/render.h"', "siblings"),
    ("src/reference/planted.h", '#include "pellucid/segment/linear.h"', "never sees segment"),
    ("src/scene/planted.h", '#include "pellucid/reference/render.h"', "to the right of scene"),
    ("src/scene/planted.h", '#include "../../apps/cli/charts/csv.h"', "neither"),
    ("src/cpu/layers/planted.h", '#include "csv.h"', "neither"),
    ("src/cpu/layers/planted.h", '#include "../ray_tracer.h"', "neither"),
    ("src/scene/planted.h", '#include "pellucid/scene/nowhere.h"', "does not exist"),
    ("src/scene/planted.h", "#include <tbb/parallel_for.h>", "does not declare"),
    ("src/scene/planted.h", "#include <unheard/of.h>", "knows"),
    ("include/pellucid/cpu/planted.h", "#include <tbb/parallel_for.h>", "public header"),
    ("include/pellucid/math/planted.h", "#include <cmath>", "in the core"),
    ("include/pellucid/math/planted.h", "#include <immintrin.h>", "SIMD library"),
    ("include/pellucid/math/planted.h", "#if defined(__CUDACC__)", "names CUDA"),
    ("include/pellucid/math/planted.h", "__device__ inline int one() { return 1; }", "names CUDA"),
    ("include/pellucid/scene/planted.h", '#include "pellucid/scene/internal/left_out.h"',
     "not installed"),
    ("include/pellucid/extras/planted.h", "#include <cstdint>", "no place in the order"),
]


def violations(copy, modules, plant):
    """What is found in the copy with a file more."""
    path = copy / plant[0]
    missing = [folder for folder in path.parents if not folder.exists()]
    path.parent.mkdir(exist_ok=True)
    path.write_text(HEAD + plant[1] + "\n")
    found = list(check_includes.check(copy, modules))
    path.unlink()
    for folder in missing:
        folder.rmdir()
    return found


def main():
    root = pathlib.Path(sys.argv[1])
    modules = check_includes.read_modules(pathlib.Path(sys.argv[2]))
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for name in ("include", "src", "apps", "plugins"):
            shutil.copytree(root / name, copy / name)
        clean = list(check_includes.check(copy, modules))
        for plant in PLANTS:
            found = [line for line in violations(copy, modules, plant) if line not in clean]
            if len(found) != 1 or plant[2] not in found[0] or not found[0].startswith(plant[0]):
                failures += 1
                print(f"planted in {plant[0]}: {plant[1]}\n"
                      f"  expected one line with: {plant[2]}\n  found: {found}")

    # A wrong arrow in CMake itself, and a right one that is missing there.
    depends, private, closure = modules
    wrong = ({**depends, "segment": ["transfer", "field"]}, private, closure)
    if not any("segment depends on field" in line for line in check_includes.check(root, wrong)):
        failures += 1
        print("segment depends on field in CMake: not found")
    missing = (depends, private, {**closure, "render": closure["render"] - {"traverse"}})
    if not any("CMake does not say" in line for line in check_includes.check(root, missing)):
        failures += 1
        print("render does not declare traverse in CMake: not found")
    print(f"{len(PLANTS) + 2} planted, {failures} not found as they should be")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
