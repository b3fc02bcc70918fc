"""Where files go: into devices, pipes and what is behind links; and what kills leave."""

import errno
import fcntl
import json
import os
import pty
import random
import re
import signal
import stat
import subprocess
import threading
import time

import program
from test_hand import gripper_urdf
from test_plan import results_text

# On Linux these are the device that is always full, and the one that swallows everything.
FULL, NULL = (1, 7), (1, 3)


class SpecialFiles(program.ProgramTest):
    """Tests of every command that writes a file whose name it is given."""

    def commands(self):
        """Yields the arguments before the file, and the file's extension."""
        self.write_torus()
        done = program.run("plan", self.folder / "torus.off", "--max-attempts", "20", "--accept", "usable",
                           "--search", "first", "--count", "1", "--out", self.folder / "plan")
        self.assertEqual(done.returncode, 0, done.stderr)
        grasps = self.folder / "plan/grasps.json"
        yield ("hand", "show", "parallel_gripper", "--html"), ".html"
        yield ("shape", "mug", "--out"), ".obj"
        yield ("convert", grasps), ".yaml"
        yield ("convert", grasps), ".glb"

    def read_pipe(self, pipe, arguments):
        """Returns what the command writes into the pipe."""
        got = []
        reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
        reader.start()
        done = program.run(*arguments, pipe)
        reader.join(20)
        self.assertEqual(done.returncode, 0, done.stderr)
        return got[0]

    def test_pipes_get_what_files_get_and_stay_pipes(self):
        for number, (arguments, extension) in enumerate(self.commands()):
            with self.subTest(arguments):
                file = self.folder / f"file{number}{extension}"
                done = program.run(*arguments, file)
                self.assertEqual(done.returncode, 0, done.stderr)
                pipe = self.folder / f"pipe{number}{extension}"
                os.mkfifo(pipe)
                self.assertEqual(self.read_pipe(pipe, arguments), file.read_bytes())
                self.assertTrue(stat.S_ISFIFO(pipe.lstat().st_mode))

    def test_links_are_followed(self):
        for number, (arguments, extension) in enumerate(self.commands()):
            with self.subTest(arguments):
                link = self.folder / f"link{number}{extension}"
                behind = self.folder / f"behind{number}{extension}"
                link.symlink_to(behind.name)
                for _ in range(2):
                    done = program.run(*arguments, link)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertTrue(link.is_symlink())
                    self.assertGreater(behind.stat().st_size, 100)

    def test_a_device_stays_one_and_its_error_is_said(self):
        def make(name, number):
            node = self.folder / name
            try:
                os.mknod(node, stat.S_IFCHR | 0o666, os.makedev(*number))
                os.close(os.open(node, os.O_WRONLY))
            except OSError as error:
                self.assertIn(error.errno, (errno.EPERM, errno.EACCES, errno.ENXIO))
                self.skipTest("no device can be made here")
            return node

        for number, (arguments, extension) in enumerate(self.commands()):
            with self.subTest(arguments):
                full, null = (make(f"{name}{number}{extension}", device)
                              for name, device in (("full", FULL), ("null", NULL)))
                done = program.run(*arguments, full)
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertIn(f"cannot write {full}: No space left on device", done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1)
                done = program.run(*arguments, null)
                self.assertEqual(done.returncode, 0, done.stderr)
                for node in (full, null):
                    self.assertTrue(stat.S_ISCHR(node.lstat().st_mode))

    def test_a_sidecar_behind_a_link_is_replaced_there(self):
        hand = self.write("jaws.urdf", gripper_urdf())
        sidecar, behind = self.folder / "jaws.graspfit.json", self.folder / "behind.json"
        self.assertEqual(program.run("hand", "derive", hand).returncode, 0)
        whole = sidecar.read_bytes()
        data = json.loads(whole)
        del data["pads"]
        behind.write_text(json.dumps(data))
        sidecar.unlink()
        sidecar.symlink_to("behind.json")
        done = program.run("hand", "derive", hand, "--force")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue(sidecar.is_symlink())
        self.assertEqual(behind.read_bytes(), whole)


class Kills(program.ProgramTest):
    """Tests that a folder of grasps is the old set, the new one, or says that it is neither."""

    def plan(self, seed, out, count=3):
        return [program.PROGRAM, "plan", str(self.folder / "torus.off"), "--seed", str(seed), "--accept", "usable",
                "--search", "first", "--count", str(count), "--page", "--out", str(self.folder / out)]

    def finished(self, seed, out, **options):
        done = subprocess.run(self.plan(seed, out, **options), capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.set_in(out)

    def set_in(self, out):
        """Returns name and content of every file that is not hidden, without the times in
        grasps.json."""
        return {path.name: results_text(path) if path.name == "grasps.json" else path.read_bytes()
                for path in (self.folder / out).iterdir() if path.name[0] != "."}

    def hidden(self):
        return [path.name for path in self.folder.rglob(".*")]

    def test_kills_at_random_moments_never_mix_two_runs_unsaid(self):
        self.write_torus()
        # The new set has fewer grasps, so that files of the old one have to go.
        old, new = self.finished(1, "old", count=4), self.finished(2, "new")
        self.assertNotEqual(old.keys(), new.keys())
        start = time.monotonic()
        self.finished(2, "timed")
        longest = time.monotonic() - start
        moments = random.Random(5)
        for number in range(6):
            with self.subTest(number):
                out = f"out{number}"
                self.finished(1, out, count=4)
                process = subprocess.Popen(self.plan(2, out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(moments.uniform(0.3, 1.0) * longest)
                process.send_signal(signal.SIGKILL)
                process.wait(20)
                found = self.set_in(out)
                done = program.run("evaluate", self.folder / out / "grasps.json")
                if found not in (old, new):
                    self.assertEqual(done.returncode, 2)
                    self.assertIn("files of two runs", done.stderr)
                self.assertEqual(self.finished(2, out), new)
                self.assertEqual(self.hidden(), [])

    def test_a_mark_of_a_broken_replacement_is_heeded_until_the_next_run(self):
        self.write_torus()
        whole = self.finished(1, "out")
        (self.folder / "out/.graspfit-replacing").write_text("")
        for command in ("evaluate", "hold"):
            done = program.run(command, self.folder / "out/grasps.json")
            if "MuJoCo" in done.stderr:
                continue
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertIn("holds files of two runs", done.stderr)
        self.assertEqual(self.finished(1, "out"), whole)
        self.assertEqual(program.run("evaluate", self.folder / "out/grasps.json").returncode, 0)

    def test_folders_of_dead_processes_are_removed_and_those_of_living_ones_stay(self):
        self.write_torus()
        (self.folder / "out").mkdir()
        for parent in (self.folder, self.folder / "out"):
            for name in ("dead00", "alive0"):
                (parent / f".graspfit-{name}").mkdir()
                (parent / f".graspfit-{name}/grasps.csv").write_text("rank\n")
        locks = [os.open(parent / ".graspfit-alive0", os.O_RDONLY) for parent in (self.folder, self.folder / "out")]
        for lock in locks:
            self.addCleanup(os.close, lock)
            fcntl.flock(lock, fcntl.LOCK_EX)
        self.finished(1, "out")
        self.finished(1, "new")
        self.assertEqual(sorted(self.hidden()), [".graspfit-alive0"] * 2)


class Interrupts(program.ProgramTest):
    def start(self):
        """Returns the process once its progress shows a grasp, and a function that ends with it and
        returns what it printed and what its terminal shows."""
        primary, secondary = pty.openpty()
        self.addCleanup(os.close, primary)
        process = subprocess.Popen(
            [program.PROGRAM, "plan", str(self.write_torus()), "--count", "1000",
             "--max-attempts", "1000000", "--out", str(self.folder / "new/out")],
            stdout=subprocess.PIPE, stderr=secondary, env={**os.environ, "TERM": "xterm"})
        self.addCleanup(process.stdout.close)
        os.close(secondary)
        shown = bytearray()
        has_grasp = threading.Event()

        def read_terminal():
            try:
                while block := os.read(primary, 4096):
                    shown.extend(block)
                    if re.search(rb"[1-9]\d* grasps", shown):
                        has_grasp.set()
            except OSError:  # The program has closed its end.
                pass

        reader = threading.Thread(target=read_terminal)
        reader.start()
        self.addCleanup(reader.join)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.assertTrue(has_grasp.wait(120))
        self.assertIsNone(process.poll())

        def ended():
            said, _ = process.communicate(timeout=120)
            reader.join()
            return said.decode(), shown.decode()

        return process, ended

    def test_one_interrupt_ends_with_the_grasps_that_were_found(self):
        for interrupt in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(interrupt.name):
                process, ended = self.start()
                process.send_signal(interrupt)
                said, shown = ended()
                self.assertEqual(process.returncode, 128 + interrupt)
                self.assertEqual(len(re.findall(r"(?m)^graspfit plan: interrupted: ", shown)), 1, shown)
                self.assertRegex(said, r"grasps, .*closed, in \d+ attempts \(interrupted\)")
                file = json.loads((self.folder / "new/out/grasps.json").read_text())
                self.assertEqual(file["results"]["stop"], "interrupted")
                self.assertTrue(file["results"]["grasps"])
                done = program.run("evaluate", self.folder / "new/out/grasps.json")
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_second_interrupt_ends_at_once_and_leaves_nothing(self):
        process, _ = self.start()
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(20), 128 + signal.SIGTERM)
        self.assertEqual(self.contents(), ["torus.off"])

    def test_a_kill_leaves_nothing(self):
        process, _ = self.start()
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.wait(20), -signal.SIGKILL)
        self.assertEqual(self.contents(), ["torus.off"])


if __name__ == "__main__":
    program.main()
