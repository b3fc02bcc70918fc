"""graspfit dataset: run, status, merge, pack."""

import csv
import hashlib
import json
import os
import re
import signal
import subprocess
import tarfile
import time

import numpy
from program import PROGRAM, ProgramTest, box, main, off_text, run, torus

# Few attempts on coarse voxels: what grasps are like is tested elsewhere.
QUICK = ("--grasps", "2", "--set", "max-attempts=4", "--set", "resolution=16",
         "--set", "weak-thickness-mm=0")
RESULTS = ("dataset.csv", "dataset.details.csv", "dataset.columns.json", "CARD.md")


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


class DatasetTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.meshes = self.folder / "meshes"
        (self.meshes / "more").mkdir(parents=True)
        self.write("meshes/torus.off", off_text(*torus()))
        self.write("meshes/more/box.off", off_text(*box(0.05, 0.06, 0.07)))
        self.write("meshes/bad.off", "OFF\n1 1 0\n")
        self.write("meshes/notes.txt.bak", "no mesh")

    def make(self, name, *arguments, code=0):
        out = self.folder / name
        done = run("dataset", "run", out, *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        return out

    def make_quick(self, name, *arguments):
        return self.make(name, "--objects", self.meshes, "--hand", "parallel_gripper", "--hand",
                         "barrett", "--protocol", "none", *QUICK, *arguments)

    def assert_same_results(self, one, other):
        names = [*RESULTS, *(str(path.relative_to(one)) for path in (one / "arrays").iterdir())]
        for name in names:
            self.assertEqual((one / name).read_bytes(), (other / name).read_bytes(), name)


class Run(DatasetTest):
    """Tests of what a data set holds."""

    def test_index_arrays_and_grasp_files_say_the_same(self):
        out = self.make_quick("out")
        rows = rows_of(out / "dataset.csv")
        self.assertEqual([(row["object"], row["hand"]) for row in rows],
                         [(name, hand) for name in ("bad", "more_box", "torus")
                          for hand in ("parallel_gripper", "barrett")])
        for row in rows[:2]:
            self.assertEqual(row["status"], "failed")
            self.assertIn("bad.off", row["reason"])
        details = rows_of(out / "dataset.details.csv")
        num_grasps = 0
        for hand in ("parallel_gripper", "barrett"):
            own = [row for row in rows[2:] if row["hand"] == hand and row["grasp_file"]]
            arrays = numpy.load(out / f"arrays/{hand}_0001.npz")
            self.assertEqual(list(arrays["object_name"]), [row["object"] for row in own])
            self.assertEqual(list(arrays["object_sha256"]), [row["object_sha256"] for row in own])
            grasps = [grasp for row in own for grasp in self.grasps_of(out / row["grasp_file"])]
            self.assertEqual(len(arrays["grasp_qpos"]), len(grasps))
            self.assertEqual(list(arrays["held"]), [-1] * len(grasps))
            for g, grasp in enumerate(grasps):
                self.check_grasp(arrays, g, grasp)
            self.assertEqual(arrays["contact_start"][-1], len(arrays["contact_point"]))
            of_hand = [float(row["m"]) for row in details if row["hand"] == hand]
            self.assertEqual(list(arrays["m"]), of_hand)
            num_grasps += len(grasps)
        self.assertGreater(num_grasps, 2)
        self.assertEqual(len(details), num_grasps)
        self.assertTrue((out / "CARD.md").read_text().startswith(
            f"# {num_grasps} grasps of 3 objects\n"))

    def grasps_of(self, file):
        return json.loads(file.read_text())["results"]["grasps"]

    def check_grasp(self, arrays, g, grasp):
        pose = grasp["X_OH"]
        # Rotations are read from quaternions, and rounded on the way.
        numpy.testing.assert_allclose(
            arrays["grasp_qpos"][g],
            [*pose["translation_m"], *pose["rotation_wxyz"], *grasp["joints"].values()],
            rtol=0, atol=1e-14)
        self.assertEqual(list(arrays["joint_names"]), list(grasp["joints"]))
        self.assertEqual(list(arrays["pregrasp_qpos"][g][7:]),
                         list(grasp["pre_grasp"]["joints"].values()))
        contacts = slice(arrays["contact_start"][g], arrays["contact_start"][g + 1])
        self.assertEqual(arrays["contact_point"][contacts].tolist(),
                         [contact["point_O_m"] for contact in grasp["contacts"]])
        self.assertEqual(list(arrays["contact_link"][contacts]),
                         [contact["link"] for contact in grasp["contacts"]])
        self.assertEqual(arrays["m"][g], grasp["m"])
        self.assertEqual(arrays["epsilon"][g], grasp["wrench"]["epsilon"])

    def test_lists_say_sizes_units_and_licenses(self):
        self.write("list.csv", "file,name,longest_m,meters_per_unit,license\n"
                               "meshes/torus.off,ring,0.16,,CC0\n"
                               "meshes/more/box.off,,,1.5,\n")
        self.write("list.txt", "# boxes\nmeshes/more/box.off  # as it is\n\n")
        out = self.make("out", "--objects", self.folder / "list.csv", "--objects",
                        self.folder / "list.txt", "--hand", "parallel_gripper", "--protocol",
                        "none", *QUICK)
        rows = rows_of(out / "dataset.csv")
        self.assertEqual([(row["object"], row["license"]) for row in rows],
                         [("ring", "CC0"), ("box", ""), ("box_2", "")])
        self.assertEqual([round(float(row["object_extent_m"]), 9) for row in rows],
                         [0.16, 0.105, 0.07])
        self.assertEqual(float(rows[1]["meters_per_file_unit"]), 1.5)
        card = (out / "CARD.md").read_text()
        self.assertIn("- 1: CC0\n", card)
        self.assertIn("- 2: none stated\n", card)

    def test_every_length_is_an_object(self):
        out = self.make("out", "--objects", self.meshes / "torus.off", "--hand", "barrett",
                        "--longest", "0.1,0.14", "--protocol", "none", *QUICK)
        rows = rows_of(out / "dataset.csv")
        self.assertEqual([(row["object"], row["object_extent_m"]) for row in rows],
                         [("torus_0.1m", "0.1"), ("torus_0.14m", "0.14")])

    def test_verdicts_and_margins_are_in_details_and_arrays(self):
        out = self.make("out", "--objects", self.meshes / "more", "--hand", "parallel_gripper",
                        "--margins", "1", *QUICK)
        row, = rows_of(out / "dataset.csv")
        details = rows_of(out / "dataset.details.csv")
        arrays = numpy.load(out / "arrays/parallel_gripper_0001.npz")
        self.assertEqual(list(arrays["held"]), [int(row["stage"] == "held") for row in details])
        self.assertEqual(int(row["held"]), int(arrays["held"].sum()))
        self.assertGreater(len(details), 0)
        self.assertEqual(arrays["margin_force"][0], float(details[0]["margin_force_n"]))
        self.assertTrue(numpy.isnan(arrays["margin_force"][1:]).all())
        self.assertEqual([row["margin_force_n"] for row in details[1:]], [""] * (len(details) - 1))

    def test_the_lines_of_the_card_load_the_arrays(self):
        out = self.make_quick("out")
        code = re.search(r"```python\n(.*?)```", (out / "CARD.md").read_text(), re.DOTALL).group(1)
        self.assertLessEqual(len(code.splitlines()), 5)
        done = subprocess.run(["/usr/bin/python3", "-c", code + "\nprint(len(wxyz), len(points))"],
                              cwd=out, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"^4 [1-9]")


class Restart(DatasetTest):
    """Tests of shards, kills and packing."""

    def test_shards_and_kills_do_not_change_a_byte(self):
        whole = self.make_quick("whole")
        parts = self.folder / "parts"
        arguments = [str(argument) for argument in
                     ("--objects", self.meshes, "--hand", "parallel_gripper", "--hand", "barrett",
                      "--protocol", "none", *QUICK)]
        self.make("parts", *arguments, "--request-only")
        self.assertEqual([path.name for path in parts.iterdir()], ["dataset.config.json"])
        self.make("parts", "--shard", "1/3")
        killed = subprocess.Popen([PROGRAM, "dataset", "run", str(parts), "--shard", "2/3"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        journal = parts / "shards/2-of-3/dataset.cells"
        end = time.monotonic() + 60
        while not (journal.exists() and b'"cell":' in journal.read_bytes()):
            self.assertLess(time.monotonic(), end)
            if killed.poll() is not None:
                break
            time.sleep(0.01)
        killed.send_signal(signal.SIGKILL)
        killed.wait()
        done = run("dataset", "merge", parts)
        self.assertEqual(done.returncode, 2)
        self.assertIn("cells are missing", done.stderr)
        for shard in ("2/3", "3/3"):
            self.make("parts", "--shard", shard)
        self.assertRegex(run("dataset", "status", parts).stdout, "^all +6 of 6 cells done, 2 of")
        done = run("dataset", "merge", parts)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same_results(whole, parts)
        # Again, with nothing left to do.
        self.make("whole", *arguments)
        self.assert_same_results(whole, parts)

    def test_an_archive_has_all_of_it_and_its_hash_on_the_card(self):
        out = self.make_quick("out")
        done = run("dataset", "pack", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        archive = self.folder / "out.tar.gz"
        digest = hashlib.sha256(archive.read_bytes()).hexdigest()
        self.assertIn(digest, done.stdout)
        card = self.folder / "out.tar.gz.card.md"
        self.assertIn(digest, card.read_text())
        self.assertTrue(card.read_text().startswith((out / "CARD.md").read_text()))
        with tarfile.open(archive) as tar:
            files = {member.name for member in tar if member.isfile()}
            self.assertEqual({member.uid for member in tar}, {0})
        own = {f"out/{path.relative_to(out)}" for path in out.rglob("*") if path.is_file()}
        self.assertEqual(own - files, {"out/dataset.cells", "out/dataset.timing.csv"})
        self.assertEqual(files - own, set())
        os.utime(out / "CARD.md", (1e9, 1e9))
        run("dataset", "pack", f"{out}/", "--archive", self.folder / "again.tar.gz")
        self.assertEqual((self.folder / "again.tar.gz").read_bytes(), archive.read_bytes())


class BadInput(DatasetTest):
    """Tests of requests that cannot be met: a line, and nothing is written."""

    def refuse(self, *arguments, says, out="out"):
        self.assert_refused("dataset", "run", self.folder / out, *arguments, says=says)

    def test_requests(self):
        torus_file = self.meshes / "torus.off"
        (self.folder / "empty").mkdir()
        self.write("bad.csv", "mesh,license\na.off,CC0\n")
        self.write("size.csv", "file,longest_m\ntorus.off,-1\n")
        self.write("mesh.doc", "x")
        hand = ("--hand", "barrett")
        self.refuse(says=("no --objects given", "holds no data set"))
        self.refuse("--objects", torus_file, says=("no --hand given",))
        self.refuse("--objects", torus_file, "--hand", "barett", says=("barett", "barrett"))
        self.refuse("--objects", self.folder / "none", *hand, says=("no such file",))
        self.refuse("--objects", self.folder / "empty", *hand, says=("holds no mesh",))
        self.refuse("--objects", self.folder / "mesh.doc", *hand, says=("no list of meshes",))
        self.refuse("--objects", self.folder / "bad.csv", *hand, says=('column "mesh" is none of',))
        self.refuse("--objects", self.folder / "size.csv", *hand,
                    says=("line 2: longest_m", '"-1", must be a number > 0'))
        self.refuse("--objects", torus_file, *hand, "--grasps", "0", says=("--grasps",))
        self.refuse("--objects", torus_file, *hand, "--protocol", "gravity",
                    says=("protocol", "gravity", "dexgraspbench-100g"))
        self.refuse("--objects", torus_file, *hand, "--protocol", "none", "--margins", "1",
                    says=("margins",))
        self.refuse("--objects", torus_file, *hand, "--set", "resolution", says=("NAME=VALUE",))
        self.refuse("--objects", torus_file, *hand, "--set", "resolutoin=16",
                    says=("resolutoin", "resolution"))
        self.refuse("--objects", torus_file, *hand, "--longest", "0.1,0", says=("--longest",))
        self.refuse("--objects", torus_file, *hand, "--longest", "0.1", "--mesh-unit", "mm",
                    says=("exclude each other",))
        self.refuse("--objects", torus_file, *hand, "--shard", "3/2", says=("3",))

    def test_another_request_needs_another_folder(self):
        out = self.make_quick("out")
        self.refuse("--objects", self.meshes, "--hand", "barrett", says=("another request",))
        self.refuse("--hand", "barrett", says=("--hand means nothing without --objects",))
        (out / "dataset.details.csv").unlink()
        self.assert_refused("dataset", "pack", out, says=("has no dataset.details.csv",))
        self.assert_refused("dataset", "pack", self.meshes, says=("no finished data set",))
        self.assert_refused("dataset", "status", self.meshes, says=("dataset",))


class OwnConfig(DatasetTest):
    """A data set is an experiment: the same cells by graspfit experiment."""

    def test_run_as_an_experiment(self):
        out, other = self.make_quick("out"), self.folder / "other"
        request = out / "dataset.config.json"
        done = run("experiment", "run", "dataset", "--config", request, "--out", other)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((other / "dataset.csv").read_bytes(), (out / "dataset.csv").read_bytes())
        self.assert_refused("experiment", "run", "dataset", "--config", request, "--publish",
                            "--out", other, says=("--publish means nothing with --config",))
        self.assert_refused("experiment", "run", "force_closure", "--config", request, "--out",
                            other, says=("experiment", "dataset"))


if __name__ == "__main__":
    main()
