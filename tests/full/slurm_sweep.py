#!/usr/bin/python3
"""Runs a sharded sweep on a Slurm of one node and compares its tables with a local run's.

Starts munged, slurmctld and slurmd of its own in a temporary folder, as root; has Snakemake submit
the shards by the profile of experiments/profiles/slurm; kills a shard on its node with SIGKILL once
it has finished cells; and waits for its resubmission, the end and the merge. Fails unless the killed
shard kept its cells, and the tables are the same bytes. Prints a transcript.

Usage: slurm_sweep.py PROGRAM
"""

import argparse
import os
import pathlib
import tempfile

from one_node_slurm import SlurmSweep, output_of, require_slurm, say, slurm

SLUG = "parameter_sweeps"
SHARDS = 3
# The sweep has 12 cells of a second or more each, so that there is a middle in which to kill it.
# They are of a shape, which needs no data.
CHANGES = ["--quick", "--set", "seed=1,2,3,4,5,6", "--set", "max-attempts=20"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    program = parser.parse_args().program.resolve()
    require_slurm()
    with tempfile.TemporaryDirectory(prefix="graspfit_slurm_") as name:
        folder = pathlib.Path(name)
        local, out = folder / "local", folder / "slurm"
        os.environ["GRASPFIT_CACHE"] = str(folder / "cache")
        output_of(program, "experiment", "run", SLUG, *CHANGES, "--out", local, "--quiet")
        say(f"local run: {len((local / f'{SLUG}.csv').read_text().splitlines()) - 1} cells")
        with slurm(folder):
            sweep = SlurmSweep(SLUG, SHARDS, out, folder)
            print(sweep.run(sweep.command(program, CHANGES)))
        ours, theirs = ((where / f"{SLUG}.csv").read_bytes() for where in (local, out))
        if ours != theirs:
            raise RuntimeError("the merged table is not the local one")
        say(f"the merged {SLUG}.csv is the local one, byte for byte ({len(ours)} bytes)")


if __name__ == "__main__":
    main()
