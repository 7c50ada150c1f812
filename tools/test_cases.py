#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts the cases of test programs whose cases ran together (PELLUCID_TEST_GROUPS).

  test_cases.py check FOLDER [NAME PROGRAM TESTS]...  ends with 1 unless the tests of each program
                                                      have run all of its cases, each of them once
  test_cases.py count FOLDER                          prints how many there were, and what was
                                                      skipped

FOLDER holds what GoogleTest wrote: TEST.json for each of TESTS, which commas separate.
"""
import collections
import json
import subprocess
import sys
from pathlib import Path


def read(file):
    """(suite.case, result) of one process; COMPLETED, SKIPPED or FAILED."""
    document = json.loads(file.read_text())
    for suite in document["testsuites"]:
        for case in suite["testsuite"]:
            if case["status"] != "RUN":
                continue  # disabled, or of another shard
            result = "FAILED" if "failures" in case else case["result"]
            yield f'{suite["name"]}.{case["name"]}', result


def listed(program):
    """The cases that the program has."""
    output = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True,
                            text=True).stdout
    suite = ""
    for line in output.splitlines():
        name = line.split("#")[0].strip()
        if not line.startswith(" "):
            suite = name
        elif not name.startswith("DISABLED_") and not suite.startswith("DISABLED_"):
            yield suite + name


def differences(name, expected, seen):
    """One line for each case that has not run once."""
    for case in sorted(expected | set(seen)):
        if seen[case] != 1 or case not in expected:
            yield f"{name}: {case} ran {seen[case]} times"


def check(folder, programs):
    found = []
    for name, program, tests in zip(programs[0::3], programs[1::3], programs[2::3]):
        seen = collections.Counter()
        for test in tests.split(","):
            file = folder / f"{test}.json"
            if file.exists():
                seen.update(case for case, _ in read(file))
        # GoogleTest lists "Suite." with the dot that joins.
        found += differences(name, set(listed(program)), seen)
    print("\n".join(found[:100]) or "every case ran once")
    return 1 if found else 0


def count(folder):
    results, skipped = collections.Counter(), collections.Counter()
    for file in sorted(folder.glob("*.json")):
        for case, result in read(file):
            results[result] += 1
            if result == "SKIPPED":
                skipped[f'{file.stem.split(".")[0]}.{case.rpartition(".")[0]}'] += 1
    print(f"{sum(results.values())} cases in the programs above: {results['COMPLETED']} passed, "
          f"{results['FAILED']} failed, {results['SKIPPED']} skipped")
    for name, number in sorted(skipped.items()):
        print(f"  skipped: {name}: {number}")
    return 0


if __name__ == "__main__":
    if len(sys.argv) >= 3 and sys.argv[1] == "check":
        sys.exit(check(Path(sys.argv[2]), sys.argv[3:]))
    if len(sys.argv) == 3 and sys.argv[1] == "count":
        sys.exit(count(Path(sys.argv[2])))
    sys.exit(__doc__)
