#!/usr/bin/python3
"""Runs a sharded sweep on a Slurm of one node and compares its tables with a local run's.

Starts munged, slurmctld and slurmd of its own in a temporary folder, as root; has Snakemake submit
the shards by the profile of experiments/profiles/slurm; kills a shard on its node with SIGKILL once
it has finished cells; and waits for its resubmission, the end and the merge. Fails unless the killed
shard kept its cells, and the tables are the same bytes. Prints a transcript.

Usage: slurm_sweep.py PROGRAM
"""

import argparse
import contextlib
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

SOURCE_DIR = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "snakemake")
SLUG = "parameter_sweeps"
SHARDS = 3
# The sweep has 12 cells of a second or more each, so that there is a middle in which to kill it.
# They are of a shape, which needs no data.
CHANGES = ["--quick", "--set", "seed=1,2,3,4,5,6", "--set", "max-attempts=20"]
START = time.monotonic()

SLURM_CONF = """\
ClusterName=graspfit_test
SlurmctldHost={node}
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
KillWait=2
NodeName={node} CPUs={processors} RealMemory={memory} State=UNKNOWN
PartitionName=all Nodes={node} Default=YES MaxTime=INFINITE State=UP
"""


def say(text):
    print(f"{time.monotonic() - START:7.1f} s  {text}", flush=True)


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(0)


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def wait_until(is_true, seconds, what):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = is_true()
        if value:
            return value
        time.sleep(0.2)
    raise RuntimeError(f"{what} has not come within {seconds} s")


def free_port():
    with socket.socket() as one:
        one.bind(("", 0))
        return one.getsockname()[1]


@contextlib.contextmanager
def daemon(name, folder, *command):
    """Runs a daemon in the foreground and ends it with the test; shows its log if it ends
    earlier."""
    with open(folder / f"{name}.log", "wb") as log:
        process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT)
    try:
        time.sleep(1.0)
        if process.poll() is not None:
            raise RuntimeError(f"{name}: {(folder / f'{name}.log').read_text()}")
        say(f"{name} runs: {' '.join(map(str, command))}")
        yield process
    finally:
        process.terminate()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@contextlib.contextmanager
def slurm(folder):
    """Runs a Slurm with this machine as its only node; SLURM_CONF names it."""
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    node = socket.gethostname().split(".")[0]
    configuration = folder / "slurm.conf"
    configuration.write_text(SLURM_CONF.format(
        node=node, folder=folder, controller_port=free_port(), node_port=free_port(),
        processors=os.cpu_count(), memory=4000))
    os.environ["SLURM_CONF"] = str(configuration)
    with contextlib.ExitStack() as stack:
        stack.enter_context(daemon(
            "munged", folder, "munged", "--foreground", "--force", f"--key-file={key}",
            f"--socket={folder}/munge.socket", f"--pid-file={folder}/munge.pid",
            f"--log-file={folder}/munged_own.log", f"--seed-file={folder}/munge.seed"))
        stack.enter_context(daemon("slurmctld", folder, "slurmctld", "-D", "-f", configuration))
        stack.enter_context(daemon("slurmd", folder, "slurmd", "-D", "-f", configuration,
                                   "-N", node))
        wait_until(lambda: "idle" in output_of("sinfo", "-h", "-o", "%T"), 60, "an idle node")
        say("sinfo: " + output_of("sinfo", "-h", "-o", "%P %D node, %c processors, %T").strip())
        yield


def num_finished(journal):
    """Returns the number of finished cells in a journal: its whole lines of cells."""
    if not journal.is_file():
        return 0
    return sum(line.endswith(b"\n") and b'"cell":' in line
               for line in journal.read_bytes().splitlines(keepends=True))


def kill_a_shard(out, snakemake):
    """Kills the first shard that has a cell, as soon as it has. Returns its journal and its job."""
    def shard_with_a_cell():
        if snakemake.poll() is not None:
            raise RuntimeError("snakemake has ended too early")
        for journal in sorted((out / "shards").glob(f"*/{SLUG}.cells")):
            if num_finished(journal) >= 1:
                return journal
        return None

    journal = wait_until(shard_with_a_cell, 120, "a shard with a cell")
    index = journal.parent.name.split("-")[0]
    job = output_of("squeue", "-h", "-o", "%i", "-n", f"graspfit_shard_{index}").split()[0]
    say("squeue:\n" + output_of("squeue", "-o", "%.6i %.24j %.10T %.8M %R").rstrip())
    subprocess.run(["scancel", "--signal=KILL", "--full", job], check=True)
    say(f"SIGKILL to job {job}, shard {journal.parent.name}, which has "
        f"{num_finished(journal)} cells")
    return journal, job


def states_of(journal, first_job):
    """Returns the states that Slurm remembers of the shard's jobs, once there is another than
    the first."""
    index = journal.parent.name.split("-")[0]
    lines = output_of("scontrol", "--oneliner", "show", "job").splitlines()
    fields = [dict(part.split("=", 1) for part in line.split() if "=" in part) for line in lines]
    jobs = {f["JobId"]: f["JobState"] for f in fields
            if f.get("JobName") == f"graspfit_shard_{index}"}
    return jobs if set(jobs) - {first_job} else None


def run_on_slurm(program, folder):
    """Runs the sweep by Snakemake with a kill on the way. Returns the folder of its results."""
    out = folder / "slurm"
    command = ["snakemake", "-s", SOURCE_DIR / "experiments/Snakefile",
               "--profile", SOURCE_DIR / "experiments/profiles/slurm", "--directory", folder,
               "--config", f"slug={SLUG}", f"shards={SHARDS}", f"out={out}",
               f"program={program}", f"changes={' '.join(CHANGES)}", "mem_mb=500", "minutes=10"]
    say(" ".join(map(str, command)))
    log = folder / "snakemake.log"
    with open(log, "wb") as stream:
        snakemake = subprocess.Popen(command, stdout=stream, stderr=subprocess.STDOUT, cwd=folder)
    try:
        journal, job = kill_a_shard(out, snakemake)
        kept = num_finished(journal)
        jobs = wait_until(lambda: states_of(journal, job), 120, "the resubmission")
        say(f"resubmitted: jobs of that shard {jobs}")
        if snakemake.wait(600) != 0:
            raise RuntimeError("snakemake failed")
    except Exception:
        print(log.read_text())
        for text in sorted(folder.glob("*.log")):
            print(f"--- {text.name}\n{text.read_text(errors='replace')[-3000:]}")
        raise
    finally:
        if snakemake.poll() is None:
            snakemake.terminate()
            snakemake.wait(60)
    say("jobs of that shard at the end: " + str(states_of(journal, job)))
    cells = [line for line in journal.read_bytes().splitlines() if b'"cell":' in line]
    starts = sum(b'"inputs":' in line and b'"cell":' not in line
                 for line in journal.read_bytes().splitlines())
    say(f"shard {journal.parent.name}: {starts} runs, {len(cells)} cells, at least {kept} of them "
        "from before the kill")
    if starts < 2:
        raise RuntimeError("the killed shard was not run again")
    print(log.read_text().rstrip())
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    program = parser.parse_args().program.resolve()
    missing = [name for name in PROGRAMS if shutil.which(name) is None]
    if missing:
        skip(f"{', '.join(missing)} not installed")
    if os.geteuid() != 0:
        skip("Slurm's daemons are started as root")
    with tempfile.TemporaryDirectory(prefix="graspfit_slurm_") as name:
        folder = pathlib.Path(name)
        local = folder / "local"
        os.environ["GRASPFIT_CACHE"] = str(folder / "cache")
        output_of(program, "experiment", "run", SLUG, *CHANGES, "--out", local, "--quiet")
        say(f"local run: {len((local / f'{SLUG}.csv').read_text().splitlines()) - 1} cells")
        with slurm(folder):
            out = run_on_slurm(program, folder)
        ours, theirs = ((where / f"{SLUG}.csv").read_bytes() for where in (local, out))
        if ours != theirs:
            raise RuntimeError("the merged table is not the local one")
        say(f"the merged {SLUG}.csv is the local one, byte for byte ({len(ours)} bytes)")


if __name__ == "__main__":
    main()
