# SPDX-License-Identifier: Apache-2.0
"""Faults that are planted for the checks of this folder."""


def status_of(cases, check):
    """The exit status of a test: 0 where the check finds in all cases what it must. A case is what
    is planted, what the check is given, and what each of its messages must say."""
    failures = 0
    for what, given, messages in cases:
        found = list(check(given))
        if len(found) != len(messages) or not all(
                message in line for message, line in zip(messages, found)):
            failures += 1
            print(f"{what}: expected {messages}, found {found}")
    print(f"{len(cases)} planted, {failures} not found as they should be")
    return 1 if failures else 0
