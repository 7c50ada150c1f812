#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the symbols of the objects that are compiled once per instruction set.

  check_symbols.py NM SET OBJECT... [SET OBJECT...]
  check_symbols.py --self-test

What such an object offers to the linker must not be known to any other by the same name: an inline
function of the standard library, or of the core under its own name, compiled for AVX-512 and kept
by the linker for the whole program, would be run on machines that have no AVX-512. Allowed are
names within the namespace that the set gives to the project (cmake/PellucidInstructionSets.cmake),
and C functions that end with the set. Prints one line per violation and ends with 1 if there is
any.
"""
import re
import subprocess
import sys

SETS = ("sse4", "avx2", "avx512", "neon64")
# Pointers to the personality routine, the same in every object; the sanitizers' own.
NEUTRAL = re.compile(r"^(DW\.ref\.__gxx_personality_v0|__(asan|ubsan|tsan|odr_asan)[._a-z]*)")


def symbols(nm_output):
    """(name, kind) of every symbol that is defined and seen from outside."""
    for line in nm_output.splitlines():
        fields = line.split()
        if len(fields) >= 2 and fields[1] not in "Uwv" and fields[1].isalpha():
            yield fields[0], fields[1]


def violations(set_name, nm_output):
    own = f"pellucid_{set_name}"
    component = re.compile(rf"(?<![0-9]){len(own)}{own}")
    for name, kind in symbols(nm_output):
        if name.startswith("_Z"):
            allowed = component.search(name)
        else:
            allowed = name.endswith(f"_{set_name}") or NEUTRAL.match(name)
        if not allowed:
            yield f"{name} ({kind}) is not of {own}: another object may have it under the same name"


def self_test():
    """What must be found, and what must not."""
    wrong = ["_ZSt3expf W 0 0", "_ZN8pellucid3fmaEfff W 0 0", "_ZN13pellucid_avx23fmaEfff W 0 0",
             "_ZN5xsimd5batchIfNS_8avx512bwEEC1Ef W 0 0", "render T 0 0", "render_avx2 T 0 0",
             "_ZNSt6vectorIfSaIfEED2Ev W 0 0", "_ZTISt9exception V 0 0", "_ZN4otherE u 0 0"]
    right = ["_ZN15pellucid_avx5123fmaEfff W 0 0", "render_avx512 T 0 0", "_ZSt3expf U", "memcpy U",
             "_ZNSt6vectorIN15pellucid_avx5123RayEED2Ev W 0 0", "DW.ref.__gxx_personality_v0 V 0 8"]
    failures = [line for line in wrong if len(list(violations("avx512", line))) != 1]
    failures += [line for line in right if list(violations("avx512", line))]
    print("\n".join(f"judged wrongly: {line}" for line in failures)
          or f"{len(wrong)} found, {len(right)} let through")
    return 1 if failures else 0


def main():
    if sys.argv[1] == "--self-test":
        return self_test()
    nm, found, checked, set_name = sys.argv[1], [], 0, None
    for argument in sys.argv[2:]:
        if argument in SETS:
            set_name = argument
            continue
        command = [nm, "--extern-only", "--format=posix", argument]
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode != 0:
            found.append(f"{argument}: not read: {result.stderr.strip()}; "
                         "build all before this test")
            continue
        output = result.stdout
        if not any(f"_{set_name}" in name for name, _ in symbols(output)):
            found.append(f"{argument}: no symbol of {set_name} at all")
        found += [f"{argument}: {line}" for line in violations(set_name, output)]
        checked += 1
    print("\n".join(found) or f"{checked} objects, each with symbols of its own only")
    return 1 if found or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
