#!/usr/bin/python3
"""Compares the processor time of two builds of the program on the same commands.

The builds run in turns, so that what else the machine does falls on both. Printed are the median
seconds (user and system) of each, the ratio of the medians, second over first, and the least and
largest ratio of a round. A command that fails ends the comparison.

    compare_programs.py old/graspfit new/graspfit --rounds 5 \\
        --run "plan bunny.off --extent 0.15 --hand barrett --grasps 3" \\
        --run "plan bunny.off --extent 0.15 --hand human --grasps 3"
"""

import argparse
import os
import shlex
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path


def processor_time(program, arguments):
    """Seconds of processor time that a run takes, in an empty folder and with an empty cache."""
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, XDG_CACHE_HOME=f"{folder}/cache")
        before = os.times()
        run = subprocess.run(
            [program, *arguments], cwd=folder, env=environment, capture_output=True, text=True
        )
        after = os.times()
    if run.returncode != 0:
        sys.exit(f"{program} {shlex.join(arguments)}: exit code {run.returncode}\n{run.stderr}")
    return (after.children_user - before.children_user) + (
        after.children_system - before.children_system
    )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("first", type=Path, help="program that is the reference")
    parser.add_argument("second", type=Path, help="program that is compared with it")
    parser.add_argument("--run", action="append", required=True, help="arguments of a run")
    parser.add_argument("--rounds", type=int, default=5, help="runs of each (default: 5)")
    options = parser.parse_args()
    programs = [str(options.first.resolve()), str(options.second.resolve())]
    print(f"{'first':>8} {'second':>8} {'ratio':>6}  least to largest  run")
    for run in options.run:
        arguments = shlex.split(run)
        times = [[processor_time(p, arguments) for p in programs] for _ in range(options.rounds)]
        first, second = (statistics.median(column) for column in zip(*times))
        ratios = [b / a for a, b in times]
        print(
            f"{first:7.2f}s {second:7.2f}s {second / first:6.3f}  "
            f"{min(ratios):.3f} to {max(ratios):.3f}    {run}",
            flush=True,
        )


if __name__ == "__main__":
    main()
