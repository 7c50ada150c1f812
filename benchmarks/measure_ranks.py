#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what ranks cost, side by side in one run:

  measure_ranks.py PROGRAM SCENE [--size WxH] [--repeat N] [--ranks N...]

PROGRAM is `pellucid`, SCENE a scene with a camera and transfer functions. In turn, so that other
work on the machine meets all alike: one process on two threads, and two ranks on one thread each;
then compositing on 1 to 8 ranks. Prints the smallest and the median time of each, and their ratio.
All pictures are to the scene's tolerance; none may have pixels over it.
"""
import argparse
import json
import os
import statistics
import subprocess
import tempfile

LAUNCH = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
          "OMPI_MCA_rmaps_base_oversubscribe": "1",
          "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
          "OMPI_MCA_mpi_yield_when_idle": "1"}


def rendered(arguments, ranks, threads, extra=()):
    with tempfile.TemporaryDirectory() as folder:
        command = [arguments.program, "render", arguments.scene, "--size", arguments.size,
                   "--threads", str(threads), "-o", os.path.join(folder, "picture.png"), "--json",
                   "-q", *extra]
        if ranks > 0:
            command = ["mpirun", "-n", str(ranks), *command, "--ranks"]
        done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **LAUNCH})
        if done.returncode != 0:
            raise SystemExit(done.stderr)
        report = json.loads(done.stdout)
        if report["pixels_over"] > 0:
            raise SystemExit("pixels are over the tolerance")
        return report


def line(name, seconds):
    print(f"{name:34} {min(seconds):8.4f} s smallest {statistics.median(seconds):8.4f} s median")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--ranks", type=int, nargs="*", default=[1, 2, 3, 4, 7, 8])
    parser.add_argument("--balance", default="work")
    arguments = parser.parse_args()
    balance = ("--balance", arguments.balance)
    alone, together, slowest = [], [], []
    for _ in range(arguments.repeat):
        alone.append(rendered(arguments, 0, 2)["seconds"])
        report = rendered(arguments, 2, 1, balance)
        together.append(report["seconds"])
        slowest.append(max(report["ranks"]["render_seconds"]))
    line("1 process, 2 threads", alone)
    line("2 ranks, 1 thread each", together)
    line("  of which the slower rank renders", slowest)
    print(f"ratio: {min(together) / min(alone):.3f} of the smallest, "
          f"{statistics.median(together) / statistics.median(alone):.3f} of the medians")
    print(f"compositing {arguments.size} pixels, the slowest rank:")
    for ranks in arguments.ranks:
        times = [max(rendered(arguments, ranks, 1, balance)["ranks"]["composite_seconds"])
                 for _ in range(arguments.repeat)]
        line(f"  {ranks} ranks", times)


if __name__ == "__main__":
    main()
