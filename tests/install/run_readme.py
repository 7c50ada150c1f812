#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the lines of README.md that begin with `pellucid `, in their order, in an empty folder.

  run_readme.py ROOT PROGRAM

Its brain.nii.gz is the one of the Debian package mricron-data; lines about it are left out where it is missing.
"""
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

BRAIN = pathlib.Path("/usr/share/mricron/templates/ch2.nii.gz")


def main():
    root, program = pathlib.Path(sys.argv[1]), sys.argv[2]
    blocks = re.findall(r"```sh\n(.*?)```", (root / "README.md").read_text(), flags=re.S)
    lines = [line for block in blocks for line in block.splitlines() if line.startswith("pellucid ")]
    if not lines:
        print("README.md shows no command")
        return 1
    with tempfile.TemporaryDirectory() as folder:
        if BRAIN.exists():
            (pathlib.Path(folder) / "brain.nii.gz").symlink_to(BRAIN)
        for line in lines:
            if "brain.nii.gz" in line and not BRAIN.exists():
                print(f"left out: {line}")
                continue
            print(line, flush=True)
            arguments = shlex.split(line)[1:]
            run = subprocess.run([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL)
            if run.returncode != 0:
                print(f"ended with {run.returncode}")
                return 1
            output = arguments[arguments.index("-o") + 1] if "-o" in arguments else None
            if output and not (pathlib.Path(folder) / output).stat().st_size:
                print(f"{output} is empty")
                return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
