#!/usr/bin/python3
"""Writes the shipped hands: description (URDF), sidecar, link meshes and SOURCE.md.

    generate.py [--out FOLDER]      default: the folder of this script

One module of `generator` per hand. Every number comes from the table of its hand there, each with
its source; shapes are built from those numbers and nothing else, so that running it twice with the
same Python on the same processor gives the same bytes.
"""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from generator import barrett, human_hand, parallel_gripper  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parent,
                        help="folder that gets one folder per hand")
    out = parser.parse_args().out
    for hand in (barrett, parallel_gripper, human_hand):
        hand.write(out)


if __name__ == "__main__":
    main()
