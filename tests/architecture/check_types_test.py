#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gives check_types.py sources with faults, and sees it find these and no others.

  check_types_test.py
"""
import sys

import check_types
import planted

AXIS = "namespace pellucid {\nstruct Axis {\n  int count = 0;\n};\n}  // namespace pellucid\n"

# (what is planted, sources, what each of the messages must say)
CASES = [
    ("a type of one file", [AXIS, AXIS.replace("Axis", "Way")], []),
    ("two types of one name", [AXIS, AXIS],
     ["pellucid::Axis: is defined in a0.h and in a1.h"]),
    ("a class and a struct", [AXIS, AXIS.replace("struct", "class")], ["pellucid::Axis"]),
    ("one of them derived", [AXIS, AXIS.replace("Axis {", "Axis final : Base {")],
     ["pellucid::Axis"]),
    ("templates", [AXIS.replace("struct", "template <class T>\nstruct")] * 2, ["pellucid::Axis"]),
    ("an enumeration", [AXIS, AXIS.replace("struct Axis {", "enum class Axis { x };")],
     ["pellucid::Axis"]),
    ("one declared only", [AXIS, AXIS.replace("struct Axis {", "struct Axis;")], []),
    ("a member of another", [AXIS, AXIS.replace("Axis {", "Box::Axis {")], []),
    ("another namespace", [AXIS, AXIS.replace("namespace pellucid", "namespace pellucid::view")],
     []),
    ("one of them in a namespace of its file",
     [AXIS, AXIS.replace("{\nstruct", "{\nnamespace {\nstruct").replace(
         "};\n", "};\n}  // namespace\n")], []),
    ("behind such a namespace",
     [AXIS, "namespace {\nint n;\n}  // namespace\n" + AXIS], ["pellucid::Axis"]),
    ("specialisations", [AXIS.replace("Axis", "Axis<4>"), AXIS.replace("Axis", "Axis<8>")], []),
    ("aligned", [AXIS, AXIS.replace("struct", "struct alignas(32)")], ["pellucid::Axis"]),
    ("marked", [AXIS, AXIS.replace("struct", 'struct [[nodiscard("x")]]')], ["pellucid::Axis"]),
    ("with a head of two lines", [AXIS, AXIS.replace("Axis {", "Axis\n    : Base {")],
     ["pellucid::Axis"]),
    ("with bases of two lines",
     [AXIS, AXIS.replace("struct Axis {", "class Axis : public A,\n             public B {")],
     ["pellucid::Axis"]),
    ("in front of kernels", [AXIS, AXIS + "#if PELLUCID_HAS_BATCH_4\nint n;\n#endif\n"],
     ["pellucid::Axis"]),
    ("of kernels", [AXIS, "#if PELLUCID_HAS_BATCH_4\n" + AXIS + "#endif\n"], []),
    ("nothing", ["int n;\n"], ["no type was found"]),
]


def check(sources):
    return check_types.check((f"a{i}.h", text) for i, text in enumerate(sources))


if __name__ == "__main__":
    sys.exit(planted.status_of(CASES, check))
