"""A Slurm of one node for tests, and sharded sweeps that Snakemake submits to it.

The daemons are started as root, in a folder of the test's own.
"""

import contextlib
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time

SOURCE_DIR = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "snakemake")
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


def require_slurm():
    """Skips the test on a machine that cannot run a Slurm."""
    missing = [name for name in PROGRAMS if shutil.which(name) is None]
    if missing:
        skip(f"{', '.join(missing)} not installed")
    if os.geteuid() != 0:
        skip("Slurm's daemons are started as root")


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


class SlurmSweep:
    """A sweep in shards on Slurm: an experiment by its slug, or a data set in the folder `out`."""

    def __init__(self, slug, shards, out, folder):
        self.slug, self.shards, self.out, self.folder = slug, shards, out, folder

    def command(self, program, changes=(), mem_mb=500, minutes=10):
        settings = [f"slug={self.slug}", f"shards={self.shards}", f"out={self.out}",
                    f"program={program}", f"mem_mb={mem_mb}", f"minutes={minutes}"]
        if changes:
            settings.append(f"changes={' '.join(changes)}")
        return ["snakemake", "-s", SOURCE_DIR / "experiments/Snakefile",
                "--profile", SOURCE_DIR / "experiments/profiles/slurm",
                "--directory", self.folder, "--config", *settings]

    def kill_a_shard(self, snakemake, num_cells=1, seconds=120):
        """Kills the first shard that runs and has `num_cells` cells, as soon as it has. Returns its
        journal, its job and the number of its cells."""
        def running_shard():
            if snakemake.poll() is not None:
                raise RuntimeError("snakemake has ended too early")
            for journal in sorted(self.out.glob(f"shards/*-of-{self.shards}/{self.slug}.cells")):
                if num_finished(journal) >= num_cells:
                    index = journal.parent.name.split("-")[0]
                    jobs = output_of("squeue", "-h", "-t", "RUNNING", "-o", "%i", "-n",
                                     f"graspfit_shard_{index}").split()
                    if jobs:
                        return journal, jobs[0]
            return None

        journal, job = wait_until(running_shard, seconds, f"a shard with {num_cells} cells")
        say("squeue:\n" + output_of("squeue", "-o", "%.6i %.24j %.10T %.8M %R").rstrip())
        subprocess.run(["scancel", "--signal=KILL", "--full", job], check=True)
        kept = num_finished(journal)
        say(f"SIGKILL to job {job}, shard {journal.parent.name}, which has {kept} cells")
        return journal, job, kept

    def run(self, command, kills=((1, 120),), seconds=600):
        """Runs the sweep with kills on the way: `(cells that a shard then has, seconds to wait for
        it)`. Fails unless each killed shard was run again and Snakemake ended well."""
        say(" ".join(map(str, command)))
        log = self.folder / "snakemake.log"
        killed = []
        with open(log, "wb") as stream:
            snakemake = subprocess.Popen(command, stdout=stream, stderr=subprocess.STDOUT,
                                         cwd=self.folder)
        try:
            for num_cells, wait in kills:
                journal, job, kept = self.kill_a_shard(snakemake, num_cells, wait)
                jobs = wait_until(lambda: states_of(journal, job), 120, "the resubmission")
                say(f"resubmitted: jobs of that shard {jobs}")
                killed.append((journal, kept))
            if snakemake.wait(seconds) != 0:
                raise RuntimeError("snakemake failed")
        except Exception:
            print(log.read_text())
            for text in sorted(self.folder.glob("*.log")):
                print(f"--- {text.name}\n{text.read_text(errors='replace')[-3000:]}")
            raise
        finally:
            if snakemake.poll() is None:
                snakemake.terminate()
                snakemake.wait(60)
        for journal, kept in killed:
            lines = journal.read_bytes().splitlines()
            cells = sum(b'"cell":' in line for line in lines)
            starts = sum(b'"inputs":' in line and b'"cell":' not in line for line in lines)
            say(f"shard {journal.parent.name}: {starts} runs, {cells} cells, at least {kept} of "
                "them from before the kill")
            if starts < 2:
                raise RuntimeError("the killed shard was not run again")
        return log.read_text().rstrip()


def states_of(journal, first_job):
    """Returns the states that Slurm remembers of the shard's jobs, once there is another than
    the first."""
    index = journal.parent.name.split("-")[0]
    lines = output_of("scontrol", "--oneliner", "show", "job").splitlines()
    fields = [dict(part.split("=", 1) for part in line.split() if "=" in part) for line in lines]
    jobs = {f["JobId"]: f["JobState"] for f in fields
            if f.get("JobName") == f"graspfit_shard_{index}"}
    return jobs if set(jobs) - {first_job} else None
